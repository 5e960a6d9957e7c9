//! The commands, one file each.

pub mod bench;
pub mod build;
pub mod cells;
pub mod frames;
pub mod hard;
pub mod mutants;
pub mod run;
pub mod stress;
pub mod sweep;
pub mod view;

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;
use serde::Serialize;

/// What a command has to say: on standard output, and on standard error what is wrong.
pub struct Said {
    pub text: String,
    pub faults: Vec<String>,
}

/// Or why it has nothing to say.
pub type Result = std::result::Result<Said, Box<dyn Error>>;

impl From<String> for Said {
    fn from(text: String) -> Self {
        Self { text, faults: Vec::new() }
    }
}

/// As JSON where that was asked for, else the page for people.
fn shown<T: Serialize>(
    value: &T,
    json: bool,
    page: impl FnOnce(&T) -> String,
) -> std::result::Result<String, serde_json::Error> {
    if json { Ok(serde_json::to_string_pretty(value)? + "\n") } else { Ok(page(value)) }
}

/// Of the commands that draw at random.
#[derive(Args)]
pub struct SeededArguments {
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
