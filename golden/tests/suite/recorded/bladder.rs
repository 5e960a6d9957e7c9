//! The same pressure on all taxels.

use golden::calibrate::recorded::{Measured, fit_uniform};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::says;
use super::simulated::{COUNTS, design, deviation, gains, normal};

#[test]
fn a_bladder_tells_gains_curve_and_dead_taxels() {
    let mut random = ChaCha8Rng::seed_from_u64(77);
    let truth = gains(&mut random, 0.15);
    let mut measured = Measured::default();
    let mut frames = Vec::new();
    for step in 0..=10 {
        for _ in 0..8 {
            let pressure = 8e3 * f64::from(step);
            frames.push(
                truth
                    .iter()
                    .enumerate()
                    .map(|(taxel, gain)| {
                        let count = (pressure / gain / 5.0).powf(0.8);
                        let count = if taxel == 20 { 0.0 } else { count };
                        (count + 50.0 + 2.0 * normal(&mut random)).round()
                    })
                    .collect(),
            );
            measured.pressures.push(Some(pressure));
            measured.forces.push([None; 3]);
        }
    }
    let found = fit_uniform(&design(COUNTS, ""), &frames, &measured).unwrap();
    let ratios = found.gains.iter().zip(&truth).enumerate().filter(|(taxel, _)| *taxel != 20);
    let off = deviation(ratios.map(|(_, (gain, truth))| gain.gain / truth));
    let errors = found.errors.unwrap();
    println!("bladder: gains within {off:.2} %, pressures {errors:?}");
    assert!(off < 0.5 && errors.median < 1.5 && errors.most < 4.0, "{off} {errors:?}");
    assert_eq!(found.design.input.dead, [20]);
    assert!(
        says(&found.remarks, &["dead: taxels 20"]) && says(&found.determined, &["curve: a power of 1.25"]),
        "{:?}",
        found.determined
    );
    // The pressure of every frame, from the design alone.
    for (frame, pressure) in frames.iter().zip(&measured.pressures).skip(16).step_by(7) {
        for taxel in [0, 33, 77] {
            let pascals = -found.design.input.to_pa(taxel, frame[taxel]);
            assert!((pascals / pressure.unwrap() - 1.0).abs() < 0.06, "{taxel}: {pascals} {pressure:?}");
        }
    }
    // One pressure tells gains, and no curve.
    let one: Vec<usize> = (0..16).collect();
    let some = |of: &[Vec<f64>]| one.iter().map(|&k| of[k].clone()).collect::<Vec<_>>();
    measured.pressures.truncate(16);
    measured.forces.truncate(16);
    let found = fit_uniform(&design(COUNTS, ""), &some(&frames), &measured).unwrap();
    assert!(
        found.errors.is_none() && says(&found.undetermined, &["curve: 1 pressure", "five or more"]),
        "{:?}",
        found.undetermined
    );
}

/// Each taxel reads the pressure and a share of what its row and its column read of it.
#[test]
fn a_bladder_is_read_through_crosstalk() {
    let crossed = |keys: &str| design(&format!("{keys}\ntension = \"clipped\"\ncrosstalk = 0.02"), "");
    let truth = crossed("pa_per_count = -10.0");
    let pressures: Vec<f64> = [0.0, 8e3, 2e4].into_iter().flat_map(|pressure| [pressure; 8]).collect();
    let delivered = |&pressure: &f64| {
        let mut frame = vec![-pressure; 78];
        truth.deliver(&mut frame);
        frame
    };
    let frames: Vec<Vec<f64>> = pressures.iter().map(delivered).collect();
    let forces = vec![[None; 3]; frames.len()];
    let measured = Measured { pressures: pressures.into_iter().map(Some).collect(), forces, ..Measured::default() };
    let found = fit_uniform(&crossed("pa_per_count = -8.0"), &frames, &measured).unwrap().design.input;
    for taxel in [0, 33, 77] {
        let [found, truth] = [&found, &truth.input].map(|input| input.to_pa(taxel, frames[20][taxel]));
        assert!((found / truth - 1.0).abs() < 1e-3, "{taxel}: {found} {truth}");
    }
}

/// A log of pressures that begins earlier or later than the frames.
#[test]
fn pressures_of_another_moment_are_paired_or_refused() {
    let mut random = ChaCha8Rng::seed_from_u64(78);
    let kilopascals = [0.0, 5.0, 10.0, 20.0, 40.0, 60.0, 30.0, 0.0, 20.0, 60.0, 0.0];
    let pressures: Vec<f64> = kilopascals.into_iter().flat_map(|pressure| [1e3 * pressure; 50]).collect();
    let frames: Vec<Vec<f64>> = pressures
        .iter()
        .map(|pressure| (0..78).map(|_| (pressure / 24.4 + normal(&mut random)).round()).collect())
        .collect();
    let (rest, some) = (vec![0.0; 10], pressures.len() - 10);
    for (logged, said) in [
        ([&rest[..], &pressures[..some]].concat(), "line 11 to frame 1"),
        ([&pressures[10..], &rest[..]].concat(), "line 1 to frame 11"),
    ] {
        let measured = Measured::of_pressures(logged.into_iter().map(Some).collect());
        let found = fit_uniform(&design(COUNTS, ""), &frames, &measured).unwrap();
        assert!(says(&found.remarks, &["paired by what fits best", said]), "{:?}", found.remarks);
        assert!(found.errors.unwrap().worst < 2.0, "{said}: {:?}", found.errors);
        let floor = found.design.algorithm.noise_floor_pa;
        assert!(floor < 5.0 * 24.4, "{said}: {floor}");
    }
    // Lines that are lost in the middle.
    let mut logged = pressures.clone();
    logged.drain(240..270);
    let measured = Measured::of_pressures(logged.into_iter().map(Some).collect());
    let said = fit_uniform(&design(COUNTS, ""), &frames, &measured).unwrap_err().to_string();
    assert!(said.contains("30 lines of pressures are missing"), "{said}");
    // And those of other frames, in as many lines.
    let turned: Vec<_> = pressures.iter().rev().map(|pressure| Some(*pressure)).collect();
    let measured = Measured::of_pressures(turned);
    let missing = fit_uniform(&design(COUNTS, ""), &frames, &measured).map(|found| found.refuse_missing(&measured));
    assert!(!matches!(&missing, Ok(Ok(()))), "{missing:?}");
}
