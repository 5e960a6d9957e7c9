//! The standard sets of contacts; no design was trained on any of them.

use std::fmt::Write;

use golden::solver::Solver;

use super::contacts::{FRICTIONS, SETS, Worst, set, worst};
use super::{Rows, design};

/// The columns of [`rows`].
pub const COLUMNS: &str = "design,contacts,noise,friction,worst,median";
/// The designs of the first sensor, and of the second.
pub const DESIGNS: [&str; 7] = [
    "sensor1-none",
    "sensor1-fast",
    "sensor1-fast-100",
    "sensor1-wide",
    "sensor2-none",
    "sensor2-fast",
    "sensor2-wide",
];

/// The table, errors of the tangential force in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    let (first, second) = DESIGNS.split_at(4);
    for names in [first, second] {
        let solvers: Vec<Solver> = names.iter().map(|name| Solver::new(&design(name))).collect::<Result<_, _>>()?;
        for contacts in SETS {
            let set = set(solvers[0].matrices().sensor(), contacts);
            let quoted = if contacts.contains(',') { format!("\"{contacts}\"") } else { contacts.to_owned() };
            for noise in [0.0, 0.2] {
                for (name, solver) in names.iter().zip(&solvers) {
                    for friction in FRICTIONS {
                        let Worst { error: [x, y, _], median, .. } = worst(solver, &set, friction, 0.01 * noise);
                        // Writing to a String cannot fail.
                        let _ = writeln!(rows, "{name},{quoted},{noise},{friction},{:.1},{median:.1}", x.max(y));
                    }
                }
            }
        }
    }
    Ok(rows)
}
