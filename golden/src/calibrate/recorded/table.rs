//! Tables of what was measured beside the frames: forces, or the pressures of a bladder, read leniently.
//!
//! One line a frame. A header names the columns and their units; without one the number of columns tells. What is blank, a
//! dash or a NaN is unknown.

use std::path::Path;

use super::RecordedError;
use super::columns::{Meaning, meanings};
use crate::frames::{Array, Content, FrameError, Frames, content};
use crate::separator::{self, Marks, Separator, is_unknown};
use crate::units::timestamp;

/// Frames and forces must have this share of the frames' time in common.
const COMMON: f64 = 0.5;

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
        let common = frames.iter().filter(|time| (begin..=end).contains(*time)).count();
        if (common as f64) < COMMON * frames.len() as f64 {
            return Err(format!(
                "the frames' times go from {} to {} s, the forces' from {begin} to {end} s: give both the same clock and a unit \
                 in the header, or leave the columns of times out",
                frames[0],
                frames[frames.len() - 1]
            ));
        }
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
        remarks.push("forces and frames are paired by their times".to_owned());
        Ok(Self {
            forces: (0..frames.len()).map(|frame| force.each_ref().map(|axis| axis[frame])).collect(),
            pressures: value(&|line| self.pressures[line]),
            contacts: self.contacts.as_ref().map(contact),
            times: Some(frames.to_vec()),
            remarks,
        })
    }
}

/// A table as it is, before anybody knows what its columns mean.
struct Raw {
    names: Option<Vec<String>>,
    units: Option<Vec<String>>,
    /// Line number and fields.
    rows: Vec<(usize, Vec<String>)>,
    /// What separates the fields.
    separator: Separator,
}

/// Reads the forces of a file: columns `F_x`, `F_y`, `F_z`, of which any may be missing, in newtons unless the header
/// names another unit.
///
/// # Errors
///
/// [`RecordedError`] for a file that cannot be read, a column nobody can tell, and a value that is no number.
pub fn read_forces(path: &Path) -> Result<Measured, RecordedError> {
    read(path, "F_x,F_y,F_z", &|count, rising| match (count, rising) {
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
    read(path, "pressure (kPa)", &|count, rising| match (count, rising) {
        (1, _) => Some(vec![Some(Meaning::Pressure)]),
        (2, true) => Some(vec![None, Some(Meaning::Pressure)]),
        _ => None,
    })
}

type Guess = dyn Fn(usize, bool) -> Option<Vec<Option<Meaning>>>;

fn read(path: &Path, example: &str, guess: &Guess) -> Result<Measured, RecordedError> {
    let wrong = |problem: String, remedy: String| RecordedError::File { path: path.to_path_buf(), problem, remedy };
    let raw = raw(path)?;
    let columns = raw.rows.first().map_or(0, |(_, fields)| fields.len());
    if columns == 0 {
        return Err(wrong("no line of numbers in it".to_owned(), "write one line for each frame".to_owned()));
    }
    let mut remarks = Vec::new();
    let header = raw.names.as_ref().map(|names| meanings(names, raw.units.as_deref(), &mut remarks));
    let found = match header {
        Some(found) => found
            .map_err(|problem| wrong(problem, "name the unit: N, mN, kN, g, kg, Pa, kPa, mbar, bar, psi".to_owned()))?,
        None => Vec::new(),
    };
    let wanted = |meaning: Meaning| match guess(1, false) {
        Some(only) if only[0] == Some(Meaning::Pressure) => meaning == Meaning::Pressure,
        _ => matches!(meaning, Meaning::Force(_)),
    };
    let mut named: Vec<Option<(Meaning, f64)>> = found;
    if !named.iter().flatten().any(|&(meaning, _)| wanted(meaning)) {
        let rising = rises(&raw);
        let guessed = guess(columns, rising).filter(|_| raw.names.is_none() || columns == 1).ok_or_else(|| {
            let seen = raw.names.as_ref().map_or_else(
                || format!("{columns} columns without a header"),
                |names| format!("the columns {}", names.join(", ")),
            );
            wrong(format!("{seen}: nobody can tell what they are"), format!("write a header such as {example}"))
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
        remarks.push(format!("no header names the columns: from column {at} on they are taken for {what}"));
        if timestamp(&raw.rows[0].1[0]).is_some() {
            named[0] = Some((Meaning::Time, 1.0));
        }
    }
    if let Some(names) = &raw.names {
        refuse_more(&raw, names.len()).map_err(|(problem, remedy)| wrong(problem, remedy))?;
    }
    let contact = named.iter().position(|column| matches!(column, Some((Meaning::Contact, _))));
    let mut measured = Measured { remarks, ..Measured::default() };
    let (mut contacts, mut times) = (Vec::new(), Vec::new());
    let mut marks = Marks::default();
    for (line, fields) in &raw.rows {
        let (mut force, mut pressure, mut time) = ([None; 3], None, f64::NAN);
        for (column, told) in named.iter().enumerate() {
            let text = fields.get(column).map_or("", String::as_str);
            let &Some((meaning, unit)) = told else { continue };
            if meaning == Meaning::Contact || is_unknown(text) {
                continue;
            }
            // What is no number at all is refused below.
            let _ = marks.take(text.as_bytes(), raw.separator, [*line, column + 1]);
            let number = separator::number(text.as_bytes()).filter(|value| value.is_finite()).map(|value| unit * value);
            let stamp = || timestamp(text).filter(|_| meaning == Meaning::Time);
            let value = number.or_else(stamp).ok_or_else(|| FrameError::Value {
                path: path.to_path_buf(),
                line: *line,
                column: column + 1,
                text: text.chars().take(40).collect(),
                remedy: "leave blank what is unknown".to_owned(),
            })?;
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
        contacts.extend(contact.map(|column| fields.get(column).cloned().unwrap_or_default()));
    }
    if let Some(unclear) = marks.open() {
        return Err(FrameError::thousands(path, unclear).into());
    }
    measured.contacts = contact.map(|_| contacts);
    measured.times = times.iter().all(|time| time.is_finite()).then_some(times).filter(|times| !times.is_empty());
    Ok(measured)
}

/// Refuses a line with more values than the header has names: decimal commas look like separators.
fn refuse_more(raw: &Raw, names: usize) -> Result<(), (String, String)> {
    let filled = |fields: &[String]| fields.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
    let Some((line, fields)) = raw.rows.iter().find(|(_, fields)| filled(fields) > names) else { return Ok(()) };
    let plural = if names == 1 { "" } else { "s" };
    let remedy = match raw.separator {
        Separator::Byte(b',') => "are these decimal commas? Separate the values by semicolons, or write decimal points",
        _ => "name every column in the header",
    };
    let problem = format!("line {line}: {} values where the header has {names} name{plural}", filled(fields));
    Err((problem, remedy.to_owned()))
}

/// Whether a line of words is the name of one column, such as `normal force (N)`.
fn is_name(line: &str) -> bool {
    matches!(meanings(&[line.to_owned()], None, &mut Vec::new()).as_deref(), Ok([Some(_)]))
}

/// Whether the first column counts or tells the time.
fn rises(raw: &Raw) -> bool {
    let value = |text: &String| separator::number(text.as_bytes()).or_else(|| timestamp(text));
    let first: Vec<f64> = raw.rows.iter().filter_map(|(_, fields)| value(fields.first()?)).collect();
    first.len() == raw.rows.len() && first.len() > 1 && first.windows(2).all(|pair| pair[1] > pair[0])
}

fn raw(path: &Path) -> Result<Raw, RecordedError> {
    let bytes = match content(path)? {
        Content::Text(bytes) => bytes,
        Content::Array(Array { shape, values }) => {
            let columns = shape.get(1..).unwrap_or(&[]).iter().product::<usize>().max(1);
            let text = |value: &f64| if value.is_nan() { String::new() } else { format!("{value:?}") };
            let rows = values.chunks(columns).enumerate();
            let rows = rows.map(|(row, values)| (row + 1, values.iter().map(text).collect())).collect();
            return Ok(Raw { names: None, units: None, rows, separator: Separator::Spaces });
        }
    };
    let (mut heads, mut comments, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let mut separator = None;
    for (index, line) in separator::lines(&bytes).enumerate() {
        let content = line.trim_ascii();
        if content.is_empty() {
            // A file of one column may leave a line blank: the force is unknown.
            if separator.is_some_and(|_| !rows.is_empty()) {
                rows.push((index + 1, Vec::new()));
            }
            continue;
        }
        if content.len() == 5 && content[..4].eq_ignore_ascii_case(b"sep=") {
            separator = Some(Separator::Byte(content[4]));
            continue;
        }
        let is_comment = content.starts_with(b"#");
        let content = content.strip_prefix(b"#").unwrap_or(content).trim_ascii();
        let of_line = Separator::of(content);
        let split = |by: Separator| -> Vec<String> {
            // A blank cell beside a tab is a cell.
            by.split(if is_comment { content } else { by.trim(line) })
                .into_iter()
                .map(|field| String::from_utf8_lossy(field).trim().trim_matches('"').to_owned())
                .collect()
        };
        let words = || String::from_utf8_lossy(content).trim_matches('"').to_owned();
        if is_comment {
            comments = vec![(of_line, words())];
            continue;
        }
        // The header again, between logs that were put behind each other.
        if !rows.is_empty() && heads.first().is_some_and(|(_, head)| *head == words()) {
            continue;
        }
        let fields = split(*separator.get_or_insert(of_line));
        let number = |field: &String| field.replace(',', ".").parse::<f64>().is_ok_and(f64::is_finite);
        if rows.is_empty()
            && heads.len() < 2
            && !fields.iter().any(number)
            && fields.iter().any(|field| !field.is_empty())
            && !fields.iter().all(|field| is_unknown(field))
        {
            // What separates a header of words may be another character than what separates the numbers.
            heads.push((of_line, words()));
            separator = None;
            continue;
        }
        rows.push((index + 1, fields));
    }
    while rows.last().is_some_and(|(_, fields): &(usize, Vec<String>)| fields.is_empty()) {
        rows.pop();
    }
    let columns = rows.first().map_or(0, |(_, fields)| fields.len());
    if columns > 1 {
        // Blank lines between the lines of a table are nothing.
        rows.retain(|(_, fields)| !fields.is_empty());
    }
    // Of one column the whole line is the name, whatever is in it.
    let fields = |(separator, line): &(Separator, String)| -> Vec<String> {
        let is_one = *separator == Separator::Spaces && is_name(line);
        let parts = if columns == 1 || is_one { vec![line.as_bytes()] } else { separator.split(line.as_bytes()) };
        parts.iter().map(|field| String::from_utf8_lossy(field).trim().trim_matches('"').to_owned()).collect()
    };
    let mut heads = heads.iter().map(fields);
    let commented = || comments.first().map(fields).filter(|names| names.len() == columns);
    let names = heads.next().or_else(commented);
    Ok(Raw { names, units: heads.next(), rows, separator: separator.unwrap_or(Separator::Spaces) })
}
