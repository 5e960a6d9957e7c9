//! Frames of a design that come line by line, as from a sensor.

use std::path::Path;

use super::FrameError;
use super::layout::{Layout, Target};
use super::text::Lines;
use crate::design::{Design, Samples};

/// Makes frames of lines of text, one after the other.
#[derive(Clone, Debug)]
pub struct FrameLines {
    lines: Lines,
    /// Whether a frame was there.
    begun: bool,
    taxels: usize,
    samples: Samples,
}

impl FrameLines {
    /// For frames of the design, whose values stand in their lines as `layout` says; `origin` is the name to use in
    /// messages.
    pub fn new(origin: &Path, design: &Design, layout: impl Into<Layout>) -> Self {
        let lines = Lines::new(origin, &layout.into(), Some(&Target::from(design)));
        Self { lines, begun: false, taxels: design.sensor.taxels(), samples: design.hardware.samples }
    }

    /// What is to be said of the lines so far, as of a first one that holds the numbers of the columns.
    pub fn remark(&self) -> Option<String> {
        let remarks = self.lines.remarks();
        (!remarks.is_empty()).then(|| remarks.join("; "))
    }

    /// The frame of the next line; nothing for a header, a blank line and a remark.
    ///
    /// # Errors
    ///
    /// As [`super::read_recording`], with the number of the line; the next one may be good again.
    pub fn frame(&mut self, line: &[u8]) -> Result<Option<Vec<f64>>, FrameError> {
        let taxels = self.taxels;
        let Some(frame) = self.lines.row(line, |found| (found != taxels).then_some(taxels))? else { return Ok(None) };
        self.lines.unclear()?;
        if !std::mem::replace(&mut self.begun, true) && self.lines.is_numbered(&frame) {
            return Ok(None);
        }
        let wrong = frame.iter().position(|&value| !self.samples.takes(value));
        let Some(column) = wrong else { return Ok(Some(frame)) };
        let place = format!("line {}, column {}", self.lines.number(), self.lines.column(column));
        let path = self.lines.path().to_path_buf();
        Err(FrameError::Sample { path, place, value: frame[column], samples: self.samples })
    }
}
