//! The frames that `run` and `view` take.

use std::error::Error;
use std::path::{Path, PathBuf};

use golden::check::check;
use golden::design::Design;
use golden::matrices::Matrices;

use golden::progress::Progress;
use testbench::frame_set::FrameSet;

#[derive(clap::Args)]
pub struct FrameArguments {
    /// Frames (CSV or .npy), one a line, in pascals or counts; default: a contact made for the sensor.
    #[arg(long)]
    frames: Option<PathBuf>,
    /// Columns of labels before the values of a frame.
    #[arg(long, default_value_t = 0, requires = "frames")]
    labels: usize,
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
            let frames = FrameSet::load(path, self.labels, reference, design)?;
            if let Some(remark) = &frames.remark {
                eprintln!("note: {remark}");
            }
            // A design without matrices is refused later, with the reason.
            for finding in check(design, &frames.stress, Matrices::of(design).ok().as_ref()) {
                eprintln!("warning: {finding}");
            }
            return Ok(frames);
        }
        progress.stage("making ground-truth frames");
        Ok(FrameSet::standing(&design.sensor)?.as_delivered(design))
    }
}
