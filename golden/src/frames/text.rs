//! Tables of numbers as text: one row a line, with or without a header, whatever separates the values.

use std::path::{Path, PathBuf};

use super::header::{self, Header};
use super::layout::{Layout, Target};
use super::{FrameError, blocks, hints, is_number};
use crate::geometry;
use crate::numbers::magnitude;
use crate::separator::{self, Marks, Separator, foreign, is_unknown, no_number};
use crate::units::{pascals, timestamp};

/// What some programs write before the first line.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Rows of a file with their lines, and what is to be said of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Text {
    pub(super) rows: Vec<Vec<f64>>,
    /// The line of each row, from 1.
    pub(super) lines: Vec<usize>,
    /// Columns before the values.
    pub(super) labels: usize,
    /// What stands above the rows.
    pub(super) header: Header,
    /// The time of each row in seconds, NaN where no column before the values has it.
    pub(super) times: Vec<f64>,
    /// Rows that were left out, by their place among all, from 0.
    pub(super) skipped: Vec<usize>,
    pub(super) remarks: Vec<String>,
}

/// What has been read of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Begin,
    /// A line of names.
    Header,
    Rows,
}

/// Reads lines one after the other; of each the columns of the values.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    /// Where they come from, for messages.
    path: PathBuf,
    layout: Layout,
    /// What they are read for; nothing for tables that are no frames.
    target: Option<Target>,
    /// That of the first line which has one; spaces between the words of a header are none.
    separator: Option<Separator>,
    state: State,
    /// The lines above the first row, and what they say.
    heads: Vec<Vec<u8>>,
    header: Header,
    /// Lines with # before the first other one: one of so many fields as a row has is a header.
    comments: Vec<(usize, Vec<u8>)>,
    /// Columns of the sensor, where a frame is a block of lines.
    block: Option<usize>,
    /// How many lines there were.
    number: usize,
    marks: Marks,
    /// Cells of a line that has blank ones behind its last value.
    padded: Option<usize>,
    /// The first line that was left out as too long, and its cells.
    too_long: Option<(usize, usize)>,
    /// Lines that were left out, and what was wrong with the first.
    bad: Option<(Vec<usize>, String)>,
    remarks: Vec<String>,
}

impl Lines {
    pub(super) fn new(path: &Path, layout: &Layout, target: Option<&Target>) -> Self {
        Self { path: path.to_path_buf(), layout: layout.clone(), target: target.cloned(), ..Self::default() }
    }

    /// Where the lines come from.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The number of the last line, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// What is to be said of the lines so far.
    pub(super) fn remarks(&self) -> Vec<String> {
        let path = self.path.display();
        let bad = self
            .bad
            .as_ref()
            .map(|(bad, first)| format!("{path}: {} frames are left out; the first: {first}", bad.len()));
        let last = self.labels() + self.target.as_ref().map_or(0, |target| target.sensor.taxels());
        let padded = self.padded.map(|_| format!("{path}: cells behind column {last} are blank, and are none"));
        let named = self.header.remarks.iter().map(|remark| format!("{path}, line {}: {remark}", self.header.line));
        self.remarks.iter().cloned().chain(named).chain(padded).chain(bad).collect()
    }

    /// Columns before the values.
    pub(super) fn labels(&self) -> usize {
        self.columns().map_or(self.layout.labels, |[first, _]| first.saturating_sub(1))
    }

    /// First and last column of the values, from 1, where the header or the options say so.
    fn columns(&self) -> Option<[usize; 2]> {
        self.header.columns.or(self.layout.columns)
    }

    /// The column of a taxel, from 1.
    pub(super) fn column(&self, taxel: usize) -> usize {
        self.header.column(self.labels(), taxel)
    }

    /// The time of a line in seconds by its labels: of the column that the header names, or a time stamp.
    fn time(&self, labels: &[&[u8]]) -> Option<f64> {
        let of_header =
            self.header.time.and_then(|(column, unit)| Some(unit * separator::number(labels.get(column)?)?));
        let text = |columns: &[&[u8]]| timestamp(&String::from_utf8_lossy(&columns.join(&b' ')));
        // Spaces part a stamp into date and time.
        of_header.or_else(|| labels.chunks(1).chain(labels.windows(2)).find_map(text))
    }

    /// The numbers of the next line. Nothing for a blank one, for one that begins with #, for lines of names and units.
    /// `wrong_length` is given the number of values and returns the number wanted, if that is another.
    pub(super) fn row(
        &mut self,
        line: &[u8],
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Option<Vec<f64>>, FrameError> {
        self.number += 1;
        let line = if self.number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line) } else { line };
        let content = line.trim_ascii();
        if content.starts_with(b"#")
            && let Some(target) = &self.target
        {
            geometry::compare_remark(content, &self.path, self.number, &target.sensor)?;
        }
        if self.number <= self.layout.skip_lines || content.is_empty() {
            return Ok(None);
        }
        if let Some(comment) = content.strip_prefix(b"#") {
            if self.state == State::Begin {
                self.comments.push((self.number, comment.trim_ascii().to_vec()));
            }
            return Ok(None);
        }
        // As spreadsheets have it.
        if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] = content {
            self.separator = Some(Separator::Byte(*separator));
            return Ok(None);
        }
        if self.heads.iter().any(|head| head == content) {
            if !self.remarks.iter().any(|said| said.contains("the header again")) {
                self.remark(
                    "the header again, as between recordings that were put behind each other; what follows are frames of \
                     the same",
                );
            }
            return Ok(None);
        }
        let separator = self.separator.unwrap_or_else(|| Separator::of(content));
        let content = separator.trim(line);
        let fields = separator.fields(content);
        if let Some(separator) = foreign(content) {
            return Err(FrameError::Separator { path: self.path.clone(), line: self.number, separator });
        }
        let values = fields.get(self.labels()..).unwrap_or_default();
        // Readings that are not there are no words.
        let is_word = |field: &&[u8]| no_number(field);
        let is_known = |field: &&[u8]| !is_unknown(&String::from_utf8_lossy(field));
        let words = if values.is_empty() { &fields } else { values };
        let is_words = || words.iter().all(is_word) && (self.target.is_none() || words.iter().any(is_known));
        let is_numbered =
            |alone| self.target.as_ref().is_some_and(|target| header::is_numbered(values, &target.sensor, alone));
        let (is_words, is_numbered) = match self.state {
            State::Begin => (is_words(), is_numbered(!fields.iter().any(is_word))),
            State::Header => (is_words() && self.is_units(values), is_numbered(false) && self.header.is_alike()),
            State::Rows => (false, false),
        };
        let is_header = is_words || is_numbered;
        self.separator = Some(separator).filter(|separator| !is_header || matches!(separator, Separator::Byte(_)));
        if is_header {
            if is_numbered {
                self.numbered(values.iter().filter_map(|field| separator::number(field)).fold(0.0, f64::max));
            }
            self.heads.push(content.trim_ascii().to_vec());
            self.names(self.number, &fields)?;
            self.state = State::Header;
            return Ok(None);
        }
        if self.state == State::Begin {
            // As numpy.savetxt writes its header.
            for (line, comment) in std::mem::take(&mut self.comments) {
                let of_comment = Separator::of(&comment);
                let names = of_comment.fields(&comment);
                // Words of a remark may be as many.
                let is_certain =
                    of_comment == separator && line + 1 == self.number && !matches!(separator, Separator::Spaces);
                match (names.len() == fields.len()).then(|| self.names(line, &names)) {
                    Some(Ok(())) => break,
                    Some(Err(problem)) if is_certain => return Err(problem),
                    _ => {}
                }
            }
        }
        self.state = State::Rows;
        match self.values(separator, content, wrong_length) {
            Ok(row) => Ok(Some(row)),
            Err(error) => self.leave_out(self.number, error),
        }
    }

    /// Counts the frame of a line among those that are left out.
    ///
    /// # Errors
    ///
    /// What is wrong with it, if none is to be left out.
    pub(super) fn leave_out(&mut self, line: usize, error: FrameError) -> Result<Option<Vec<f64>>, FrameError> {
        if !self.layout.skip_bad {
            return Err(error);
        }
        if let FrameError::Length { found, expected, .. } = error
            && found > expected
        {
            self.too_long.get_or_insert((line, found));
        }
        self.bad.get_or_insert_with(|| (Vec::new(), error.to_string())).0.push(line);
        Ok(None)
    }

    /// Takes the fields of a line for names of the columns.
    fn names(&mut self, line: usize, fields: &[&[u8]]) -> Result<(), FrameError> {
        if let Some(target) = &self.target {
            let wrong = |problem| FrameError::Shape { path: self.path.clone(), line, problem };
            self.header = self.header.with(line, fields, target, &self.layout).map_err(wrong)?;
        }
        Ok(())
    }

    /// Adds what is to be said of the line.
    fn remark(&mut self, remark: &str) {
        self.remarks.push(format!("{}, line {}: {remark}", self.path.display(), self.number));
    }

    /// Whether a first row is a header of the sensor's numbers, as far as it can tell: they are whole and ascend. It says so.
    pub(super) fn is_numbered(&mut self, first: &[f64]) -> bool {
        let is_header = self.heads.is_empty() && header::ascends(first);
        if is_header {
            self.numbered(first[first.len() - 1]);
        }
        is_header
    }

    /// Says that a line was taken for the numbers of the columns.
    fn numbered(&mut self, last: f64) {
        self.remark(&format!(
            "numbers up to {last} are those of the columns, as pandas writes them; the line is taken for a header"
        ));
    }

    /// The values of a line behind the labels.
    fn values(
        &mut self,
        separator: Separator,
        content: &[u8],
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Vec<f64>, FrameError> {
        let first = self.labels();
        // Blank cells behind the last column are nothing; a blank one in it is a value that is not there.
        let cells = separator.split(content);
        let columns = match (&self.target, self.columns()) {
            (_, Some(_)) => cells.len(),
            (Some(target), None) => first + target.sensor.taxels(),
            (None, None) => 1,
        };
        let fields = separator.at_most(columns, content);
        if self.target.is_some() && fields.len() == columns && cells.len() > columns {
            self.padded = Some(cells.len());
        }
        let end = self.columns().map_or(fields.len(), |[_, last]| last);
        if fields.len() < end {
            return Err(self.wrong_length(fields.len(), end));
        }
        // A blank cell may be that of a label.
        if let Some(wanted) = wrong_length(end.saturating_sub(first))
            && fields.iter().any(|field| field.is_empty())
        {
            return Err(self.wrong_length(fields.len(), first + wanted));
        }
        let unit = self.header.unit.unwrap_or(1.0);
        let order = self.header.order.as_ref();
        let taxel = |index: usize| order.and_then(|order| order.get(index).copied()).unwrap_or(index);
        let mut row = Vec::with_capacity(end);
        for (index, field) in fields.iter().enumerate().take(end).skip(first) {
            let place = match self.block {
                Some(columns) => [self.number + index / columns, index % columns + 1],
                None => [self.number, index + 1],
            };
            self.marks.take(field, separator, place).map_err(|unclear| FrameError::thousands(&self.path, &unclear))?;
            let number = separator::number(field).map(|value| value * unit).filter(|&value| is_number(value));
            let target = self.target.as_ref();
            let is_dead = || target.is_some_and(|target| target.dead.contains(&taxel(index - first)));
            match number {
                Some(number) => row.push(number),
                None if is_dead() => row.push(0.0),
                None => {
                    let text: String = String::from_utf8_lossy(field).chars().take(40).collect();
                    let remedy = hints::value(target, &self.layout, &text);
                    let [line, column] = place;
                    return Err(FrameError::Value { path: self.path.clone(), line, column, remedy, text });
                }
            }
        }
        if let Some(wanted) = wrong_length(row.len()) {
            return Err(self.wrong_length(fields.len(), first + wanted));
        }
        let Some(order) = order else { return Ok(row) };
        let mut ordered = row.clone();
        order.iter().zip(row).for_each(|(&taxel, value)| ordered[taxel] = value);
        Ok(ordered)
    }

    /// A line of another length than `expected`, the labels among it.
    fn wrong_length(&self, found: usize, expected: usize) -> FrameError {
        let hint = hints::length(self.target.as_ref(), self.labels(), found, expected);
        FrameError::Length { path: self.path.clone(), line: self.number, found, expected, hint }
    }

    /// Whether the fields of a second line of words are units: the same for all taxels, or pressures.
    fn is_units(&self, values: &[&[u8]]) -> bool {
        let Some(target) = &self.target else { return false };
        let values = &values[..values.len().min(target.sensor.taxels())];
        let is_pressure = |field: &[u8]| pascals(&String::from_utf8_lossy(field)).is_some();
        values.len() > 1 && values.iter().all(|field| *field == values[0] || is_pressure(field))
    }

    /// From now on a line is a frame whose rows have so many columns and begin at line `number`, in a unit worth so much.
    pub(super) fn begin_block(&mut self, number: usize, columns: usize, unit: Option<f64>, separator: u8) {
        self.separator = Some(Separator::Byte(separator));
        (self.state, self.block, self.number) = (State::Rows, Some(columns), number - 1);
        (self.layout.labels, self.header.unit) = (0, unit);
    }

    /// What is still to be refused at the end: commas or points that may be either.
    pub(super) fn unclear(&self) -> Result<(), FrameError> {
        self.marks.open().map_or(Ok(()), |unclear| Err(FrameError::thousands(&self.path, unclear)))
    }

    /// Ends the reading of these rows.
    ///
    /// # Errors
    ///
    /// As [`Lines::unclear`]. A column behind the values that is blank on some lines, and whose other lines were left out.
    pub(super) fn end(mut self, text: &mut Text) -> Result<(), FrameError> {
        self.unclear()?;
        if let Some((line, found)) = self.too_long
            && self.padded == Some(found)
        {
            self.number = line;
            let taxels = self.target.as_ref().map_or(0, |target| target.sensor.taxels());
            return Err(self.wrong_length(found, self.labels() + taxels));
        }
        text.labels = self.labels();
        text.remarks = self.remarks();
        let bad = self.bad.map_or(Vec::new(), |(bad, _)| bad);
        let place = |(before, line): (usize, &usize)| before + text.lines.partition_point(|kept| kept < line);
        text.skipped = bad.iter().enumerate().map(place).collect();
        text.header = self.header;
        Ok(())
    }
}

/// Reads all rows of a text, see [`Lines::row`], or blocks of rows where the shape of the file says so.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    layout: &Layout,
    target: Option<&Target>,
    wrong_length: impl Fn(usize) -> Option<usize>,
) -> Result<Text, FrameError> {
    let mut lines = Lines::new(path, layout, target);
    if let Some(target) = target.filter(|_| layout.columns.is_none())
        && let Some(blocks) = blocks::join(path, bytes, layout, target)?
    {
        return blocks.read(lines, target, wrong_length);
    }
    let mut text = Text::default();
    let mut labels: Vec<bool> = Vec::new();
    for line in separator::lines(bytes) {
        let Some(row) = lines.row(line, &wrong_length)? else { continue };
        let fields = lines.separator.map(|separator| separator.split(separator.trim(line))).unwrap_or_default();
        let time = lines.time(fields.get(..lines.labels()).unwrap_or_default());
        let is_number = fields.first().is_some_and(|label| separator::number(label).is_some());
        labels.push(lines.labels() == 0 || is_number || time.is_some());
        text.times.push(time.unwrap_or(f64::NAN));
        text.rows.push(row);
        text.lines.push(lines.number);
    }
    if target.is_some()
        && lines.heads.is_empty()
        && let Some(is_head) = header::guessed(&text.rows, &labels)
    {
        lines.number = text.lines[0];
        lines.numbered(magnitude(&text.rows[0]));
        let kept = || is_head.iter().map(|is_head| !is_head);
        let [mut of_rows, mut of_lines, mut of_times] = [kept(), kept(), kept()];
        text.rows.retain(|_| of_rows.next() == Some(true));
        text.lines.retain(|_| of_lines.next() == Some(true));
        text.times.retain(|_| of_times.next() == Some(true));
    }
    lines.end(&mut text)?;
    Ok(text)
}
