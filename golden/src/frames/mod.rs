//! Frame files: one value for each taxel, in taxel order: the stress in pascals or, for a design with `pa_per_count`, the
//! sensor's count.
//!
//! As text, one frame a line, with a header line or none, separated by commas, semicolons, tabs or spaces; recordings may
//! have label columns before the values. Or `NumPy`'s `.npy`, of frames by taxels or frames by rows by columns.

mod error;
mod format;
mod npy;
mod stream;
mod text;

pub(crate) use npy::Array;

use std::fmt::Write;
use std::path::Path;

pub use error::FrameError;
pub use stream::{FrameLines, FrameStream};

use crate::design::Design;
use crate::output;
use crate::sensor::Sensor;

/// Frames, one value for each taxel, and a remark about the file they are from.
pub type WithRemark = (Vec<Vec<f64>>, Option<String>);

/// Reads all frames of a file; each has a finite value for each taxel of the sensor.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for the first line that is no frame, and for a `.npy` file of another shape.
pub fn read_frames(path: &Path, sensor: &Sensor) -> Result<Vec<Vec<f64>>, FrameError> {
    read_labelled_frames(path, sensor, 0)
}

/// As [`read_frames`], of a file whose lines begin with `labels` columns of any text, which are skipped.
///
/// # Errors
///
/// As [`read_frames`].
pub fn read_labelled_frames(path: &Path, sensor: &Sensor, labels: usize) -> Result<Vec<Vec<f64>>, FrameError> {
    Ok(read_with_remark(path, sensor, labels)?.0)
}

/// The frames, and what is to be said of a header that numbers the columns.
fn read_with_remark(path: &Path, sensor: &Sensor, labels: usize) -> Result<WithRemark, FrameError> {
    let taxels = sensor.taxels();
    let wrong_length = |found| (found != labels + taxels).then_some(labels + taxels);
    let (frames, remark) = read_table(path, labels, Some(sensor), wrong_length, |shape| of_grid(shape, sensor))?;
    match (frames.is_empty(), remark) {
        (true, None) => Err(FrameError::Empty { path: path.to_path_buf(), expected: taxels }),
        (true, Some(remark)) => Err(FrameError::HeaderAlone { remark }),
        (false, remark) => Ok((frames, remark)),
    }
}

/// Reads the frames of a design: as [`read_labelled_frames`], and each value is one that the design's samples can be.
///
/// # Errors
///
/// As [`read_frames`].
pub fn read_frames_of(path: &Path, design: &Design, labels: usize) -> Result<Vec<Vec<f64>>, FrameError> {
    Ok(read_frames_and_remark(path, design, labels)?.0)
}

/// As [`read_frames_of`], and what is to be said of a first line that holds the numbers of the columns, from 0 or 1 on: it
/// is taken for a header.
///
/// # Errors
///
/// As [`read_frames`].
pub fn read_frames_and_remark(path: &Path, design: &Design, labels: usize) -> Result<WithRemark, FrameError> {
    let (frames, remark) = read_with_remark(path, &design.sensor, labels)?;
    let samples = design.hardware.samples;
    let wrong = |values: &Vec<f64>| values.iter().position(|&value| !samples.takes(value));
    let found = frames.iter().enumerate().find_map(|(frame, values)| Some((frame, wrong(values)?)));
    let Some((frame, column)) = found else { return Ok((frames, remark)) };
    let at = text::line_of(path, labels, frame);
    let place = match at {
        Some(line) => format!("line {line}, column {}", labels + column + 1),
        None => format!("[{frame}, {}]", labels + column),
    };
    Err(FrameError::Sample { path: path.to_path_buf(), place, value: frames[frame][column], samples })
}

/// Reads the rows of a file of finite numbers, which may have a header. `wrong_length` is given the number of values of a
/// row and returns the number wanted if that is another.
pub(crate) fn read_rows(
    path: &Path,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<Vec<Vec<f64>>, FrameError> {
    Ok(read_table(path, 0, None, wrong_length, |_| Ok(()))?.0)
}

/// Reads the columns after the labels; `wrong_length` is given the number of all columns, `check` an array's shape, and a
/// remark about the sensor has to be of `sensor`.
fn read_table(
    path: &Path,
    labels: usize,
    sensor: Option<&Sensor>,
    wrong_length: impl Fn(usize) -> Option<usize>,
    check: impl Fn(&[usize]) -> Result<(), String>,
) -> Result<WithRemark, FrameError> {
    let bytes = bytes_of(path)?;
    if !bytes.starts_with(npy::MAGIC) {
        return text::read(path, &bytes, labels, sensor, wrong_length);
    }
    let wrong = |problem| FrameError::Array { path: path.to_path_buf(), problem };
    let array = npy::parse(&bytes).map_err(wrong)?;
    let [count, row @ ..] = array.shape.as_slice() else {
        return Err(wrong("it holds a single number".to_owned()));
    };
    check(row).map_err(wrong)?;
    let length: usize = row.iter().product();
    if let Some(expected) = wrong_length(length).filter(|_| *count > 0) {
        return Err(wrong(format!("it has {length} values a row where {expected} are needed")));
    }
    let rows: Vec<Vec<f64>> =
        array.values.chunks(length.max(1)).map(|row| row[labels.min(length)..].to_vec()).collect();
    for (row, values) in rows.iter().enumerate() {
        if let Some(column) = values.iter().position(|value| !is_number(*value)) {
            return Err(wrong(format!("[{row}, {}] is {}, no finite float32", labels + column, values[column])));
        }
    }
    Ok((rows, None))
}

/// The content of a file that may be one of frames.
fn bytes_of(path: &Path) -> Result<Vec<u8>, FrameError> {
    let bytes = std::fs::read(path).map_err(|source| FrameError::Read { path: path.to_path_buf(), source })?;
    match format::other(&bytes) {
        Some((what, remedy)) => Err(FrameError::Format { path: path.to_path_buf(), what, remedy }),
        None => Ok(bytes),
    }
}

/// The first line of a file of text that is no remark; nothing for a `.npy` file.
pub(crate) fn first_line(path: &Path) -> Result<Option<String>, FrameError> {
    let bytes = bytes_of(path)?;
    if bytes.starts_with(npy::MAGIC) {
        return Ok(None);
    }
    let text = String::from_utf8_lossy(&bytes);
    let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
    Ok(Some(line.unwrap_or("").to_owned()))
}

/// Shape and values of a `.npy` file, NaN among them; nothing for a file of text.
pub(crate) fn read_array(path: &Path) -> Result<Option<Array>, FrameError> {
    let bytes = bytes_of(path)?;
    if !bytes.starts_with(npy::MAGIC) {
        return Ok(None);
    }
    let array = npy::parse(&bytes).map_err(|problem| FrameError::Array { path: path.to_path_buf(), problem })?;
    Ok(Some(array))
}

/// Whether frames of this shape, without the number of frames, are those of the sensor; else what they look like.
///
/// # Errors
///
/// What to do, for a grid that is transposed, a single frame, or another sensor's.
pub fn of_grid(shape: &[usize], sensor: &Sensor) -> Result<(), String> {
    let Sensor { columns, rows, .. } = sensor;
    match shape {
        [_] => Ok(()),
        [a, b] if a == rows && b == columns => Ok(()),
        [a, b] if a == columns && b == rows => Err(format!(
            "its frames are {a} by {b}, the transposed grid: the sensor has {rows} rows of {columns} columns; \
             transpose them with frames.transpose(0, 2, 1)"
        )),
        [] => Err("it holds one row of numbers; a single frame is numpy.atleast_2d(frame)".to_owned()),
        _ => Err(format!("its frames are {shape:?} where the sensor has {rows} rows of {columns} columns")),
    }
}

/// Whether a float32 stream can carry the value.
fn is_number(value: f64) -> bool {
    value.abs() <= f64::from(f32::MAX)
}

/// Writes frames so that reading them gives the same bits back, the whole file or nothing: as `NumPy` does where the name
/// ends in `.npy`, else as CSV.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_frames(path: &Path, frames: &[Vec<f64>]) -> Result<(), FrameError> {
    if is_npy(path) {
        return write_array(path, frames.first().map_or(0, Vec::len), frames);
    }
    output::write_whole(path, to_text(frames).as_bytes())?;
    Ok(())
}

/// Frames as text, a line each. Counts, and stresses if all are whole, have no point.
pub fn to_text(frames: &[Vec<f64>]) -> String {
    let mut text = String::new();
    let whole =
        |value: &f64| value.fract() == 0.0 && value.abs() < 1e15 && !(*value == 0.0 && value.is_sign_negative());
    if frames.iter().flatten().all(whole) {
        for frame in frames {
            let line: Vec<String> = frame.iter().map(f64::to_string).collect();
            text += &(line.join(",") + "\n");
        }
        return text;
    }
    for frame in frames {
        push_row(&mut text, frame.iter().copied());
    }
    text
}

/// Whether a file's name asks for `NumPy`'s format.
pub(crate) fn is_npy(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy"))
}

/// Writes rows of equal length as `NumPy` does, the whole file or nothing.
pub(crate) fn write_array(path: &Path, columns: usize, rows: &[Vec<f64>]) -> Result<(), FrameError> {
    output::write_whole(path, &npy::file(columns, rows))?;
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
