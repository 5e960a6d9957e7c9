//! `testbench view`.

use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;
use golden::output::write_whole;

use super::frames::FrameArguments;
use golden::progress::Progress;
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
    /// True forces of the frames (CSV), for a picture.
    #[arg(long, requires = "svg", requires = "frames")]
    reference: Option<PathBuf>,
    /// Draws the frame into this file, in place of the terminal: the stress, and the forces with their scales.
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    svg: Option<PathBuf>,
    /// All values as JSON.
    #[arg(long)]
    json: bool,
}

/// Shows the forces of a frame.
pub fn run(arguments: &Arguments) -> super::Result {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = arguments.frames.load(arguments.reference.as_deref(), &design, &progress)?;
    let view = view::frame(&design, &frames, arguments.frame, &progress)?;
    if let Some(path) = &arguments.svg {
        let Some(picture) = view.svg() else {
            return Err(format!("{} puts out resultants only: there is no field to draw", design.name).into());
        };
        write_whole(path, picture.as_bytes())?;
        return Ok(format!("frame {} is drawn in {}\n", arguments.frame, path.display()).into());
    }
    Ok(if arguments.json { view.json()? } else { view.page(view::wants_colour()) }.into())
}
