//! The rows of `results/several-contacts.csv`, errors in percent of the normal force.

use std::fmt::Write;

use golden::metrics::Quantiles;
use golden::scene::SceneFrame;
use golden::solver::Solver;

use super::kinds::{Kind, frame};
use super::{clipped, design, judge};
use crate::designs::renew_table;

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

/// Kinds of the first table, and of those of single designs.
const KINDS: [(Kind, &str); 19] = [
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

#[test]
#[ignore = "writes results/several-contacts.csv; minutes"]
fn table() {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        for (kind, label) in KINDS {
            let geometry = design(&format!("{sensor}-fast"), 1).sensor;
            let frames: Vec<SceneFrame> = (0..100).map(|seed| frame(&geometry, kind, 3000 + seed)).collect();
            for (name, training_set) in [("fast", "sliding"), ("wide", "general")] {
                let solvers =
                    [1, 4].map(|contacts| Solver::new(&design(&format!("{sensor}-{name}"), contacts)).unwrap());
                add_rows(&mut rows, [sensor, label, training_set], &solvers, &frames);
            }
        }
    }
    let shown = |kind: &Kind| match kind {
        Kind::Apart(micrometres) => *micrometres >= 6000,
        other => !matches!(other, Kind::Row | Kind::Heavier(_) | Kind::Wide),
    };
    for sensor in ["sensor1", "sensor2"] {
        let solvers = [1, 4].map(|contacts| Solver::new(&design(&format!("{sensor}-clipped-wide"), contacts)).unwrap());
        for (kind, label) in KINDS.into_iter().filter(|(kind, _)| shown(kind)) {
            let frames = clipped::frames(solvers[0].matrices().sensor(), kind, 3000..3100);
            add_rows(&mut rows, [sensor, label, "\"general, clipped\""], &solvers, &frames);
        }
    }
    let names = ["fast", "wide", "clipped-wide"];
    let names: Vec<String> =
        ["sensor1", "sensor2"].iter().flat_map(|sensor| names.map(|name| format!("{sensor}-{name}"))).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    renew_table("several-contacts.csv", &names, "sensor,frames,training_set,quantity,median,p95,worst,right", &rows);
}
