//! `testbench hard`.

use std::path::{Path, PathBuf};

use clap::Args;
use golden::output::write_whole;

use super::{Said, shown};
use golden::progress::Progress;
use testbench::hard::{self, Scope};

#[derive(Args)]
pub struct Arguments {
    /// Leave out what takes more than a second: large sensors, and the RTL of all.
    #[arg(long)]
    quick: bool,
    /// Where to write the table as a page (Markdown).
    #[arg(long, value_name = "PAGE.md")]
    page: Option<PathBuf>,
    /// Where to draw errors over depth by pitch (SVG).
    #[arg(long, value_name = "PLOT.svg")]
    plot: Option<PathBuf>,
    /// Print the table as JSON.
    #[arg(long)]
    json: bool,
}

/// Judges the hard cases.
pub fn run(arguments: &Arguments) -> super::Result {
    let rows = hard::table(Scope { large: !arguments.quick, rtl: !arguments.quick }, &Progress::new())?;
    let unsound =
        "an answer is wrong in silence, or not that of the model: see DIFFERS and SILENTLY WRONG in the table";
    let faults = if hard::is_sound(&rows) { Vec::new() } else { vec![unsound.to_owned()] };
    if let Some(path) = &arguments.plot {
        write_whole(path, hard::plot::both(&rows).as_bytes())?;
    }
    if let Some(path) = &arguments.page {
        // The plot lies beside the page.
        let plot = arguments.plot.as_deref().and_then(Path::file_name).and_then(|name| name.to_str());
        write_whole(path, hard::tables::markdown(&rows, plot).as_bytes())?;
    }
    Ok(Said { text: shown(&rows, arguments.json, |rows| hard::tables::text(rows))?, faults })
}
