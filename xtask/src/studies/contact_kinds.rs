//! Contacts of other kinds than those that the estimators were made for.

use std::fmt::Write;

use golden::design::Sensor;
use golden::scene::{Kind, SceneError, SceneFrame};

use super::{Rows, cells, estimators, shear_errors};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,kind,estimator,friction,median,p95,worst";
/// Contacts of a kind.
const CONTACTS: u64 = 200;

/// Whether the contacts have frictions of their own, whatever is asked for.
fn has_own_friction(kind: Kind) -> bool {
    matches!(kind, Kind::MixedInside | Kind::Mixed)
}

/// The contacts of a kind, ten times as many of several frictions.
pub fn frames(sensor: &Sensor, kind: Kind, friction: f64) -> Result<Vec<SceneFrame>, SceneError> {
    let count = if has_own_friction(kind) { 10 * CONTACTS } else { CONTACTS };
    kind.frames(sensor, friction, 1000..1000 + count)
}

/// The table, errors of the tangential force in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let (number, solvers) = (&sensor[6..], estimators(sensor)?);
        let (_, general) = &solvers[2];
        let geometry = general.matrices().sensor();
        for kind in Kind::all() {
            let all = has_own_friction(kind);
            let own = if all { "0.1 to 1" } else { "0.5" };
            let frames = frames(geometry, kind, 0.5)?;
            for (estimator, solver) in &solvers {
                let errors = shear_errors(solver, &frames)?;
                // Writing to a String cannot fail.
                let _ = writeln!(rows, "{number},{kind},{estimator},{own},{}", cells(errors));
            }
            for friction in [0.2, 0.8].into_iter().filter(|_| !all) {
                let errors = shear_errors(general, &self::frames(geometry, kind, friction)?)?;
                let _ = writeln!(rows, "{number},{kind},general,{friction},{}", cells(errors));
            }
        }
    }
    Ok(rows)
}
