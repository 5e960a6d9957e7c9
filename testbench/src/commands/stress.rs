//! `testbench stress`.

use clap::Args;
use golden::design::Design;

use super::{SeededArguments, shown};
use golden::progress::Progress;
use testbench::stress::{Options, stress};

#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    common: SeededArguments,
    /// Frames to send.
    #[arg(long, default_value_t = 100_000)]
    frames: u64,
}

/// Stresses a design.
pub fn run(arguments: &Arguments) -> super::Result {
    let SeededArguments { design, seed, json } = &arguments.common;
    let options = Options { frames: arguments.frames, seed: *seed };
    let report = stress(&Design::load(design)?, &options, &Progress::new())?;
    Ok(shown(&report, *json, ToString::to_string)?.into())
}
