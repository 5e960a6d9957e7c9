//! Force files: CSV with a header line, one frame a line, or `NumPy`'s `.npy` where the name ends so.
//!
//! [`columns`] names the values of a line, [`row`] and [`reference_row`] have them: the status word, the resultants and
//! what follows from them, and, where asked for, `f_x, f_y, f_z` in newtons for each taxel in turn. A file without a
//! header, or with the first eight columns alone, is read too.

use std::path::{Path, PathBuf};

use crate::frames::{self, FrameError};
use crate::metrics::Outcome;
use crate::output;
use crate::scene::SceneFrame;
use crate::solver::Solution;

/// Values on a line that a reader needs.
const NEEDED: usize = 8;
/// The columns before those of bodies and taxels: the status is a word of bits; forces are in newtons, torques in N m,
/// `phi` in radians.
const SUMMARY: [&str; 13] =
    ["status", "F_x", "F_y", "F_z", "mu", "phi", "mu_x", "mu_y", "T_x", "T_y", "T_z", "standard_error", "bodies"];

/// The names of the columns of a file with the forces of so many taxels.
pub fn columns(taxels: usize) -> Vec<String> {
    let summary = SUMMARY.into_iter().map(str::to_owned);
    summary.chain((0..taxels).flat_map(|taxel| ["x", "y", "z"].map(|axis| format!("taxel{taxel}_f_{axis}")))).collect()
}

/// A solution as a line, with the force field of each taxel if `with_field`.
pub fn row(solution: &Solution, with_field: bool) -> Vec<f64> {
    let [fx, fy, fz] = solution.resultant;
    let [tx, ty, tz] = solution.torque;
    let Solution { status, mu, phi, mu_x, mu_y, standard_error, bodies, .. } = solution;
    let summary = [fx, fy, fz, *mu, *phi, *mu_x, *mu_y, tx, ty, tz, *standard_error, *bodies as f64];
    let taxels = if with_field { solution.field[0].len() } else { 0 };
    let field = (0..taxels).flat_map(|taxel| solution.field.each_ref().map(|component| component[taxel]));
    std::iter::once(f64::from(status.0)).chain(summary).chain(field).collect()
}

/// The truth of a scene's frame in the form of a solution with status 0.
pub fn reference_row(frame: &SceneFrame) -> Vec<f64> {
    let ([fx, fy, fz], [tx, ty, tz]) = (frame.force, frame.torque);
    let normal = fz.abs();
    let bodies = frame.bodies as f64;
    vec![0.0, fx, fy, fz, frame.friction, frame.direction, fx / normal, fy / normal, tx, ty, tz, 0.0, bodies]
}

/// Writes solutions, with the force field of each taxel if `with_field`, the whole file or nothing.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_solutions(path: &Path, solutions: &[Solution], with_field: bool) -> Result<(), FrameError> {
    let taxels = solutions.first().map_or(0, |solution| solution.field[0].len());
    let rows = solutions.iter().map(|solution| row(solution, with_field));
    write(path, &columns(if with_field { taxels } else { 0 }), rows)
}

/// Writes the true forces of scene frames, in the form of solutions with status 0.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_reference(path: &Path, frames: &[SceneFrame]) -> Result<(), FrameError> {
    write(path, &columns(0), frames.iter().map(reference_row))
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
    frames::push_row(text, row.iter().skip(1).copied());
}

/// Reads the resultants, friction and direction of a force file of `frames` lines.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for a line that is too short or holds something else than finite
/// numbers, and for a file with another number of lines.
pub fn read_outcomes(path: &Path, frames: usize) -> Result<Vec<Outcome>, FrameError> {
    let rows = frames::read_rows(path, |found| (found < NEEDED).then_some(NEEDED))?;
    if rows.len() != frames {
        return Err(FrameError::Count { path: path.to_path_buf(), found: rows.len(), expected: frames });
    }
    Ok(rows
        .iter()
        .map(|row| Outcome { force: [row[1], row[2], row[3]], friction: row[4], direction: row[5] })
        .collect())
}

/// The place of the reference forces of a frame file: `frames.csv` has them in `frames.forces.csv`, `frames.npy` in
/// `frames.forces.npy`.
pub fn reference_path(frames: &Path) -> PathBuf {
    frames.with_extension(if frames::is_npy(frames) { "forces.npy" } else { "forces.csv" })
}
