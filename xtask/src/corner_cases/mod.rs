//! `cargo xtask corner-cases`: what becomes of frames and sensors at the limits, in f64, float32 and the hardware's fixed point.

pub mod cases;
pub mod float32;
pub mod judge;
pub mod rtl;

use golden::design::DesignError;
use golden::scene::SceneError;
use rayon::prelude::*;
use thiserror::Error;

use cases::Case;
use golden::progress::Progress;
use judge::Row;
use testbench::co_simulation::CoSimulationError;

/// Why there is no table.
#[derive(Debug, Error)]
pub enum CornerCasesError {
    /// A case's design is wrong; a defect of the table.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A case's scene cannot be computed; a defect of the table.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A design's RTL cannot be built or simulated.
    #[error(transparent)]
    CoSimulation(#[from] CoSimulationError),
}

/// How much of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scope {
    /// What takes more than a second too.
    pub large: bool,
    /// All frames through the RTL: a build for each design.
    pub rtl: bool,
}

/// Judges all cases, on all cores: by the line search, then by the joint one.
///
/// # Errors
/// [`CornerCasesError`] if a case cannot be made, or its RTL not be simulated.
pub fn table(scope: Scope, progress: &Progress) -> Result<Vec<Row>, CornerCasesError> {
    let mut cases: Vec<Case> = cases::all(scope.large)?;
    cases.extend(cases::by_joint(&cases)?);
    progress.counted_in("cases", "corner cases", cases.len() as u64);
    let mut rows: Vec<Row> = cases
        .par_iter()
        .map(|case| {
            let row = judge::judge(case);
            progress.step();
            row
        })
        .collect();
    if scope.rtl {
        for (row, exact) in rows.iter_mut().zip(rtl::check(&cases, progress)?) {
            row.rtl_is_model = exact;
        }
    }
    Ok(rows)
}

/// The rows with a result that nothing warned of, a NaN or a force beyond reason without a status bit, or with an RTL word
/// that is not the model's.
pub fn unsound(rows: &[Row]) -> Vec<&Row> {
    let silent = |row: &Row| [&row.f64, &row.fixed, &row.wide].into_iter().flatten().any(|judged| judged.silent > 0);
    rows.iter().filter(|row| silent(row) || row.rtl_is_model == Some(false)).collect()
}
