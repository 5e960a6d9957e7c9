//! The rows of a table that a design names, separated as those of frames.

use std::fmt::Display;
use std::path::PathBuf;

use super::DesignError;
use super::files::FileSource;
use crate::separator::{self, Marks, Separator, Unclear};

/// A line that is neither blank nor a remark.
pub(super) struct Row {
    /// Its number, from 1.
    pub(super) line: usize,
    /// The line, for messages.
    content: String,
    fields: Vec<String>,
    /// The fields' numbers; none where there is none.
    numbers: Vec<Option<f64>>,
}

impl Row {
    /// Its names, in small letters without units, if none of its fields is a number: a header.
    pub(super) fn header(&self) -> Option<Vec<String>> {
        let name = |field: &String| {
            let unit = field.find(['(', '[']).unwrap_or(field.len());
            field[..unit].trim().to_lowercase()
        };
        self.numbers.iter().all(Option::is_none).then(|| self.fields.iter().map(name).collect())
    }

    /// So many numbers, NaN and infinities among them, if it has no more and no fewer.
    pub(super) fn numbers(&self, count: usize) -> Option<Vec<f64>> {
        self.numbers.iter().copied().collect::<Option<Vec<f64>>>().filter(|numbers| numbers.len() == count)
    }

    /// The beginning of the line, for messages.
    pub(super) fn shown(&self) -> String {
        self.content.chars().take(40).collect()
    }
}

/// A file that is read.
pub(super) struct Rows {
    pub(super) path: PathBuf,
    pub(super) rows: Vec<Row>,
}

impl Rows {
    /// Reads a file of those `beside` the design. A byte order mark is skipped.
    pub(super) fn read(file: &str, beside: FileSource<'_>) -> Result<Self, DesignError> {
        let path = beside.path(file);
        let text = beside.read(file).map_err(|source| DesignError::read(&path, &source))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let lines = (1..).zip(text.lines().map(str::trim));
        let lines = lines.filter(|(_, content)| !content.is_empty() && !content.starts_with('#'));
        let mut separator = None;
        let row = |(line, content): (usize, &str)| {
            let separator = *separator.get_or_insert_with(|| Separator::of(content.as_bytes()));
            let fields = separator.fields(content.as_bytes());
            Row {
                line,
                content: content.to_owned(),
                numbers: fields.iter().map(|field| separator::number(field)).collect(),
                fields: fields.iter().map(|field| String::from_utf8_lossy(field).into_owned()).collect(),
            }
        };
        let rows = Self { rows: lines.map(row).collect(), path };
        rows.refuse_thousands()?;
        Ok(rows)
    }

    /// Refuses commas of which each has three digits behind it: decimal points, or separators of thousands?
    fn refuse_thousands(&self) -> Result<(), DesignError> {
        let mut marks = Marks::default();
        let fields = self.rows.iter().flat_map(|row| row.fields.iter().map(|field| (row.line, field)));
        // Points are decimal ones, whatever separates.
        let taken = fields.map(|(line, field)| marks.take(field.as_bytes(), Separator::Spaces, [line, 0]));
        match taken.collect::<Result<(), _>>().err().or_else(|| marks.open().cloned()) {
            Some(Unclear { place: [line, _], text, .. }) => Err(self.wrong(
                line,
                format!("\"{text}\" has a decimal comma or a separator of thousands"),
                "write decimal points, or remove the separators",
            )),
            None => Ok(()),
        }
    }

    /// The last row's line, or the first line of an empty file.
    pub(super) fn end(&self) -> usize {
        self.rows.last().map_or(1, |row| row.line)
    }

    /// What is wrong on a line.
    pub(super) fn wrong(&self, line: usize, problem: impl Display, remedy: impl Display) -> DesignError {
        DesignError::line(&self.path, line, problem, remedy)
    }
}
