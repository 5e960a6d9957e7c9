//! `sptfra view`: forces in the terminal or as a picture.

use std::io::ErrorKind;
use std::path::PathBuf;

use crate::arguments::design_file;
use crate::message;
use golden::design::Design;
use golden::output::write_whole;

use super::frames::FrameArguments;
use golden::progress::Progress;
use testbench::view::{self, FrameRange, Rate};

/// Shows forces in the terminal or as a picture.
///
/// One cell a taxel, y upwards: an arrow for the direction of the shear, a digit for its share of the largest force, and
/// a digit for that of the normal force. In colour on a terminal, unless `NO_COLOR` is set. The forces are the
/// hardware's, from the integer model.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra view pad --frames frames.csv --frame 0-9")]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    #[command(flatten)]
    frames: FrameArguments,
    /// Which frame, from 0; several as FIRST-LAST or all.
    #[arg(long, default_value = "0", value_name = "N")]
    frame: FrameRange,
    /// Frames a second that play.
    #[arg(long, default_value = "10", value_name = "HZ")]
    rate: Rate,
    /// One character a taxel, as always on a narrow terminal.
    #[arg(long, conflicts_with_all = ["json", "svg"])]
    compact: bool,
    /// True forces of the frames (CSV), for a picture.
    #[arg(long, value_name = "FORCES.csv", requires = "svg", requires = "frames")]
    reference: Option<PathBuf>,
    /// Draw stress and forces of one frame into this file instead.
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    svg: Option<PathBuf>,
    /// All values as JSON.
    #[arg(long)]
    json: bool,
}

/// Shows the forces of frames.
pub fn run(arguments: &Args) -> message::Result {
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
        // `sptfra view … | head` is no failure.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(String::new().into()),
    }
}
