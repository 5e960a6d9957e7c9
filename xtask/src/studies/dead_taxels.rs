//! What is left of the error of dead taxels whose place is known.

use std::fmt::Write;

use golden::dead_taxels::MOST_DEAD;
use golden::design::Sensor;
use golden::scene::{Contact, Scene, SceneError, SceneFrame, SensorErrors, Shape, Traction};
use golden::solver::{Solver, SolverError, Status};
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::contacts::LAYER;
use super::{Fallible, Rows, design};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,dead,taxels,median,worst";
/// The designs of the table.
pub const DESIGNS: [&str; 2] = ["sensor1-fast", "sensor2-fast"];

/// Frames of contacts of some sizes and places, each pushed in eight directions.
fn scenes(sensor: &Sensor) -> Result<Vec<Vec<SceneFrame>>, SceneError> {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let side = |count: usize, pitch: f64| (count - 1) as f64 * pitch * 1e-3;
    let sides = [side(sensor.columns, sensor.pitch_mm[0]), side(sensor.rows, sensor.pitch_mm[1])];
    let mut scenes = Vec::new();
    for radius in [5e-3, 7e-3, 9e-3] {
        let contact = Contact {
            shape: Shape::Hertz { semi_axes_m: [radius; 2] },
            centre_m: sides.map(|side| side * random.random_range(0.4..0.6)),
            normal_force_n: 6.0,
            friction: 0.5,
            direction_deg: 0.0,
            traction: Traction::default(),
        };
        let scene = Scene {
            sensor: sensor.clone(),
            medium: LAYER,
            contacts: vec![contact],
            sweep_deg: (0..8).map(|step| 45.0 * f64::from(step) + 10.0).collect(),
            sensor_errors: SensorErrors::default(),
        };
        scenes.push(scene.frames()?);
    }
    Ok(scenes)
}

/// The taxels from the most loaded one down.
fn by_load(frame: &SceneFrame) -> Vec<usize> {
    let mut taxels: Vec<usize> = (0..frame.stress.len()).collect();
    taxels.sort_by(|&a, &b| frame.stress[b].abs().total_cmp(&frame.stress[a].abs()));
    taxels
}

/// Median, and worst, in percent.
fn shown(errors: &mut [f64]) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    [errors[errors.len() / 2], errors[errors.len() - 1]].map(|error| 100.0 * error)
}

/// Largest tangential error against the truth, as a share of the normal force, and the status.
fn judge(solver: &Solver, frame: &SceneFrame, dead: &[usize]) -> Result<(f64, Status), SolverError> {
    let mut stress = frame.stress.clone();
    for &taxel in dead {
        stress[taxel] = 0.0;
    }
    let solution = solver.solve(&stress)?;
    let difference = |axis: usize| (solution.resultant[axis] - frame.force[axis]).abs();
    Ok((difference(0).max(difference(1)) / frame.force[2].abs(), solution.status))
}

/// Median and worst error in percent with so many dead taxels, as they read and as they are replaced.
struct Errors {
    dead: usize,
    reads: [f64; 2],
    replaced: [f64; 2],
}

/// Errors without a dead taxel, and with some of the most loaded ones dead.
fn measure(name: &str) -> Fallible<([f64; 2], Vec<Errors>)> {
    let design = design(name);
    let scenes = scenes(&design.sensor)?;
    let plain = Solver::new(&design)?;
    let mut whole: Vec<f64> =
        scenes.iter().flatten().map(|frame| Ok(judge(&plain, frame, &[])?.0)).collect::<Result<_, SolverError>>()?;
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut errors = Vec::new();
    for dead in [1, 2, 4, MOST_DEAD] {
        let (mut reads, mut replaced) = (Vec::new(), Vec::new());
        for frames in &scenes {
            // One at a time of the ten most loaded ones, or as many of the twenty.
            let loaded = by_load(&frames[0]);
            let maps: Vec<Vec<usize>> = if dead == 1 {
                loaded[..10].iter().map(|&taxel| vec![taxel]).collect()
            } else {
                (0..4).map(|_| loaded[..20].choose_multiple(&mut random, dead).copied().collect()).collect()
            };
            for mut dead in maps {
                dead.sort_unstable();
                let mut with_map = design.clone();
                with_map.input.dead.clone_from(&dead);
                let solver = Solver::new(&with_map)?;
                for frame in frames {
                    reads.push(judge(&plain, frame, &dead)?.0);
                    let (error, status) = judge(&solver, frame, &dead)?;
                    assert!(status.contains(Status::REPLACED));
                    replaced.push(error);
                }
            }
        }
        errors.push(Errors { dead, reads: shown(&mut reads), replaced: shown(&mut replaced) });
    }
    Ok((shown(&mut whole), errors))
}

/// The table, errors in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    let mut row = |sensor: usize, dead: &str, taxels: &str, [median, worst]: [f64; 2]| {
        // Writing to a String cannot fail.
        let _ = writeln!(rows, "{sensor},{dead},{taxels},{median:.1},{worst:.1}");
    };
    let [first, second] = [measure(DESIGNS[0])?, measure(DESIGNS[1])?];
    row(1, "none", "no dead taxel", first.0);
    row(2, "none", "no dead taxel", second.0);
    for pair in first.1.iter().zip(&second.1) {
        for (number, Errors { dead, reads, replaced }) in [(1, pair.0), (2, pair.1)] {
            let dead = dead.to_string();
            row(number, &dead, "reads 0", *reads);
            row(number, &dead, "replaced", *replaced);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_make_good_most_of_a_dead_taxels_error() {
        // Most that is allowed with one dead taxel among the ten most loaded: median and worst, in percent.
        for (name, most) in [("sensor1-fast", [2.5, 9.0]), ("sensor2-fast", [3.5, 20.0])] {
            for Errors { dead, reads: was, replaced: is } in measure(name).expect("errors").1 {
                assert!(is[0] < 0.6 * was[0], "{name}: {was:?} to {is:?}");
                assert!(dead > 1 || (is[0] < most[0] && is[1] < most[1]), "{name}: {is:?}");
            }
        }
    }
}
