//! Whether the taxels of frames stand in the order of the sensor.

use nalgebra::DVector;

use crate::design::Sensor;
use crate::matrices::Matrices;
use crate::names::MatrixName;
use crate::parity::FoldedMatrix;

/// Frames looked at; more tell no more.
const FRAMES: usize = 32;
/// Share of pulls among the normal forces above which something is wrong: contacts reach an eighth, by friction.
const SUSPICIOUS: f64 = 0.13;
/// Another order explains the frames if it leaves this share of the pulls,
const BETTER: f64 = 0.6;
/// and no order does where pulls make up this share without one: the forces alternate like a checkerboard.
const ALTERNATING: f64 = 0.2;

/// An order of taxels: the index in a frame of the value that belongs to taxel `iy * columns + ix`.
type Order = fn(&Sensor, usize, usize) -> usize;

/// Orders that people's wiring has.
const OTHERS: [(Order, &str); 2] = [
    (
        |sensor, ix, iy| ix * sensor.rows + iy,
        "column after column; put taxel i = iy * columns + ix at place i of a line, x first, or swap x and y in \
         sensor.columns, rows and pitch_mm",
    ),
    (
        |sensor, ix, iy| iy * sensor.columns + if iy % 2 == 1 { sensor.columns - 1 - ix } else { ix },
        "every second row backwards; let each row begin at the same side",
    ),
];

/// Normal forces press; where the stress is put on the wrong taxels, its inverse alternates between push and pull.
pub(super) fn check(sensor: &Sensor, matrices: &Matrices, loaded: &[Vec<f64>]) -> Option<String> {
    let inverse = matrices.folded(MatrixName::C33inv);
    let step = loaded.len().div_ceil(FRAMES);
    let frames: Vec<&Vec<f64>> = loaded.iter().step_by(step.max(1)).collect();
    let pulls = |order: Order| pulls(sensor, &inverse, &frames, order);
    let found = pulls(|sensor, ix, iy| iy * sensor.columns + ix);
    if found < SUSPICIOUS {
        return None;
    }
    let percent = 100.0 * found;
    for (order, cause) in OTHERS {
        let other = pulls(order);
        if other < BETTER * found {
            return Some(format!(
                "the normal forces alternate, {percent:.0} % of them pull, as if the frames held {cause} (which would \
                 leave {:.0} %)",
                100.0 * other
            ));
        }
    }
    (found > ALTERNATING).then(|| {
        format!(
            "the normal forces alternate like a checkerboard, {percent:.0} % of them pull: are the taxels in another \
             order than i = iy * columns + ix, is sensor.depth_mm too large, or the noise for lack of \
             algorithm.regularisation?"
        )
    })
}

/// The share of pulls in the normal forces, the mean over frames.
fn pulls(sensor: &Sensor, inverse: &FoldedMatrix, frames: &[&Vec<f64>], order: Order) -> f64 {
    let share = |frame: &&Vec<f64>| {
        let taxels =
            (0..sensor.taxels()).map(|taxel| frame[order(sensor, taxel % sensor.columns, taxel / sensor.columns)]);
        let forces = inverse * &DVector::from_iterator(sensor.taxels(), taxels);
        let [pull, all] = forces.iter().fold([0.0, 0.0], |[pull, all], f| [pull + f.max(0.0), all + f.abs()]);
        if all > 0.0 { pull / all } else { 0.0 }
    };
    frames.iter().map(share).sum::<f64>() / frames.len() as f64
}
