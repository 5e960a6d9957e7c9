//! Sensors that read no tension: what a calibration on clipped frames reaches, on contacts that it has not seen.

use std::fmt::Write;
use std::path::Path;

use crate::contacts::{Pressed, Truth, errors_of as judge, frames, inside, places_inside};
use crate::families::{judge as judged, row, share};
use golden::design::Design;
use golden::scene::{Kind, Medium};
use golden::solver::Solver;

const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };
/// Of contacts; the calibrations have seed 1 and another way to draw.
const SEED: u64 = 0x5eed_0ff0;
const FRICTIONS: [f64; 3] = [0.2, 0.5, 0.8];

fn design(name: &str) -> Design {
    Design::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs").join(format!("{name}.toml"))).unwrap()
}

/// Frames as a sensor reads them that knows no pull.
fn clipped(set: &[Pressed], friction: f64, noise: f64) -> Vec<Truth> {
    let mut frames = frames(set, friction, noise);
    for stress in frames.iter_mut().flat_map(|truth| &mut truth.frame) {
        *stress = stress.min(0.0);
    }
    frames
}

/// What 95 % of 200 contacts keep to at each friction, in percent: of the tangential force, and of the normal one. Trained
/// at a noise of 1 %, on contacts of any kind. What a calibration for sensors that read tension makes of the same frames is
/// beyond any of it.
#[test]
fn one_contact_keeps_to_the_figures() {
    for (sensor, limits) in [("sensor1", [4.2, 8.0, 9.0]), ("sensor2", [4.3, 9.5, 10.5])] {
        let [clipped_one, reads] = ["clipped-wide", "fast"].map(|kind| design(&format!("{sensor}-{kind}")));
        let set = inside(&clipped_one.sensor, LAYER, SEED, 200);
        let [solver, other] = [&clipped_one, &reads].map(|design| Solver::new(design).unwrap());
        for (friction, limit) in FRICTIONS.into_iter().zip(limits) {
            let frames = clipped(&set, friction, 0.0);
            let ([tangential, normal], _) = judge(&solver, &frames);
            let [most, of_normal] = [&tangential, &normal].map(|errors| share(errors, 0.95));
            assert!(most <= limit && of_normal <= 4.6, "{sensor}, µ = {friction}: {most:.2} {of_normal:.2}");
            let ([elsewhere, _], warned) = judge(&other, &frames);
            if friction > 0.3 {
                assert!(share(&elsewhere, 0.5) > 10.0, "{sensor}, µ = {friction}: {:.1}", share(&elsewhere, 0.5));
                assert!(warned >= 195, "{sensor}, µ = {friction}: {warned} frames say that there is no tension");
            }
        }
    }
}

#[test]
#[ignore = "prints the first table of clipped sensors in docs/explanation/accuracy.md; seconds"]
fn table() {
    for sensor in ["sensor1", "sensor2"] {
        for kind in ["fast", "clipped-wide"] {
            let design = design(&format!("{sensor}-{kind}"));
            let solver = Solver::new(&design).unwrap();
            for (poisson, noise) in [(0.49, 0.0), (0.49, 0.002), (0.47, 0.0)] {
                let set = inside(&design.sensor, Medium::BondedLayer { poisson }, SEED, 200);
                let mut row = format!("| {} | {kind} | {poisson} | {} |", &sensor[6..], 100.0 * noise);
                for friction in FRICTIONS {
                    let ([tangential, normal], _) = judge(&solver, &clipped(&set, friction, noise));
                    let [median, most, worst] = [0.5, 0.95, 1.0].map(|part| share(&tangential, part));
                    // Writing to a String cannot fail.
                    let _ = write!(row, " {median:.1} / {most:.1} / {worst:.1} | {:.1} |", share(&normal, 0.95));
                }
                println!("{row}");
            }
        }
    }
}

#[test]
#[ignore = "prints the table of clipped families in docs/explanation/accuracy.md; minutes"]
fn families() {
    for sensor in ["sensor1", "sensor2"] {
        let design = design(&format!("{sensor}-clipped-wide"));
        let solver = Solver::new(&design).unwrap();
        for kind in Kind::ALL {
            let (label, count) = (kind.title(), if kind.has_own_friction() { 2000 } else { 200 });
            let mut frames = kind.frames(&design.sensor, 0.5, 1000..1000 + count).unwrap();
            for stress in frames.iter_mut().flat_map(|frame| &mut frame.stress) {
                *stress = stress.min(0.0);
            }
            let wide = judged(&solver, &frames);
            let [bad, good] =
                wide.doubtful.map(|share| if share.is_nan() { String::new() } else { format!("{share:.0}") });
            println!("| {} | {label} |{} {bad} | {good} | {:.0} |", &sensor[6..], row(&wide), wide.within);
        }
    }
}

/// Which contacts make a sensor's 95 %: errors of one contact, as [`table`], by shape and radius.
#[test]
#[ignore = "prints which contacts of clipped sensors err most, for docs/explanation/accuracy.md; seconds"]
fn by_size() {
    for sensor in ["sensor1", "sensor2"] {
        let design = design(&format!("{sensor}-clipped-wide"));
        let solver = Solver::new(&design).unwrap();
        let set = inside(&design.sensor, LAYER, SEED, 800);
        let places = places_inside(&design.sensor, SEED, 800);
        for friction in FRICTIONS {
            let frames = clipped(&set, friction, 0.0);
            let errors: Vec<f64> =
                frames.iter().map(|frame| judge(&solver, std::slice::from_ref(frame)).0[0][0]).collect();
            let of = |label: &str, belongs: &dyn Fn(usize) -> bool| {
                let mut own: Vec<f64> =
                    errors.iter().enumerate().filter(|(index, _)| belongs(*index)).map(|(_, error)| *error).collect();
                own.sort_by(f64::total_cmp);
                if !own.is_empty() {
                    let [median, most] = [0.5, 0.95].map(|part| share(&own, part));
                    println!("| {sensor} | {friction} | {label} | {} | {median:.1} / {most:.1} |", own.len());
                }
            };
            for (first, last) in [(5.0, 6.0), (6.0, 7.0), (7.0, 8.1), (8.1, 10.1)] {
                let within = |index: usize| (first..last).contains(&(1e3 * places[index].0));
                of(&format!("Hertz, {first} to {last} mm"), &|index| index % 2 == 0 && within(index));
                of(&format!("even, {first} to {last} mm"), &|index| index % 2 == 1 && within(index));
            }
            of("all up to 8.1 mm", &|index| places[index].0 < 8.1e-3);
            of("all", &|_| true);
        }
    }
}
