//! `cargo xtask corner-cases`: the table of results/README.md.

use sptfra::message::{self, Message, json_or};
use std::path::{Path, PathBuf};

use golden::output::write_whole;

use golden::progress::Progress;
use xtask::corner_cases::{self, Scope};

/// Tests sensors, contacts and frames at the limits, in f64, float32, integers and the simulated RTL.
///
/// The exit code is 0 only if no answer is wrong without a status bit, no force is NaN or beyond reason without one, and
/// every word of the RTL is the model's.
#[derive(clap::Args)]
pub struct Args {
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
pub fn run(arguments: &Args) -> message::Result {
    let rows = corner_cases::table(Scope { large: !arguments.quick, rtl: !arguments.quick }, &Progress::new())?;
    let unsound =
        "an answer is wrong in silence, or not that of the model: see DIFFERS and SILENTLY WRONG in the table";
    let faults = if corner_cases::is_sound(&rows) { Vec::new() } else { vec![unsound.to_owned()] };
    if let Some(path) = &arguments.plot {
        write_whole(path, corner_cases::plot::both(&rows).as_bytes())?;
    }
    if let Some(path) = &arguments.page {
        // The plot lies beside the page.
        let plot = arguments.plot.as_deref().and_then(Path::file_name).and_then(|name| name.to_str());
        write_whole(path, corner_cases::tables::markdown(&rows, plot).as_bytes())?;
    }
    Ok(Message { text: json_or(&rows, arguments.json, |rows| corner_cases::tables::text(rows))?, faults })
}
