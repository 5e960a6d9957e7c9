//! Time to plan a design and to print its files, in memory.

use std::time::Instant;

use golden::design::{Design, DesignError};
use hdl_gen::emit::emit;
use serde::Serialize;

use super::cycles::{Kind, SIDES, square};
use super::machine::{forget_peak_memory, peak_memory};
use super::{BenchError, Scope, median};
use crate::PLAIN_DESIGN;
use golden::progress::Progress;
use testbench::co_simulation::{CoSimulationError, planned};

/// Repetitions behind a median.
pub const REPETITIONS: usize = 3;
/// Lanes of the square sensors.
pub const LANES: usize = 16;
/// Largest side of the squares from which on the largest grid is generated too, which takes a minute.
const MAT_FROM: usize = 32;

/// One design's times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Generation {
    /// What is generated.
    pub design: String,
    /// Hash of a design that is a file.
    pub hash: Option<String>,
    /// Taxels.
    pub taxels: usize,
    /// Median seconds from the checked design to its plan.
    pub plan_s: f64,
    /// Median seconds from the plan to all files.
    pub emit_s: f64,
    /// Size of the files in bytes.
    pub bytes: usize,
    /// The most memory of the process meanwhile, in bytes, with the files; where the system tells.
    pub memory: Option<u64>,
}

/// Times square sensors up to the scope's largest side, and the scope's designs.
pub(super) fn measure(scope: &Scope, progress: &Progress) -> Result<Vec<Generation>, BenchError> {
    let mut designs = Vec::new();
    for side in SIDES.into_iter().filter(|&side| side <= scope.largest) {
        let name = format!("{side} × {side}, reduced, no filter, {LANES} lanes");
        designs.push((name, None, square(Kind::Reduced, side, LANES)?));
    }
    designs
        .extend(scope.designs.iter().map(|(path, design)| (format!("`{path}`"), Some(design.hash()), design.clone())));
    // Last: what it leaves allocated would count as memory of the next.
    if scope.largest >= MAT_FROM {
        designs.push(("64 × 64, reduced, cell kernel, F2 with p = 1, 64 lanes".to_owned(), None, mat()?));
    }
    let mut rows = Vec::new();
    for (name, hash, design) in designs {
        progress.stage(format!("generating {name}"));
        let (mut plans, mut emits, mut bytes) = (Vec::new(), Vec::new(), 0);
        forget_peak_memory();
        for _ in 0..REPETITIONS {
            let start = Instant::now();
            let plan = planned(&design)?;
            plans.push(start.elapsed().as_secs_f64());
            let start = Instant::now();
            let files = emit(&plan).map_err(CoSimulationError::from)?;
            emits.push(start.elapsed().as_secs_f64());
            bytes = files.values().map(Vec::len).sum();
        }
        let taxels = design.sensor.taxels();
        let (plan_s, emit_s, memory) = (median(plans), median(emits), peak_memory());
        rows.push(Generation { design: name, hash, taxels, plan_s, emit_s, bytes, memory });
    }
    Ok(rows)
}

/// The largest grid, with the pitch and depth of the mat in `designs/bed-mat.toml`.
fn mat() -> Result<Design, DesignError> {
    let text = format!(
        "{PLAIN_DESIGN}name = \"mat\"\n[sensor]\ncolumns = 64\nrows = 64\npitch_mm = [28.0, 28.0]\ndepth_mm = 8.0\n\
                [algorithm]\nplan = \"reduced\"\nkernel = \"cell\"\nfilter = {{ kind = \"f2\", p = 1.0 }}\n\
                [hardware]\nlanes = 64\n"
    );
    Design::from_toml(&text, "largest grid")
}
