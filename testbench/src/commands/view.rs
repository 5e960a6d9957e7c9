//! `testbench view`.

use std::io::ErrorKind;
use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;
use golden::output::write_whole;

use super::frames::FrameArguments;
use golden::progress::Progress;
use testbench::view::{self, FrameRange, Rate};

#[derive(Args)]
pub struct Arguments {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    #[command(flatten)]
    frames: FrameArguments,
    /// Which frame, from 0; several as FIRST-LAST or all: they play on a terminal, to one scale.
    #[arg(long, default_value = "0", value_name = "N")]
    frame: FrameRange,
    /// Frames a second that play.
    #[arg(long, default_value = "10", value_name = "HZ")]
    rate: Rate,
    /// One character a taxel; so anyway where the terminal is too narrow for four.
    #[arg(long, conflicts_with_all = ["json", "svg"])]
    compact: bool,
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

/// Shows the forces of frames.
pub fn run(arguments: &Arguments) -> super::Result {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = arguments.frames.load(arguments.reference.as_deref(), &design, &progress)?;
    let views = view::frames(&design, &frames, arguments.frame, &progress)?;
    if let Some(path) = &arguments.svg {
        let [view] = views.as_slice() else {
            return Err("a picture shows one frame: name it with --frame N".into());
        };
        let Some(picture) = view.svg() else {
            return Err(format!("{} puts out resultants only: there is no field to draw", design.name).into());
        };
        write_whole(path, picture.as_bytes())?;
        return Ok(format!("frame {} is drawn in {}\n", view.number(), path.display()).into());
    }
    if arguments.json {
        return Ok(view::json(&views)?.into());
    }
    drop(progress);
    match view::play(&views, arguments.compact, arguments.rate) {
        // `testbench view … | head` is no failure.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(String::new().into()),
    }
}
