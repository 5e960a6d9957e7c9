//! `testbench hard`.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use golden::output::write_whole;

use testbench::hard::{self, Scope};
use testbench::progress::Progress;

#[derive(Args)]
pub struct Arguments {
    /// Leave out what takes more than a second: large sensors, and the RTL of all.
    #[arg(long)]
    quick: bool,
    /// Where to write the table as a page (Markdown).
    #[arg(long, value_name = "PAGE.md")]
    page: Option<PathBuf>,
    /// Print the table as JSON.
    #[arg(long)]
    json: bool,
}

/// Judges the hard cases; returns what to print, and whether all is as it must be.
pub fn run(arguments: &Arguments) -> Result<(String, bool), Box<dyn Error>> {
    let rows = hard::table(Scope { large: !arguments.quick, rtl: !arguments.quick }, &Progress::new())?;
    let sound = hard::is_sound(&rows);
    if let Some(path) = &arguments.page {
        write_whole(path, hard::tables::markdown(&rows).as_bytes())?;
    }
    let text = if arguments.json { serde_json::to_string_pretty(&rows)? + "\n" } else { hard::tables::text(&rows) };
    Ok((text, sound))
}
