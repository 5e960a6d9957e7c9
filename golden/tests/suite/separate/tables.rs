//! The rows of `results/several-contacts.csv`, errors in percent of the normal force.

use golden::metrics::Quantiles;
use golden::scene::SceneFrame;
use golden::solver::Solver;

use super::kinds::{Kind, frame};
use super::{design, judge};

/// Prints the rows of one kind of frames, solved as one contact and with each contact separated.
pub fn print_rows(sensor: &str, label: &str, training_set: &str, solvers: &[Solver; 2], frames: &[SceneFrame]) {
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
            println!("{},\"{label}\",{training_set},{quantity},{median:.1},{most:.1},{worst:.1},{right}", &sensor[6..]);
        }
    }
}

/// Kinds of the first table, and of those of single designs.
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

#[test]
#[ignore = "prints rows of results/several-contacts.csv; minutes"]
fn separated() {
    for sensor in ["sensor1", "sensor2"] {
        for (kind, label) in KINDS {
            let geometry = design(&format!("{sensor}-fast"), 1).sensor;
            let frames: Vec<SceneFrame> = (0..100).map(|seed| frame(&geometry, kind, 3000 + seed)).collect();
            for (name, training_set) in [("fast", "sliding"), ("wide", "general")] {
                let solvers =
                    [1, 4].map(|contacts| Solver::new(&design(&format!("{sensor}-{name}"), contacts)).unwrap());
                print_rows(sensor, label, training_set, &solvers, &frames);
            }
        }
    }
}
