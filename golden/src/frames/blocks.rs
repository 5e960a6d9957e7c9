//! Frames as blocks of rows: a line for each row of taxels, blank lines or lines of words between the frames.
//!
//! So `numpy.savetxt` writes one frame, and so pressure mats' programs export theirs: key lines, a marker and the rows of
//! each frame, an end marker.

use std::path::Path;

use super::layout::{Layout, Target};
use super::text::{Lines, Text};
use super::{FrameError, header, names};
use crate::numbers::counted;
use crate::sensor::Sensor;
use crate::separator::{self, Separator, is_unknown, no_number};
use crate::units::pascals;

/// A line of a file.
struct Line<'a> {
    number: usize,
    content: &'a [u8],
    /// Its fields behind the labels, if they are numbers.
    row: Option<Vec<&'a [u8]>>,
    /// Its label, where rows have one that says their place in the frame.
    label: Option<&'a [u8]>,
}

/// Frames of a file, each on one line.
pub(super) struct Blocks {
    /// The first line of each, from 1, and its fields; or why it is left out.
    frames: Vec<(usize, Result<Vec<u8>, FrameError>)>,
    /// What separates them.
    separator: u8,
    /// Columns before the values of a row.
    labels: usize,
    /// What else stands in the lines, in words.
    beside: &'static str,
    /// The unit that the header names, and its line.
    unit: Option<(usize, String)>,
}

impl Blocks {
    /// The frames.
    pub(super) fn read(self, mut lines: Lines, target: &Target) -> Result<Text, FrameError> {
        let Sensor { columns, rows, .. } = target.sensor;
        let path = lines.cells.path.display().to_string();
        let (unit, remark) = match self.unit {
            Some((line, unit)) => header::worth(&unit, target, -1.0)
                .map_err(|problem| FrameError::line(&lines.cells.path, line, problem))?,
            None => (None, None),
        };
        let mut text = Text::default();
        for (line, frame) in self.frames {
            lines.begin_block(line, [columns, self.labels], unit, self.separator);
            let row = frame.and_then(|frame| lines.row(&frame));
            if let Some(row) = row.or_else(|error| lines.leave_out(line, error))? {
                text.rows.push(row);
                text.lines.push(line);
            }
        }
        lines.end(&mut text)?;
        text.remarks.push(format!("{path}: frames are blocks of {rows} lines of {columns} values{}", self.beside));
        text.remarks.extend(remark.map(|remark| format!("{path}: {remark}")));
        Ok(text)
    }
}

/// Puts the rows of each frame on one line; nothing if the file has a line for each frame, or lines of other lengths.
pub(super) fn join<'a>(
    path: &Path,
    bytes: &'a [u8],
    layout: &Layout,
    target: &Target,
) -> Result<Option<Blocks>, FrameError> {
    let (columns, rows) = (target.sensor.columns, target.sensor.rows);
    let end = layout.columns.map(|[_, last]| last);
    let behind = |labels: usize| -> Vec<Line<'a>> {
        let of = |(index, line): (usize, &'a [u8])| {
            let content = Separator::of(line.trim_ascii()).trim(line);
            Line { number: index + 1, content, row: row(content, columns, labels, end), label: None }
        };
        separator::lines(bytes).enumerate().skip(layout.skip_lines).map(of).collect()
    };
    let of_length = |all: &[Line], length: usize| {
        all.iter().filter(|line| line.row.as_ref().is_some_and(|row| row.len() == length)).count()
    };
    let mut all = behind(layout.first());
    if rows == 1 || of_length(&all, target.sensor.taxels()) > 0 {
        return Ok(None);
    }
    let shape = |(line, problem): (usize, String)| FrameError::line(path, line, problem);
    let wrong = |line: usize, problem: String| shape((line, problem));
    // Numbers of the columns above frames, as pandas writes them: without them the rows are whole frames.
    let numbers = Sensor { rows: 1, ..target.sensor.clone() };
    // Of several labels one may be the number of the row; a label that no option names stands alone.
    let is_implied = layout.first() == 0 && end.is_none() && of_length(&all, columns) == 0;
    let before = if is_implied { 1 } else { layout.first() };
    let labelled = (0..before).find_map(|at| behind_labels(behind(before), &numbers, rows, at));
    let is_labelled = labelled.is_some();
    all = labelled.unwrap_or(all);
    if of_length(&all, columns) < rows {
        return transposed(&all, of_length(&all, rows), &target.sensor).map_or(Ok(None), |problem| Err(shape(problem)));
    }
    let head = all.iter().find_map(|line| Some((line.content, line.row.as_ref()?)));
    let head = head.filter(|(_, row)| header::is_numbered(row, &numbers, true)).map(|(content, _)| content);
    let is_row = |line: &&Line| line.row.as_ref().is_some_and(|row| row.len() == columns) && Some(line.content) != head;
    let others = all.iter().filter(is_row).count();
    let is_numbered = head.is_some() && others > 0 && others.is_multiple_of(rows);
    all.iter_mut().filter(|line| is_numbered && Some(line.content) == head).for_each(|line| line.row = None);
    if let Some(wrong) =
        all.iter().filter(|line| line.row.is_none()).find_map(|line| other_order(line, columns, before))
    {
        return Err(shape(wrong));
    }
    if end.is_some() {
        keep_width(&mut all, columns, layout.skip_bad).map_err(shape)?;
    }
    // Points between semicolons or tabs may separate thousands; no number has a control character.
    let is_marked = |line: &Line| line.row.is_some() && line.content.iter().any(|byte| b";\t".contains(byte));
    let separator = if all.iter().any(is_marked) { b';' } else { 0x1f };
    let unit = unit(&all);
    if !target.counts {
        one_unit(&all, unit.as_ref()).map_err(shape)?;
    }
    all = parted(all, columns, rows, layout.first());
    let (mut frames, mut run) = (Vec::new(), Vec::new());
    let last = all.iter().rposition(|line| !line.content.is_empty()).map_or(0, |last| last + 1);
    all.truncate(last);
    all.push(Line { number: last + layout.skip_lines, content: b"", row: None, label: None });
    let in_order: Vec<&[u8]> = all.iter().filter_map(|line| line.label).take(rows).collect();
    let places = places(&all, &in_order, rows).map_err(shape)?;
    for (index, Line { number, content, row, label }) in all.iter().enumerate() {
        match row {
            // A row in the place of another is as good as damaged.
            Some(row) if row.len() == columns => {
                let belongs = label.is_none_or(|label| in_order[run.len() % rows] == label);
                run.push((*number, belongs.then(|| row.join(&separator))));
            }
            // A row that is damaged ends no frame.
            _ if layout.skip_bad && run.len() % rows > 0 && Some(*content) != head && is_damaged(content) => {
                run.push((*number, None));
            }
            _ if run.is_empty() || content.starts_with(b"#") && !layout.skip_bad => {}
            _ => {
                let found = run.len();
                let problem = if index == last {
                    format!("the file ends within a frame, after {} of {rows} rows", found % rows)
                } else {
                    format!(
                        "a block of {} ends here where the sensor has {rows}; skip lines above the first frame with \
                         --skip-lines N, or leave such frames out with --skip-bad",
                        counted(found, "row")
                    )
                };
                // A row too many is that of a single block.
                let is_alone = index == last && frames.is_empty();
                let whole = if found % rows == 0 || is_alone || found > 2 * rows { found / rows } else { 0 };
                for frame in run[..whole * rows].chunks(rows) {
                    let damaged = frame.iter().find(|(_, row)| row.is_none());
                    let sorted = places.iter().map_while(|&row| frame[row].1.as_deref());
                    let joined = sorted.collect::<Vec<_>>().join(&separator);
                    let problem =
                        || format!("this row of a block has no {columns} numbers, or the label of another row");
                    frames.push((frame[0].0, damaged.map_or(Ok(joined), |(line, _)| Err(wrong(*line, problem())))));
                }
                if whole * rows < found {
                    frames.push((run[whole * rows].0, Err(wrong(*number, problem))));
                }
                run.clear();
            }
        }
    }
    let beside = match (is_labelled, is_numbered, places.is_sorted()) {
        (true, _, false) => ", behind numbers of the rows, which say which is which",
        (true, ..) => ", behind labels of the rows",
        (false, true, _) => ", below numbers of the columns",
        (false, false, _) => "",
    };
    Ok(Some(Blocks { frames, separator, labels: before, beside, unit }))
}

/// What is wrong where so many lines have as many values as the grid has rows: it lies on its side.
fn transposed(all: &[Line], lines: usize, &Sensor { columns, rows, .. }: &Sensor) -> Option<(usize, String)> {
    let is_whole = columns > 1 && lines > 0 && lines.is_multiple_of(columns) && rows != columns;
    is_whole.then(|| {
        (
            all.iter().find(|line| line.row.is_some()).map_or(1, |line| line.number),
            format!(
                "blocks of {columns} lines of {rows} values are the transposed grid: the sensor has {rows} rows of {columns} \
                 columns; write a line for each row, or swap columns, rows and pitch_mm of the design"
            ),
        )
    })
}

/// The rows of a frame from the first of the grid on: by their numbers, where they have some, else as they come.
fn places(all: &[Line], in_order: &[&[u8]], rows: usize) -> Result<Vec<usize>, (usize, String)> {
    let numbers = if in_order.len() == rows { names::places(in_order) } else { None };
    let mut places: Vec<usize> = (0..rows).collect();
    places.sort_by_key(|&row| numbers.as_ref().map(|numbers| numbers[row]));
    let mut labelled = all.iter().skip_while(|line| line.label.is_none()).peekable();
    let first = labelled.peek().map_or(1, |line| line.number);
    let is_run_on = labelled.take_while(|line| line.label.is_some()).count() > rows;
    let is_back = rows > 2 && places.iter().rev().is_sorted();
    if is_run_on && !places.is_sorted() && !is_back {
        let problem = "the numbers of the rows do not begin with the first or the last one, as if the file began within a frame: \
                       skip the rows of that with --skip-lines N, or write a blank line between frames";
        return Err((first, problem.to_owned()));
    }
    Ok(places)
}

/// A line of names of the columns that is in another order than the taxels, and what to do. Rows stand behind so many labels.
fn other_order(line: &Line, columns: usize, before: usize) -> Option<(usize, String)> {
    let names = Separator::of(line.content).fields(line.content);
    // A word may stand above the labels, or where rows have none.
    let others = names.len().checked_sub(columns).filter(|&others| others <= before.max(1))?;
    let names = &names[others..];
    let is_other = columns > 2 && names::places(names).is_some_and(|places| !places.is_sorted());
    let [first, last] = [names.first()?, names.last()?].map(|name| String::from_utf8_lossy(name));
    is_other.then(|| {
        (
            line.number,
            format!("the columns, {first} to {last}, are not in the order of the taxels: write the first one first"),
        )
    })
}

/// The fields of a line behind so many labels and up to a last column, if they are nothing but numbers and readings that are
/// not there.
fn row(line: &[u8], columns: usize, labels: usize, end: Option<usize>) -> Option<Vec<&[u8]>> {
    let fields = Separator::of(line).at_most(columns + labels, line);
    let fields = fields.get(labels..end.unwrap_or(fields.len()))?.to_vec();
    let is_number = |field: &&[u8]| separator::number(field).is_some_and(f64::is_finite);
    let is_reading = |field: &&[u8]| separator::number(field).is_some() || is_unknown(&String::from_utf8_lossy(field));
    (fields.iter().all(is_reading) && fields.iter().any(is_number)).then_some(fields)
}

/// Whether a line is one of numbers for the most part.
fn is_damaged(line: &[u8]) -> bool {
    let fields = Separator::of(line).fields(line);
    !line.starts_with(b"#")
        && fields.len() > 1
        && 2 * fields.iter().filter(|field| separator::number(field).is_some()).count() > fields.len()
}

/// Lines whose rows have a label `at` this place, words that are the same for each frame, or numbers from 0 or 1 on in any
/// order; nothing if they do not. A blank label, or a word beside numbers of the columns, is that of a header.
fn behind_labels<'a>(mut lines: Vec<Line<'a>>, numbers: &Sensor, rows: usize, at: usize) -> Option<Vec<Line<'a>>> {
    let mut labels: Vec<&[u8]> = Vec::new();
    for line in &mut lines {
        let Some(row) = line.row.as_ref().filter(|row| row.len() == numbers.columns) else { continue };
        let label = *Separator::of(line.content).split(line.content).get(at)?;
        if label.is_empty() || no_number(label) && header::is_numbered(row, numbers, false) {
            line.row = None;
        } else {
            labels.push(label);
            line.label = Some(label);
        }
    }
    let first = labels.get(..rows)?;
    let counts = |from: usize| (from..from + rows).all(|number| first.contains(&number.to_string().as_bytes()));
    let are_words =
        first.iter().all(|label| no_number(label)) && (1..rows).all(|row| !first[..row].contains(&first[row]));
    let are_labels = (counts(0) || counts(1) || are_words) && labels.iter().all(|label| first.contains(label));
    are_labels.then_some(lines)
}

/// Lines with a blank one where the number of the frame changes, a label that most frames have on all of their rows. So a
/// lost row shifts no other into its place.
fn parted<'a>(all: Vec<Line<'a>>, columns: usize, rows: usize, labels: usize) -> Vec<Line<'a>> {
    let label = |line: &Line<'a>, at: usize| {
        line.row.as_ref().filter(|row| row.len() == columns)?;
        Separator::of(line.content).split(line.content).get(at).copied()
    };
    let is_of_frames = |&at: &usize| {
        let of: Vec<&[u8]> = all.iter().filter_map(|line| label(line, at)).collect();
        let runs: Vec<usize> = of.chunk_by(|a, b| a == b).map(<[_]>::len).collect();
        let whole = runs.iter().filter(|&&run| run == rows).count();
        // A clock may tick within a frame: no row is lost where the two ends make a frame.
        let ticks = whole + 2 == runs.len() && runs[0] + runs[runs.len() - 1] == rows;
        whole > 1 && 2 * whole >= runs.len() && !ticks
    };
    let Some(at) = (0..labels).find(is_of_frames) else { return all };
    let (mut lines, mut before) = (Vec::new(), None);
    for line in all {
        let this = label(&line, at);
        if this.is_some() && before.is_some() && this != before {
            lines.push(Line { number: line.number, content: b"", row: None, label: None });
        }
        before = this.or(before);
        lines.push(line);
    }
    lines
}

/// Refuses rows of another number of cells than the first, or leaves them out: columns of values stay where they are only if
/// all rows have as many.
fn keep_width(all: &mut [Line], columns: usize, skip_bad: bool) -> Result<(), (usize, String)> {
    let cells = |line: &Line| Separator::of(line.content).split(line.content).len();
    let mut rows = all.iter_mut().filter(|line| line.row.as_ref().is_some_and(|row| row.len() == columns));
    let width = rows.next().map_or(0, |line| cells(line));
    for line in rows.filter(|line| cells(line) != width) {
        if !skip_bad {
            let found = counted(cells(line), "cell");
            return Err((line.number, format!("{found} where the first row of the blocks has {width}")));
        }
        line.row = None;
    }
    Ok(())
}

/// Refuses a second unit of pressure. Without a unit above the frames they are pascals.
fn one_unit(all: &[Line], unit: Option<&(usize, String)>) -> Result<(), (usize, String)> {
    let first = unit.map_or(Some(1.0), |(_, unit)| pascals(unit));
    let mut named = all.iter().filter(|line| line.row.is_none()).filter_map(numbered);
    let other = named.find(|(_, other)| pascals(other).is_some_and(|other| Some(other) != first));
    other.map_or(Ok(()), |(line, other)| {
        let before = unit.map_or_else(
            || "the frames above have none".to_owned(),
            |(above, unit)| format!("line {above} says {unit}"),
        );
        Err((line, format!("the unit {other} where {before}: give all frames in one unit, or a file for each")))
    })
}

/// The unit that lines of words above the frames name: the first known one, or else the first.
fn unit(lines: &[Line]) -> Option<(usize, String)> {
    let above = lines.iter().take_while(|line| line.row.as_ref().is_none_or(|row| row.len() < 2));
    let units: Vec<(usize, String)> = above.filter_map(numbered).collect();
    units.iter().find(|(_, unit)| pascals(unit).is_some()).or(units.first()).cloned()
}

/// The line, and the unit that it names.
fn numbered(line: &Line) -> Option<(usize, String)> {
    Some((line.number, header::unit_in(line.content)?))
}
