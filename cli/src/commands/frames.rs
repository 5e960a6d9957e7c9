//! The frames that `run` and `view` take.

use std::error::Error;
use std::path::{Path, PathBuf};

use golden::check::check;
use golden::design::Design;
use golden::matrices::Matrices;

use golden::progress::Progress;
use testbench::frame_set::FrameSet;

use super::recording::{LayoutArguments, warn};

#[derive(clap::Args)]
pub struct FrameArguments {
    /// Frames (CSV or .npy), one a line [default: a contact made for the sensor]
    ///
    /// Frames are in pascals or counts.
    #[arg(long)]
    frames: Option<PathBuf>,
    #[command(flatten)]
    layout: LayoutArguments,
}

impl FrameArguments {
    /// Frames of the file, with warnings of what is wrong with them, or the standing ones.
    pub fn load(
        &self,
        reference: Option<&Path>,
        design: &Design,
        progress: &Progress,
    ) -> Result<FrameSet, Box<dyn Error>> {
        if let Some(path) = &self.frames {
            let frames = FrameSet::load(path, self.layout.layout(), reference, design)?;
            if let Some(remark) = &frames.remark {
                eprintln!("note: {remark}");
            }
            // A design without matrices is refused later, with the reason.
            warn(&check(design, &frames.stress, Matrices::of(design).ok().as_ref()));
            return Ok(frames);
        }
        if self.layout.given() {
            return Err("--labels, --columns, --skip-lines and --skip-bad are for recordings: give --frames".into());
        }
        progress.stage("making ground-truth frames");
        Ok(FrameSet::standing(&design.sensor)?.as_delivered(design))
    }
}
