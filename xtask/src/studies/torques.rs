//! Torques of single contacts: where a contact presses, and how it turns.

use std::fmt::Write;

use golden::contacts::ContactForces;
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame};
use golden::sensor::Sensor;
use golden::solver::{Solver, SolverError};

use super::{Rows, contact_kinds, design};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,kind,line_tz_median,line_tz_p95,line_tz_worst,tz_median,tz_p95,tz_worst,own_median,own_p95,own_worst,own_true,place_median,place_p95,place_worst,along,beside";
/// The designs of the table.
pub const DESIGNS: [&str; 4] = ["sensor1-none", "sensor1-wide", "sensor2-none", "sensor2-wide"];

/// Errors over the normal force in mm.
struct Torques {
    /// Distance from where the normal force acts to where it is found: the error of `T_x` and `T_y`,
    place: Quantiles,
    /// the mean of it along the push,
    along: f64,
    /// and what is left where that is taken off.
    beside: Quantiles,
    /// Of `T_z` about the middle of the grid,
    about_middle: Quantiles,
    /// of that about the place where the normal force acts, as found and as it is,
    own: Quantiles,
    /// and how large this is.
    is: Quantiles,
}

/// Torque about the axis along z through where the normal force acts.
fn own(sensor: &Sensor, force: [f64; 3], torque: [f64; 3]) -> ([f64; 2], f64) {
    let centre = ContactForces::centre_of(sensor, force, torque);
    (centre, torque[2] - sensor.torque_of(centre, force)[2])
}

fn judge(solver: &Solver, frames: &[SceneFrame]) -> Result<Torques, SolverError> {
    let sensor = solver.matrices().sensor();
    let mut errors = [const { Vec::new() }; 4];
    let mut shifts = Vec::new();
    for frame in frames {
        let found = solver.solve(&frame.stress)?;
        let (truth, true_own) = own(sensor, frame.force, frame.torque);
        let (centre, found_own) = own(sensor, found.resultant, found.torque);
        let normal = frame.force[2].abs();
        let (sin, cos) = frame.direction.sin_cos();
        let [x, y] = [0, 1].map(|axis| centre[axis] - truth[axis]);
        shifts.push([x * cos + y * sin, y * cos - x * sin].map(|part| 1e3 * part));
        let of_frame = [
            x.hypot(y),
            (found.torque[2] - frame.torque[2]).abs() / normal,
            (found_own - true_own).abs() / normal,
            true_own.abs() / normal,
        ];
        errors.iter_mut().zip(of_frame).for_each(|(all, error)| all.push(1e3 * error));
    }
    let [place, about_middle, own, is] = errors.map(Quantiles::of);
    let along = shifts.iter().map(|[along, _]| along).sum::<f64>() / shifts.len() as f64;
    let beside = Quantiles::of(shifts.iter().map(|[shift, across]| (shift - along).hypot(*across)).collect());
    Ok(Torques { place, along, beside, about_middle, own, is })
}

/// The table.
pub fn rows() -> Rows {
    let mut rows = String::new();
    let row = |Quantiles { median, most, worst }: Quantiles| format!("{median:.2},{most:.2},{worst:.2}");
    let solvers: Vec<Solver> = DESIGNS.iter().map(|name| Solver::new(&design(name))).collect::<Result<_, _>>()?;
    for kind in Kind::all() {
        for (index, solvers) in solvers.chunks(2).enumerate() {
            let [line, wide] = [&solvers[0], &solvers[1]];
            let frames = contact_kinds::frames(wide.matrices().sensor(), kind, 0.5)?;
            let line = judge(line, &frames)?;
            let Torques { place, along, beside, about_middle, own, is } = judge(wide, &frames)?;
            let [line, about_middle, own, place] = [line.about_middle, about_middle, own, place].map(row);
            let (sensor, own_true, beside) = (index + 1, is.median, beside.median);
            // Writing to a String cannot fail.
            let _ = writeln!(
                rows,
                "{sensor},{kind},{line},{about_middle},{own},{own_true:.2},{place},{along:.2},{beside:.2}"
            );
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Within the grid a contact's place is known to a fraction of the pitch, and `T_z` to what the tangential force errs by times
    /// its arm.
    #[test]
    fn torques_are_near_the_true_ones_on_every_kind() {
        let solver = Solver::new(&design("sensor2-wide")).expect("matrices");
        for kind in Kind::all() {
            let frames = kind.frames(solver.matrices().sensor(), 0.5, 0..8).expect("frames");
            let Torques { place, along, beside, about_middle, own, is } = judge(&solver, &frames).expect("forces");
            let said = format!("{}: {place:?} {along} {beside:?} {about_middle:?} {own:?} {is:?}", kind.title());
            // Too far along the push, and hardly anything else.
            if kind == Kind::Sliding {
                assert!((0.4..0.7).contains(&along) && beside.median < 0.25, "{said}");
            }
            match kind {
                Kind::Border | Kind::Mixed => {}
                // What turns about its own axis presses and pulls as what does not.
                Kind::Spinning => {
                    assert!(place.median < 0.8 && own.median > 0.9 * is.median && is.median > 0.5, "{said}");
                }
                _ => assert!(place.median < 0.8 && about_middle.median < 0.6 && own.median < 0.3, "{said}"),
            }
        }
    }
}
