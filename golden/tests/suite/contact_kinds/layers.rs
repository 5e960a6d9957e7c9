//! Layers further from what the design says than any of the calibration: another Poisson's ratio, another depth.

use std::fmt::Write;

use golden::design::Sensor;
use golden::scene::{Kind, Medium, SceneFrame};
use golden::solver::Solver;

use super::{Judged, cells, design, judge, share};
use crate::designs::{ESTIMATORS, renew_table};

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
fn frames(sensor: &Sensor, (_, poisson, depth): Layer, seeds: std::ops::Range<u64>) -> Vec<SceneFrame> {
    let frame = |seed| {
        let mut scene = Kind::Sliding.scene(sensor, 0.5, seed);
        scene.medium = Medium::BondedLayer { poisson };
        scene.sensor_errors.depth = depth;
        scene.frames().unwrap().remove(0)
    };
    seeds.map(frame).collect()
}

#[test]
#[ignore = "writes results/layers.csv; minutes"]
fn table() {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let solvers = ["none", "fast", "wide"].map(|kind| Solver::new(&design(&format!("{sensor}-{kind}"))).unwrap());
        for layer in LAYERS {
            let frames = frames(solvers[0].matrices().sensor(), layer, 1000..1200);
            for (estimator, solver) in ["line", "sliding", "general"].iter().zip(&solvers) {
                // Writing to a String cannot fail.
                let _ = writeln!(rows, "{},{},{estimator},{}", &sensor[6..], layer.0, cells(&judge(solver, &frames)));
            }
        }
    }
    renew_table("layers.csv", &ESTIMATORS, "sensor,layer,estimator,median,p95,worst", &rows);
}

/// Error of a frame's tangential force in percent of the normal force: along its push, more than 0 for too much, and
/// across.
fn error_of(solver: &Solver, frame: &SceneFrame) -> [f64; 2] {
    let found = solver.solve(&frame.stress).unwrap();
    let [x, y] = [0, 1].map(|axis| 100.0 * (found.resultant[axis] - frame.force[axis]) / frame.force[2].abs());
    let (sin, cos) = frame.direction.sin_cos();
    [x * cos + y * sin, y * cos - x * sin]
}

/// Mean error along the push in percent of the normal force, more than 0 for too much of it.
fn mean_along(solver: &Solver, frames: &[SceneFrame]) -> f64 {
    let along = |frame: &SceneFrame| error_of(solver, frame)[0];
    frames.iter().map(along).sum::<f64>() / frames.len() as f64
}

/// On either sensor, with the general training set: the most that the median and 95 % of the errors may be, in percent,
/// and which way they go.
#[test]
fn layers_unlike_the_design_err_as_stated() {
    for sensor in ["sensor1", "sensor2"] {
        let solver = Solver::new(&design(&format!("{sensor}-wide"))).unwrap();
        for (layer, limits) in [(LAYERS[3], [9.0, 14.0]), (LAYERS[5], [7.0, 9.0])] {
            let frames = frames(solver.matrices().sensor(), layer, 5000..5024);
            let Judged { errors, .. } = judge(&solver, &frames);
            let found = [0.5, 0.95].map(|part| share(&errors, part));
            let along = mean_along(&solver, &frames);
            let said = format!("{sensor}, {}: {found:.1?}, {along:+.1}", layer.0);
            assert!(found.iter().zip(limits).all(|(found, limit)| *found < limit), "{said}");
            assert!(along.abs() > 3.0 && (along > 0.0) == (layer.2 >= 0.0), "{said}");
        }
    }
}
