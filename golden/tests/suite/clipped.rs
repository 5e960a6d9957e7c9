//! Sensors that read no tension: what a calibration on clipped frames reaches, on contacts that it has not seen.

use std::fmt::Write;

use crate::contact_kinds::{cells, has_own_friction, judge as judged, share};
use crate::contacts::{Pressed, Truth, errors_of as judge, frames, inside};
use crate::designs::{design, renew_table};
use golden::scene::{Kind, Medium};
use golden::solver::Solver;

const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };
/// Of contacts; the calibrations have seed 1 and another way to draw.
const SEED: u64 = 0x5eed_0ff0;
const FRICTIONS: [f64; 3] = [0.2, 0.5, 0.8];

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
    for (sensor, limits) in [("sensor1", [4.2, 8.4, 9.8]), ("sensor2", [4.3, 9.7, 11.0])] {
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
#[ignore = "writes results/clipped.csv; seconds"]
fn table() {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        for (kind, training_set) in [("fast", "\"sliding, for tension\""), ("clipped-wide", "general")] {
            let design = design(&format!("{sensor}-{kind}"));
            let solver = Solver::new(&design).unwrap();
            for (poisson, noise) in [(0.49, 0.0), (0.49, 0.002), (0.47, 0.0)] {
                let set = inside(&design.sensor, Medium::BondedLayer { poisson }, SEED, 200);
                for friction in FRICTIONS {
                    let ([tangential, normal], _) = judge(&solver, &clipped(&set, friction, noise));
                    let [median, most, worst] = [0.5, 0.95, 1.0].map(|part| share(&tangential, part));
                    let (sensor, noise, normal) = (&sensor[6..], 100.0 * noise, share(&normal, 0.95));
                    // Writing to a String cannot fail.
                    let _ = writeln!(
                        rows,
                        "{sensor},{training_set},{poisson},{noise},{friction},{median:.1},{most:.1},{worst:.1},{normal:.1}"
                    );
                }
            }
        }
    }
    let names = ["sensor1-fast", "sensor1-clipped-wide", "sensor2-fast", "sensor2-clipped-wide"];
    let columns = "sensor,training_set,poisson,noise,friction,median,p95,worst,normal_p95";
    renew_table("clipped.csv", &names, columns, &rows);
}

#[test]
#[ignore = "writes results/clipped-kinds.csv; minutes"]
fn kinds() {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let design = design(&format!("{sensor}-clipped-wide"));
        let solver = Solver::new(&design).unwrap();
        for kind in Kind::all() {
            let count = if has_own_friction(kind) { 2000 } else { 200 };
            let mut frames = kind.frames(&design.sensor, 0.5, 1000..1000 + count).unwrap();
            for stress in frames.iter_mut().flat_map(|frame| &mut frame.stress) {
                *stress = stress.min(0.0);
            }
            let _ = writeln!(rows, "{},{kind},general,{}", &sensor[6..], cells(&judged(&solver, &frames)));
        }
    }
    let names = ["sensor1-clipped-wide", "sensor2-clipped-wide"];
    renew_table("clipped-kinds.csv", &names, "sensor,kind,training_set,median,p95,worst", &rows);
}
