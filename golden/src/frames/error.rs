//! What is wrong with files of frames, where, and what to do about it.

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
    /// The file has no frame in it.
    #[error(
        "{}: no frame in the file; write one line of {expected} stresses, separated by commas, for each frame",
        path.display()
    )]
    Empty {
        /// The file.
        path: PathBuf,
        /// Values in a frame.
        expected: usize,
    },
    /// The file has no more than a line that numbers the columns.
    #[error("{remark}, and no frame follows it; if it is a frame, write a line of names above it")]
    HeaderAlone {
        /// What it is taken for, and where.
        remark: String,
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
    /// Commas, or points between semicolons, that are decimal ones or separators of thousands.
    #[error(
        "{}, line {line}, column {column}: \"{text}\" is a number with a decimal {mark} or one with separators of thousands, \
         and three digits follow every {mark} of the file; {}, or remove the separators",
        path.display(), if *mark == "comma" { "write decimal points" } else { "separate the values by commas" }
    )]
    Thousands {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Position on the line, from 1.
        column: usize,
        /// What is there.
        text: String,
        /// "comma" or "point".
        mark: &'static str,
    },
    /// Lines or columns that do not fit the sensor.
    #[error("{}, line {line}: {problem}", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A character between the values that separates none.
    #[error(
        "{}, line {line}: {separator} separates the values; separate them by commas, semicolons, tabs or spaces",
        path.display()
    )]
    Separator {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What does, in words.
        separator: &'static str,
    },
    /// A value that the design's integer samples cannot be.
    #[error(
        "{}, {place}: {value} is no {samples}, as hardware.samples says that the sensor's counts are; {}",
        path.display(), samples.remedy()
    )]
    Sample {
        /// The file.
        path: PathBuf,
        /// Line and column.
        place: String,
        /// What is there.
        value: f64,
        /// What it should be.
        samples: Samples,
    },
    /// A `.npy` file that holds something else than frames.
    #[error(
        "{}: {problem}; save frames by taxels, or frames by rows by columns, with numpy.save", path.display()
    )]
    Array {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A file of another format.
    #[error("{}: the file is {what}; {remedy}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What it is, in words.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A file of forces that holds something else.
    #[error(
        "{}, line {line}: {problem}, so these are no forces; true forces lie beside the frames of `sptfra scene`, in \
         FRAMES.forces.csv, a line each that begins with status, F_x, F_y, F_z, mu and phi", path.display()
    )]
    NoForces {
        /// The file.
        path: PathBuf,
        /// Which of the lines with numbers, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
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
    /// The frames of another sensor.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] OutputError),
}

impl FrameError {
    pub(crate) fn thousands(path: &Path, unclear: &Unclear) -> Self {
        let Unclear { place: [line, column], text, mark } = unclear.clone();
        Self::Thousands { path: path.to_path_buf(), line, column, text, mark }
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
