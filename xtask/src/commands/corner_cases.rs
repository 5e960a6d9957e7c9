//! `cargo xtask corner-cases`: the rows of results/corner-cases.csv.

use golden::progress::Progress;
use sptfra::message::{self, Message};
use xtask::corner_cases::{self, Scope};

/// Tests sensors, contacts and frames at the limits, in f64, float32, integers and the simulated RTL; prints JSON.
///
/// The exit code is 0 only if no answer is wrong without a status bit, no force is NaN or beyond reason without one, and
/// every word of the RTL is the model's.
#[derive(clap::Args)]
pub struct Args {
    /// Leave out what takes more than a second: large sensors, and the RTL of all.
    #[arg(long)]
    quick: bool,
}

/// Judges the corner cases.
pub fn run(arguments: &Args) -> message::Result {
    let rows = corner_cases::table(Scope { large: !arguments.quick, rtl: !arguments.quick }, &Progress::new())?;
    let fault = |row: &&_| {
        let corner_cases::judge::Row { group, case, estimator, .. } = row;
        format!("{group}, {estimator}, {case}: an answer is wrong in silence, or not that of the model")
    };
    let faults = corner_cases::unsound(&rows).iter().map(fault).collect();
    Ok(Message { text: serde_json::to_string_pretty(&rows)? + "\n", faults })
}
