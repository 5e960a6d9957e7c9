//! Layers thinner than a pitch: a contact's edge falls between the taxels. How far constants and a correction carry.

use std::fmt::Write;

use golden::calibrate::{Settings, calibrate};
use golden::design::Design;
use golden::kernel::Kernel;
use golden::solver::{Solver, SolverError, Status};

use super::contacts::{LAYER, errors_of, frames, inside};
use super::{Fallible, Rows, cells};
use crate::PLAIN_DESIGN;

/// The columns of [`rows`].
pub const COLUMNS: &str =
    "depth_over_pitch,kernel,estimator,median,p95,worst,normal_median,normal_p95,normal_worst,not_good";
/// Of contacts; calibrations have another seed and another way to draw.
const SEED: u64 = 0x7417;
const PITCH_MM: f64 = 4.0;
/// The word in a design, with constants to start from.
const JOINT: &str = "\"joint\"\ngain = 1\nfriction_correction = [1, 0]";

/// 10 × 10 taxels, calibrated where the estimator is the joint one.
fn design(depth_by_pitch: f64, kernel: Kernel, settings: Option<&Settings>) -> Fallible<Design> {
    let (depth, estimator) = (PITCH_MM * depth_by_pitch, settings.map_or("\"line\"", |_| JOINT));
    let text = format!(
        "{PLAIN_DESIGN}name = \"thin\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = {:?}\ndepth_mm = {depth:?}\n\
         [algorithm]\nestimator = {estimator}\nkernel = \"{kernel}\"\n",
        [PITCH_MM; 2]
    );
    let mut design = Design::from_toml(&text, "thin")?;
    if let Some(settings) = settings {
        *design.algorithm.joint = calibrate(&design, settings, &mut || ())?;
    }
    Ok(design)
}

/// Errors of frames along the surface and of the normal force in rising order, frames that have another status than that of
/// low confidence, and those with low confidence.
fn judge(design: &Design, count: usize) -> Result<([Vec<f64>; 2], usize, usize), SolverError> {
    let frames = frames(&inside(&design.sensor, LAYER, SEED, count), 0.5, 0.0);
    let solver = Solver::new(design)?;
    let statuses: Vec<Status> =
        frames.iter().map(|truth| Ok(solver.solve(&truth.frame)?.status)).collect::<Result<_, SolverError>>()?;
    let low_confidence = statuses.iter().filter(|status| status.contains(Status::LOW_CONFIDENCE)).count();
    let other = statuses.iter().filter(|status| status.0 & !Status::LOW_CONFIDENCE.0 != 0).count();
    Ok((errors_of(&solver, &frames).0, other, low_confidence))
}

/// The table, errors in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for kernel in [Kernel::Point, Kernel::Cell] {
        // By points there is nothing below 0.3.
        let thinnest = [0.2, 0.25].into_iter().filter(|_| kernel == Kernel::Cell);
        for ratio in thinnest.chain([0.3, 0.35, 0.4, 0.5, 0.6, 0.75, 1.0]) {
            let kinds = [None, Some(Settings::constants()), Some(Settings::default())];
            for (name, settings) in ["line", "\"grid, as new\"", "\"grid, calibrated\""].into_iter().zip(kinds) {
                let (errors, other, _) = judge(&design(ratio, kernel, settings.as_ref())?, 200)?;
                let [tangential, normal] = errors.map(cells);
                // Writing to a String cannot fail.
                let _ = writeln!(rows, "{ratio},{kernel},{name},{tangential},{normal},{other}");
            }
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use golden::metrics::Quantiles;
    use rayon::prelude::*;

    use super::*;

    /// What thin layers come to, on 20 frames: medians in percent along the surface and of the normal force, at least and at most;
    /// and that every frame says so where the design is beyond its limit.
    #[test]
    fn thin_layers_are_as_bad_as_the_table_says_and_their_frames_say_so() {
        let constants = Settings::constants();
        let quick = Settings::quick();
        let cases = [
            (0.5, Kernel::Point, None, [12.0, 21.0], [48.0, 57.0], 20),
            (0.5, Kernel::Cell, None, [12.0, 30.0], [0.0, 8.0], 20),
            (0.5, Kernel::Point, Some(&constants), [4.0, 11.0], [0.0, 2.0], 0),
            (0.4, Kernel::Point, Some(&constants), [8.0, 20.0], [0.0, 3.0], 20),
            (0.4, Kernel::Cell, Some(&constants), [4.0, 10.0], [0.0, 3.0], 0),
            (0.3, Kernel::Cell, Some(&constants), [5.0, 12.0], [0.0, 4.0], 20),
            (0.3, Kernel::Cell, Some(&quick), [1.0, 7.0], [0.0, 4.0], 0),
            (1.0, Kernel::Point, None, [1.0, 5.0], [5.0, 8.0], 0),
        ];
        cases.into_par_iter().for_each(|(ratio, kernel, settings, tangential, normal, marked)| {
            let design = design(ratio, kernel, settings).expect("a calibrated design");
            let (errors, _, low_confidence) = judge(&design, 20).expect("forces");
            let medians = errors.map(|errors| Quantiles::of(errors).median);
            let said = format!("{ratio}, {kernel}, {}: {medians:.1?}, {low_confidence}", design.algorithm.estimator);
            for (median, [least, most]) in medians.into_iter().zip([tangential, normal]) {
                assert!((least..=most).contains(&median), "{said}");
            }
            assert_eq!(low_confidence, marked, "{said}");
            assert_eq!(design.thin_layer().is_some(), marked > 0, "{said}");
        });
    }
}
