//! Tables of numbers as text: one row a line, with or without a header, whatever separates the values.

use std::path::Path;

use super::{FrameError, is_number, npy};

/// What stands between the values of a line.
#[derive(Clone, Copy)]
pub(crate) enum Separator {
    /// This character.
    Byte(u8),
    /// Spaces, as many as there are.
    Spaces,
}

impl Separator {
    /// The separator of a line: the first of those that it has, a space being one only where there is no other.
    pub(crate) fn of(line: &[u8]) -> Self {
        let byte = b";\t,".iter().copied().find(|byte| line.contains(byte));
        byte.map_or(Self::Spaces, Self::Byte)
    }

    pub(crate) fn split(self, line: &[u8]) -> Vec<&[u8]> {
        match self {
            Self::Byte(separator) => line.split(|&byte| byte == separator).map(<[u8]>::trim_ascii).collect(),
            Self::Spaces => line.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty()).collect(),
        }
    }

    /// The finite number, within the range of a float32, that a field holds.
    fn number(self, field: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(field).ok()?;
        let value: f64 = match self {
            // Where it separates nothing, a comma is a decimal point.
            Self::Byte(b';' | b'\t') => text.replace(',', ".").parse().ok()?,
            _ => text.parse().ok()?,
        };
        is_number(value).then_some(value)
    }
}

/// Reads the columns after the labels; `wrong_length` is given the number of all columns. Blank lines, lines that begin
/// with #, a byte order mark, and a first line without any number after the labels are skipped.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    labels: usize,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<Vec<Vec<f64>>, FrameError> {
    // By hand, since a CSV reader skips blank lines without counting them and a message needs the right line.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let (mut rows, mut separator) = (Vec::new(), None);
    for (index, content) in text.split(|&byte| byte == b'\n').enumerate() {
        let line = index + 1;
        let content = content.trim_ascii();
        if content.is_empty() || content.starts_with(b"#") {
            continue;
        }
        let is_first = separator.is_none();
        let separator = *separator.get_or_insert_with(|| Separator::of(content));
        let fields = separator.split(content);
        if is_first && fields.iter().skip(labels).all(|field| no_number(field)) {
            continue;
        }
        let mut row = Vec::with_capacity(fields.len());
        for (index, field) in fields.iter().enumerate().skip(labels) {
            row.push(separator.number(field).ok_or_else(|| FrameError::Value {
                path: path.to_path_buf(),
                line,
                column: index + 1,
                text: String::from_utf8_lossy(field).chars().take(40).collect(),
            })?);
        }
        if let Some(expected) = wrong_length(fields.len()) {
            return Err(FrameError::Length { path: path.to_path_buf(), line, found: fields.len(), expected });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// The line, from 1, on which a frame of a file that was read before stands; none in an array.
pub(super) fn line_of(path: &Path, labels: usize, frame: usize) -> Option<usize> {
    let bytes = std::fs::read(path).ok().filter(|bytes| !bytes.starts_with(npy::MAGIC))?;
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).enumerate();
    let mut rows = lines.filter(|(_, content)| !content.is_empty() && !content.starts_with(b"#"));
    let (first, content) = rows.next()?;
    let fields = Separator::of(content).split(content);
    let has_header = fields.iter().skip(labels).all(|field| no_number(field));
    let (index, _) =
        if has_header { rows.nth(frame)? } else { std::iter::once((first, content)).chain(rows).nth(frame)? };
    Some(index + 1)
}

/// Whether a field is that of a header: text and no number of any kind.
fn no_number(field: &[u8]) -> bool {
    std::str::from_utf8(field).is_ok_and(|text| text.replace(',', ".").parse::<f64>().is_err())
}
