//! Contacts counted by the hardware, against those that the solver counts.

use std::fmt::Write;

use golden::solver::{Solver, Status};
use hdl_gen::plan::{Plan, words};
use testbench::co_simulation::model_answers;

use super::kinds::{Kind, frame};
use super::several_contacts::KINDS;
use super::{Fallible, Rows, design};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,frames,marked,right,as_f64";
/// The designs of the table, which count where theirs do not.
pub const DESIGNS: [&str; 2] = ["sensor1-fast", "sensor2-fast"];

/// Frames of a kind, and in how many of them the hardware counts as many contacts as the solver, as the scene has, and more
/// than one.
fn agreement((plan, solver): &(Plan, Solver), kind: Kind, frames: u64, seed: u64) -> Fallible<[usize; 3]> {
    let scenes: Vec<_> = (0..frames).map(|number| frame(&plan.design.sensor, kind, seed + number)).collect();
    let packets: Vec<Vec<u32>> = scenes.iter().map(|scene| plan.streams().packet(&scene.stress)).collect();
    let mut counts = [0; 3];
    for (answer, scene) in model_answers(plan, &packets).iter().zip(&scenes) {
        let found = solver.solve(&scene.stress)?;
        assert_eq!(found.status.contains(Status::SEVERAL_CONTACTS), found.contacts > 1);
        let contacts = (answer[words::COUNTERS] & 0xFF) as usize;
        let told = [contacts == found.contacts, contacts == scene.contacts.len(), contacts > 1];
        counts.iter_mut().zip(told).for_each(|(count, told)| *count += usize::from(told));
    }
    Ok(counts)
}

/// A design that counts: what the hardware does, and the solver.
fn pair(name: &str) -> Fallible<(Plan, Solver)> {
    let mut design = design(name);
    design.algorithm.count_contacts = true;
    Ok((Plan::new(&design)?, Solver::new(&design)?))
}

/// The table, frames of 100.
pub fn rows() -> Rows {
    let mut rows = String::new();
    let pairs = [pair(DESIGNS[0])?, pair(DESIGNS[1])?];
    let shown = |kind: &Kind| !matches!(kind, Kind::Apart(3000 | 8000) | Kind::Heavier(8 | 12) | Kind::Wide);
    let (one, several): (Vec<_>, Vec<_>) = KINDS.into_iter().partition(|(kind, _)| *kind == Kind::One);
    for (kind, label) in one.into_iter().chain(several).filter(|(kind, _)| shown(kind)) {
        for (number, pair) in pairs.iter().enumerate() {
            let [same, right, several] = agreement(pair, kind, 100, 3000)?;
            // Writing to a String cannot fail.
            let _ = writeln!(rows, "{},\"{label}\",{several},{right},{same}", number + 1);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solver_counts_as_the_hardware_does() {
        for name in ["sensor1-fast", "sensor2-none"] {
            let pair = pair(name).expect("a plan");
            for (kind, marked) in [(Kind::One, 0..=0), (Kind::Anyhow, 11..=12), (Kind::Three, 12..=12)] {
                let [same, right, several] = agreement(&pair, kind, 12, 500).expect("forces");
                assert!(
                    same == 12 && right >= 10 && marked.contains(&several),
                    "{name}, {kind:?}: {same} {right} {several}"
                );
            }
        }
    }
}
