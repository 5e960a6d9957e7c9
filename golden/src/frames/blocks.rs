//! Frames as blocks of rows: a line for each row of taxels, blank lines or lines of words between the frames.
//!
//! So `numpy.savetxt` writes one frame, and so pressure mats' programs export theirs: key lines, a marker and the rows of
//! each frame, an end marker.

use std::path::Path;

use super::layout::{Layout, Target};
use super::text::{Lines, Text};
use super::{FrameError, header};
use crate::sensor::Sensor;
use crate::separator::{self, Separator, is_unknown};
use crate::units::pascals;

/// A line of a file.
struct Line<'a> {
    number: usize,
    content: &'a [u8],
    /// Its fields, if they are numbers.
    row: Option<Vec<&'a [u8]>>,
}

/// Frames of a file, each on one line.
pub(super) struct Blocks {
    /// The first line of each, from 1, and its fields, separated by semicolons or tabs.
    frames: Vec<(usize, Vec<u8>)>,
    /// Whether numbers of the columns stand above.
    is_numbered: bool,
    /// The unit that the header names.
    unit: Option<String>,
}

impl Blocks {
    /// The frames.
    pub(super) fn read(
        &self,
        mut lines: Lines,
        target: &Target,
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Text, FrameError> {
        let Sensor { columns, rows, .. } = target.sensor;
        let (unit, remark) = self.unit.as_ref().map_or((None, None), |unit| header::worth(unit, target, -1.0));
        let path = lines.path().display().to_string();
        let mut text = Text::default();
        for (line, frame) in &self.frames {
            lines.begin_block(*line, columns, unit);
            if let Some(row) = lines.row(frame, &wrong_length)? {
                text.rows.push(row);
                text.lines.push(*line);
            }
        }
        lines.end(&mut text)?;
        let numbers = if self.is_numbered { ", below numbers of the columns" } else { "" };
        text.remarks.push(format!("{path}: frames are blocks of {rows} lines of {columns} values{numbers}"));
        text.remarks.extend(remark.map(|remark| format!("{path}: {remark}")));
        Ok(text)
    }
}

/// Puts the rows of each frame on one line; nothing if the file has a line for each frame, or lines of other lengths.
pub(super) fn join(path: &Path, bytes: &[u8], layout: &Layout, target: &Target) -> Result<Option<Blocks>, FrameError> {
    let (columns, rows) = (target.sensor.columns, target.sensor.rows);
    let mut all: Vec<Line> = separator::lines(bytes)
        .enumerate()
        .skip(layout.skip_lines)
        .map(|(index, line)| Line { number: index + 1, content: line.trim_ascii(), row: row(line, columns) })
        .collect();
    let of_length =
        |length: usize| all.iter().filter(move |line| line.row.as_ref().is_some_and(|row| row.len() == length)).count();
    if rows == 1 || of_length(target.sensor.taxels()) > 0 {
        return Ok(None);
    }
    let wrong = |line: usize, problem: String| FrameError::Shape { path: path.to_path_buf(), line, problem };
    if of_length(columns) < rows {
        // The rows of the grid laid on its side.
        return match of_length(rows) {
            lines if columns > 1 && lines > 0 && lines.is_multiple_of(columns) && rows != columns => Err(wrong(
                all.iter().find(|line| line.row.is_some()).map_or(1, |line| line.number),
                format!(
                    "blocks of {columns} lines of {rows} values are the transposed grid: the sensor has {rows} rows of \
                     {columns} columns; write a line for each row, or swap columns, rows and pitch_mm of the design"
                ),
            )),
            _ => Ok(None),
        };
    }
    // Numbers of the columns above frames, as pandas writes them: without them the rows are whole frames.
    let numbers = Sensor { rows: 1, ..target.sensor.clone() };
    let head = all.iter().find_map(|line| Some((line.content, line.row.as_ref()?)));
    let head = head.filter(|(_, row)| header::is_numbered(row, &numbers, true)).map(|(content, _)| content);
    let is_row = |line: &&Line| line.row.as_ref().is_some_and(|row| row.len() == columns) && Some(line.content) != head;
    let others = all.iter().filter(is_row).count();
    let is_numbered = head.is_some() && others > 0 && others.is_multiple_of(rows);
    if is_numbered {
        all.iter_mut().filter(|line| Some(line.content) == head).for_each(|line| line.row = None);
    }
    // Points between semicolons may separate thousands.
    let separator: &[u8] =
        if all.iter().any(|line| line.row.is_some() && line.content.contains(&b';')) { b";" } else { b"\t" };
    let (mut frames, mut block) = (Vec::new(), Vec::new());
    for Line { number, content, row } in &all {
        match row {
            Some(row) if row.len() == columns => block.push(row.join(separator)),
            _ if block.is_empty() || content.starts_with(b"#") => {}
            _ => {
                let found = block.len();
                return Err(wrong(
                    *number,
                    format!(
                        "a block of {found} rows ends here where the sensor has {rows}; skip lines above the first frame with \
                         --skip-lines N"
                    ),
                ));
            }
        }
        if block.len() == rows {
            frames.push((number + 1 - rows, std::mem::take(&mut block).join(separator)));
        }
    }
    if !block.is_empty() {
        let problem = format!("the file ends within a frame, after {} of {rows} rows", block.len());
        return Err(wrong(all.len(), problem));
    }
    Ok(Some(Blocks { frames, is_numbered, unit: unit(&all) }))
}

/// The fields of a line that has nothing but numbers and readings that are not there.
fn row(line: &[u8], columns: usize) -> Option<Vec<&[u8]>> {
    let separator = Separator::of(line.trim_ascii());
    let fields = separator.at_most(columns, separator.trim(line));
    let is_number = |field: &&[u8]| separator::number(field).is_some_and(f64::is_finite);
    let is_reading = |field: &&[u8]| separator::number(field).is_some() || is_unknown(&String::from_utf8_lossy(field));
    (fields.iter().all(is_reading) && fields.iter().any(is_number)).then_some(fields)
}

/// The unit that a line of words above the frames names: a known one, or else the word behind "unit".
fn unit(lines: &[Line]) -> Option<String> {
    let words = lines.iter().take_while(|line| line.row.as_ref().is_none_or(|row| row.len() < 2));
    words.map(|line| String::from_utf8_lossy(line.content)).find_map(|text| {
        let is_unit = |word: &&str| ["unit", "einheit"].iter().any(|unit| word.to_lowercase().contains(unit));
        let mut words =
            text.split([' ', '\t', ':', '=', ',', ';', '"', '(', ')', '[', ']']).filter(|word| !word.is_empty());
        words.find(is_unit)?;
        let behind: Vec<&str> = words.collect();
        let unit = behind.iter().find(|word| pascals(word).is_some()).or(behind.first())?;
        Some(unit.replace(char::is_control, ""))
    })
}
