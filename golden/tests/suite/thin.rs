//! Layers thinner than a pitch: a contact's edge falls between the taxels. How far constants and a correction carry.

use std::fmt::Write;

use golden::calibrate::{Settings, calibrate};
use golden::design::Design;
use golden::scene::Medium;
use golden::solver::Solver;

use crate::contacts::{errors_of, frames, inside};
use crate::families::share;

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

#[test]
#[ignore = "prints the table of thin layers in docs/contacts.md; minutes"]
fn table() {
    for ratio in [0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.75, 1.0] {
        let kinds = [None, Some(Settings::constants()), Some(Settings::default())];
        for (name, settings) in ["line", "joint, as new", "joint, calibrated"].into_iter().zip(kinds) {
            let design = design(ratio, settings.as_ref());
            let frames = frames(&inside(&design.sensor, LAYER, SEED, 200), 0.5, 0.0);
            let ([tangential, normal], flagged) = errors_of(&Solver::new(&design).unwrap(), &frames);
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
