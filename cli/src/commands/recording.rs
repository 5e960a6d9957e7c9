//! Recordings that commands read, and the warnings about them.

use std::path::Path;

use golden::check::Finding;
use golden::design::Design;
use golden::frames::{self, FrameError};
use golden::geometry;

/// The name of standard input and output.
const STANDARD: &str = "-";

/// Whether a file's name means standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == STANDARD
}

/// A file of frames.
pub struct Recording<'a> {
    pub file: &'a Path,
    /// Columns of labels before the values.
    pub labels: usize,
}

impl Recording<'_> {
    /// The frames, which may not be known to be those of another sensor than the design's. Says on standard error what is
    /// to be known of their header.
    pub fn read(&self, design: &Design) -> Result<Vec<Vec<f64>>, FrameError> {
        geometry::compare(self.file, &design.name, &design.sensor)?;
        let (frames, remark) = frames::read_frames_and_remark(self.file, design, self.labels)?;
        if let Some(remark) = remark {
            eprintln!("note: {remark}");
        }
        Ok(frames)
    }
}

/// Says on standard error what is suspicious.
pub fn warn(findings: &[Finding]) {
    for finding in findings {
        eprintln!("warning: {finding}");
    }
}
