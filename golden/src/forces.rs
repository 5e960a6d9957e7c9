//! Force files: CSV with a header line, one frame a line, or `NumPy`'s `.npy` where the name ends so.
//!
//! [`columns`] names the values of a line, [`row`] and [`reference_row`] have them: the status word, the resultants and
//! what follows from them, the records and torques of contacts where there may be several. Where asked for, `f_x, f_y, f_z`
//! in newtons of each taxel follow. A file without a header, or with the first eight columns alone, is read too.

use std::path::{Path, PathBuf};

use crate::calibrate::recorded::{self, Measured};
use crate::contacts::{ContactForces, MOST};
use crate::frames::{self, FrameError, Numbers, Table};
use crate::geometry::{self, GeometryError};
use crate::metrics::Outcome;
use crate::numbers::push_row;
use crate::output;
use crate::scene::SceneFrame;
use crate::sensor::Sensor;
use crate::solver::{Solution, Status};

/// Values on a line that a reader needs.
const NEEDED: usize = 8;
/// How the columns of a contact begin, before its number from 1.
const CONTACT: &str = "contact";
/// The columns before those of contacts and taxels: the status is a word of bits; forces are in newtons, torques in N m,
/// `phi` in radians.
const SUMMARY: [&str; 13] =
    ["status", "F_x", "F_y", "F_z", "mu", "phi", "mu_x", "mu_y", "T_x", "T_y", "T_z", "standard_error", "contacts"];

/// The columns of each contact, as in `contact1_taxels`: a word of bits as above, its centre in metres from the first
/// taxel.
pub const OF_CONTACT: [&str; 9] = ["taxels", "status", "x", "y", "F_x", "F_y", "F_z", "mu", "standard_error"];
/// Behind those of all contacts each one's torque, in N m as the frame's.
pub const TORQUE_OF_CONTACT: [&str; 3] = ["T_x", "T_y", "T_z"];

/// A column with its unit, as a header has it: `F_x (N)`; the status, numbers of things and friction have none.
fn with_unit(name: String) -> String {
    let owned = name.split_once('_').filter(|(owner, _)| owner.starts_with(CONTACT) || owner.starts_with("taxel"));
    let unit = match owned.map_or(&*name, |(_, quantity)| quantity) {
        "phi" => "rad",
        "x" | "y" => "m",
        "standard_error" => "N",
        quantity if quantity.starts_with("F_") || quantity.starts_with("f_") => "N",
        quantity if quantity.starts_with("T_") => "N m",
        _ => return name,
    };
    format!("{name} ({unit})")
}

/// The names of the columns, with units, of a file with so many records of contacts and the forces of so many taxels.
pub fn columns(records: usize, taxels: usize) -> Vec<String> {
    let summary = SUMMARY.into_iter().map(str::to_owned);
    let of = |number, names: &[&str]| names.iter().map(|name| format!("{CONTACT}{number}_{name}")).collect::<Vec<_>>();
    let summary = summary.chain((1..=records).flat_map(|number| of(number, &OF_CONTACT)));
    let summary = summary.chain((1..=records).flat_map(|number| of(number, &TORQUE_OF_CONTACT)));
    summary
        .chain((0..taxels).flat_map(|taxel| ["x", "y", "z"].map(|axis| format!("taxel{taxel}_f_{axis}"))))
        .map(with_unit)
        .collect()
}

/// A contact as its columns, but for the torque.
pub fn record(contact: &ContactForces) -> [f64; 9] {
    let ContactForces { taxels, status, centre_m: [x, y], force: [fx, fy, fz], mu, standard_error, .. } = *contact;
    [taxels as f64, f64::from(status.0), x, y, fx, fy, fz, mu, standard_error]
}

/// A solution as a line, with its records of contacts, and with the force field of each taxel if `with_field`.
pub fn row(solution: &Solution, with_field: bool) -> Vec<f64> {
    let [fx, fy, fz] = solution.resultant;
    let [tx, ty, tz] = solution.torque;
    let Solution { status, mu, phi, mu_x, mu_y, standard_error, contacts, .. } = solution;
    let summary = [fx, fy, fz, *mu, *phi, *mu_x, *mu_y, tx, ty, tz, *standard_error, *contacts as f64];
    let taxels = if with_field { solution.field[0].len() } else { 0 };
    let field = (0..taxels).flat_map(|taxel| solution.field.each_ref().map(|component| component[taxel]));
    let contacts = of_contacts(&solution.records);
    std::iter::once(f64::from(status.0)).chain(summary).chain(contacts).chain(field).collect()
}

/// Contacts as their columns: all records, then all torques.
fn of_contacts(contacts: &[ContactForces]) -> impl Iterator<Item = f64> {
    contacts.iter().flat_map(record).chain(contacts.iter().flat_map(|contact| contact.torque))
}

/// The truth of a scene's frame in the form of a solution with status 0, with a record of each contact if there are several.
pub fn reference_row(frame: &SceneFrame) -> Vec<f64> {
    let ([fx, fy, fz], [tx, ty, tz]) = (frame.force, frame.torque);
    let normal = fz.abs();
    let contacts = frame.contacts.len() as f64;
    let mut row =
        vec![0.0, fx, fy, fz, frame.friction, frame.direction, fx / normal, fy / normal, tx, ty, tz, 0.0, contacts];
    row.extend(of_contacts(&frame.contacts[..records_of(frame)]));
    row
}

/// Records of a scene's frame: one of each contact, and none of a single one.
fn records_of(frame: &SceneFrame) -> usize {
    if frame.contacts.len() > 1 { frame.contacts.len() } else { 0 }
}

/// Writes solutions, with the force field of each taxel if `with_field`, the whole file or nothing.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_solutions(path: &Path, solutions: &[Solution], with_field: bool) -> Result<(), FrameError> {
    let taxels = solutions.first().map_or(0, |solution| solution.field[0].len());
    let rows = solutions.iter().map(|solution| row(solution, with_field));
    let records = solutions.first().map_or(0, |solution| solution.records.len());
    write(path, &columns(records, if with_field { taxels } else { 0 }), rows)
}

/// Writes the true forces of scene frames, in the form of solutions with status 0.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_reference(path: &Path, frames: &[SceneFrame]) -> Result<(), FrameError> {
    let records = frames.first().map_or(0, records_of);
    write(path, &columns(records, 0), frames.iter().map(reference_row))
}

/// Writes lines of equal length, as `NumPy` does where the name ends in `.npy`, else as CSV.
fn write(path: &Path, columns: &[String], rows: impl Iterator<Item = Vec<f64>>) -> Result<(), FrameError> {
    if frames::is_npy(path) {
        return frames::write_array(path, columns.len(), &rows.collect::<Vec<_>>());
    }
    let mut text = columns.join(",");
    text.push('\n');
    for row in rows {
        push_line(&mut text, &row);
    }
    output::write_whole(path, text.as_bytes())?;
    Ok(())
}

/// Appends a line of a force file.
pub fn push_line(text: &mut String, row: &[f64]) {
    // A status is a word of bits, so it is written without a point.
    text.push_str(&(row[0] as u32).to_string());
    text.push(',');
    push_row(text, row.iter().skip(1).copied());
}

/// Reads the resultants, friction and direction of a force file of `frames` lines: one of [`row`], or any table of measured
/// `F_x`, `F_y` and `F_z` that [`recorded::read_forces`] reads, where a positive `F_z` presses if most are positive.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for a line that is too short or holds something else than finite
/// numbers, for a file with another number of lines, and for one of something else.
pub fn read_outcomes(path: &Path, frames: usize) -> Result<Vec<Outcome>, FrameError> {
    let text = frames::text(path)?;
    let table = recorded::table(path, &text)?;
    let own = own_rows(path, &table, frames);
    let is_named = table.names.first().is_some_and(|name| !name.starts_with("status"));
    if is_named || matches!(own, Err(FrameError::Length { .. })) {
        match (recorded::forces(path, &table), &own) {
            (Err(_), Err(_)) => {}
            (Err(error), Ok(_)) => return Err(unusable(path, 1, &error.to_string())),
            (Ok(measured), _) => match measured_outcomes(path, frames, &measured) {
                Err(_) if own.is_err() && !is_named => {}
                outcomes => return outcomes,
            },
        }
    }
    Ok(own?
        .iter()
        .map(|row| Outcome { force: [row[1], row[2], row[3]], friction: row[4], direction: row[5] })
        .collect())
}

/// An error of forces that errors cannot be taken against.
fn unusable(path: &Path, line: usize, problem: &str) -> FrameError {
    let remedy = "true forces lie beside the frames of `sptfra scene`, in FRAMES.forces.csv, a line each that begins with \
                  status, F_x, F_y, F_z, mu and phi";
    FrameError::line(path, line, format_args!("{problem}, so errors cannot be computed; {remedy}"))
}

/// The same of a table of measured forces.
fn measured_outcomes(path: &Path, frames: usize, measured: &Measured) -> Result<Vec<Outcome>, FrameError> {
    if measured.forces.len() != frames {
        let found = measured.forces.len();
        return Err(FrameError::Count { path: path.to_path_buf(), found, expected: frames });
    }
    let sign = if measured.forces.iter().filter_map(|force| force[2]).sum::<f64>() > 0.0 { -1.0 } else { 1.0 };
    let outcome = |(line, force): (usize, &[Option<f64>; 3])| match *force {
        [Some(x), Some(y), Some(z)] => {
            let tangential = x.hypot(y);
            let friction = if tangential > 0.0 { tangential / z.abs().max(f64::MIN_POSITIVE) } else { 0.0 };
            Ok(Outcome { force: [x, y, sign * z], friction, direction: y.atan2(x) })
        }
        _ => Err(unusable(path, line + 1, "F_x, F_y or F_z is not known")),
    };
    measured.forces.iter().enumerate().map(outcome).collect()
}

/// Reads the contacts of a force file of `frames` lines, of each line those that there are. Nothing if the file does not
/// separate them: it has no records, and more contacts than one.
///
/// In a file of text the names of the columns say how many records there are; a `.npy` file has no field then. A file without
/// the torque of each contact is read too.
///
/// # Errors
///
/// As [`read_outcomes`].
pub fn read_contacts(
    path: &Path,
    frames: usize,
    sensor: &Sensor,
) -> Result<Option<Vec<Vec<ContactForces>>>, FrameError> {
    let text = frames::text(path)?;
    let table = recorded::table(path, &text)?;
    let rows = own_rows(path, &table, frames)?;
    let (records, torques) = if table.names.is_empty() {
        let more = rows.first().map_or(0, |row| row.len().saturating_sub(SUMMARY.len()));
        let all = OF_CONTACT.len() + TORQUE_OF_CONTACT.len();
        match [more / all, more / OF_CONTACT.len()] {
            [records, _] if more == records * all && records <= MOST => (records, records),
            [_, records] if more == records * OF_CONTACT.len() && records <= MOST => (records, 0),
            _ => (0, 0),
        }
    } else {
        let of_contacts = || table.names.iter().filter_map(|name| name.strip_prefix(CONTACT));
        let count =
            |of: &str| of_contacts().filter(|name| name.split(' ').next().unwrap_or(name).ends_with(of)).count();
        (count("_F_z"), count("_T_z"))
    };
    let contacts = |row: &Vec<f64>| match row.get(SUMMARY.len()..) {
        Some(rest) if records > 0 => {
            let mut contacts: Vec<ContactForces> = rest.as_chunks::<9>().0.iter().take(records).map(contact).collect();
            let behind = rest.get(records * OF_CONTACT.len()..).unwrap_or_default();
            for (contact, torque) in contacts.iter_mut().zip(behind.as_chunks::<3>().0.iter().take(torques)) {
                contact.torque = *torque;
            }
            contacts.retain(|contact| *contact != ContactForces::default());
            Some(contacts)
        }
        Some(_) if row[SUMMARY.len() - 1] <= 1.0 => {
            let (force, torque) = ([row[1], row[2], row[3]], [row[8], row[9], row[10]]);
            let centre_m = ContactForces::centre_of(sensor, force, torque);
            Some(vec![ContactForces { centre_m, force, torque, mu: row[4], ..ContactForces::default() }])
        }
        _ => None,
    };
    Ok(rows.iter().map(contacts).collect())
}

/// The contact of a record's columns.
fn contact(&[taxels, status, x, y, fx, fy, fz, mu, standard_error]: &[f64; 9]) -> ContactForces {
    let (taxels, status) = (taxels as usize, Status(status as u32));
    ContactForces {
        taxels,
        status,
        centre_m: [x, y],
        force: [fx, fy, fz],
        mu,
        standard_error,
        ..ContactForces::default()
    }
}

/// The rows of a force file, each long enough.
fn own_rows(path: &Path, table: &Table<'_>, frames: usize) -> Result<Vec<Vec<f64>>, FrameError> {
    if table.names.iter().any(|name| name.contains("body0_")) {
        let what =
            "a force file of an older version, whose columns body0_taxels, body0_status … number contacts from 0";
        let remedy = "rename these columns contact1_taxels, contact1_status …, numbered from 1, or write the file anew";
        return Err(FrameError::format(path, what, remedy));
    }
    let mut numbers = Numbers::new(path);
    let mut row = |&(line, ref cells): &(usize, Vec<&[u8]>)| -> Result<Vec<f64>, FrameError> {
        let found = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
        let mut row = Vec::with_capacity(found);
        for (index, cell) in cells[..found].iter().enumerate() {
            let place = [line, index + 1];
            let number = numbers.of(cell, table.separator, place)?.filter(|number| number.is_finite());
            let wrong = || FrameError::value(path, place, cell, "give a number in newtons or radians");
            row.push(number.ok_or_else(wrong)?);
        }
        if found < NEEDED {
            let hint = "give a line of forces for each frame".to_owned();
            return Err(FrameError::Length { path: path.to_path_buf(), line, found, expected: NEEDED, hint });
        }
        Ok(row)
    };
    let rows = table.rows.iter().map(&mut row).collect::<Result<Vec<_>, _>>()?;
    numbers.end()?;
    if rows.len() != frames {
        return Err(FrameError::Count { path: path.to_path_buf(), found: rows.len(), expected: frames });
    }
    match rows.iter().enumerate().find_map(|(index, row)| Some((index, no_forces(row)?))) {
        Some((index, problem)) => Err(unusable(path, index + 1, &problem)),
        None => Ok(rows),
    }
}

/// What no row of forces can have: frames are taken for forces else, and every error is one of thousands of percent.
fn no_forces(row: &[f64]) -> Option<String> {
    let (status, mu, phi) = (row[0], row[4], row[5]);
    if status.fract() != 0.0 || !(0.0..=f64::from(u16::MAX)).contains(&status) {
        return Some(format!("the first value, {status}, is no status of 16 bits"));
    }
    if mu < 0.0 {
        return Some(format!("the friction, {mu}, is negative"));
    }
    // Written with nine digits.
    (phi.abs() > std::f64::consts::PI + 1e-6).then(|| format!("the direction, {phi}, is no angle in radians"))
}

/// Compares the sensor of the frames whose reference forces these are, if it is known, with a design's. The message names
/// the forces, which is what was given.
///
/// # Errors
///
/// [`GeometryError`], as [`geometry::compare`].
pub fn compare_sensor(reference: &Path, design_name: &str, design: &Sensor) -> Result<(), GeometryError> {
    // `frames.forces.csv` has its sensor beside `frames.csv`.
    let beside = geometry::beside(&reference.with_extension(""));
    geometry::compare_beside(reference, &beside, design_name, design)
}

/// The place of the reference forces of a frame file: `frames.csv` has them in `frames.forces.csv`, `frames.npy` in
/// `frames.forces.npy`.
pub fn reference_path(frames: &Path) -> PathBuf {
    frames.with_extension(if frames::is_npy(frames) { "forces.npy" } else { "forces.csv" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_of_another_sensor_are_named_as_they_were_given() {
        let sensor = Sensor { columns: 10, rows: 7, pitch_mm: [4.0, 2.0], depth_mm: 3.0 };
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("h.sensor.toml"), geometry::to_toml(&sensor)).expect("writable");
        let forces = folder.path().join("h.forces.csv");
        assert!(compare_sensor(&forces, "pad", &sensor).is_ok());
        let other = compare_sensor(&forces, "pad", &Sensor { rows: 8, ..sensor }).expect_err("another sensor");
        assert!(other.to_string().starts_with(&format!("{}: the frames belong to", forces.display())), "{other}");
    }
}
