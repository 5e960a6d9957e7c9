//! Whether the taxels of frames stand in the order of the sensor.

use nalgebra::DVector;

use super::together;
use crate::design::{Design, Sensor, Tension};
use crate::matrices::Matrices;
use crate::names::MatrixName;
use crate::numbers::mean;
use crate::parity::FoldedMatrix;
use crate::scene::{Scene, SensorErrors};

/// Frames looked at; more tell no more.
const FRAMES: usize = 32;
/// Share of pulls among the normal forces above which something is wrong: contacts reach an eighth, by friction, and where
/// the layer is deep for the pitch more, as noise makes them alternate.
const SUSPICIOUS: f64 = 0.13;
/// Noise that frames may have, a share of their peak,
const NOISE: f64 = 0.01;
/// and how many times as many pulls as a contact with that noise has are suspicious.
const MORE: f64 = 1.3;
/// Another order explains the frames if neighbours have so much more in common in it,
const SMOOTHER: f64 = 0.2;
/// and this much.
const ALIKE: f64 = 0.4;
/// Directions in degrees in which that contact is pushed.
const DIRECTIONS: [f64; 3] = [0.0, 45.0, 90.0];
/// Another order explains the frames if it leaves this share of the pulls,
const BETTER: f64 = 0.6;
/// or, of fewer than are suspicious, but more than this share,
const FEW: f64 = 0.015;
/// next to none.
const FAR_BETTER: f64 = 0.3;
/// Taxels a row apart differ by this share of what taxels half a row apart do, squared, and frames do not.
const BELOW: f64 = 0.6;
/// No order does where pulls make up this share without one: the forces alternate like a checkerboard.
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
pub(super) fn check(design: &Design, matrices: &Matrices, loaded: &[Vec<f64>]) -> Option<String> {
    let sensor = &design.sensor;
    let inverse = matrices.folded(MatrixName::C33inv);
    let step = loaded.len().div_ceil(FRAMES);
    let frames: Vec<&Vec<f64>> = loaded.iter().step_by(step.max(1)).collect();
    let alike = |order: Order| alike(sensor, &frames, order);
    let own = alike(|sensor, ix, iy| iy * sensor.columns + ix);
    for (order, cause) in OTHERS {
        let other = alike(order);
        if other > own + SMOOTHER && other > ALIKE {
            return Some(format!(
                "neighbours have little in common (correlation {own:.2}), as if the frames held {cause} (it would be {other:.2})"
            ));
        }
    }
    let pulls = |order: Order| pulls(sensor, &inverse, &frames, order);
    let found = pulls(|sensor, ix, iy| iy * sensor.columns + ix);
    let is_suspicious = found >= SUSPICIOUS;
    // Of good frames of this sensor, which the deeper it is say the less.
    let usual = if is_suspicious { MORE * usual(design, &inverse) } else { FEW };
    if found < usual {
        return None;
    }
    let share = if is_suspicious { BETTER } else { FAR_BETTER };
    let better = |(other, _): &(f64, &str)| *other < share * found;
    if let Some((other, cause)) = OTHERS.map(|(order, cause)| (pulls(order), cause)).into_iter().find(better) {
        return Some(format!(
            "the normal forces alternate, {:.0} % of them pull, as if the frames held {cause} (which would leave {:.0} %)",
            100.0 * found,
            100.0 * other
        ));
    }
    (found > ALTERNATING).then(|| {
        let percent = 100.0 * found;
        let [order, depth] = [
            "are the taxels in another order than i = iy * columns + ix",
            "is sensor.depth_mm too large, or the noise for lack of algorithm.regularisation",
        ];
        // What is likelier comes first.
        let [first, second] = if usual > SUSPICIOUS { [depth, order] } else { [order, depth] };
        format!(
            "the normal forces alternate like a checkerboard, {percent:.0} % of them pull: {first}, or {second}, or did \
             something lie on the sensor when it was tared?"
        )
    })
}

/// Whether an array of as many frames as rows and columns has another axis for its frames, by how smooth it is along each:
/// two axes are of the sensor and alike.
pub(super) fn axes(sensor: &Sensor, frames: &[Vec<f64>]) -> Option<String> {
    let side = sensor.columns;
    if sensor.rows != side || frames.len() != side || side < 4 {
        return None;
    }
    let at = |[i, j, k]: [usize; 3]| frames[i][j * side + k];
    // Squares of the steps along an axis.
    let steps = |axis: usize| -> f64 {
        let step = |index: usize| {
            let mut place = [index / (side * side), index / side % side, index % side];
            let here = at(place);
            place[axis] += 1;
            if place[axis] < side { (at(place) - here).powi(2) } else { 0.0 }
        };
        (0..side.pow(3)).map(step).sum()
    };
    let steps = [0, 1, 2].map(steps);
    let apart = |a: usize, b: usize| (steps[a] / steps[b]).ln().abs();
    let [first, middle, last] = [apart(1, 2), apart(0, 2), apart(0, 1)];
    if !first.is_finite() || first < 1.5_f64.ln() || middle.min(last) > 0.5 * first {
        return None;
    }
    let (axis, remedy) = if last <= middle { ("last", "2") } else { ("middle", "1") };
    Some(format!(
        "the array is as rough along its first axis as along one of the others, and the {axis} one is unlike both: are its \
         frames along the {axis} axis? Save numpy.moveaxis(frames, {remedy}, 0)"
    ))
}

/// Whether a file of as many frames as taxels has a line for each taxel. Taxels that are a row of the grid apart are alike,
/// here along the frames' axis.
pub(super) fn swapped(sensor: &Sensor, frames: &[Vec<f64>]) -> Option<String> {
    let (taxels, columns) = (sensor.taxels(), sensor.columns);
    if frames.len() != taxels || columns < 4 || sensor.rows < 3 {
        return None;
    }
    // Mean square of the difference of values so far apart.
    let apart = |lag: usize, value: &dyn Fn(usize, usize) -> f64| -> f64 {
        let step = |at: usize, other: usize| (value(at + lag, other) - value(at, other)).powi(2);
        let squares: f64 = (0..taxels - lag).map(|at| (0..taxels).map(|other| step(at, other)).sum::<f64>()).sum();
        squares / (taxels - lag) as f64
    };
    let is_grid = |value: &dyn Fn(usize, usize) -> f64| apart(columns, value) < BELOW * apart(columns / 2, value);
    let is_swapped = is_grid(&|frame, taxel| frames[frame][taxel]) && !is_grid(&|taxel, frame| frames[frame][taxel]);
    is_swapped.then(|| {
        format!(
            "lines {columns} apart are alike, as taxels below each other, and columns so far apart are not: does each of the \
             {taxels} lines hold a taxel, and each column a frame? Save numpy.transpose(frames)"
        )
    })
}

/// Correlation of neighbours, the mean over frames, where they stand in an order.
fn alike(sensor: &Sensor, frames: &[&Vec<f64>], order: Order) -> f64 {
    let place = |frame: &&Vec<f64>| -> f64 {
        let taxel = |taxel: usize| frame[order(sensor, taxel % sensor.columns, taxel / sensor.columns)];
        together(sensor, &(0..sensor.taxels()).map(taxel).collect::<Vec<_>>())
    };
    mean(frames.iter().map(place))
}

/// The share of pulls of a contact that suits the sensor, with noise; 0 if there is none.
fn usual(design: &Design, inverse: &FoldedMatrix) -> f64 {
    let mut scene = Scene::standing(&design.sensor);
    scene.sweep_deg = DIRECTIONS.to_vec();
    scene.sensor_errors = SensorErrors { seed: 1, noise: NOISE, ..SensorErrors::default() };
    let Ok(mut frames) = scene.frames() else { return 0.0 };
    if design.input.tension == Tension::Clipped {
        frames.iter_mut().flat_map(|frame| &mut frame.stress).for_each(|stress| *stress = stress.min(0.0));
    }
    let frames: Vec<&Vec<f64>> = frames.iter().map(|frame| &frame.stress).collect();
    pulls(&design.sensor, inverse, &frames, |sensor, ix, iy| iy * sensor.columns + ix)
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
