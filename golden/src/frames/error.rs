//! What is wrong with files of frames, where, and what to do about it.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use crate::design::Samples;
use crate::geometry::GeometryError;
use crate::numbers::counted;
use crate::output::OutputError;
use crate::separator::Unclear;

/// What is wrong with a frame file.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The file could not be read.
    #[error("{}: cannot read the frames: {source}; {}", path.display(), crate::missing_file::remedy(path, source, crate::missing_file::FRAMES))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A line with too few or too many values.
    #[error(
        "{}, line {line}: the line ends at column {found} where {expected} values are needed; {hint}", path.display()
    )]
    Length {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Values on the line.
        found: usize,
        /// Values in a frame.
        expected: usize,
        /// What to do.
        hint: String,
    },
    /// A value that is no finite number.
    #[error("{}, line {line}, column {column}: {text:?} is no finite float32 number; {remedy}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Position on the line, from 1.
        column: usize,
        /// What is there.
        text: String,
        /// What to do.
        remedy: String,
    },
    /// A force file that does not belong to the frames.
    #[error(
        "{}: forces of {} where there are {expected}; give the file that was made with these frames",
        path.display(), counted(*found, "frame")
    )]
    Count {
        /// The file.
        path: PathBuf,
        /// Lines in the file.
        found: usize,
        /// Frames.
        expected: usize,
    },
    /// What else is wrong: the file and the place in it, and what to do.
    #[error("{0}")]
    Wrong(String),
    /// The frames of another sensor.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] OutputError),
}

impl FrameError {
    /// What is wrong with a file as a whole.
    pub(crate) fn file(path: &Path, problem: impl Display) -> Self {
        Self::Wrong(format!("{}: {problem}", path.display()))
    }

    /// What is wrong at a place of a file.
    pub(crate) fn at(path: &Path, place: impl Display, problem: impl Display) -> Self {
        Self::Wrong(format!("{}, {place}: {problem}", path.display()))
    }

    /// A cell that is no finite number.
    pub(crate) fn value(path: &Path, [line, column]: [usize; 2], cell: &[u8], remedy: impl Into<String>) -> Self {
        let text = String::from_utf8_lossy(cell).chars().take(40).collect();
        Self::Value { path: path.to_path_buf(), line, column, text, remedy: remedy.into() }
    }

    /// What is wrong with a line, from 1: as with lines or columns that do not fit the sensor.
    pub(crate) fn line(path: &Path, line: usize, problem: impl Display) -> Self {
        Self::at(path, format_args!("line {line}"), problem)
    }

    /// A `.npy` file that holds something else than frames.
    pub(crate) fn array(path: &Path, problem: impl Display) -> Self {
        let remedy = "save frames by taxels, or frames by rows by columns, with numpy.save";
        Self::file(path, format_args!("{problem}; {remedy}"))
    }

    /// A file of another format.
    pub(crate) fn format(path: &Path, what: &str, remedy: &str) -> Self {
        Self::file(path, format_args!("the file is {what}; {remedy}"))
    }

    /// A value that the design's integer samples cannot be.
    pub(crate) fn sample(path: &Path, place: &str, value: f64, samples: Samples) -> Self {
        let remedy = samples.remedy();
        let problem =
            format!("{value} is no {samples}, as hardware.samples says that the sensor's counts are; {remedy}");
        Self::at(path, place, problem)
    }

    /// Commas, or points between semicolons, that are decimal ones or separators of thousands.
    pub(crate) fn thousands(path: &Path, Unclear { place: [line, column], text, mark }: &Unclear) -> Self {
        let remedy = if *mark == "comma" { "write decimal points" } else { "separate the values by commas" };
        let problem = format!(
            "\"{text}\" is a number with a decimal {mark} or one with separators of thousands, and three digits follow \
             every {mark} of the file; {remedy}, or remove the separators"
        );
        Self::at(path, format_args!("line {line}, column {column}"), problem)
    }

    /// Whether a line of text is one that was cut off at its beginning: too few values, or a first one that is none.
    pub fn is_of_a_cut_line(&self) -> bool {
        match self {
            Self::Length { found, expected, .. } => found < expected,
            Self::Value { column, .. } => *column == 1,
            _ => false,
        }
    }
}
