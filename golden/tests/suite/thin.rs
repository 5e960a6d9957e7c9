//! Layers thinner than a pitch: a contact's edge falls between the taxels. How far constants and a correction carry.

use std::fmt::Write;

use golden::calibrate::{Settings, calibrate};
use golden::design::Design;
use golden::scene::Medium;
use golden::solver::Solver;

use crate::contacts::{Pressed, Truth, frames, inside};

const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };
/// Of contacts; calibrations have another seed and another way to draw.
const SEED: u64 = 0x7417;
const PITCH_MM: f64 = 4.0;

/// 10 × 10 taxels, with the constants of `hdl-gen new` or another calibration where the estimator has any.
fn design(depth_by_pitch: f64, settings: Option<&Settings>) -> Design {
    let estimator = settings.map_or("line", |_| "joint");
    let depth = PITCH_MM * depth_by_pitch;
    let text = format!(
        "name = \"thin\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [{PITCH_MM:?}, {PITCH_MM:?}]\ndepth_mm = {depth:?}\n\
         [algorithm]\nestimator = \"{estimator}\"\n"
    );
    let mut design = Design::from_toml(&text, "thin").unwrap();
    if let Some(settings) = settings {
        *design.algorithm.joint = calibrate(&design, settings, &mut |_| ()).unwrap();
    }
    design
}

/// Errors of the tangential and of the normal force in percent of the normal one, each in rising order, and frames that are
/// said to be anything but good.
fn judge(design: &Design, set: &[Pressed]) -> ([Vec<f64>; 2], usize) {
    let solver = Solver::new(design).unwrap();
    let (mut errors, mut flagged) = ([Vec::new(), Vec::new()], 0);
    for Truth { frame, outcome } in frames(set, 0.5, 0.0) {
        let found = solver.solve(&frame).unwrap();
        flagged += usize::from(found.status.0 != 0);
        let off = [0, 1, 2].map(|axis| 100.0 * (found.resultant[axis] - outcome.force[axis]) / outcome.force[2].abs());
        errors[0].push(off[0].hypot(off[1]));
        errors[1].push(off[2].abs());
    }
    for errors in &mut errors {
        errors.sort_by(f64::total_cmp);
    }
    (errors, flagged)
}

fn share(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() as f64 * share).ceil() as usize).clamp(1, sorted.len()) - 1]
}

#[test]
#[ignore = "prints the table of thin layers in docs/contacts.md; minutes"]
fn table() {
    for ratio in [0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.75, 1.0] {
        let kinds = [None, Some(Settings::constants()), Some(Settings::default())];
        for (name, settings) in ["line", "joint, as new", "joint, calibrated"].into_iter().zip(kinds) {
            let design = design(ratio, settings.as_ref());
            let ([tangential, normal], flagged) = judge(&design, &inside(&design.sensor, LAYER, SEED, 200));
            let mut row = format!("| {ratio} | {name} |");
            for errors in [tangential, normal] {
                let [median, most, worst] = [0.5, 0.95, 1.0].map(|part| share(&errors, part));
                // Writing to a String cannot fail.
                let _ = write!(row, " {median:.1} / {most:.1} / {worst:.1} |");
            }
            println!("{row} {flagged} |");
        }
    }
}
