//! Frames as text: one a line, with or without a header, whatever separates the values.

use std::path::Path;

use super::cells::{Cells, Line, Numbers, are_words};
use super::header::{self, Header, Label};
use super::layout::{Layout, Target};
use super::{FrameError, hints, is_number};
use crate::geometry;
use crate::numbers::{counted, magnitude};
use crate::separator::{self, Separator, is_unknown, no_number};
use crate::units::{pascals, timestamp};

/// Lines of means, deviations and the like at most.
const SUMMARIES: usize = 8;

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

/// Reads lines one after the other; of each the columns of the values.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    layout: Layout,
    target: Target,
    pub(super) cells: Cells,
    numbers: Numbers,
    header: Header,
    /// The unit that a line above the rows names, and that line.
    unit: Option<(usize, String)>,
    /// Columns of the sensor and of labels before them, where a frame is a block of lines.
    block: Option<[usize; 2]>,
    /// Cells of a line that has blank ones behind its last value.
    padded: Option<usize>,
    /// The first line that was left out as too long, and its cells.
    too_long: Option<(usize, usize)>,
    /// Lines that were left out, and what was wrong with the first.
    bad: Option<(Vec<usize>, String)>,
    remarks: Vec<String>,
}

impl Lines {
    pub(super) fn new(path: &Path, layout: &Layout, target: &Target) -> Self {
        Self {
            layout: layout.clone(),
            target: target.clone(),
            cells: Cells::new(path, layout.skip_lines),
            numbers: Numbers::new(path),
            header: Header::default(),
            unit: None,
            block: None,
            padded: None,
            too_long: None,
            bad: None,
            remarks: Vec::new(),
        }
    }

    /// What is to be said of the lines so far.
    pub(super) fn remarks(&self) -> Vec<String> {
        let path = self.cells.path.display();
        let bad = self
            .bad
            .as_ref()
            .map(|(bad, first)| format!("{path}: {} left out; the first: {first}", counted(bad.len(), "frame")));
        let last = self.labels() + self.target.sensor.taxels();
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

    /// What the first label of a row is, and the time of its labels.
    pub(super) fn label(&self, line: &[u8]) -> (Label, Option<f64>) {
        let separator = self.cells.separator.unwrap_or(Separator::Spaces);
        let fields = separator.split(separator.trim(line));
        let time = self.time(fields.get(..self.labels()).unwrap_or_default());
        let label = match fields.first() {
            Some(label) if self.labels() > 0 && time.is_none() && separator::number(label).is_none() => {
                if is_unknown(&String::from_utf8_lossy(label)) { Label::Blank } else { Label::Word }
            }
            _ => Label::Number,
        };
        (label, time)
    }

    /// The frame of the next line. Nothing for a blank one, for one that begins with #, for lines of names and units.
    pub(super) fn row(&mut self, line: &[u8]) -> Result<Option<Vec<f64>>, FrameError> {
        let (content, separator) = match self.cells.line(line)? {
            Line::Cells(content, separator) => (content, separator),
            Line::Remark(remark) => {
                geometry::compare_remark(remark, &self.cells.path, self.cells.number, &self.target.sensor)?;
                self.is_unit(remark);
                return Ok(None);
            }
            Line::Again if !self.remarks.iter().any(|said| said.contains("the header again")) => {
                self.remark(
                    "the header again, as between recordings that were put behind each other; what follows are frames of \
                     the same",
                );
                return Ok(None);
            }
            Line::Again | Line::Blank => return Ok(None),
        };
        let fields = separator.fields(content);
        let values = fields.get(self.labels()..).unwrap_or_default();
        let is_words = || are_words(if values.is_empty() { &fields } else { values });
        let is_numbered = |alone| header::is_numbered(values, &self.target.sensor, alone);
        let (is_words, is_numbered) = match (self.cells.has_rows, self.cells.heads.is_empty()) {
            (true, _) => (false, false),
            (false, true) => (is_words(), is_numbered(!fields.iter().any(|field| no_number(field)))),
            (false, false) => (is_words() && self.is_units(values), is_numbered(false) && self.header.is_alike()),
        };
        let number = self.cells.number;
        if is_words && fields.len() < self.target.sensor.taxels() && self.is_unit(content) {
            return Ok(None);
        }
        if is_words || is_numbered {
            if is_numbered {
                self.numbered(values.iter().filter_map(|field| separator::number(field)).fold(0.0, f64::max));
            }
            self.cells.head(content, &fields);
            let line = if self.cells.heads.len() > 1 { self.header.line } else { number };
            self.header = self.named(line, self.cells.names.clone())?;
            return Ok(None);
        }
        if !self.cells.has_rows && self.cells.heads.is_empty() {
            for (line, names, is_certain) in self.cells.remarked(fields.len(), separator) {
                match self.named(line, names) {
                    Ok(header) => {
                        self.header = header;
                        break;
                    }
                    Err(problem) if is_certain => return Err(problem),
                    Err(_) => {}
                }
            }
        }
        if let Some((line, unit)) = self.unit.take().filter(|_| self.header.unit.is_none()) {
            let path = &self.cells.path;
            let (worth, remark) =
                header::worth(&unit, &self.target, 1.0).map_err(|problem| FrameError::line(path, line, problem))?;
            self.header.unit = worth;
            self.remarks.extend(remark.map(|remark| format!("{}, line {line}: {remark}", path.display())));
        }
        self.cells.begin(separator);
        match self.values(separator, content) {
            Ok(row) => {
                self.cells.width.get_or_insert(separator.split(content).len());
                Ok(Some(row))
            }
            Err(error) => self.leave_out(number, error),
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

    /// Whether a line above the rows names a known unit of pressure: that of all values without one of their own.
    fn is_unit(&mut self, line: &[u8]) -> bool {
        let unit = header::unit_in(line).filter(|unit| !self.cells.has_rows && pascals(unit).is_some());
        let is_unit = unit.is_some();
        self.unit = unit.map(|unit| (self.cells.number, unit)).or(self.unit.take());
        is_unit
    }

    /// The header of these names.
    fn named(&self, line: usize, names: Vec<String>) -> Result<Header, FrameError> {
        Header::of(line, names, &self.target, &self.layout)
            .map_err(|problem| FrameError::line(&self.cells.path, line, problem))
    }

    /// Adds what is to be said of the line.
    fn remark(&mut self, remark: &str) {
        self.remarks.push(format!("{}, line {}: {remark}", self.cells.path.display(), self.cells.number));
    }

    /// Whether a first row is a header of the sensor's numbers, as far as it can tell: they are whole and ascend. It says so.
    pub(super) fn is_numbered(&mut self, first: &[f64]) -> bool {
        let is_header = self.cells.heads.is_empty() && header::ascends(first);
        if is_header {
            self.numbered(first[first.len() - 1]);
        }
        is_header
    }

    /// Says that a line was taken for the numbers of the columns.
    fn numbered(&mut self, last: f64) {
        self.remark(&format!(
            "numbers up to {last} are those of the columns, as pandas writes them; the line is read as a header"
        ));
    }

    /// The values of a line behind the labels.
    fn values(&mut self, separator: Separator, content: &[u8]) -> Result<Vec<f64>, FrameError> {
        let (first, taxels) = (self.labels(), self.target.sensor.taxels());
        // Blank cells behind the last column are nothing; a blank one in it is a value that is not there.
        let cells = separator.split(content);
        let columns = if self.columns().is_some() { cells.len() } else { first + taxels };
        let fields = separator.at_most(columns, content);
        if fields.len() == columns && cells.len() > columns {
            self.padded = Some(cells.len());
        }
        let end = self.columns().map_or(fields.len(), |[_, last]| last);
        self.refuse_shifted(cells.len(), separator.fields(content).len(), end)?;
        if fields.len() < end {
            return Err(self.wrong_length(fields.len(), end));
        }
        let is_wrong = end.saturating_sub(first) != taxels;
        // A blank cell may be that of a label.
        if is_wrong && fields.iter().any(|field| field.is_empty()) {
            return Err(self.wrong_length(fields.len(), first + taxels));
        }
        let unit = self.header.unit.unwrap_or(1.0);
        let order = self.header.order.as_ref();
        let taxel = |index: usize| order.and_then(|order| order.get(index).copied()).unwrap_or(index);
        let mut row = Vec::with_capacity(end);
        for (index, field) in fields.iter().enumerate().take(end).skip(first) {
            let place = match self.block {
                Some([columns, labels]) => [self.cells.number + index / columns, labels + index % columns + 1],
                None => [self.cells.number, index + 1],
            };
            let number = self.numbers.of(field, separator, place)?.map(|value| value * unit);
            match number.filter(|&value| is_number(value)) {
                Some(number) => row.push(number),
                None if self.target.dead.contains(&taxel(index - first)) => row.push(0.0),
                None => {
                    let text: String = String::from_utf8_lossy(field).chars().take(40).collect();
                    let remedy = hints::value(&self.target, &self.layout, &text);
                    return Err(FrameError::value(&self.cells.path, place, field, remedy));
                }
            }
        }
        if is_wrong {
            return Err(self.wrong_length(fields.len(), first + taxels));
        }
        let Some(order) = order else { return Ok(row) };
        let mut ordered = row.clone();
        order.iter().zip(row).for_each(|(&taxel, value)| ordered[taxel] = value);
        Ok(ordered)
    }

    /// Refuses a line of so many cells, `filled` without blank ones at its end, whose values may stand in other columns: more
    /// than names, or others than the first row where no header names the columns up to `end`.
    fn refuse_shifted(&self, cells: usize, filled: usize, end: usize) -> Result<(), FrameError> {
        let names = self.cells.names.len();
        let (is_wrong, expected, than) = match self.cells.width {
            _ if self.columns().is_none() => return Ok(()),
            _ if names >= end => (filled > names, names, "the header has names"),
            Some(width) => (filled > width || cells < width, width, "the first row has"),
            None => return Ok(()),
        };
        if !is_wrong {
            return Ok(());
        }
        let problem = format!(
            "{} where {than}: {expected}; are these decimal commas or separators of thousands? Separate the cells by \
             semicolons, and give each column a name and each row all its cells",
            counted(if filled > expected { filled } else { cells }, "cell")
        );
        Err(FrameError::line(&self.cells.path, self.cells.number, problem))
    }

    /// A line of another length than `expected`, the labels among it.
    fn wrong_length(&self, found: usize, expected: usize) -> FrameError {
        let hint = hints::length(&self.target, self.labels(), found, expected);
        FrameError::Length { path: self.cells.path.clone(), line: self.cells.number, found, expected, hint }
    }

    /// Whether the fields of a second line of words are units: the same for all taxels, or pressures.
    fn is_units(&self, values: &[&[u8]]) -> bool {
        let values = &values[..values.len().min(self.target.sensor.taxels())];
        let is_pressure = |field: &[u8]| pascals(&String::from_utf8_lossy(field)).is_some();
        values.len() > 1 && values.iter().all(|field| *field == values[0] || is_pressure(field))
    }

    /// From now on a line is a frame whose rows have `block` columns and labels and begin at line `number`, in a unit worth so
    /// much.
    pub(super) fn begin_block(&mut self, number: usize, block: [usize; 2], unit: Option<f64>, separator: u8) {
        self.cells.begin_at(number, Separator::Byte(separator));
        (self.block, self.header.unit) = (Some(block), unit);
        (self.layout.labels, self.layout.columns) = (0, None);
    }

    /// Refuses commas or points that may be decimal ones or separators of thousands.
    pub(super) fn unclear(&self) -> Result<(), FrameError> {
        self.numbers.end()
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
            self.cells.number = line;
            return Err(self.wrong_length(found, self.labels() + self.target.sensor.taxels()));
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

/// Reads all rows of a text that has one for each frame, see [`Lines::row`].
pub(super) fn read(mut lines: Lines, bytes: &[u8]) -> Result<Text, FrameError> {
    let mut text = Text::default();
    let mut labels: Vec<Label> = Vec::new();
    for line in separator::lines(bytes) {
        let Some(row) = lines.row(line)? else { continue };
        let (label, time) = lines.label(line);
        labels.push(label);
        text.times.push(time.unwrap_or(f64::NAN));
        text.rows.push(row);
        text.lines.push(lines.cells.number);
    }
    if lines.cells.heads.is_empty()
        && let Some(is_head) = header::guessed(&text.rows, &labels)
    {
        lines.cells.number = text.lines[0];
        match is_head.iter().take_while(|&&is_head| is_head).count() {
            1 => lines.numbered(magnitude(&text.rows[0])),
            heads => lines.remark(&format!("a word where other lines have a number: {heads} lines read as a header")),
        }
        let mut kept = is_head.iter().map(|is_head| !is_head).cycle();
        text.rows.retain(|_| kept.next() == Some(true));
        text.lines.retain(|_| kept.next() == Some(true));
        text.times.retain(|_| kept.next() == Some(true));
        labels.retain(|_| kept.next() == Some(true));
    }
    drop_summaries(&mut lines, &mut text, &labels);
    lines.end(&mut text)?;
    Ok(text)
}

/// Takes off lines at the end with a word as their label where all others have a number: mean, deviation and the like.
fn drop_summaries(lines: &mut Lines, text: &mut Text, labels: &[Label]) {
    let frames = labels.iter().take_while(|label| **label == Label::Number).count();
    let summaries = labels.len() - frames;
    if frames < 2
        || !(1..=SUMMARIES.min(frames)).contains(&summaries)
        || labels[frames..].iter().any(|label| *label != Label::Word)
    {
        return;
    }
    lines.cells.number = text.lines[frames];
    lines.remark(&format!(
        "a word where other lines have a number: {} at the end left out, such as a mean; give frames a number",
        counted(summaries, "line")
    ));
    text.rows.truncate(frames);
    text.lines.truncate(frames);
    text.times.truncate(frames);
}
