//! Frames of a design that come line by line, as from a sensor.

use std::path::Path;

use super::FrameError;
use super::header::Label;
use super::layout::{Layout, Target};
use super::text::Lines;
use crate::design::{Design, Samples};
use crate::separator::Separator;

/// Labels of lines that are no frames. Other words may mark an event, and of a stream nobody knows whether more follow.
const SUMMARIES: [&str; 9] = ["mean", "average", "avg", "median", "total", "sum", "std", "min", "max"];

/// Makes frames of lines of text, one after the other.
#[derive(Clone, Debug)]
pub struct FrameLines {
    lines: Lines,
    /// Whether a frame was there.
    begun: bool,
    /// Whether the label of the first one is a number.
    is_numbered: Option<bool>,
    samples: Samples,
    /// Fields of a row of the grid.
    columns: usize,
}

impl FrameLines {
    /// For frames of the design, whose values stand in their lines as `layout` says; `origin` is the name to use in
    /// messages.
    pub fn new(origin: &Path, design: &Design, layout: impl Into<Layout>) -> Self {
        let layout = layout.into();
        let lines = Lines::new(origin, &layout, &Target::from(design));
        let columns = layout.first() + design.sensor.columns;
        Self { lines, columns, begun: false, is_numbered: None, samples: design.hardware.samples }
    }

    /// The error of a line, which may hold a row of the grid.
    fn of_row(&self, error: FrameError) -> FrameError {
        match error {
            FrameError::Length { path, line, found, expected, .. } if found == self.columns && found < expected => {
                let hint = "is it a row of the grid? A stream has a frame a line; save the lines to a file, where frames may \
                            be blocks of rows";
                FrameError::Length { path, line, found, expected, hint: hint.to_owned() }
            }
            error => error,
        }
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
        // A mark may come first.
        if line.len() > 3 && line.chunks_exact(2).skip(1).all(|pair| pair.contains(&0)) {
            let remedy = "pipe it through iconv -f UTF-16 -t UTF-8, or save it to a file, which is read as it is";
            return Err(FrameError::format(&self.lines.cells.path, "UTF-16, two bytes a character", remedy));
        }
        let Some(frame) = self.lines.row(line).map_err(|error| self.of_row(error))? else { return Ok(None) };
        self.lines.unclear()?;
        if !std::mem::replace(&mut self.begun, true) && self.lines.is_numbered(&frame) {
            return Ok(None);
        }
        let number = self.lines.cells.number;
        let is_numbered = self.lines.label(line).0 == Label::Number;
        if *self.is_numbered.get_or_insert(is_numbered) && is_summary(line) {
            let problem =
                "a mean or the like, where the lines before have a number: take the line out, or give frames a number";
            let wrong = FrameError::line(&self.lines.cells.path, number, problem);
            return self.lines.leave_out(number, wrong);
        }
        let wrong = frame.iter().position(|&value| !self.samples.takes(value));
        let Some(column) = wrong else { return Ok(Some(frame)) };
        let place = format!("line {}, column {}", self.lines.cells.number, self.lines.column(column));
        Err(FrameError::sample(&self.lines.cells.path, &place, frame[column], self.samples))
    }
}

/// Whether a line's label says that it is a mean or the like.
fn is_summary(line: &[u8]) -> bool {
    let label = String::from_utf8_lossy(Separator::of(line).split(line)[0]).to_lowercase();
    SUMMARIES.contains(&label.trim_matches(|letter: char| letter == '"' || letter.is_whitespace()))
}
