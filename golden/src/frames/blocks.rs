//! Frames as blocks of rows: a line for each row of taxels, blank lines or lines of words between the frames.
//!
//! So `numpy.savetxt` writes one frame, and so pressure mats' programs export theirs: key lines, a marker and the rows of
//! each frame, an end marker.

use std::path::Path;

use super::layout::{Layout, Target};
use super::text::Text;
use super::{FrameError, is_number};
use crate::calibrate::recorded::pressure_unit;
use crate::separator::{self, Comma, Separator, is_unknown};

/// A line of a file.
struct Line<'a> {
    number: usize,
    content: &'a [u8],
    /// Its numbers, NaN where one is not there, if it has nothing else.
    row: Option<Vec<f64>>,
}

/// Reads blocks of rows; nothing if the file does not hold any: its lines have a value for each taxel, or other lengths.
pub(super) fn read(path: &Path, bytes: &[u8], layout: &Layout, target: &Target) -> Result<Option<Text>, FrameError> {
    let (columns, rows) = (target.sensor.columns, target.sensor.rows);
    let all: Vec<Line> = separator::lines(bytes)
        .enumerate()
        .skip(layout.skip_lines)
        .map(|(index, line)| (index + 1, line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line).trim_ascii()))
        .map(|(number, content)| Line { number, content, row: numbers(content) })
        .collect();
    let of_length =
        |length: usize| all.iter().filter(move |line| line.row.as_ref().is_some_and(|row| row.len() == length)).count();
    if rows == 1 || of_length(target.sensor.taxels()) > 0 {
        return Ok(None);
    }
    let wrong = |line: usize, problem: String| FrameError::Block { path: path.to_path_buf(), line, problem };
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
    let (unit, mut text) = (unit(&all), Text::default());
    let mut block: Vec<f64> = Vec::new();
    let (mut bad, mut commas) = (0, (false, None));
    for Line { number, content, row } in &all {
        match row {
            Some(row) if row.len() == columns => block.extend(row),
            _ if block.is_empty() || content.starts_with(b"#") => continue,
            _ => {
                let found = block.len() / columns;
                return Err(wrong(
                    *number,
                    format!(
                        "a block of {found} rows ends here where the sensor has {rows}; skip lines above the first frame with \
                         --skip-lines N"
                    ),
                ));
            }
        }
        for field in Separator::of(content).fields(content) {
            match Comma::of(field) {
                Some(Comma::Decimal) => commas.0 = true,
                Some(Comma::Unclear) => {
                    commas.1.get_or_insert_with(|| (*number, String::from_utf8_lossy(field).into_owned()));
                }
                None => {}
            }
        }
        if block.len() < columns * rows {
            continue;
        }
        let mut frame = std::mem::take(&mut block);
        for &taxel in &target.dead {
            frame[taxel] = if is_number(frame[taxel]) { frame[taxel] } else { 0.0 };
        }
        match frame.iter().position(|value| !is_number(*value)) {
            None => {
                text.rows.push(frame);
                text.lines.push(number + 1 - rows);
            }
            Some(_) if layout.skip_bad => bad += 1,
            Some(taxel) => {
                return Err(wrong(
                    number + 1 - rows + taxel / columns,
                    format!(
                        "column {} is no number; name a taxel that is dead in sensor.dead, or leave such frames out with \
                         --skip-bad",
                        taxel % columns + 1
                    ),
                ));
            }
        }
    }
    if let (false, Some((line, text))) = commas {
        return Err(FrameError::Thousands { path: path.to_path_buf(), line, column: 1, text });
    }
    if !block.is_empty() {
        let problem = format!("the file ends within a frame, after {} of {rows} rows", block.len() / columns);
        return Err(wrong(all.len(), problem));
    }
    let path = path.display();
    text.remarks.push(format!("{path}: frames are blocks of {rows} lines of {columns} values"));
    if bad > 0 {
        text.remarks.push(format!("{path}: {bad} frames with values that are no numbers are left out"));
    }
    if let Some((name, pascals)) = unit {
        text.remarks.push(if target.counts {
            format!("{path}: the header gives the unit {name}; the design says what a value is worth")
        } else {
            text.rows.iter_mut().flatten().for_each(|value| *value *= -pascals);
            format!("{path}: the header gives the unit {name}; pressure presses, so that 1 {name} is {} Pa", -pascals)
        });
    }
    Ok(Some(text))
}

/// The numbers of a line that has nothing else.
fn numbers(content: &[u8]) -> Option<Vec<f64>> {
    let separator = Separator::of(content);
    let fields = separator.fields(content);
    let number = |field: &&[u8]| match separator::number(field) {
        Some(value) => Some(value),
        None => is_unknown(&String::from_utf8_lossy(field)).then_some(f64::NAN),
    };
    let row: Vec<f64> = fields.iter().map(number).collect::<Option<_>>()?;
    row.iter().any(|value| value.is_finite()).then_some(row)
}

/// The unit of pressure that a line of words above the frames names, and what it is worth in pascals.
fn unit(lines: &[Line]) -> Option<(String, f64)> {
    let words = lines.iter().take_while(|line| line.row.as_ref().is_none_or(|row| row.len() < 2));
    words
        .map(|line| String::from_utf8_lossy(line.content))
        .filter(|text| text.to_lowercase().contains("unit"))
        .find_map(|text| {
            let mut names = text.split(|c: char| !c.is_alphanumeric());
            names.find_map(|name| Some((name.to_owned(), pressure_unit(&name.to_lowercase())?)))
        })
}
