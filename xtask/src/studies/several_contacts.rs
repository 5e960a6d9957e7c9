//! Several contacts, separated in software: errors in percent of the normal force.

use std::fmt::Write;

use golden::metrics::Quantiles;
use golden::scene::SceneFrame;
use golden::solver::{Solver, SolverError};

use super::kinds::{Kind, clipped, frame, judge};
use super::{Rows, design};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,frames,training_set,quantity,median,p95,worst,right";
/// The designs of the table.
pub const DESIGNS: [&str; 6] =
    ["sensor1-fast", "sensor1-wide", "sensor1-clipped-wide", "sensor2-fast", "sensor2-wide", "sensor2-clipped-wide"];

/// The solvers of a design: of one contact, and of several.
fn solvers(name: &str) -> Result<[Solver; 2], SolverError> {
    let with = |contacts| {
        let mut design = design(name);
        design.algorithm.contacts = contacts;
        Solver::new(&design)
    };
    Ok([with(1)?, with(4)?])
}

/// Adds the rows of one kind of frames, solved as one contact and with each contact separated.
fn add_rows(rows: &mut String, [sensor, label, training_set]: [&str; 3], solvers: &[Solver; 2], frames: &[SceneFrame]) {
    let [one, several] = solvers.each_ref().map(|solver| judge(solver, frames));
    for (quantity, Quantiles { median, most, worst }) in [
        ("\"sum, solved as one\"", one.total),
        ("sum", several.total),
        ("each", several.contacts.tangential),
        ("\"each, normal\"", several.contacts.normal),
    ] {
        // Of no contact there is no error.
        if !median.is_nan() {
            let right = several.contacts.right;
            let sensor = &sensor[6..];
            // Writing to a String cannot fail.
            let _ = writeln!(
                rows,
                "{sensor},\"{label}\",{training_set},{quantity},{median:.1},{most:.1},{worst:.1},{right}"
            );
        }
    }
}

/// All kinds, as tables call them.
pub const KINDS: [(Kind, &str); 19] = [
    (Kind::Same, "two, pushed the same way"),
    (Kind::Opposed, "two, opposed"),
    (Kind::Anyhow, "two, anyhow"),
    (Kind::Small, "4 N, and 1 N on half the radius"),
    (Kind::Held, "one slides, one is held"),
    (Kind::Three, "three, anyhow"),
    (Kind::Row, "three in a row"),
    (Kind::Apart(8000), "two, 8 mm apart"),
    (Kind::Apart(6000), "two, 6 mm apart"),
    (Kind::Apart(4000), "two, 4 mm apart"),
    (Kind::Apart(3000), "two, 3 mm apart"),
    (Kind::Apart(2000), "two, 2 mm apart"),
    (Kind::Apart(0), "two that touch"),
    (Kind::Heavier(6), "one 6 times as heavy"),
    (Kind::Heavier(8), "one 8 times as heavy"),
    (Kind::Heavier(10), "one 10 times as heavy"),
    (Kind::Heavier(12), "one 12 times as heavy"),
    (Kind::One, "one alone"),
    (Kind::Wide, "one to three general ones"),
];

/// The table.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let solvers =
            [("sliding", solvers(&format!("{sensor}-fast"))?), ("general", solvers(&format!("{sensor}-wide"))?)];
        for (kind, label) in KINDS {
            let geometry = solvers[0].1[0].matrices().sensor();
            let frames: Vec<SceneFrame> = (3000..3100).map(|seed| frame(geometry, kind, seed)).collect();
            for (training_set, solvers) in &solvers {
                add_rows(&mut rows, [sensor, label, training_set], solvers, &frames);
            }
        }
    }
    let shown = |kind: &Kind| match kind {
        Kind::Apart(micrometres) => *micrometres >= 6000,
        other => !matches!(other, Kind::Row | Kind::Heavier(_) | Kind::Wide),
    };
    for sensor in ["sensor1", "sensor2"] {
        let solvers = solvers(&format!("{sensor}-clipped-wide"))?;
        for (kind, label) in KINDS.into_iter().filter(|(kind, _)| shown(kind)) {
            let frames = clipped(solvers[0].matrices().sensor(), kind, 3000..3100);
            add_rows(&mut rows, [sensor, label, "\"general, clipped\""], &solvers, &frames);
        }
    }
    Ok(rows)
}
