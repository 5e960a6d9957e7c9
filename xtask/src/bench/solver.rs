//! Frames a second of the f64 solver, as `cargo xtask solver --json` measured them.

use std::path::Path;

use golden::design::PlanKind;
use serde::{Deserialize, Serialize};

use super::{BenchError, read_json};

/// One design's speed.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct SolverRate {
    /// The design file.
    pub file: String,
    /// The design's name.
    pub design: String,
    /// Its hash.
    pub hash: String,
    /// Its plan.
    pub plan: PlanKind,
    /// Its taxels.
    pub taxels: usize,
    /// Seconds for matrices and filter, once.
    pub setup_s: f64,
    /// Repetitions behind each median.
    pub repetitions: usize,
    /// Frame after frame.
    pub one_by_one: Speed,
    /// Many frames at a time.
    pub in_batches: Speed,
    /// Cores of the machine,
    pub cores: usize,
    /// and many frames at a time on all of them.
    pub on_all_cores: Speed,
    /// What numpy does with the same products and search on one BLAS thread, in batches: `tools/bench_numpy.py --add`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numpy_frames_per_second: Option<f64>,
}

/// Frames a second, median, and the spread behind it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Speed {
    /// One over the median time.
    pub frames_per_second: f64,
    /// Median of the repetitions.
    pub us_per_frame: f64,
    /// The fastest and the slowest repetition.
    pub us_per_frame_range: [f64; 2],
}

/// Reads the command's output.
///
/// # Errors
/// [`BenchError::Read`] and [`BenchError::Json`].
pub fn read(path: &Path) -> Result<Vec<SolverRate>, BenchError> {
    read_json(path)
}
