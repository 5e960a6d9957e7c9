//! `testbench view`.

use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;

use super::frames::FrameArguments;
use testbench::progress::Progress;
use testbench::view;

#[derive(Args)]
pub struct Arguments {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    #[command(flatten)]
    frames: FrameArguments,
    /// Which frame, from 0.
    #[arg(long, default_value_t = 0, value_name = "N")]
    frame: usize,
    /// All values as JSON.
    #[arg(long)]
    json: bool,
}

/// Shows the forces of a frame.
pub fn run(arguments: &Arguments) -> super::Result {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = arguments.frames.load(None, &design, &progress)?;
    let view = view::frame(&design, &frames, arguments.frame, &progress)?;
    Ok(if arguments.json { view.json()? } else { view.page(view::wants_colour()) }.into())
}
