//! Tables of numbers as text: one row a line, with or without a header, whatever separates the values.

use std::path::{Path, PathBuf};

use super::blocks::{self, Blocks};
use super::header::{self, FEWEST_NUMBERED, Header};
use super::layout::{Layout, Target};
use super::{FrameError, is_number};
use crate::geometry;
use crate::separator::{self, Comma, Separator, is_unknown};

/// What some programs write before the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// What may stand before decimals.
const MARKS: [&str; 2] = ["comma", "point"];

/// Rows of a file with their lines, and what is to be said of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Text {
    pub(super) rows: Vec<Vec<f64>>,
    /// The line of each row, from 1.
    pub(super) lines: Vec<usize>,
    /// Columns before the values.
    pub(super) labels: usize,
    /// The taxel of each value behind the labels, where that is not their order.
    pub(super) order: Option<Vec<usize>>,
    /// The time of each row in seconds, where the header names such a column.
    pub(super) times: Option<Vec<f64>>,
    /// Rows that were left out, by their place among all, from 0.
    pub(super) skipped: Vec<usize>,
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
    /// The lines above the first row, and what they say.
    heads: Vec<Vec<u8>>,
    header: Header,
    /// Lines with # before the first other one: one of so many fields as a row has is a header.
    comments: Vec<(usize, Vec<u8>)>,
    /// Columns of the sensor, where a frame is a block of lines.
    block: Option<usize>,
    /// How many lines there were.
    number: usize,
    /// Whether a comma, and a point, is a decimal one for certain, and the first of which that is not clear.
    decimal: [bool; 2],
    unclear: [Option<(usize, usize, String)>; 2],
    /// Cells of a line that has blank ones behind its last value.
    padded: Option<usize>,
    /// Lines that were left out, and what was wrong with the first.
    bad: Option<(Vec<usize>, String)>,
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
            heads: Vec::new(),
            header: Header::default(),
            comments: Vec::new(),
            block: None,
            number: 0,
            decimal: [false; 2],
            unclear: [None, None],
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
        let bad = self
            .bad
            .as_ref()
            .map(|(bad, first)| format!("{path}: {} lines are left out; the first: {first}", bad.len()));
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
        column(self.labels(), self.header.order.as_deref(), taxel)
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
        let is_words = || values.iter().all(|field| no_number(field));
        let is_numbered = || self.target.as_ref().is_some_and(|target| header::is_numbered(values, &target.sensor));
        let (is_words, is_numbered) = match self.state {
            State::Begin => (is_words(), is_numbered()),
            State::Header => (is_words() && self.is_units(values), is_numbered() && self.header.is_alike()),
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
            let names = std::mem::take(&mut self.comments).into_iter().find_map(|(line, comment)| {
                let names =
                    Separator::of(&comment).fields(&comment).into_iter().map(<[u8]>::to_vec).collect::<Vec<_>>();
                (names.len() == fields.len()).then_some((line, names))
            });
            if let Some((line, names)) = names {
                self.names(line, &names.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
            }
        }
        self.state = State::Rows;
        match self.values(separator, content, wrong_length) {
            Ok(row) => Ok(Some(row)),
            Err(error) if self.layout.skip_bad => {
                self.bad.get_or_insert_with(|| (Vec::new(), error.to_string())).0.push(self.number);
                Ok(None)
            }
            Err(error) => Err(error),
        }
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

    /// Whether the first row is a header of the sensor's numbers: they are whole and ascend, as those of no other row.
    pub(super) fn is_numbered(&self, first: &[f64], others: &[&Vec<f64>]) -> bool {
        self.target.is_some() && self.heads.is_empty() && ascends(first) && !others.iter().any(|row| ascends(row))
    }

    /// Takes the last line for one of numbers of the columns, and each that is the same.
    pub(super) fn take_for_header(&mut self, line: &[u8], row: &[f64]) {
        self.heads.push(line.trim_ascii().to_vec());
        self.numbered(row[row.len() - 1]);
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
        let dead = self.target.as_ref().map_or(Vec::new(), |target| target.dead.clone());
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
        let path = self.path.clone();
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
            let (line, column) = match self.block {
                Some(columns) => (self.number + index / columns, index % columns + 1),
                None => (self.number, index + 1),
            };
            let text = || String::from_utf8_lossy(field).chars().take(40).collect::<String>();
            let number = separator::number(field).map(|value| value * unit).filter(|&value| is_number(value));
            let points = Some(field).filter(|_| matches!(separator, Separator::Byte(b';')));
            for (mark, found) in
                [Comma::of(field), points.and_then(|field| Comma::of_points(field))].into_iter().enumerate()
            {
                match (found, number) {
                    (Some(Comma::Decimal), Some(_)) => self.decimal[mark] = true,
                    (Some(Comma::Unclear), Some(_)) => {
                        self.unclear[mark].get_or_insert_with(|| (line, column, text()));
                    }
                    (Some(Comma::Unclear), None) => {
                        return Err(FrameError::Thousands { path, line, column, text: text(), mark: MARKS[mark] });
                    }
                    _ => {}
                }
            }
            match number {
                Some(number) => row.push(number),
                None if dead.contains(&taxel(index - first)) => row.push(0.0),
                None => {
                    let (text, remedy) = (text(), self.value_remedy(&text()));
                    return Err(FrameError::Value { path, line, column, remedy, text });
                }
            }
        }
        match wrong_length(row.len()) {
            None => {
                let mut ordered = row.clone();
                row.iter().enumerate().for_each(|(index, &value)| ordered[taxel(index)] = value);
                Ok(ordered)
            }
            Some(wanted) => Err(self.wrong_length(fields.len(), first + wanted)),
        }
    }

    /// What to do about a field that is no number.
    fn value_remedy(&self, text: &str) -> String {
        let counts = self.target.as_ref().is_some_and(|target| target.counts);
        if is_unknown(text) && self.target.is_some() {
            let skip = if self.layout.skip_bad { "" } else { ", or leave such frames out with --skip-bad" };
            return format!("name a taxel that is dead in sensor.dead{skip}");
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

    /// Whether the fields of a second line of words are units: the same for all taxels.
    fn is_units(&self, values: &[&[u8]]) -> bool {
        let Some(target) = &self.target else { return false };
        let values = &values[..values.len().min(target.sensor.taxels())];
        values.len() > 1 && values.iter().all(|field| *field == values[0])
    }

    /// The frames of a file of blocks.
    fn blocks(
        mut self,
        blocks: &Blocks,
        target: &Target,
        wrong_length: impl Fn(usize) -> Option<usize>,
    ) -> Result<Text, FrameError> {
        let (columns, rows) = (target.sensor.columns, target.sensor.rows);
        (self.state, self.block) = (State::Rows, Some(columns));
        let (unit, remark) = blocks.unit.as_ref().map_or((None, None), |unit| header::worth(unit, target, -1.0));
        self.header.unit = unit;
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
        let numbers = if blocks.is_numbered { ", below numbers of the columns" } else { "" };
        text.remarks.push(format!("{path}: frames are blocks of {rows} lines of {columns} values{numbers}"));
        text.remarks.extend(remark.map(|remark| format!("{path}: {remark}")));
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

    /// What is still to be refused at the end: commas or points that may be either.
    pub(super) fn unclear(&self) -> Result<(), FrameError> {
        let open =
            (0..MARKS.len()).find_map(|mark| Some((mark, self.unclear[mark].clone()?)).filter(|_| !self.decimal[mark]));
        let Some((mark, (line, column, text))) = open else { return Ok(()) };
        Err(FrameError::Thousands { path: self.path.clone(), line, column, text, mark: MARKS[mark] })
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
        if let Some((column, unit)) = lines.header.time {
            text.times.get_or_insert_default().push(label(column).map_or(f64::NAN, |time| unit * time));
        }
        labels.push(lines.labels() == 0 || label(0).is_some());
        text.rows.push(row);
        text.lines.push(lines.number);
    }
    lines.unclear()?;
    lines.padding(bytes)?;
    if let Some(first) = text.rows.first().cloned() {
        let is_again = |row: usize| text.rows[row] == first && labels[row] == labels[0];
        let others: Vec<usize> = (1..text.rows.len()).filter(|&row| !is_again(row)).collect();
        let rows: Vec<&Vec<f64>> = others.iter().map(|&row| &text.rows[row]).collect();
        // Its label is a word where all others are numbers.
        let is_labelled = target.is_some()
            && is_whole(&first)
            && !rows.is_empty()
            && !labels[0]
            && others.iter().all(|&row| labels[row]);
        // A single row may be a frame whose values happen to ascend.
        let is_numbered = !rows.is_empty() && lines.is_numbered(&first, &rows);
        if is_numbered || lines.heads.is_empty() && is_labelled {
            lines.number = text.lines[0];
            lines.take_for_header(&[], &first);
            text.rows = rows.into_iter().cloned().collect();
            text.lines = others.iter().map(|&row| text.lines[row]).collect();
        }
    }
    text.order = lines.header.order.take();
    text.labels = lines.labels();
    text.remarks = lines.remarks();
    let bad = lines.bad.map_or(Vec::new(), |(bad, _)| bad);
    let place = |(before, line): (usize, &usize)| before + text.lines.partition_point(|kept| kept < line);
    text.skipped = bad.iter().enumerate().map(place).collect();
    Ok(text)
}

/// The column of a taxel behind the labels, from 1.
pub(super) fn column(labels: usize, order: Option<&[usize]>, taxel: usize) -> usize {
    let place = order.and_then(|order| order.iter().position(|&other| other == taxel));
    labels + place.unwrap_or(taxel) + 1
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
