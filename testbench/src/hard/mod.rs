//! `testbench hard`: what becomes of frames and sensors at the limits, in f64, float32 and the hardware's fixed point.

pub mod cases;
pub mod judge;
pub mod render;
pub mod single;

use golden::design::DesignError;
use golden::scene::SceneError;
use rayon::prelude::*;
use thiserror::Error;

use crate::progress::Progress;
use cases::Case;
use judge::Row;

/// Why there is no table.
#[derive(Debug, Error)]
pub enum HardError {
    /// A case's design is wrong; a defect of the table.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A case's scene cannot be computed; a defect of the table.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Judges all cases, on all cores.
///
/// # Errors
/// [`HardError`] if a case cannot be made.
pub fn table(large: bool, progress: &Progress) -> Result<Vec<Row>, HardError> {
    let cases: Vec<Case> = cases::all(large)?;
    progress.counted_in("cases", "hard cases", cases.len() as u64);
    Ok(cases
        .par_iter()
        .map(|case| {
            let row = judge::judge(case);
            progress.step();
            row
        })
        .collect())
}

/// Whether no case had a result that nothing warned of: a NaN, or a force beyond reason without a status bit.
pub fn is_sound(rows: &[Row]) -> bool {
    rows.iter().all(|row| [&row.f64, &row.fixed].into_iter().flatten().all(|judged| judged.silent == 0))
}
