//! Tables of numbers as text: one row a line, with or without a header, whatever separates the values.

use std::path::{Path, PathBuf};

use super::blocks::{self, Blocks};
use super::layout::{Layout, Target};
use super::{FrameError, is_number};
use crate::geometry;
use crate::separator::{self, Comma, Separator, is_unknown};

/// What some programs write before the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// So few numbers in turn may be a frame: no sensor has fewer taxels.
const FEWEST_NUMBERED: usize = 4;

/// Rows of a file with their lines, and what is to be said of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Text {
    pub(super) rows: Vec<Vec<f64>>,
    /// The line of each row, from 1.
    pub(super) lines: Vec<usize>,
    /// Columns before the values.
    pub(super) labels: usize,
    /// The time of each row in seconds, where the header names such a column.
    pub(super) times: Option<Vec<f64>>,
    pub(super) remarks: Vec<String>,
}

/// What has been read of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Begin,
    /// A line of names.
    Header,
    Rows,
}

/// Reads lines one after the other; of each the columns of the values.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    /// Where they come from, for messages.
    path: PathBuf,
    layout: Layout,
    /// What they are read for; nothing for tables that are no frames.
    target: Option<Target>,
    /// That of the first line which has one; spaces between the words of a header are none.
    separator: Option<Separator>,
    state: State,
    /// The line of names.
    header: Option<Vec<u8>>,
    /// Which column holds times, and seconds of their unit.
    time: Option<(usize, f64)>,
    /// Columns of the sensor, where a frame is a block of lines.
    block: Option<usize>,
    /// How many lines there were.
    number: usize,
    /// Whether a comma is a decimal point for certain, and the first one of which that is not clear.
    decimal: bool,
    unclear: Option<(usize, usize, String)>,
    /// Cells of a line that has blank ones behind its last value.
    padded: Option<usize>,
    /// Lines that were left out, and what was wrong with the first.
    bad: Option<(usize, String)>,
    remarks: Vec<String>,
}

impl Lines {
    pub(super) fn new(path: &Path, layout: &Layout, target: Option<&Target>) -> Self {
        Self {
            path: path.to_path_buf(),
            layout: layout.clone(),
            target: target.cloned(),
            separator: None,
            state: State::Begin,
            header: None,
            time: None,
            block: None,
            number: 0,
            decimal: false,
            unclear: None,
            padded: None,
            bad: None,
            remarks: Vec::new(),
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

    /// What is to be said of the lines so far.
    pub(super) fn remarks(&self) -> Vec<String> {
        let path = self.path.display();
        let bad =
            self.bad.as_ref().map(|(count, first)| format!("{path}: {count} lines are left out; the first: {first}"));
        let last = self.labels() + self.target.as_ref().map_or(0, |target| target.sensor.taxels());
        let padded = self.padded.map(|_| format!("{path}: cells behind column {last} are blank, and are none"));
        self.remarks.iter().cloned().chain(padded).chain(bad).collect()
    }

    /// Columns before the values.
    pub(super) fn labels(&self) -> usize {
        self.layout.first()
    }

    /// The numbers of the next line. Nothing for a blank one, for one that begins with #, for lines of names and units.
    /// `wrong_length` is given the number of values and returns the
    /// number wanted, if that is another.
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
        if self.number <= self.layout.skip_lines || content.is_empty() || content.starts_with(b"#") {
            return Ok(None);
        }
        // As spreadsheets have it.
        if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator] = content {
            self.separator = Some(Separator::Byte(*separator));
            return Ok(None);
        }
        if self.header.as_deref() == Some(content) {
            let remark = format!(
                "{}, line {}: the header again, as between recordings that were put behind each other; what follows are frames of \
                 the same",
                self.path.display(),
                self.number
            );
            if !self.remarks.iter().any(|said| said.contains("the header again")) {
                self.remarks.push(remark);
            }
            return Ok(None);
        }
        let separator = self.separator.unwrap_or_else(|| Separator::of(content));
        let content = separator.trim(line);
        let fields = separator.fields(content);
        if let Some(separator) = foreign(content) {
            return Err(FrameError::Separator { path: self.path.clone(), line: self.number, separator });
        }
        let is_words = fields.iter().skip(self.labels()).all(|field| no_number(field));
        let is_header = match self.state {
            State::Begin => is_words,
            State::Header => is_words && self.is_units(&fields),
            State::Rows => false,
        };
        self.separator = Some(separator).filter(|separator| !is_header || matches!(separator, Separator::Byte(_)));
        if is_header {
            if self.state == State::Begin {
                self.header = Some(content.trim_ascii().to_vec());
                self.names(&fields)?;
            }
            self.state = State::Header;
            return Ok(None);
        }
        self.state = State::Rows;
        match self.values(separator, content, wrong_length) {
            Ok(row) => Ok(Some(row)),
            Err(error) if self.layout.skip_bad => {
                self.bad.get_or_insert_with(|| (0, error.to_string())).0 += 1;
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Whether the first row is a header of the sensor's numbers: they are whole and ascend, as those of no other row.
    pub(super) fn is_numbered(&self, first: &[f64], others: &[Vec<f64>]) -> bool {
        self.target.is_some() && self.header.is_none() && ascends(first) && !others.iter().any(|row| ascends(row))
    }

    /// Says that a row was taken for the numbers of the columns.
    pub(super) fn numbered(&mut self, line: usize, row: &[f64]) {
        let remark = format!(
            "{}, line {line}: numbers up to {} are those of the columns, as pandas writes them; the line is taken for a header",
            self.path.display(),
            row[row.len() - 1]
        );
        self.remarks.push(remark);
    }

    /// The values of a line behind the labels.
    fn values(
        &mut self,
        separator: Separator,
        content: &[u8],
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Vec<f64>, FrameError> {
        let first = self.labels();
        let dead = self.target.as_ref().map_or(Vec::new(), |target| target.dead.clone());
        // Blank cells behind the last column are nothing; a blank one in it is a value that is not there.
        let cells = separator.split(content);
        let columns = match (&self.target, self.layout.columns) {
            (_, Some(_)) => cells.len(),
            (Some(target), None) => first + target.sensor.taxels(),
            (None, None) => 1,
        };
        let fields = separator.at_most(columns, content);
        if self.target.is_some() && fields.len() == columns && cells.len() > columns {
            self.padded = Some(cells.len());
        }
        let path = self.path.clone();
        let end = self.layout.columns.map_or(fields.len(), |[_, last]| last);
        if fields.len() < end {
            return Err(self.wrong_length(fields.len(), end));
        }
        let mut row = Vec::with_capacity(end);
        for (index, field) in fields.iter().enumerate().take(end).skip(first) {
            let (line, column) = match self.block {
                Some(columns) => (self.number + index / columns, index % columns + 1),
                None => (self.number, index + 1),
            };
            let text = || String::from_utf8_lossy(field).chars().take(40).collect::<String>();
            let number = separator::number(field).filter(|&value| is_number(value));
            match (Comma::of(field), number) {
                (Some(Comma::Decimal), Some(_)) => self.decimal = true,
                (Some(Comma::Unclear), Some(_)) => {
                    self.unclear.get_or_insert_with(|| (line, column, text()));
                }
                (Some(Comma::Unclear), None) => {
                    return Err(FrameError::Thousands { path, line, column, text: text() });
                }
                _ => {}
            }
            match number {
                Some(number) => row.push(number),
                None if dead.contains(&(index - first)) => row.push(0.0),
                None => {
                    let (text, remedy) = (text(), self.value_remedy(&text()));
                    return Err(FrameError::Value { path, line, column, remedy, text });
                }
            }
        }
        match wrong_length(row.len()) {
            None => Ok(row),
            Some(wanted) => Err(self.wrong_length(fields.len(), first + wanted)),
        }
    }

    /// What to do about a field that is no number.
    fn value_remedy(&self, text: &str) -> String {
        let counts = self.target.as_ref().is_some_and(|target| target.counts);
        if is_unknown(text) && self.target.is_some() {
            return "name a taxel that is dead in sensor.dead, or leave such frames out with --skip-bad".to_owned();
        }
        let what = if counts { "the sensor's count, such as 1012" } else { "the stress in pascals, such as -1250.5" };
        format!(
            "give {what}, separated by commas, semicolons, tabs or spaces; columns before the values need --labels, columns \
             behind them --columns FIRST-LAST, lines above them --skip-lines, and a header has no number in it"
        )
    }

    /// A line of another length than `expected`, the labels among it.
    fn wrong_length(&self, found: usize, expected: usize) -> FrameError {
        let hint = match &self.target {
            Some(target) => self.length_hint(target, found, expected),
            None => "give a line of forces for each frame".to_owned(),
        };
        FrameError::Length { path: self.path.clone(), line: self.number, found, expected, hint }
    }

    /// What to do about it.
    fn length_hint(&self, target: &Target, found: usize, expected: usize) -> String {
        let (first, taxels) = (self.labels(), target.sensor.taxels());
        let hint = match found.saturating_sub(expected) {
            0 => String::new(),
            more if more == taxels => format!(
                "; are these decimal commas? Separate the values by semicolons. Or two arrays in a line? Say which with \
                 --columns {}-{} or --columns {}-{}",
                first + 1,
                first + taxels,
                first + taxels + 1,
                first + 2 * taxels
            ),
            more => format!(
                "; {more} columns more than taxels, a time or a total: in front of the values? Say so with --labels {}. Behind \
                 them? With --columns {}-{}",
                first + more,
                first + 1,
                first + taxels
            ),
        };
        let what = if target.counts { "count" } else { "stress" };
        format!("give one {what} for each taxel of the sensor{hint}")
    }

    /// Finds the columns of the values and of times by the names of a header.
    fn names(&mut self, fields: &[&[u8]]) -> Result<(), FrameError> {
        let Some(target) = &self.target else { return Ok(()) };
        let (first, taxels) = (self.labels(), target.sensor.taxels());
        let names: Vec<String> = fields.iter().map(|field| String::from_utf8_lossy(field).into_owned()).collect();
        // Names that differ by numbers alone.
        let kinds: Vec<String> = names.iter().map(|name| kind_of(name)).collect();
        let mut runs: Vec<[usize; 2]> = Vec::new();
        let mut at = 0;
        for run in kinds.chunk_by(|a, b| a == b) {
            if run.len() == taxels && run[0].contains('#') {
                runs.push([at + 1, at + taxels]);
            }
            at += run.len();
        }
        let wrong = |problem: String| FrameError::Shape { path: self.path.clone(), line: self.number, problem };
        let shown = |[first, last]: [usize; 2]| format!("{} to {}", names[first - 1], names[last - 1]);
        if let (&[[from, to]], None) = (&runs[..], self.layout.columns) {
            if first > 0 && first != from - 1 {
                return Err(wrong(format!(
                    "the header names columns {from} to {to}, {}, for the taxels, and --labels {first} takes others: \
                     leave --labels away",
                    shown([from, to])
                )));
            }
            if from > 1 && first == 0 || names.len() > to {
                self.remarks.push(format!(
                    "{}, line {}: columns {from} to {to}, {}, are the taxels, as the header names them",
                    self.path.display(),
                    self.number,
                    shown([from, to])
                ));
                self.layout.columns = Some([from, to]);
            }
        } else if let (&[a, b, ..], None, true) = (&runs[..], self.layout.columns, names.len() > first + taxels) {
            let [left, right] = [a, b].map(|[from, to]| format!("--columns {from}-{to} ({})", shown([from, to])));
            return Err(wrong(format!("a line holds several arrays: say which with {left} or {right}")));
        }
        let before = self.labels().min(names.len());
        self.time = names[..before].iter().enumerate().find_map(|(column, name)| Some((column, seconds(name)?)));
        Ok(())
    }

    /// Whether the fields of a second line of words are units: the same for all taxels.
    fn is_units(&self, fields: &[&[u8]]) -> bool {
        let values = fields.get(self.labels()..).unwrap_or_default();
        self.target.is_some() && values.len() > 1 && values.iter().all(|field| *field == values[0])
    }

    /// The frames of a file of blocks.
    fn blocks(
        mut self,
        blocks: &Blocks,
        target: &Target,
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Text, FrameError> {
        let (columns, rows) = (target.sensor.columns, target.sensor.rows);
        (self.state, self.separator, self.block) = (State::Rows, Some(Separator::Byte(b';')), Some(columns));
        let mut text = Text::default();
        for (line, frame) in &blocks.frames {
            self.number = line - 1;
            if let Some(row) = self.row(frame, &wrong_length)? {
                text.rows.push(row);
                text.lines.push(*line);
            }
        }
        self.unclear()?;
        let path = self.path.display();
        text.remarks = self.remarks();
        text.remarks.push(format!("{path}: frames are blocks of {rows} lines of {columns} values"));
        if let Some((name, pascals)) = &blocks.unit {
            text.remarks.push(if target.counts {
                format!("{path}: the header gives the unit {name}; the design says what a value is worth")
            } else {
                text.rows.iter_mut().flatten().for_each(|value| *value *= -pascals);
                format!(
                    "{path}: the header gives the unit {name}; pressure presses, so that 1 {name} is {} Pa",
                    -pascals
                )
            });
        }
        Ok(text)
    }

    /// Refuses a column behind the values that is blank on some lines, and whose other lines were left out.
    fn padding(&mut self, bytes: &[u8]) -> Result<(), FrameError> {
        let (Some(cells), Some(_), Some(separator)) = (self.padded, &self.bad, self.separator) else { return Ok(()) };
        let count = |line: &[u8]| separator.fields(separator.trim(line)).len();
        let Some(full) = separator::lines(bytes).position(|line| count(line) == cells) else { return Ok(()) };
        self.number = full + 1;
        Err(self.wrong_length(cells, self.labels() + self.target.as_ref().map_or(0, |target| target.sensor.taxels())))
    }

    /// What is still to be refused at the end: commas that may be either.
    pub(super) fn unclear(&self) -> Result<(), FrameError> {
        match &self.unclear {
            Some((line, column, text)) if !self.decimal => {
                Err(FrameError::Thousands { path: self.path.clone(), line: *line, column: *column, text: text.clone() })
            }
            _ => Ok(()),
        }
    }
}

/// A name with `#` in the place of each of its numbers.
fn kind_of(name: &str) -> String {
    let mut kind = String::new();
    for letter in name.chars() {
        if !letter.is_ascii_digit() {
            kind.push(letter);
        } else if !kind.ends_with('#') {
            kind.push('#');
        }
    }
    kind
}

/// Seconds of the unit of a column of times, by its name; nothing for another column.
pub(crate) fn seconds(name: &str) -> Option<f64> {
    let lower = name.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric() && c != 'µ').filter(|word| !word.is_empty());
    let is_time = matches!(words.next()?, "t" | "time" | "timestamp" | "zeit");
    let unit = match words.next() {
        None | Some("s" | "sec" | "seconds") => 1.0,
        Some("ms" | "millis" | "milliseconds") => 1e-3,
        Some("us" | "µs" | "micros" | "microseconds") => 1e-6,
        Some("ns") => 1e-9,
        Some(_) => return None,
    };
    is_time.then_some(unit)
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
    if let Some(target) = target.filter(|_| layout.first() == 0 && layout.columns.is_none())
        && let Some(blocks) = blocks::join(path, bytes, layout, target)?
    {
        return lines.blocks(&blocks, target, wrong_length);
    }
    let mut text = Text::default();
    let mut labels: Vec<bool> = Vec::new();
    for line in separator::lines(bytes) {
        let Some(row) = lines.row(line, &wrong_length)? else { continue };
        let fields = lines.separator.map(|separator| separator.split(separator.trim(line))).unwrap_or_default();
        let label = |column: usize| fields.get(column).and_then(|label| separator::number(label));
        if let Some((column, unit)) = lines.time {
            text.times.get_or_insert_default().push(label(column).map_or(f64::NAN, |time| unit * time));
        }
        labels.push(lines.labels() == 0 || label(0).is_some());
        text.rows.push(row);
        text.lines.push(lines.number);
    }
    lines.unclear()?;
    lines.padding(bytes)?;
    if let [first, others @ ..] = &text.rows[..] {
        // Its label is a word where all others are numbers.
        let is_labelled = || {
            target.is_some() && is_whole(first) && !others.is_empty() && !labels[0] && labels[1..].iter().all(|&is| is)
        };
        // A single row may be a frame whose values happen to ascend.
        let is_numbered = lines.is_numbered(first, others)
            && (!others.is_empty() || first.windows(2).all(|pair| pair[1] - pair[0] < 1.5) && first[0] < 2.0);
        if is_numbered || lines.header.is_none() && is_labelled() {
            let row = text.rows.remove(0);
            lines.numbered(text.lines.remove(0), &row);
        }
    }
    text.labels = lines.labels();
    text.remarks = lines.remarks();
    Ok(text)
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

/// Whether all values are those of a count from 0 on.
fn is_whole(row: &[f64]) -> bool {
    row.len() >= FEWEST_NUMBERED && row.iter().all(|&value| value >= 0.0 && value.fract() == 0.0)
}

/// Whether values are whole and each is larger than the one before, as the numbers of a sensor's taxels with gaps.
fn ascends(row: &[f64]) -> bool {
    is_whole(row) && row.windows(2).all(|pair| pair[1] > pair[0])
}

/// Whether a field is that of a header: text, of any encoding, and no number of any kind.
fn no_number(field: &[u8]) -> bool {
    String::from_utf8_lossy(field).replace(',', ".").parse::<f64>().is_err()
}
