//! Force files: CSV without a header, one frame a line, or `NumPy`'s `.npy` where the name ends so.
//!
//! A line has the status word, `F_x, F_y, F_z` in newtons, `mu`, `phi` in radians, `mu_x`, `mu_y`, and, where asked
//! for, `f_x, f_y, f_z` in newtons for each taxel in turn.

use std::path::{Path, PathBuf};

use crate::frames::{self, FrameError};
use crate::metrics::Outcome;
use crate::output;
use crate::scene::SceneFrame;
use crate::solver::Solution;

/// Values on a line before the field.
const SUMMARY: usize = 8;

/// Writes solutions, with the force field of each taxel if `with_field`, the whole file or nothing.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_solutions(path: &Path, solutions: &[Solution], with_field: bool) -> Result<(), FrameError> {
    let row = |solution: &Solution| {
        let taxels = if with_field { solution.field[0].len() } else { 0 };
        let field = (0..taxels).flat_map(|taxel| solution.field.each_ref().map(|component| component[taxel]));
        let [fx, fy, fz] = solution.resultant;
        let summary = [fx, fy, fz, solution.mu, solution.phi, solution.mu_x, solution.mu_y];
        line(solution.status.0, summary, field)
    };
    write(path, &solutions.iter().map(row).collect::<Vec<_>>())
}

/// Writes the true forces of scene frames, in the form of solutions with status 0.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_reference(path: &Path, frames: &[SceneFrame]) -> Result<(), FrameError> {
    let row = |frame: &SceneFrame| {
        let [fx, fy, fz] = frame.force;
        let normal = fz.abs();
        let summary = [fx, fy, fz, frame.friction, frame.direction, fx / normal, fy / normal];
        line(0, summary, std::iter::empty())
    };
    write(path, &frames.iter().map(row).collect::<Vec<_>>())
}

/// The values of a line.
fn line(status: u32, summary: [f64; SUMMARY - 1], field: impl Iterator<Item = f64>) -> Vec<f64> {
    std::iter::once(f64::from(status)).chain(summary).chain(field).collect()
}

/// Writes lines of equal length, as `NumPy` does where the name ends in `.npy`, else as CSV.
fn write(path: &Path, lines: &[Vec<f64>]) -> Result<(), FrameError> {
    if frames::is_npy(path) {
        return frames::write_array(path, lines.first().map_or(SUMMARY, Vec::len), lines);
    }
    let mut text = String::new();
    for line in lines {
        // A status is a word of bits, so it is written without a point.
        text.push_str(&(line[0] as u32).to_string());
        text.push(',');
        frames::push_row(&mut text, line[1..].iter().copied());
    }
    output::write_whole(path, text.as_bytes())?;
    Ok(())
}

/// Reads the resultants, friction and direction of a force file of `frames` lines.
///
/// # Errors
///
/// [`FrameError`], with file, line and column, for a line that is too short or holds something else than finite
/// numbers, and for a file with another number of lines.
pub fn read_outcomes(path: &Path, frames: usize) -> Result<Vec<Outcome>, FrameError> {
    let rows = frames::read_rows(path, |found| (found < SUMMARY).then_some(SUMMARY))?;
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
