//! Frame files: one value for each taxel, in taxel order: the stress in pascals or, for a design with `pa_per_count`, the
//! sensor's count.
//!
//! As text, one frame a line, with a header line or none, separated by commas, semicolons, tabs or spaces; recordings may
//! have other columns before the values and behind them ([`Layout`]). Or a line for each row of taxels. Or `NumPy`'s `.npy`,
//! of frames by taxels or frames by rows by columns.

mod blocks;
mod cells;
mod error;
mod format;
mod header;
mod hints;
mod layout;
mod names;
mod npy;
mod stream;
mod text;

use cells::BYTE_ORDER_MARK;
pub(crate) use cells::{Numbers, Table};

use std::path::Path;

pub use error::FrameError;
pub use layout::Layout;
use layout::Target;
use npy::Array;
pub use stream::FrameLines;
use text::{Lines, Text};

use crate::design::Design;
use crate::numbers::{counted, push_row};
use crate::output;
use crate::sensor::Sensor;
use crate::units::without_gaps;

/// A column of times before the values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clock {
    /// From 1.
    pub column: usize,
    /// As the header names it.
    pub name: String,
    /// Whether the name says in which unit it counts.
    pub has_unit: bool,
}

/// Frames of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    /// One value for each taxel.
    pub frames: Vec<Vec<f64>>,
    /// The time of each frame in seconds, where the file's header names a column of times before the values, or one has time
    /// stamps.
    pub times: Option<Vec<f64>>,
    /// The column that the header names as one of times.
    pub clock: Option<Clock>,
    /// Frames that were left out (`--skip-bad`), by their place among all in the file, from 0.
    pub skipped: Vec<usize>,
    /// What was taken for what, on one line.
    pub remark: Option<String>,
}

impl Frames {
    /// Frames of the file, those that were left out among them.
    pub fn count(&self) -> usize {
        self.frames.len() + self.skipped.len()
    }

    /// Lines of a file beside the frames, without those of frames that were left out, which it may have or not. `read` reads
    /// so many lines.
    ///
    /// # Errors
    ///
    /// Those of `read`, and [`FrameError::Count`] for another number of lines.
    pub fn lines_of<T>(&self, read: impl Fn(usize) -> Result<Vec<T>, FrameError>) -> Result<Vec<T>, FrameError> {
        match read(self.count()) {
            Err(FrameError::Count { .. }) if !self.skipped.is_empty() => read(self.frames.len()),
            lines => lines,
        }
        .map(|lines| self.kept(lines))
    }

    /// The lines of a file that has one for each frame, without those of frames that were left out. It stays as it is if it
    /// has none of these.
    pub(crate) fn kept<T>(&self, lines: Vec<T>) -> Vec<T> {
        if lines.len() == self.frames.len() {
            return lines;
        }
        let is_kept = |place: &usize| self.skipped.binary_search(place).is_err();
        lines.into_iter().enumerate().filter(|(place, _)| is_kept(place)).map(|(_, line)| line).collect()
    }
}

/// Reads the frames of a design, with their times and what is to be said of the file; each has a value for each taxel that
/// the design's samples can be. The values stand where `layout` says: a number is that of columns of any text before them. Of
/// a dead taxel any text is read, as 0.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for the first line that is no frame, and for a `.npy` file of another shape.
pub fn read_recording(path: &Path, design: &Design, layout: impl Into<Layout>) -> Result<Frames, FrameError> {
    let Text { rows: frames, lines, labels, header, times, skipped, mut remarks } =
        read_text(path, &layout.into(), &design.into())?;
    if frames.is_empty() {
        return Err(if remarks.is_empty() {
            let remedy =
                format!("write one line of {} stresses, separated by commas, for each frame", design.sensor.taxels());
            FrameError::file(path, format_args!("no frame in the file; {remedy}"))
        } else {
            // No more than a line that numbers the columns; the remark says where.
            let problem = "no frame follows it; if it is a frame, write a line of names above it";
            FrameError::Wrong(format!("{}, and {problem}", remarks.join("; ")))
        });
    }
    let samples = design.hardware.samples;
    let wrong = |values: &Vec<f64>| values.iter().position(|&value| !samples.takes(value));
    let found = frames.iter().enumerate().find_map(|(frame, values)| Some((frame, wrong(values)?)));
    let Some((frame, column)) = found else {
        let times = match without_gaps(times) {
            Err(place) if header.time.is_some() => {
                return Err(FrameError::line(path, lines[place], NO_TIME));
            }
            times => times.unwrap_or_default(),
        };
        let times = times.filter(|(times, _)| times.len() == frames.len());
        if let Some((_, unknown)) = times.as_ref().filter(|(_, unknown)| *unknown > 0) {
            remarks.push(format!("{}: {}", path.display(), between(*unknown)));
        }
        let times = times.map(|(times, _)| times);
        let remark = (!remarks.is_empty()).then(|| remarks.join("; "));
        return Ok(Frames { frames, times, clock: header.clock, skipped, remark });
    };
    let place = match lines.get(frame) {
        Some(line) => format!("line {line}, column {}", header.column(labels, column)),
        None => format!("[{frame}, {}]", labels + column),
    };
    Err(FrameError::sample(path, &place, frames[frame][column], samples))
}

/// Of a line without a time, where others have one.
pub(crate) const NO_TIME: &str = "the time is no number, and others are: fill it in, or take the line out of the file";

/// What is to be said of so many lines without a time.
pub(crate) fn between(lines: usize) -> String {
    format!("{} without a time: it is taken from those around", counted(lines, "line"))
}

/// The frames of a file with their lines.
fn read_text(path: &Path, layout: &Layout, target: &Target) -> Result<Text, FrameError> {
    let wrong = |problem: String| FrameError::array(path, problem);
    let array = match content(path)? {
        Content::Text(bytes) => {
            let lines = Lines::new(path, layout, target);
            return match blocks::join(path, &bytes, layout, target)? {
                Some(blocks) => blocks.read(lines, target),
                None => text::read(lines, &bytes),
            };
        }
        Content::Array(array) => array,
    };
    let [count, row @ ..] = array.shape.as_slice() else {
        return Err(wrong("it holds a single number".to_owned()));
    };
    if array.values.is_empty() {
        return Err(wrong(format!("the array is empty, {:?}", array.shape)));
    }
    of_grid(row, &target.sensor).map_err(wrong)?;
    let length: usize = row.iter().product();
    let first = layout.first().min(length);
    let end = layout.columns.map_or(length, |[_, last]| last.clamp(first, length));
    let expected = target.sensor.taxels();
    if end - first != expected {
        let more = if *count == expected { "; are frames its columns? Give its transpose" } else { "" };
        return Err(wrong(format!(
            "it has {length} values a row where {} are needed{more}",
            layout.first() + expected
        )));
    }
    let mut text = Text { labels: first, ..Text::default() };
    for (row, values) in array.values.chunks(length.max(1)).enumerate() {
        let mut values = values[first..end].to_vec();
        for &taxel in &target.dead {
            values[taxel] = if is_number(values[taxel]) { values[taxel] } else { 0.0 };
        }
        match values.iter().position(|value| !is_number(*value)) {
            None => text.rows.push(values),
            Some(_) if layout.skip_bad => text.skipped.push(row),
            Some(column) => {
                let value = values[column];
                return Err(wrong(format!(
                    "[{row}, {}] is {value}, no finite float32: name a taxel that is dead in sensor.dead, or leave such \
                     frames out with --skip-bad",
                    first + column
                )));
            }
        }
    }
    let bad = count - text.rows.len();
    if bad > 0 {
        text.remarks.push(format!(
            "{}: {bad} of {} left out for values that are no numbers",
            path.display(),
            counted(*count, "frame")
        ));
    }
    Ok(text)
}

/// What is in a file.
enum Content {
    /// Values of a `.npy` file, NaN among them.
    Array(Array),
    Text(Vec<u8>),
}

/// The content of a file that may be one of frames.
fn content(path: &Path) -> Result<Content, FrameError> {
    let mut bytes = std::fs::read(path).map_err(|source| FrameError::Read { path: path.to_path_buf(), source })?;
    if bytes.starts_with(npy::MAGIC) {
        let array = npy::parse(&bytes).map_err(|problem| FrameError::array(path, problem))?;
        return Ok(Content::Array(array));
    }
    if bytes.starts_with(BYTE_ORDER_MARK) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    // A mark of UTF-16, and a digit or a sign in two bytes.
    let of_pair: Option<fn([u8; 2]) -> u16> = match bytes[..] {
        [0xff, 0xfe, _, 0, ..] => Some(u16::from_le_bytes),
        [0xfe, 0xff, 0, ..] => Some(u16::from_be_bytes),
        _ => None,
    };
    if let Some(of_pair) = of_pair {
        let letters: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| of_pair([pair[0], pair[1]])).collect();
        bytes = String::from_utf16_lossy(&letters).into_bytes();
    }
    match format::other(&bytes) {
        Some((what, remedy)) => Err(FrameError::format(path, what, remedy)),
        None => Ok(Content::Text(bytes)),
    }
}

/// A file of any table as text: an array has a line for each of its rows.
pub(crate) fn text(path: &Path) -> Result<Vec<u8>, FrameError> {
    let Array { shape, values } = match content(path)? {
        Content::Text(bytes) => return Ok(bytes),
        Content::Array(array) => array,
    };
    let columns = shape.iter().skip(1).product::<usize>().max(1);
    let mut text = String::new();
    values.chunks(columns).for_each(|row| push_row(&mut text, row.iter().copied()));
    Ok(text.into_bytes())
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
