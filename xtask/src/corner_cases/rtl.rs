//! The cases' frames through the simulated RTL: one build a design, the frames of all its cases one after the other.

use golden::design::Design;
use hdl_gen::plan::Plan;

use super::cases::Case;
use golden::progress::Progress;
use testbench::co_simulation::{CoSimulation, CoSimulationError};
use testbench::stream_words::packets;

/// Decides the pauses of the streams and the registers' random start.
const SEED: u32 = 1;

/// Whether the RTL answers each case as the integer model does, word by word in all stream modes, and in the cycles of
/// the plan; `None` where there is no hardware.
///
/// # Errors
/// [`CoSimulationError`] if a design's RTL cannot be built or simulated.
pub fn check(cases: &[Case], progress: &Progress) -> Result<Vec<Option<bool>>, CoSimulationError> {
    let mut designs: Vec<(&Design, Vec<usize>)> = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        match designs.iter_mut().find(|(design, _)| **design == case.design) {
            Some((_, own)) => own.push(index),
            None => designs.push((&case.design, vec![index])),
        }
    }
    progress.counted_in("designs", "building and simulating the RTL", designs.len() as u64);
    let mut exact = vec![None; cases.len()];
    // One after the other: Verilator and the stream modes use all cores by themselves.
    for (design, own) in designs {
        if let Ok(plan) = Plan::new(design) {
            let own_cases: Vec<&Case> = own.iter().map(|&index| &cases[index]).collect();
            for (index, is_exact) in own.into_iter().zip(of_design(&plan, &own_cases)?) {
                exact[index] = Some(is_exact);
            }
        }
        progress.step();
    }
    Ok(exact)
}

fn of_design(plan: &Plan, cases: &[&Case]) -> Result<Vec<bool>, CoSimulationError> {
    let frames: Vec<Vec<f64>> = cases.iter().flat_map(|case| &case.frames).cloned().collect();
    let run = CoSimulation::new(plan, packets(plan.streams(), &frames), SEED);
    let verdict = run.run()?;
    let simulation = &verdict.simulation;
    let mut first = 0;
    let free: Vec<bool> = cases
        .iter()
        .map(|case| {
            let frames = first..first + case.frames.len();
            first = frames.end;
            simulation.answers.get(frames.clone()) == Some(&run.expected[frames])
        })
        .collect();
    // A difference that only another mode has is not known by case: it counts against all of them.
    let others = simulation.is_exact() || !free.iter().all(|&exact| exact);
    Ok(free.into_iter().map(|exact| exact && others && verdict.is_timely()).collect())
}
