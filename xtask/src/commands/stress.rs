//! `cargo xtask stress`: many random frames.

use golden::design::Design;
use sptfra::message::{self, json_or};

use super::SeededArgs;
use golden::progress::Progress;
use xtask::stress::{Options, stress};

/// Sends very many frames, good, short, long and with NaN, through streams with random pauses and resets.
///
/// The exit code is 0 only if each answer is the model's, each bad frame is flagged, and none is lost except to a reset,
/// doubled or out of order.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    common: SeededArgs,
    /// Frames to send.
    #[arg(long, default_value_t = 100_000)]
    frames: u64,
}

/// Stresses a design.
pub fn run(arguments: &Args) -> message::Result {
    let SeededArgs { design, seed, json } = &arguments.common;
    let options = Options { frames: arguments.frames, seed: *seed };
    let report = stress(&Design::load(design)?, &options, &Progress::new())?;
    Ok(json_or(&report, *json, ToString::to_string)?.into())
}
