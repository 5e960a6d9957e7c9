//! Tables of numbers as text: one row a line, with or without a header, whatever separates the values.

use std::path::{Path, PathBuf};

use super::{FrameError, is_number, npy};
use crate::geometry;
use crate::sensor::Sensor;
use crate::separator::Separator;

/// What some programs write before the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// So few numbers in turn may be a frame: no sensor has fewer taxels.
const FEWEST_NUMBERED: usize = 4;

/// The finite number, within the range of a float32, that a field holds.
fn number(separator: Separator, field: &[u8]) -> Option<f64> {
    separator.value(field).filter(|&value| is_number(value))
}

/// Reads lines one after the other; of each the columns after the labels.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    /// Where they come from, for messages.
    path: PathBuf,
    labels: usize,
    /// The sensor that they are read for, if it is to be that of a remark.
    sensor: Option<Sensor>,
    /// That of the first line which has one; spaces between the words of a header are none.
    separator: Option<Separator>,
    /// Whether a line was a header or a frame.
    begun: bool,
    /// How many there were.
    number: usize,
    /// The line whose numbers were taken for those of the columns, and the last one of them.
    numbered: Option<[usize; 2]>,
}

impl Lines {
    pub(super) fn new(path: &Path, labels: usize, sensor: Option<&Sensor>) -> Self {
        Self {
            path: path.to_path_buf(),
            labels,
            sensor: sensor.cloned(),
            separator: None,
            begun: false,
            number: 0,
            numbered: None,
        }
    }

    /// Where the lines come from.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The number of the last line, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// What is to be said of a first line that numbers the columns.
    pub(super) fn remark(&self) -> Option<String> {
        let [line, last] = self.numbered?;
        Some(format!(
            "{}, line {line}: numbers in turn up to {last} are those of the columns, as pandas writes them; the line is taken for a header",
            self.path.display()
        ))
    }

    /// Columns before the values.
    pub(super) fn labels(&self) -> usize {
        self.labels
    }

    /// The numbers of the next line. Nothing for a blank one, for one that begins with #, and for a first one without any
    /// number after the labels, or with those of the taxels in turn; a byte order mark is skipped. `wrong_length` is given the number of all columns.
    pub(super) fn row(
        &mut self,
        line: &[u8],
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Option<Vec<f64>>, FrameError> {
        self.number += 1;
        let line = if self.number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line) } else { line };
        let content = line.trim_ascii();
        if content.starts_with(b"#")
            && let Some(sensor) = &self.sensor
        {
            geometry::compare_remark(content, &self.path, self.number, sensor)?;
        }
        if content.is_empty() || content.starts_with(b"#") {
            return Ok(None);
        }
        let is_first = !std::mem::replace(&mut self.begun, true);
        let separator = self.separator.unwrap_or_else(|| Separator::of(content));
        let fields = separator.fields(content);
        if let Some(separator) = foreign(content) {
            return Err(FrameError::Separator { path: self.path.clone(), line: self.number, separator });
        }
        let is_header = is_first && fields.iter().skip(self.labels).all(|field| no_number(field));
        self.separator = Some(separator).filter(|separator| !is_header || matches!(separator, Separator::Byte(_)));
        if is_header {
            return Ok(None);
        }
        let mut row = Vec::with_capacity(fields.len());
        for (index, field) in fields.iter().enumerate().skip(self.labels) {
            row.push(number(separator, field).ok_or_else(|| FrameError::Value {
                path: self.path.clone(),
                line: self.number,
                column: index + 1,
                text: String::from_utf8_lossy(field).chars().take(40).collect(),
            })?);
        }
        match wrong_length(fields.len()) {
            None if is_first && self.sensor.is_some() && numbers_columns(&row, self.labels) => {
                self.numbered = Some([self.number, row[row.len() - 1] as usize]);
                Ok(None)
            }
            None => Ok(Some(row)),
            Some(expected) => {
                Err(FrameError::Length { path: self.path.clone(), line: self.number, found: fields.len(), expected })
            }
        }
    }
}

/// Reads all rows of a text, see [`Lines::row`], and what is to be said of its header.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    labels: usize,
    sensor: Option<&Sensor>,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<(Vec<Vec<f64>>, Option<String>), FrameError> {
    // By hand, since a CSV reader skips blank lines without counting them and a message needs the right line.
    let mut lines = Lines::new(path, labels, sensor);
    let rows = bytes.split(|&byte| byte == b'\n').filter_map(|line| lines.row(line, &wrong_length).transpose());
    let rows = rows.collect::<Result<_, _>>()?;
    Ok((rows, lines.remark()))
}

/// The line, from 1, on which a frame of a file that was read before stands; none in an array.
pub(super) fn line_of(path: &Path, labels: usize, frame: usize) -> Option<usize> {
    let bytes = std::fs::read(path).ok().filter(|bytes| !bytes.starts_with(npy::MAGIC))?;
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&bytes);
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).enumerate();
    let mut rows = lines.filter(|(_, content)| !content.is_empty() && !content.starts_with(b"#"));
    let (first, content) = rows.next()?;
    let separator = Separator::of(content);
    // A header may have fewer fields than there are labels.
    let fields: Vec<_> = separator.fields(content).into_iter().skip(labels).collect();
    let row: Option<Vec<f64>> = fields.iter().map(|field| number(separator, field)).collect();
    let has_header =
        fields.iter().all(|field| no_number(field)) || row.is_some_and(|row| numbers_columns(&row, labels));
    let (index, _) =
        if has_header { rows.nth(frame)? } else { std::iter::once((first, content)).chain(rows).nth(frame)? };
    Some(index + 1)
}

/// What separates the numbers of a line, where that is nothing that separates values here.
fn foreign(content: &[u8]) -> Option<&'static str> {
    const SEPARATORS: [(char, &str); 5] = [
        ('|', "\"|\""),
        (':', "\":\""),
        ('/', "\"/\""),
        ('\u{a0}', "a no-break space"),
        ('\u{202f}', "a narrow no-break space"),
    ];
    let text = std::str::from_utf8(content).ok()?;
    let separates = |&(separator, _): &(char, &str)| {
        let ends = |c: char| c == separator || c.is_whitespace();
        let mut fields = text.trim_matches(ends).split(separator);
        fields.clone().nth(1).is_some() && fields.all(|field| field.trim().parse::<f64>().is_ok())
    };
    SEPARATORS.iter().find(|&separator| separates(separator)).map(|&(_, name)| name)
}

/// Whether a line's values, behind the labels, are the numbers of its columns: from 0 or 1 on, or as the labels have it.
fn numbers_columns(row: &[f64], labels: usize) -> bool {
    let from =
        |first: usize| row.iter().zip(first..).all(|(&value, number)| value.to_bits() == (number as f64).to_bits());
    row.len() >= FEWEST_NUMBERED && [0, 1, labels].into_iter().any(from)
}

/// Whether a field is that of a header: text and no number of any kind.
fn no_number(field: &[u8]) -> bool {
    std::str::from_utf8(field).is_ok_and(|text| text.replace(',', ".").parse::<f64>().is_err())
}
