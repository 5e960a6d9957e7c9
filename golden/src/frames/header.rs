//! What the lines above the frames say: which columns hold the taxels, in which order and unit, and which one times.

use super::Clock;
use super::layout::{Layout, Target};
use super::names::{Open, as_text, kind_of, split, taxels as taxels_of};
use crate::numbers::{correlation, rounded, sorted};
use crate::sensor::Sensor;
use crate::separator;
use crate::units::{force_or_pressure, no_pressure, pascals, seconds, unit_of_time};

/// So few numbers in turn may be a frame: no sensor has fewer taxels.
const FEWEST_NUMBERED: usize = 4;
/// So few numbers in any order may be a frame, if no word stands beside them.
const FEWEST_ALONE: usize = 6;

/// So many lines of numbers behind words are a header at most.
const HEADS: usize = 4;

/// A count is worth the pascals of a unit within this logarithm: gains differ a little.
const OTHER_UNIT: f64 = 0.3;

/// Correlation of a frame with the next one, at least: taxels differ by more than their noise.
const ALIKE: f64 = 0.98;

/// The first label of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Label {
    /// A number or a time; so is a row without labels.
    Number,
    Word,
    Blank,
}

/// The names of the columns, and what they say.
#[derive(Clone, Debug, Default)]
pub(super) struct Header {
    names: Vec<String>,
    /// First and last column of the values, from 1, where names say so.
    pub(super) columns: Option<[usize; 2]>,
    /// The taxel of each value, where that is not their order.
    pub(super) order: Option<Vec<usize>>,
    /// Which column holds times, and seconds of their unit.
    pub(super) time: Option<(usize, f64)>,
    /// The first column before the values that is named as one of times, whether they can be read or not.
    pub(super) clock: Option<Clock>,
    /// Pascals of a value.
    pub(super) unit: Option<f64>,
    /// What is to be said of it, and of which line.
    pub(super) remarks: Vec<String>,
    pub(super) line: usize,
}

impl Header {
    /// The header of names, at this line.
    ///
    /// # Errors
    ///
    /// What is wrong with names that leave open which columns are the taxels.
    pub(super) fn of(line: usize, names: Vec<String>, target: &Target, layout: &Layout) -> Result<Self, String> {
        let mut header = Self { names, line, ..Self::default() };
        header.columns(target, layout)?;
        let (names, taxels) = (&header.names, target.sensor.taxels());
        let [from, to] = header.columns.or(layout.columns).unwrap_or([layout.labels + 1, layout.labels + taxels]);
        let before = from.saturating_sub(1).min(names.len());
        header.time = names[..before].iter().enumerate().find_map(|(column, name)| Some((column, seconds(name)?)));
        header.clock = names[..before].iter().enumerate().find_map(|(column, name)| {
            let has_unit = !unit_of_time(name)?.is_empty();
            Some(Clock { column: column + 1, name: name.clone(), has_unit })
        });
        let Some(values) = names.get(from.saturating_sub(1)..to).filter(|values| values.len() == taxels) else {
            return Ok(header);
        };
        let order = taxels_of(values, &target.sensor).map_err(|Open| {
            format!(
                "the names {}, {} have two numbers each, and on a square grid either may be that of the row: name the columns \
                 r0c0, r0c1 and so on, or skip the header with --skip-lines {line} if the values stand row by row",
                values[0], values[1]
            )
        })?;
        if order.is_none()
            && let Some(pair) = as_text(values)
        {
            return Err(format!(
                "the columns are sorted by the text of their names, {} before {}: sort them by their numbers, or number them \
                 from 0 without a gap",
                pair[0], pair[1]
            ));
        }
        header.order = order.filter(|order| !order.is_sorted());
        if header.order.is_some() {
            header.remarks.push(format!(
                "the columns, {} to {}, are not in the order of the taxels: the numbers of their names say which is which",
                values[0],
                values[taxels - 1]
            ));
        }
        let units = || values.iter().map(|name| split(name).1);
        let unit = split(&values[0]).1;
        // What is in brackets may be a place: only what is a unit can differ.
        let is_unit = |unit: &str| no_pressure(unit).is_some();
        let is_other =
            |other: &&str| pascals(other) != pascals(unit) || *other != unit && (is_unit(other) || is_unit(unit));
        let other = units().find(is_other);
        if let Some(other) = other.filter(|_| !target.counts) {
            let [one, other] = [unit, other].map(|unit| if unit.is_empty() { "none" } else { unit });
            return Err(format!(
                "the header names several units, {one} and {other}: give all values in one unit, and name it in each column"
            ));
        }
        if !unit.is_empty() && units().all(|other| other == unit || pascals(other).is_some()) {
            let (worth, remark) = worth(unit, target, 1.0)?;
            header.unit = worth;
            header.remarks.extend(remark);
        }
        Ok(header)
    }

    /// Finds the columns of the values.
    fn columns(&mut self, target: &Target, layout: &Layout) -> Result<(), String> {
        let (names, first, taxels) = (&self.names, layout.first(), target.sensor.taxels());
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
        let shown = |[first, last]: [usize; 2]| format!("{} to {}", names[first - 1], names[last - 1]);
        let differs = |[from, to]: [usize; 2], option: String, remedy: &str| {
            Err(format!(
                "the header names columns {from} to {to}, {}, for the taxels, and {option} takes others: {remedy}",
                shown([from, to])
            ))
        };
        if let Some(at) = kinds.windows(2 * taxels).position(alternate).filter(|_| runs.is_empty()) {
            return Err(format!(
                "the columns of two arrays alternate, {}: write those of one array side by side",
                names[at..at + 3].join(", ")
            ));
        }
        if let Some([from, to]) = layout.columns {
            return match runs[..] {
                [run, ..] if !runs.contains(&[from, to]) => {
                    let remedy = format!("leave --columns away, or the header with --skip-lines {}", self.line);
                    differs(run, format!("--columns {from}-{to}"), &remedy)
                }
                [] if names.len() >= first + taxels => self.are_taxels(&kinds, target, first),
                _ => Ok(()),
            };
        }
        if runs.is_empty() && first == 0 && names.len() == taxels + 1 && is_label(&names[0]) {
            runs.push([2, taxels + 1]);
        }
        match runs[..] {
            [[from, to]] => {
                if first > 0 && first != from - 1 {
                    return differs([from, to], format!("--labels {first}"), "leave --labels away");
                }
                if from > 1 && first == 0 || names.len() > to {
                    self.remarks.push(format!(
                        "columns {from} to {to}, {}, are the taxels, as the header names them",
                        shown([from, to])
                    ));
                    self.columns = Some([from, to]);
                }
            }
            [a, b, ..] if names.len() > first + taxels => {
                let [left, right] = [a, b].map(|[from, to]| format!("--columns {from}-{to} ({})", shown([from, to])));
                return Err(format!("a line holds several arrays: say which with {left} or {right}"));
            }
            [] if names.len() == first + taxels => self.are_taxels(&kinds, target, first)?,
            _ => {}
        }
        Ok(())
    }

    /// Refuses columns, behind so many others, of which one is named as no taxel is: without a number among numbered ones, or as
    /// a time.
    fn are_taxels(&self, kinds: &[String], target: &Target, before: usize) -> Result<(), String> {
        let taxels = target.sensor.taxels();
        let values = before..before + taxels;
        let others = values.clone().filter(|&column| !kinds[column].contains('#')).count();
        let are_numbered = others < taxels - others;
        let is_other = |&column: &usize| {
            !target.dead.contains(&(column - before))
                && !kinds[column].contains('#')
                && (are_numbered || column == before && is_label(&self.names[column]))
        };
        let Some(column) = values.clone().find(is_other) else { return Ok(()) };
        Err(format!(
            "{} taxels are named, the design has {taxels}: column {}, {:?}, is none; correct columns and rows of the design, or \
             give each taxel a column and name dead ones in sensor.dead",
            taxels - values.filter(is_other).count(),
            column + 1,
            self.names[column]
        ))
    }

    /// The column of a taxel, from 1, behind so many of labels.
    pub(super) fn column(&self, labels: usize, taxel: usize) -> usize {
        let place = self.order.as_ref().and_then(|order| order.iter().position(|&other| other == taxel));
        labels + place.unwrap_or(taxel) + 1
    }

    /// Whether the names of some columns are the same, so that a line of numbers below is one of names.
    pub(super) fn is_alike(&self) -> bool {
        let mut names = self.names.clone();
        names.sort();
        names.len() < FEWEST_NUMBERED || names.windows(2).any(|pair| pair[0] == pair[1])
    }
}

/// Whether numbered names of two kinds follow each other in turns.
fn alternate(kinds: &[String]) -> bool {
    kinds.len() > 2
        && kinds[0] != kinds[1]
        && kinds[0].contains('#')
        && kinds.windows(3).all(|three| three[0] == three[2])
}

/// Whether a name is that of a label, not of a value.
fn is_label(name: &str) -> bool {
    name.is_empty() || seconds(name).is_some()
}

/// Whether a line has the numbers of all taxels, or of their columns or rows, and no other number. Alone, without a word or a
/// blank beside them, a few small numbers may be a frame.
pub(super) fn is_numbered(fields: &[&[u8]], sensor: &Sensor, alone: bool) -> bool {
    let whole = |number: f64| (number >= 0.0 && number.fract() == 0.0).then_some(number as usize);
    let numbers = fields.iter().filter_map(|field| separator::number(field));
    let Some(numbers) = numbers.map(whole).collect::<Option<Vec<usize>>>() else { return false };
    let Sensor { columns, rows, .. } = *sensor;
    if numbers.len() != sensor.taxels() || numbers.len() < FEWEST_NUMBERED {
        return false;
    }
    let mut sorted = numbers.clone();
    sorted.sort_unstable();
    let of = |number: &dyn Fn(usize) -> usize| {
        numbers.iter().enumerate().all(|(at, &found)| found == sorted[0] + number(at))
    };
    let least = if alone { 3 } else { 2 };
    let is_grid = columns >= least && rows > 1 && of(&|taxel| taxel % columns)
        || rows >= least && columns > 1 && of(&|taxel| taxel / columns);
    let is_each = sorted.iter().copied().eq(sorted[0]..sorted[0] + numbers.len());
    sorted[0] < 2 && (is_grid || is_each && (!alone || numbers.len() >= FEWEST_ALONE || numbers.is_sorted()))
}

/// Which of these rows are a header: the first, and those that are the same between recordings. Nothing if it is a frame.
///
/// Its whole numbers ascend or descend, or differ where others have a fraction, or where others stand behind a number and it
/// behind a word. They are unlike the row below: a frame is much like the next one.
pub(super) fn guessed(rows: &[Vec<f64>], labels: &[Label]) -> Option<Vec<bool>> {
    let first = rows.first()?;
    // Lines of numbers behind words, as of places of the columns.
    let words = labels.iter().take_while(|label| **label == Label::Word).count();
    let is_named = (1..=HEADS).contains(&words)
        && words < rows.len()
        && labels[words..].iter().all(|label| *label == Label::Number)
        && (0..words).all(|row| correlation(rows[row].iter().copied().zip(rows[words].iter().copied())) < ALIKE);
    if words > 1 && is_named {
        return Some((0..rows.len()).map(|row| row < words).collect());
    }
    let again: Vec<bool> = (0..rows.len()).map(|row| rows[row] == *first && labels[row] == labels[0]).collect();
    let others = || (0..rows.len()).filter(|&row| !again[row]);
    let is_sorted = is_in_turn(first) && !others().any(|row| is_in_turn(&rows[row]));
    // Numbers of columns differ; counts of a frame often do not.
    let is_number = |row: usize| labels[row] == Label::Number;
    let differs = is_whole(first) && differ(first);
    let is_labelled = differs && !is_number(0) && others().all(is_number);
    let is_alone = differs && !others().any(|row| is_whole(&rows[row]));
    let is_unlike = |row: usize| correlation(first.iter().copied().zip(rows[row].iter().copied())) < ALIKE;
    let is_header = others().next().is_some_and(is_unlike)
        && !again.windows(2).any(|pair| pair[0] && pair[1])
        && (is_sorted || is_labelled || is_alone);
    is_header.then_some(again)
}

/// Whether all values are those of a count from 0 on.
fn is_whole(row: &[f64]) -> bool {
    row.len() >= FEWEST_NUMBERED && row.iter().all(|&value| value >= 0.0 && value.fract() == 0.0)
}

/// Whether no two values are the same.
fn differ(row: &[f64]) -> bool {
    let sorted = sorted(row.iter().copied());
    sorted.windows(2).all(|pair| pair[0] < pair[1])
}

/// Whether values are whole and each is larger than the one before, as the numbers of a sensor's taxels with gaps.
pub(super) fn ascends(row: &[f64]) -> bool {
    is_whole(row) && row.windows(2).all(|pair| pair[1] > pair[0])
}

/// Likewise in either direction.
fn is_in_turn(row: &[f64]) -> bool {
    ascends(row) || is_whole(row) && row.windows(2).all(|pair| pair[1] < pair[0])
}

/// What a value is worth in pascals by the unit of a header, and what is to be said of it; `sign` is that of what presses.
///
/// # Errors
///
/// What to do about a unit that is certainly no pressure.
pub(super) fn worth(unit: &str, target: &Target, sign: f64) -> Result<(Option<f64>, Option<String>), String> {
    let gives = format!("the header gives the unit {unit}");
    if let Some(what) = no_pressure(unit).filter(|_| !target.counts) {
        let [x, y] = target.sensor.pitch_mm;
        let remedy = match force_or_pressure(unit) {
            Some((newtons, _)) => format!(
                "to {}: pascals of 1 {unit} that presses on a taxel of {x} x {y} mm",
                rounded(-newtons / (1e-6 * x * y), 4)
            ),
            None => format!("or sensor.curve to what 1 {unit} is worth in pascals"),
        };
        return Err(format!("{gives}, {what}, and the design reads pascals: set sensor.pa_per_count {remedy}"));
    }
    Ok(match pascals(unit).map(|pascals| sign * pascals) {
        Some(pascals) if target.per_count.is_some_and(|own| (own / pascals.abs()).ln().abs() > OTHER_UNIT) => {
            let own = target.per_count.unwrap_or_default();
            (
                None,
                Some(format!(
                    "{gives}, and sensor.pa_per_count says {own} Pa: are values in that unit? Then give its pascals there"
                )),
            )
        }
        Some(_) if target.counts => (None, Some(format!("{gives}; the design says what a value is worth"))),
        None if target.counts => (None, None),
        None => (None, Some(format!("{gives}, which is no known pressure: values are read as pascals"))),
        Some(1.0) => (None, None),
        Some(pascals) => {
            let presses = if sign < 0.0 { "pressure presses, so that " } else { "" };
            (Some(pascals), Some(format!("{gives}; {presses}1 {unit} is {pascals} Pa")))
        }
    })
}

/// The unit that a line names: a known one, or else the word behind "unit".
pub(super) fn unit_in(line: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(line);
    let is_unit = |word: &&str| {
        let word = word.to_lowercase();
        word.starts_with("unit") || ["unit", "units"].iter().any(|end| word.ends_with(end)) || word.contains("einheit")
    };
    let mut words =
        text.split([' ', '\t', ':', '=', ',', ';', '"', '(', ')', '[', ']']).filter(|word| !word.is_empty());
    words.find(is_unit)?;
    let behind: Vec<&str> = words.collect();
    let unit = behind.iter().find(|word| pascals(word).is_some()).or(behind.first())?;
    Some(unit.replace(char::is_control, ""))
}
