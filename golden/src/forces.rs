//! Force files: CSV without a header, one frame a line.
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
    let mut text = String::new();
    for solution in solutions {
        let taxels = if with_field { solution.field[0].len() } else { 0 };
        let field = (0..taxels).flat_map(|taxel| solution.field.each_ref().map(|component| component[taxel]));
        let [fx, fy, fz] = solution.resultant;
        let summary = [fx, fy, fz, solution.mu, solution.phi, solution.mu_x, solution.mu_y];
        push_line(&mut text, solution.status.0, summary, field);
    }
    output::write_whole(path, text.as_bytes())?;
    Ok(())
}

/// Writes the true forces of scene frames, in the form of solutions with status 0.
///
/// # Errors
///
/// [`FrameError::Write`] if the file cannot be written.
pub fn write_reference(path: &Path, frames: &[SceneFrame]) -> Result<(), FrameError> {
    let mut text = String::new();
    for frame in frames {
        let [fx, fy, fz] = frame.force;
        let normal = fz.abs();
        let summary = [fx, fy, fz, frame.friction, frame.direction, fx / normal, fy / normal];
        push_line(&mut text, 0, summary, std::iter::empty());
    }
    output::write_whole(path, text.as_bytes())?;
    Ok(())
}

fn push_line(text: &mut String, status: u32, summary: [f64; SUMMARY - 1], field: impl Iterator<Item = f64>) {
    // A status is a word of bits, so it is written without a point.
    text.push_str(&status.to_string());
    text.push(',');
    frames::push_row(text, summary.into_iter().chain(field));
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

/// The place of the reference forces of a frame file: `frames.csv` has them in `frames.forces.csv`.
pub fn reference_path(frames: &Path) -> PathBuf {
    frames.with_extension("forces.csv")
}
