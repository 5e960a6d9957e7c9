//! Time to plan a design and to print its files, in memory.

use std::time::Instant;

use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;
use serde::Serialize;

use super::cycles::{Kind, SIDES, square};
use super::{BenchError, Scope, median};
use crate::progress::Progress;

/// Repetitions behind a median.
pub const REPETITIONS: usize = 3;
/// Lanes of the square sensors.
pub const LANES: usize = 16;

/// One design's times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Generation {
    /// What is generated.
    pub design: String,
    /// Taxels.
    pub taxels: usize,
    /// Median seconds from the checked design to its plan.
    pub plan_s: f64,
    /// Median seconds from the plan to all files.
    pub emit_s: f64,
    /// Size of the files in bytes.
    pub bytes: usize,
}

/// Times square sensors up to the scope's largest side, and the scope's designs.
pub(super) fn measure(scope: &Scope, progress: &Progress) -> Result<Vec<Generation>, BenchError> {
    let mut designs = Vec::new();
    for side in SIDES.into_iter().filter(|&side| side <= scope.largest) {
        designs
            .push((format!("{side} × {side}, reduced, no filter, {LANES} lanes"), square(Kind::Reduced, side, LANES)?));
    }
    designs.extend(scope.designs.iter().map(|(path, design)| (format!("`{path}`"), design.clone())));
    let mut rows = Vec::new();
    for (name, design) in designs {
        progress.stage(format!("generating {name}"));
        let (mut plans, mut emits, mut bytes) = (Vec::new(), Vec::new(), 0);
        for _ in 0..REPETITIONS {
            let start = Instant::now();
            let plan = Plan::new(&design)?;
            plans.push(start.elapsed().as_secs_f64());
            let start = Instant::now();
            let files = emit(&plan)?;
            emits.push(start.elapsed().as_secs_f64());
            bytes = files.values().map(Vec::len).sum();
        }
        let taxels = design.sensor.taxels();
        rows.push(Generation { design: name, taxels, plan_s: median(plans), emit_s: median(emits), bytes });
    }
    Ok(rows)
}
