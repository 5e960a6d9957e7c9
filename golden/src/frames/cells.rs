//! Cells of a table of text: what separates them, the names above them, and the lines that are no rows.

use std::path::{Path, PathBuf};

use super::FrameError;
use crate::separator::{self, Marks, Separator, bare, foreign, is_unknown, no_number};
use crate::units::timestamp;

/// What some programs write before the first line.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// What a line is.
pub(super) enum Line<'a> {
    /// Without a cell.
    Blank,
    /// One that begins with #, or as MATLAB has it with %.
    Remark(&'a [u8]),
    /// The header again, as between recordings that were put behind each other.
    Again,
    /// Cells, and what separates them.
    Cells(&'a [u8], Separator),
}

/// Reads lines one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    /// Where they come from, for messages.
    pub(super) path: PathBuf,
    /// Lines at the beginning that are skipped.
    skip: usize,
    /// Lines so far.
    pub(super) number: usize,
    /// That of the first row, or what a line `sep=;` says.
    pub(super) separator: Option<Separator>,
    /// Cells of the first row that was read, blank ones among them.
    pub(super) width: Option<usize>,
    /// Whether a row was there.
    pub(super) has_rows: bool,
    /// The lines of the header.
    pub(super) heads: Vec<Vec<u8>>,
    /// The names in them. A number or a unit of a second line stands behind the name.
    pub(super) names: Vec<String>,
    /// Lines with # above the first row.
    remarks: Vec<(usize, Vec<u8>)>,
}

impl Cells {
    pub(super) fn new(path: &Path, skip: usize) -> Self {
        Self { path: path.to_path_buf(), skip, ..Self::default() }
    }

    /// What the next line is.
    ///
    /// # Errors
    ///
    /// A character between numbers that separates none.
    pub(super) fn line<'a>(&mut self, line: &'a [u8]) -> Result<Line<'a>, FrameError> {
        self.number += 1;
        let line = if self.number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line) } else { line };
        let content = line.trim_ascii();
        let is_skipped = self.number <= self.skip;
        if let Some(remark) = content.strip_prefix(b"#").or(content.strip_prefix(b"%"))
            && !self.is_unreadable(remark)
        {
            if !self.has_rows && !is_skipped {
                self.remarks.push((self.number, remark.trim_ascii().to_vec()));
            }
            return Ok(Line::Remark(content));
        }
        if is_skipped || content.is_empty() {
            return Ok(Line::Blank);
        }
        // As spreadsheets have it.
        if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] = content {
            self.separator = Some(Separator::Byte(*separator));
            return Ok(Line::Blank);
        }
        if self.heads.iter().any(|head| head == content) {
            return Ok(Line::Again);
        }
        let separator = self.separator.unwrap_or_else(|| Separator::of(content));
        let content = separator.trim(line);
        match foreign(content) {
            Some(separator) => {
                let problem = format!("{separator} separates the values");
                let remedy = "separate them by commas, semicolons, tabs or spaces";
                Err(FrameError::line(&self.path, self.number, format_args!("{problem}; {remedy}")))
            }
            None => Ok(Line::Cells(content, separator)),
        }
    }

    /// Whether a line behind its # is a row whose first cell a spreadsheet could not fill, as #N/A. A row behind a # is a remark.
    fn is_unreadable(&self, remark: &[u8]) -> bool {
        let separator = self.separator.unwrap_or_else(|| Separator::of(remark));
        let cells = separator.split(remark);
        let is_cell = |cell: &&[u8]| {
            separator::number(cell).is_some() || cell.starts_with(b"#") || is_unknown(&String::from_utf8_lossy(cell))
        };
        let width = self.width.unwrap_or(self.names.len());
        // Without a width a first cell of any word may be a name behind a #.
        let is_error = || cells[0].eq_ignore_ascii_case(b"N/A") || matches!(cells[0], [.., b'!' | b'?']);
        let is_first = if width > 0 {
            cells.len() == width && separator != Separator::Spaces && no_number(cells[0])
        } else {
            remark.first().is_some_and(u8::is_ascii_alphabetic) && is_error()
        };
        cells.len() > 1 && is_first && cells[1..].iter().all(is_cell)
    }

    /// Takes the line for one of the header. What separates its names may be another character than in the rows.
    pub(super) fn head(&mut self, content: &[u8], fields: &[&[u8]]) {
        self.heads.push(content.trim_ascii().to_vec());
        self.names = below(&self.names, fields);
    }

    /// Takes the line for a row: so are all that follow.
    pub(super) fn begin(&mut self, separator: Separator) {
        (self.separator, self.has_rows) = (Some(separator), true);
    }

    /// From now on lines are rows with this separator, from line `number` on.
    pub(super) fn begin_at(&mut self, number: usize, separator: Separator) {
        self.begin(separator);
        self.number = number - 1;
    }

    /// Names behind # above the first row, as `numpy.savetxt` writes them: of each such line with `count` fields its number,
    /// its names, and whether it is a header for certain. Words of a remark may be as many.
    pub(super) fn remarked(&mut self, count: usize, separator: Separator) -> Vec<(usize, Vec<String>, bool)> {
        let names = |(line, remark): (usize, Vec<u8>)| {
            let of_line = Separator::of(&remark);
            let is_certain = of_line == separator && line + 1 == self.number && separator != Separator::Spaces;
            let fields = if count == 1 { vec![bare(&remark)] } else { of_line.at_most(count, &remark) };
            (fields.len() == count).then(|| (line, below(&[], &fields), is_certain))
        };
        std::mem::take(&mut self.remarks).into_iter().filter_map(names).collect()
    }
}

/// The numbers of a file, with decimal points or commas.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    path: PathBuf,
    marks: Marks,
}

impl Numbers {
    pub(crate) fn new(path: &Path) -> Self {
        Self { path: path.to_path_buf(), marks: Marks::default() }
    }

    /// The number of a field at this line and column, from 1; nothing if it is none.
    ///
    /// # Errors
    ///
    /// A number only with separators of thousands.
    pub(crate) fn of(&mut self, field: &[u8], by: Separator, at: [usize; 2]) -> Result<Option<f64>, FrameError> {
        self.marks.take(field, by, at).map_err(|unclear| FrameError::thousands(&self.path, &unclear))?;
        Ok(separator::number(field))
    }

    /// Refuses commas or points that may be either.
    ///
    /// # Errors
    ///
    /// The first of them.
    pub(crate) fn end(&self) -> Result<(), FrameError> {
        self.marks.open().map_or(Ok(()), |unclear| Err(FrameError::thousands(&self.path, unclear)))
    }
}

/// Whether fields are those of a header: words, of which some stand for more than a value that is not there.
pub(super) fn are_words(fields: &[&[u8]]) -> bool {
    let is_known = |field: &&[u8]| !is_unknown(&String::from_utf8_lossy(field));
    let is_word = |field: &&[u8]| no_number(field) && timestamp(&String::from_utf8_lossy(field)).is_none();
    fields.iter().all(is_word) && fields.iter().any(is_known)
}

/// Names with the fields of a line below them: names, or of each a number or a unit.
fn below(above: &[String], fields: &[&[u8]]) -> Vec<String> {
    let mut names: Vec<String> = fields.iter().map(|field| decoded(field)).collect();
    for (name, above) in names.iter_mut().zip(above) {
        *name = match separator::number(name.as_bytes()) {
            Some(_) => format!("{above} {name}"),
            None => format!("{above} ({})", name.trim_matches(['(', ')', '[', ']', '{', '}'])),
        };
    }
    names
}

/// The text of a field: UTF-8, or else Latin-1.
fn decoded(field: &[u8]) -> String {
    let latin = |_| field.iter().copied().map(char::from).collect();
    let text: String = std::str::from_utf8(field).map_or_else(latin, str::to_owned);
    text.replace(char::is_control, " ")
}

/// A table of any columns.
pub(crate) struct Table<'a> {
    /// Nothing without a header.
    pub(crate) names: Vec<String>,
    /// The line of each row and its cells: none where a line of a single column is blank.
    pub(crate) rows: Vec<(usize, Vec<&'a [u8]>)>,
    /// What separates them.
    pub(crate) separator: Separator,
}

impl<'a> Table<'a> {
    /// Reads a text. `is_name` tells whether a line of several words is the name of a single column.
    ///
    /// # Errors
    ///
    /// As [`Cells::line`].
    pub(crate) fn of(path: &Path, text: &'a [u8], is_name: impl Fn(&str) -> bool) -> Result<Self, FrameError> {
        let mut cells = Cells::new(path, 0);
        let mut rows: Vec<(usize, Vec<&[u8]>)> = Vec::new();
        for line in separator::lines(text) {
            match cells.line(line)? {
                // A file of one column may leave a line blank: the value is unknown.
                Line::Blank if !rows.is_empty() => rows.push((cells.number, Vec::new())),
                Line::Cells(content, separator) => {
                    let fields = separator.split(content);
                    if rows.is_empty() && cells.heads.len() < 2 && are_words(&fields) {
                        let is_whole = separator == Separator::Spaces && is_name(&decoded(bare(content)));
                        cells.head(content, &if is_whole { vec![bare(content)] } else { fields });
                        continue;
                    }
                    cells.begin(separator);
                    cells.width.get_or_insert(fields.len());
                    rows.push((cells.number, fields));
                }
                _ => {}
            }
        }
        rows.truncate(rows.iter().rposition(|(_, row)| !row.is_empty()).map_or(0, |last| last + 1));
        let columns = rows.first().map_or(0, |(_, row)| row.len());
        if columns > 1 {
            rows.retain(|(_, row)| !row.is_empty());
        }
        let separator = cells.separator.unwrap_or(Separator::Spaces);
        let names = match &cells.heads[..] {
            [] => cells.remarked(columns, separator).pop().map_or(Vec::new(), |(_, names, _)| names),
            // Of one column the whole line is the name, whatever is in it.
            heads if columns == 1 => heads.iter().fold(Vec::new(), |names, head| below(&names, &[bare(head)])),
            _ => cells.names,
        };
        Ok(Self { names, rows, separator })
    }
}
