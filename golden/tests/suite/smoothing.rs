//! Averages over frames, and creep: what they follow, what restarts them, and the same in every way to solve many frames.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::Design;
use golden::scene::{Kind, normal};
use golden::smoothing::{Average, RESTART, Smoothing};
use golden::solver::{PIECE, Past, Solution, Solver, Status};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const NOISE: f64 = 0.01;

/// Frames of 100 taxels with one that reads 1 and noise.
fn noisy(random: &mut ChaCha8Rng) -> Vec<f64> {
    (0..100).map(|taxel| if taxel == 44 { -1.0 } else { 0.0 } + NOISE * normal(random)).collect()
}

#[test]
fn noise_alone_hardly_ever_restarts() {
    const FRAMES: usize = 40_000;
    for k in [1, 2, 4, 8] {
        let smoothing = Smoothing::new(k, NOISE, None);
        let (mut average, mut random) = (Average::default(), ChaCha8Rng::seed_from_u64(7));
        let mut restarts = 0;
        let (mut squares, mut count) = (0.0, 0.0);
        for number in 0..FRAMES {
            let frame = noisy(&mut random);
            let mut smoothed = frame.clone();
            smoothing.take(&mut average, &mut smoothed, &[]);
            restarts += usize::from(number > 0 && smoothed == frame);
            if number > 2000 {
                squares += smoothed[..44].iter().map(|stress| stress * stress).sum::<f64>();
                count += 44.0;
            }
        }
        let weight = 0.5_f64.powi(k as i32);
        let expected = NOISE * (weight / (2.0 - weight)).sqrt();
        let found = f64::sqrt(squares / count);
        println!("k = {k}: {restarts} restarts of {FRAMES}, noise {found:.6}, expected {expected:.6}");
        assert!(restarts * 10_000 < FRAMES, "k = {k}: {restarts}");
        assert!((found / expected - 1.0).abs() < 0.03, "k = {k}: {found} {expected}");
    }
}

/// Frame by frame after a restart, what the average says of its noise is what is found in 44 taxels of 500 streams.
#[test]
fn the_noise_left_is_known_from_the_restart_on() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for k in [1, 2, 4] {
        let smoothing = Smoothing::new(k, NOISE, None);
        let (mut squares, mut said) = ([0.0; 12], [0.0; 12]);
        for _ in 0..500 {
            let mut average = Average::default();
            for (squares, said) in squares.iter_mut().zip(&mut said) {
                let mut frame = noisy(&mut random);
                *said = smoothing.take(&mut average, &mut frame, &[]);
                *squares += frame[..44].iter().map(|stress| stress * stress).sum::<f64>() / (500.0 * 44.0);
            }
        }
        assert_eq!(said[0], 1.0);
        for (n, (squares, said)) in squares.iter().zip(said).enumerate() {
            let found = squares.sqrt() / NOISE;
            assert!((found / said - 1.0).abs() < 0.03, "k = {k}, frame {n}: {found} {said}");
        }
    }
}

#[test]
fn a_step_is_followed_at_once_or_within_its_frames() {
    for k in 1..=8 {
        let smoothing = Smoothing::new(k, NOISE, None);
        let mut average = Average::default();
        let mut take = |stress: f64| {
            let mut frame = [stress, -1.0];
            smoothing.take(&mut average, &mut frame, &[]);
            frame[0]
        };
        assert_eq!(take(0.0), 0.0);
        let above = -1.01 * RESTART * NOISE;
        assert_eq!(take(above), above, "a step above the limit restarts");
        assert_eq!(take(above), above, "what is constant stays");
        // Below the limit it is left by a factor of 1 - 2^-k with each frame.
        let below = above - 0.9 * RESTART * NOISE;
        let frames = 5 * (1 << k);
        let last = (0..frames).map(|_| take(below)).last().unwrap();
        assert!((last - below).abs() < 0.01 * (below - above).abs(), "k = {k}: {last} {below}");
        assert_eq!(take(0.0), 0.0, "a release restarts");
    }
}

/// All of it is noise.
const ERROR: &str = "standard_error = { model = 0.001, noise = 10.0, border = 0.0 }\nmax_standard_error = 1.0";

fn design(more: &str) -> Design {
    let text = format!(
        "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n{ERROR}\n[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\nnoise = 0.01\n{more}"
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

#[test]
fn frames_are_averaged_alike_however_they_are_solved() {
    let creep = "creep = { strength = 0.1, seconds = 0.2, frames_per_second = 100.0 }\n";
    let smooth = design(&format!("smoothing = 2\ndead = [3]\ncrosstalk = 0.01\n{creep}"));
    let plain = design("dead = [3]\ncrosstalk = 0.01\n");
    let [solver, without] = [&smooth, &plain].map(|design| Solver::new(design).unwrap());
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let contacts = Kind::Sliding.frames(&smooth.sensor, 0.5, 1..3).unwrap();
    let mut frames = Vec::new();
    let mut frame_of = |contact: usize| {
        let mut stress = contacts[contact].stress.clone();
        let peak = stress.iter().fold(0.0_f64, |peak, stress| peak.max(stress.abs()));
        for stress in &mut stress {
            *stress += NOISE * peak * normal(&mut random);
        }
        smooth.deliver(&mut stress);
        stress
    };
    for number in 0..2 * PIECE + 5 {
        frames.push(frame_of(usize::from(number % 40 >= 20)));
    }
    frames[9][0] = f64::NAN;
    // By hand: averages of what is decoded, without creep, restarted where the contact changes. Creep is too slow to restart them.
    let decoded: Vec<Vec<f64>> =
        frames.iter().map(|frame| (0..30).map(|taxel| smooth.input.to_pa(taxel, frame[taxel])).collect()).collect();
    let (mut expected, mut average): (Vec<Solution>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut variance = 1.0;
    let mut crept = vec![0.0; 30];
    for (number, frame) in decoded.iter().enumerate() {
        if number == 9 {
            expected.push(without.solve(frame).unwrap());
            assert_eq!(expected[9].status, Status::NOT_FINITE);
            continue;
        }
        let frame: Vec<f64> = frame.iter().zip(&crept).map(|(stress, crept)| stress - crept).collect();
        let share = 1.0 - f64::exp(-1.0 / 20.0);
        crept.iter_mut().zip(&frame).for_each(|(crept, stress)| *crept += share * (0.1 * stress - *crept));
        if number % 20 == 0 {
            average.clone_from(&frame);
            variance = 1.0;
        } else {
            variance = (9.0 * variance + 1.0) / 16.0;
            average.iter_mut().zip(&frame).for_each(|(average, stress)| *average += (stress - *average) / 4.0);
        }
        let mut solution = without.solve(&average).unwrap();
        solution.standard_error *= f64::sqrt(variance);
        expected.push(solution);
    }
    let close = |found: &[Solution]| {
        for (n, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found.status, expected.status);
            let far = (0..3).map(|axis| (found.resultant[axis] - expected.resultant[axis]).abs()).fold(0.0, f64::max);
            assert!(far < 1e-9, "{n}: {far}");
            let [found, expected] = [found, expected].map(|solution| solution.standard_error);
            assert!((found - expected).abs() <= 1e-9 * expected, "{n}: {found} {expected}");
        }
    };
    close(&solver.solve_in_order(&frames).unwrap());
    // In batches that go on with the average.
    let (mut workspace, mut together, mut some) = (solver.workspace(), Vec::new(), Vec::new());
    for part in frames.chunks(50) {
        solver.solve_batch(&mut workspace, part, &mut some).unwrap();
        together.append(&mut some);
    }
    close(&together);
    // On all cores, in two calls and a single frame.
    let mut past = Past::default();
    let mut on_cores = vec![Solution::zeros(Status::default(), 0); frames.len()];
    for (begin, end) in [(0, 70), (70, 71), (71, frames.len())] {
        let places = on_cores[begin..end].chunks_mut(PIECE);
        let values = frames[begin..end].concat();
        solver
            .solve_on_all_cores(&values, &mut past, places, |place, index, found| place[index].clone_from(found))
            .unwrap();
    }
    close(&on_cores);
    // A frame alone has no average.
    assert_eq!(solver.solve(&frames[5]).unwrap(), without.solve(&frames[5]).unwrap());
}

/// A sensor's own frames creep, so that the solver finds a held contact's force constant.
#[test]
fn frames_that_are_delivered_in_order_creep() {
    let creeping = design("crosstalk = 0.01\ncreep = { strength = 0.4, seconds = 0.2, frames_per_second = 100.0 }\n");
    let contact = Kind::Sliding.frames(&creeping.sensor, 0.5, 1..2).unwrap().remove(0).stress;
    let normal_forces = |deliver: &dyn Fn(&mut Vec<Vec<f64>>)| -> Vec<f64> {
        let mut frames = vec![contact.clone(); 60];
        deliver(&mut frames);
        let found = Solver::new(&creeping).unwrap().solve_in_order(&frames).unwrap();
        found.iter().map(|found| found.resultant[2]).collect()
    };
    let in_order = normal_forces(&|frames| creeping.deliver_in_order(frames));
    assert!(in_order.iter().all(|force| (force / in_order[0] - 1.0).abs() < 1e-9), "{in_order:?}");
    let one_by_one = normal_forces(&|frames| frames.iter_mut().for_each(|frame| creeping.deliver(frame)));
    assert!((one_by_one[0] / in_order[0] - 1.0).abs() < 1e-9 && one_by_one[59] / in_order[0] < 0.8, "{one_by_one:?}");
}
