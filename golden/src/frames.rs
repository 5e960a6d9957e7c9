//! Frame files: CSV without a header, one frame a line, one value for each taxel, in taxel order: the stress in pascals
//! or, for a design with `pa_per_count`, the sensor's count. Recordings may have label columns before the values.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::geometry::GeometryError;
use crate::output::{self, OutputError};

/// What is wrong with a frame file.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The file could not be read.
    #[error("{}: cannot read the frames: {source}; check the path and the permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file has no frame in it.
    #[error(
        "{}: no frame in the file; write one line of {expected} comma-separated stresses for each frame",
        path.display()
    )]
    Empty {
        /// The file.
        path: PathBuf,
        /// Values in a frame.
        expected: usize,
    },
    /// A line with too few or too many values.
    #[error(
        "{}, line {line}: the line ends at column {found} where {expected} values are needed; \
         give one stress for each taxel of the sensor", path.display()
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
    },
    /// A value that is no finite number.
    #[error(
        "{}, line {line}, column {column}: \"{text}\" is no finite float32 number; give the stress in pascals, \
         such as -1250.5, and no header line; columns before the values need --labels", path.display()
    )]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Position on the line, from 1.
        column: usize,
        /// What is there.
        text: String,
    },
    /// A force file that does not belong to the frames.
    #[error(
        "{}: forces of {found} frames where there are {expected}; give the file that was made with these frames",
        path.display()
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

/// Reads all frames of a file; each has `taxels` finite values. Blank lines and a byte order mark are skipped.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for the first line that is not `taxels` finite numbers.
pub fn read_frames(path: &Path, taxels: usize) -> Result<Vec<Vec<f64>>, FrameError> {
    read_labelled_frames(path, taxels, 0)
}

/// As [`read_frames`], of a file whose lines begin with `labels` columns of any text, which are skipped. Such a file
/// may have a header: a first line without any number after the labels.
///
/// # Errors
///
/// As [`read_frames`].
pub fn read_labelled_frames(path: &Path, taxels: usize, labels: usize) -> Result<Vec<Vec<f64>>, FrameError> {
    let wrong_length = |found| (found != labels + taxels).then_some(labels + taxels);
    let frames = read_table(path, labels, wrong_length)?;
    if frames.is_empty() {
        return Err(FrameError::Empty { path: path.to_path_buf(), expected: taxels });
    }
    Ok(frames)
}

/// Reads the rows of a CSV file of finite numbers. `wrong_length` is given the number of values of a row and
/// returns the number wanted if that is another.
pub(crate) fn read_rows(
    path: &Path,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<Vec<Vec<f64>>, FrameError> {
    read_table(path, 0, wrong_length)
}

/// Reads the columns after the labels; `wrong_length` is given the number of all columns.
fn read_table(
    path: &Path,
    labels: usize,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<Vec<Vec<f64>>, FrameError> {
    let unreadable = |source| FrameError::Read { path: path.to_path_buf(), source };
    let bytes = std::fs::read(path).map_err(unreadable)?;
    // By hand, since a CSV reader skips blank lines without counting them and a message needs the right line.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let (mut rows, mut begun) = (Vec::new(), false);
    for (index, content) in text.split(|&byte| byte == b'\n').enumerate() {
        let line = index + 1;
        let content = content.trim_ascii();
        if content.is_empty() {
            continue;
        }
        let fields = || content.split(|&byte| byte == b',').map(<[u8]>::trim_ascii);
        if labels > 0 && rows.is_empty() && !std::mem::replace(&mut begun, true) && fields().skip(labels).all(no_number)
        {
            continue;
        }
        let mut row = Vec::new();
        for (index, field) in fields().enumerate().skip(labels) {
            row.push(number(field).ok_or_else(|| FrameError::Value {
                path: path.to_path_buf(),
                line,
                column: index + 1,
                text: String::from_utf8_lossy(field).chars().take(40).collect(),
            })?);
        }
        let found = fields().count();
        if let Some(expected) = wrong_length(found) {
            return Err(FrameError::Length { path: path.to_path_buf(), line, found, expected });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// The finite number, within the range of a float32, that a field holds.
fn number(field: &[u8]) -> Option<f64> {
    let value: f64 = std::str::from_utf8(field).ok()?.parse().ok()?;
    (value.abs() <= f64::from(f32::MAX)).then_some(value)
}

/// Whether a field is that of a header: text and no number of any kind.
fn no_number(field: &[u8]) -> bool {
    std::str::from_utf8(field).is_ok_and(|text| text.parse::<f64>().is_err())
}

/// Writes frames so that reading them gives the same bits back, the whole file or nothing.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_frames(path: &Path, frames: &[Vec<f64>]) -> Result<(), FrameError> {
    let mut text = String::new();
    for frame in frames {
        push_row(&mut text, frame.iter().copied());
    }
    output::write_whole(path, text.as_bytes())?;
    Ok(())
}

/// Appends one CSV row; each number is the shortest that reads back as the same float.
pub(crate) fn push_row(text: &mut String, values: impl Iterator<Item = f64>) {
    for (index, value) in values.enumerate() {
        let separator = if index == 0 { "" } else { "," };
        // Writing to a String cannot fail.
        let _ = write!(text, "{separator}{value:?}");
    }
    text.push('\n');
}
