//! Layers further from what the design says than any of the calibration: another Poisson's ratio, another depth.

use std::fmt::Write;
use std::ops::Range;

use golden::design::Sensor;
use golden::scene::{Kind, Medium, SceneError, SceneFrame};

use super::{Rows, cells, estimators, shear_errors};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,layer,estimator,median,p95,worst";

/// A layer: its Poisson's ratio, and how much deeper it is than the design says, as a share.
type Layer = (&'static str, f64, f64);

const LAYERS: [Layer; 6] = [
    ("as designed", 0.49, 0.0),
    ("ν 0.45", 0.45, 0.0),
    ("ν 0.4", 0.4, 0.0),
    ("ν 0.3", 0.3, 0.0),
    ("10 % deeper", 0.49, 0.1),
    ("10 % less deep", 0.49, -0.1),
];

/// Round sliding contacts, those of [`Kind::Sliding`], on a layer.
fn frames(sensor: &Sensor, (_, poisson, depth): Layer, seeds: Range<u64>) -> Result<Vec<SceneFrame>, SceneError> {
    let frame = |seed| {
        let mut scene = Kind::Sliding.scene(sensor, 0.5, seed);
        scene.medium = Medium::BondedLayer { poisson };
        scene.sensor_errors.depth = depth;
        Ok(scene.frames()?.remove(0))
    };
    seeds.map(frame).collect()
}

/// The table, errors of the tangential force in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let solvers = estimators(sensor)?;
        for layer in LAYERS {
            let frames = frames(solvers[0].1.matrices().sensor(), layer, 1000..1200)?;
            for (estimator, solver) in &solvers {
                let errors = shear_errors(solver, &frames)?;
                // Writing to a String cannot fail.
                let _ = writeln!(rows, "{},{},{estimator},{}", &sensor[6..], layer.0, cells(errors));
            }
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use golden::metrics::Quantiles;
    use golden::solver::Solver;

    use super::*;
    use crate::studies::design;

    /// Mean error along the push in percent of the normal force, more than 0 for too much of it.
    fn mean_along(solver: &Solver, frames: &[SceneFrame]) -> f64 {
        let along = |frame: &SceneFrame| {
            let found = solver.solve(&frame.stress).expect("forces").resultant;
            let [x, y] = [0, 1].map(|axis| 100.0 * (found[axis] - frame.force[axis]) / frame.force[2].abs());
            let (sin, cos) = frame.direction.sin_cos();
            x * cos + y * sin
        };
        frames.iter().map(along).sum::<f64>() / frames.len() as f64
    }

    /// On either sensor, with the general training set: the most that the median and 95 % of the errors may be, in percent,
    /// and which way they go.
    #[test]
    fn layers_unlike_the_design_err_as_stated() {
        for sensor in ["sensor1", "sensor2"] {
            let solver = Solver::new(&design(&format!("{sensor}-wide"))).expect("matrices");
            for (layer, limits) in [(LAYERS[3], [9.0, 14.0]), (LAYERS[5], [7.0, 9.0])] {
                let frames = frames(solver.matrices().sensor(), layer, 5000..5024).expect("frames");
                let Quantiles { median, most, .. } = Quantiles::of(shear_errors(&solver, &frames).expect("forces"));
                let found = [median, most];
                let along = mean_along(&solver, &frames);
                let said = format!("{sensor}, {}: {found:.1?}, {along:+.1}", layer.0);
                assert!(found.iter().zip(limits).all(|(found, limit)| *found < limit), "{said}");
                assert!(along.abs() > 3.0 && (along > 0.0) == (layer.2 >= 0.0), "{said}");
            }
        }
    }
}
