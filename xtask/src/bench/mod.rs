//! What `cargo xtask bench` measures.

pub mod cells;
pub mod cycles;
pub mod filters;
pub mod generation;
pub mod levels;
pub mod machine;
pub mod simulation_rate;
pub mod solver;

use std::path::PathBuf;

use golden::design::{Design, DesignError};
use golden::scene::SceneError;
use golden::solver::SolverError;
use serde::Serialize;
use thiserror::Error;

use golden::progress::Progress;
use testbench::co_simulation::CoSimulationError;

use cells::Cells;
use cycles::Point;
use filters::Filtered;
use generation::Generation;
use machine::Machine;
use simulation_rate::Rate;
use solver::SolverRate;

/// Why there are no figures.
#[derive(Debug, Error)]
pub enum BenchError {
    /// A design is wrong.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A design cannot be planned, built or simulated.
    #[error(transparent)]
    CoSimulation(#[from] CoSimulationError),
    /// A design's words or cycles are wrong: it has no figures.
    #[error("{design}: {fault}; please report this design")]
    Wrong {
        /// Which.
        design: String,
        /// What is wrong.
        fault: String,
    },
    /// A frame cannot be solved.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// The frames cannot be computed.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file of figures cannot be read.
    #[error("{}: cannot read the file: {source}; write it first, see --help", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A file of figures is of another kind.
    #[error("{}: {source}; write it anew with the command that --help names", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// Yosys' statistics do not hold the design's top module.
    #[error("{}: no module `{module}`; are these statistics of this design, without -flatten?", path.display())]
    NoModule {
        /// The statistics.
        path: PathBuf,
        /// What is looked for.
        module: String,
    },
    /// A netlist has a cell that is none of `UltraScale+`.
    #[error("{}: no cell of UltraScale+ and no module is called `{cell}`; was this netlist made by tools/synth.py?", path.display())]
    UnknownCell {
        /// The netlist.
        path: PathBuf,
        /// What it is called.
        cell: String,
    },
    /// Logic in a circle has no levels.
    #[error("{}: a way of logic comes back to where it began, without a register; please report this design", path.display())]
    Loop {
        /// The netlist.
        path: PathBuf,
    },
    /// The record of levels is no such file.
    #[error("{}: {source}; blocks and levels stand there by design", path.display())]
    Record {
        /// The record.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<toml::de::Error>,
    },
    /// Blocks have got longer.
    #[error(
        "{design}: more levels of logic than {} has:\n  {}\nshorten these ways, or record them: RECORD=1 tools/synth.py",
        path.display(), .blocks.join("\n  ")
    )]
    Longer {
        /// The design.
        design: String,
        /// The record.
        path: PathBuf,
        /// What is longer.
        blocks: Vec<String>,
    },
    /// The record cannot be written.
    #[error("{}: cannot write the file: {source}", path.display())]
    Write {
        /// The record.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
}

/// What to measure.
#[derive(Clone, Debug)]
pub struct Scope {
    /// Designs generated and simulated, with the path that the page calls them by.
    pub designs: Vec<(String, Design)>,
    /// Largest side of the square sensors that are planned.
    pub largest: usize,
    /// Output of `cargo xtask solver --json`, if there is one.
    pub solver: Option<PathBuf>,
    /// Outputs of `cargo xtask cells --json`.
    pub cells: Vec<PathBuf>,
}

/// Everything measured, read and predicted.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Where it was measured.
    pub machine: Machine,
    /// The f64 solver.
    pub solver: Vec<SolverRate>,
    /// Time to generate hardware.
    pub generation: Vec<Generation>,
    /// Speed of the simulation.
    pub simulation: Vec<Rate>,
    /// Latency and interval against lanes and taxels.
    pub cycles: Vec<Point>,
    /// What filters save of folded blocks, and their error.
    pub filters: Vec<Filtered>,
    /// Yosys' cell counts by block.
    pub cells: Vec<Cells>,
}

/// Measures what `scope` asks for. Takes minutes for the shipped designs.
///
/// # Errors
/// The first [`BenchError`].
pub fn measure(scope: &Scope, progress: &Progress) -> Result<Figures, BenchError> {
    let solver = scope.solver.as_deref().map(solver::read).transpose()?.unwrap_or_default();
    let cells = scope.cells.iter().map(|path| cells::read(path)).collect::<Result<Vec<_>, _>>()?;
    Ok(Figures {
        machine: Machine::this(),
        solver,
        generation: generation::measure(scope, progress)?,
        simulation: simulation_rate::measure(scope, progress)?,
        cycles: cycles::measure(scope.largest, progress)?,
        filters: filters::measure(scope, progress)?,
        cells,
    })
}

/// The middle of the values; of an even number the upper one. Zero if there are none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

fn read_json<T: serde::de::DeserializeOwned>(path: &std::path::Path) -> Result<T, BenchError> {
    let bytes = std::fs::read(path).map_err(|source| BenchError::Read { path: path.to_owned(), source })?;
    serde_json::from_slice(&bytes).map_err(|source| BenchError::Json { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!([median(vec![3.0, 9.0, 1.0]), median(vec![])].map(|value| value as i64), [3, 0]);
    }
}
