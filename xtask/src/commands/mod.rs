//! The tasks, one file each.

pub mod bench;
pub mod cells;
pub mod corner_cases;
pub mod luts;
pub mod mutants;
pub mod solver;
pub mod stress;
pub mod study;

use std::path::PathBuf;

use golden::design::{Design, DesignError};
use sptfra::arguments::design_file;

/// Designs, which go by the names of their files.
fn named(files: &[PathBuf]) -> Result<Vec<(String, Design)>, DesignError> {
    let name = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    files.iter().map(|path| Ok((name(path), Design::load(path)?))).collect()
}

/// Options of the tasks that draw at random.
#[derive(clap::Args)]
pub struct SeededArgs {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Decides everything that is random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}
