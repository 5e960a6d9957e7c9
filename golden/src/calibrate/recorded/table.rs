//! Tables of what was measured beside the frames: forces, or the pressures of a bladder, read leniently.
//!
//! One line a frame. A header names the columns and their units; without one the number of columns tells. What is blank, a
//! dash or a NaN is unknown.

use std::path::Path;

use super::RecordedError;
use super::columns::{Meaning, meanings};
use crate::frames::{FrameError, Frames, NO_TIME, Numbers, Table, between, text};
use crate::numbers::counted;
use crate::separator::{self, Separator, is_unknown};
use crate::units::{timestamp, without_gaps};

/// Frames and forces must have this share of the frames' time in common.
const COMMON: f64 = 0.5;
/// Clocks that begin within so many seconds from 0 may be those of each log alone.
const BEGINS: f64 = 0.1;

/// How measured lines belong to frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// One for one, in turn.
    #[default]
    Lines,
    /// By the times of one clock.
    Clock,
    /// By times that may count from the beginning of each log.
    Clocks,
    /// By times of clocks that differ, which were set to begin together.
    Apart,
}

/// What was measured, frame by frame: forces and pressures have an entry for each, known or not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// `[F_x, F_y, F_z]` in newtons, as far as known, with the signs of the file.
    pub forces: Vec<[Option<f64>; 3]>,
    /// Pressure in pascals.
    pub pressures: Vec<Option<f64>>,
    /// The name of the contact, where a column has one.
    pub contacts: Option<Vec<String>>,
    /// The time of each line in seconds, where a column has it.
    pub times: Option<Vec<f64>>,
    /// How its lines belong to the frames.
    pub pairing: Pairing,
    /// What was taken for what.
    pub remarks: Vec<String>,
}

impl Measured {
    /// Forces `[F_x, F_y, F_z]` in newtons of each frame, as far as they are known.
    pub fn of_forces(forces: Vec<[Option<f64>; 3]>) -> Self {
        Self { pressures: vec![None; forces.len()], forces, ..Self::default() }
    }

    /// The pressure in pascals of each frame, where it is known.
    pub fn of_pressures(pressures: Vec<Option<f64>>) -> Self {
        Self { forces: vec![[None; 3]; pressures.len()], pressures, ..Self::default() }
    }

    /// What was measured with these frames, without the lines of those that were left out.
    #[must_use]
    pub fn without_skipped(self, frames: &Frames) -> Self {
        Self {
            forces: frames.kept(self.forces),
            pressures: frames.kept(self.pressures),
            contacts: self.contacts.map(|names| frames.kept(names)),
            times: self.times.map(|times| frames.kept(times)),
            pairing: self.pairing,
            remarks: self.remarks,
        }
    }

    /// What was measured at the times of the frames, in seconds: between two lines a straight line, beyond the first and the
    /// last nothing. Without times of its own it stays as it is.
    ///
    /// # Errors
    ///
    /// What is wrong with times that fall, or that have less than half of the frames' in common with them.
    pub fn at(&self, frames: &[f64]) -> Result<Self, String> {
        let Some(times) = &self.times else { return Ok(self.clone()) };
        let falls = |times: &[f64]| times.windows(2).any(|pair| pair[1] < pair[0]);
        if falls(frames) || falls(times) || times.is_empty() {
            return Err("times fall from one line to the next: leave their column out, or sort the lines".to_owned());
        }
        let (begin, end) = (times[0], times[times.len() - 1]);
        let is_enough = |ahead: f64| {
            let common = frames.iter().filter(|&&time| (begin..=end).contains(&(time + ahead))).count();
            common as f64 >= COMMON * frames.len() as f64
        };
        let ahead = begin - frames[0];
        let are_apart = !is_enough(0.0);
        if are_apart && !is_enough(ahead) {
            return Err(format!(
                "the frames' times go from {} to {} s, the other file's from {begin} to {end} s: give both the same clock and a unit \
                 in the header, or leave the columns of times out",
                frames[0],
                frames[frames.len() - 1]
            ));
        }
        // Differences of what begins in 1970 lose digits that no log has.
        let times: &Vec<f64> = &times.iter().map(|time| if are_apart { time - ahead } else { *time }).collect();
        let lines: Vec<Option<(usize, f64)>> = frames
            .iter()
            .map(|&time| {
                let next = times.partition_point(|&other| other < time);
                match (times.get(next), next.checked_sub(1)) {
                    (Some(&at), Some(before)) if at > time => {
                        Some((before, (time - times[before]) / (at - times[before])))
                    }
                    (Some(&at), _) if at.total_cmp(&time).is_eq() => Some((next, 0.0)),
                    _ => None,
                }
            })
            .collect();
        let value = |of: &dyn Fn(usize) -> Option<f64>| -> Vec<Option<f64>> {
            let between = |&(line, share): &(usize, f64)| match share {
                0.0 => of(line),
                share => Some((1.0 - share) * of(line)? + share * of(line + 1)?),
            };
            lines.iter().map(|line| line.as_ref().and_then(between)).collect()
        };
        let force = [0, 1, 2].map(|axis| value(&|line| self.forces[line][axis]));
        let nearest = |(line, share): (usize, f64)| line + usize::from(share > 0.5);
        let contact = |names: &Vec<String>| {
            lines.iter().map(|line| line.map_or(String::new(), |line| names[nearest(line)].clone())).collect()
        };
        let mut remarks = self.remarks.clone();
        remarks.push(if are_apart {
            format!("the clocks of frames and of what was measured differ by about {ahead:.1} s: both are set to begin together")
        } else {
            "frames are paired by their times with what was measured".to_owned()
        });
        Ok(Self {
            forces: (0..frames.len()).map(|frame| force.each_ref().map(|axis| axis[frame])).collect(),
            pressures: value(&|line| self.pressures[line]),
            contacts: self.contacts.as_ref().map(contact),
            times: Some(frames.to_vec()),
            pairing: match frames[0].abs().max(begin.abs()) {
                _ if are_apart => Pairing::Apart,
                begin if begin < BEGINS => Pairing::Clocks,
                _ => Pairing::Clock,
            },
            remarks,
        })
    }
}

/// Reads the forces of a file: columns `F_x`, `F_y`, `F_z`, of which any may be missing, in newtons unless the header
/// names another unit.
///
/// # Errors
///
/// [`RecordedError`] for a file that cannot be read, a column nobody can tell, and a value that is no number.
pub fn read_forces(path: &Path) -> Result<Measured, RecordedError> {
    forces(path, &table(path, &text(path)?)?)
}

/// The same of a table.
pub(crate) fn forces(path: &Path, table: &Table<'_>) -> Result<Measured, RecordedError> {
    read(path, table, "F_x,F_y,F_z", &|count, rising| match (count, rising) {
        (1, _) => Some(vec![Some(Meaning::Force(2))]),
        (2, true) => Some(vec![None, Some(Meaning::Force(2))]),
        (3, _) => Some((0..3).map(|axis| Some(Meaning::Force(axis))).collect()),
        (4, true) => Some([None].into_iter().chain((0..3).map(|axis| Some(Meaning::Force(axis)))).collect()),
        // As `sptfra solve` writes them.
        (8.., _) => {
            Some((0..count).map(|column| (1..4).contains(&column).then(|| Meaning::Force(column - 1))).collect())
        }
        _ => None,
    })
}

/// Reads the pressures of a file, in pascals unless the header names another unit.
///
/// # Errors
///
/// As [`read_forces`].
pub fn read_pressures(path: &Path) -> Result<Measured, RecordedError> {
    read(path, &table(path, &text(path)?)?, "pressure (kPa)", &|count, rising| match (count, rising) {
        (1, _) => Some(vec![Some(Meaning::Pressure)]),
        (2, true) => Some(vec![None, Some(Meaning::Pressure)]),
        _ => None,
    })
}

type Guess = dyn Fn(usize, bool) -> Option<Vec<Option<Meaning>>>;

/// The table of a text of measured values.
///
/// # Errors
///
/// As [`Table::of`].
pub(crate) fn table<'a>(path: &Path, text: &'a [u8]) -> Result<Table<'a>, FrameError> {
    // Such as `normal force (N)`.
    let is_name = |line: &str| matches!(meanings(&[line.to_owned()], &mut Vec::new()).as_deref(), Ok([Some(_)]));
    Table::of(path, text, is_name)
}

fn read(path: &Path, table: &Table<'_>, example: &str, guess: &Guess) -> Result<Measured, RecordedError> {
    let wrong = |problem: String, remedy: String| RecordedError::of(path.display(), (problem, remedy));
    let columns = table.rows.first().map_or(0, |(_, fields)| fields.len());
    if columns == 0 {
        return Err(wrong("no line of numbers in it".to_owned(), "write one line for each frame".to_owned()));
    }
    let mut remarks = Vec::new();
    let mut named = meanings(&table.names, &mut remarks)
        .map_err(|problem| wrong(problem, "name the unit: N, mN, kN, g, kg, Pa, kPa, mbar, bar, psi".to_owned()))?;
    let wanted = |meaning: Meaning| match guess(1, false) {
        Some(only) if only[0] == Some(Meaning::Pressure) => meaning == Meaning::Pressure,
        _ => matches!(meaning, Meaning::Force(_)),
    };
    if !named.iter().flatten().any(|&(meaning, _)| wanted(meaning)) {
        let may_be_decimals = table.names.is_empty() && may_be_decimals(table);
        let is_open = columns == 1 || table.names.is_empty() && !may_be_decimals;
        let guessed = guess(columns, rises(table)).filter(|_| is_open).ok_or_else(|| {
            let seen = match table.names[..] {
                [] => format!("{} without a header", counted(columns, "column")),
                _ => format!("the columns {}", table.names.join(", ")),
            };
            let (asked, points) = if may_be_decimals {
                (", unless the commas are decimal ones", "decimal points, or ")
            } else {
                ("", "")
            };
            wrong(
                format!("{seen}: nobody can tell what they are{asked}"),
                format!("write {points}a header such as {example}"),
            )
        })?;
        named = guessed.into_iter().map(|meaning| meaning.map(|meaning| (meaning, 1.0))).collect();
        let what = if named.iter().flatten().any(|&(meaning, _)| meaning == Meaning::Pressure) {
            "a pressure in pascals"
        } else if named.iter().flatten().count() == 1 {
            "F_z in newtons"
        } else {
            "F_x, F_y and F_z in newtons"
        };
        let at = named.iter().position(Option::is_some).unwrap_or(0) + 1;
        remarks.push(match &table.names[..] {
            [] => format!("no header names the columns: from column {at} on they are taken for {what}"),
            names => {
                format!("the header names neither quantity nor unit, {}: it is taken for {what}", names.join(", "))
            }
        });
        if timestamp(&String::from_utf8_lossy(table.rows[0].1[0])).is_some() {
            named[0] = Some((Meaning::Time, 1.0));
        }
    }
    refuse_more(table).map_err(|(problem, remedy)| wrong(problem, remedy))?;
    let contact = named.iter().position(|column| matches!(column, Some((Meaning::Contact, _))));
    let mut measured = Measured { remarks, ..Measured::default() };
    let (mut contacts, mut times) = (Vec::new(), Vec::new());
    let mut numbers = Numbers::new(path);
    for (line, fields) in &table.rows {
        let (mut force, mut pressure, mut time) = ([None; 3], None, f64::NAN);
        let cell = |column: usize| fields.get(column).copied().unwrap_or_default();
        let text = |column: usize| String::from_utf8_lossy(cell(column));
        for (column, told) in named.iter().enumerate() {
            let &Some((meaning, unit)) = told else { continue };
            if meaning == Meaning::Contact || is_unknown(&text(column)) {
                continue;
            }
            let place = [*line, column + 1];
            let number = numbers.of(cell(column), table.separator, place)?;
            let number = number.filter(|value| value.is_finite()).map(|value| unit * value);
            let stamp = || timestamp(&text(column)).filter(|_| meaning == Meaning::Time);
            let wrong = || FrameError::value(path, place, cell(column), "leave blank what is unknown");
            let value = number.or_else(stamp).ok_or_else(wrong)?;
            match meaning {
                Meaning::Force(axis) => force[axis] = Some(value),
                Meaning::Pressure => pressure = Some(value),
                Meaning::Time => time = value,
                Meaning::Contact => {}
            }
        }
        times.push(time);
        measured.forces.push(force);
        measured.pressures.push(pressure);
        contacts.extend(contact.map(|column| text(column).into_owned()));
    }
    numbers.end()?;
    measured.contacts = contact.map(|_| contacts);
    let times = without_gaps(times).map_err(|place| FrameError::line(path, table.rows[place].0, NO_TIME))?;
    if let Some((_, unknown)) = times.as_ref().filter(|(_, unknown)| *unknown > 0) {
        measured.remarks.push(format!("{}: {}", path.display(), between(*unknown)));
    }
    measured.times = times.map(|(times, _)| times);
    Ok(measured)
}

/// Refuses a line with more values than the header has names: decimal commas look like separators.
fn refuse_more(table: &Table<'_>) -> Result<(), (String, String)> {
    let names = table.names.len();
    let filled = |fields: &[&[u8]]| fields.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
    let more = table.rows.iter().find(|(_, fields)| names > 0 && filled(fields) > names);
    let Some((line, fields)) = more else { return Ok(()) };
    let remedy = match table.separator {
        Separator::Byte(b',') => "are these decimal commas? Separate the values by semicolons, or write decimal points",
        _ => "name every column in the header",
    };
    let problem = format!("line {line}: {} values where the header has {}", filled(fields), counted(names, "name"));
    Err((problem, remedy.to_owned()))
}

/// Whether two columns may be one of numbers with decimal commas. The first column of a table is one of times or numbers if
/// its steps are equal.
fn may_be_decimals(table: &Table<'_>) -> bool {
    let is_whole = |cell: &[u8]| !cell.is_empty() && cell.iter().all(u8::is_ascii_digit);
    let halves = |(_, row): &(usize, Vec<&[u8]>)| match row[..] {
        [before, after] if is_whole(after) && is_whole(before.strip_prefix(b"-").unwrap_or(before)) => {
            separator::number(before)
        }
        _ => None,
    };
    let Some(first) = table.rows.iter().map(halves).collect::<Option<Vec<f64>>>() else { return false };
    let mut steps = first.windows(2).map(|pair| pair[1] - pair[0]);
    let step = steps.next();
    table.separator == Separator::Byte(b',') && (step.is_none() || steps.any(|other| Some(other) != step))
}

/// Whether the first column counts or tells the time.
fn rises(table: &Table<'_>) -> bool {
    let value = |text: &[u8]| separator::number(text).or_else(|| timestamp(&String::from_utf8_lossy(text)));
    let first: Vec<f64> = table.rows.iter().filter_map(|(_, fields)| value(fields.first()?)).collect();
    first.len() == table.rows.len() && first.len() > 1 && first.windows(2).all(|pair| pair[1] > pair[0])
}
