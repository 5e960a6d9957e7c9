//! Points as jobs of their own: what `sptfra run --json` needs for each, and its reports as the proof of a point.

use std::fs;
use std::path::{Path, PathBuf};

use golden::forces::{reference_path, write_reference};
use golden::frames::write_frames;
use golden::metrics::ErrorSummary;
use golden::output::write_whole;
use hdl_gen::plan::Plan;
use hdl_gen::write::io_error;
use rayon::prelude::*;
use serde::Deserialize;

use super::grid::Job;
use super::{Sweep, SweepError, SweepScene};
use crate::accuracy::StatusCounts;
use crate::simulate::Cycles;

/// Folder of the jobs in that of a sweep, one folder a point.
const JOBS: &str = "jobs";
/// Errors of a report were computed from the same words: what may differ is the last digit of a sum.
const SAME: f64 = 1e-9;

/// What a point needs of a report of `sptfra run --json`.
#[derive(Clone, Debug, Deserialize)]
pub struct RunReport {
    frames: usize,
    bit_exact: bool,
    latency_cycles: u64,
    interval_cycles: u64,
    true_force_errors: Option<ErrorSummary>,
    status_counts: StatusCounts,
}

impl RunReport {
    /// Reads a report.
    ///
    /// # Errors
    /// What is wrong, for people.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| format!("cannot be read: {error}"))?;
        serde_json::from_str(&text).map_err(|error| format!("is no report of `sptfra run --json`: {error}"))
    }

    /// Whether the run was one of `frames` frames with these results of the model, and found its words in the RTL.
    ///
    /// # Errors
    /// What differs, for people.
    pub fn check(
        &self,
        plan: &Plan,
        frames: usize,
        errors: &ErrorSummary,
        counts: &StatusCounts,
    ) -> Result<(), String> {
        if !self.bit_exact {
            return Err("says that the RTL is not the model".to_owned());
        }
        let simulated = Cycles { latency: self.latency_cycles, interval: self.interval_cycles };
        let timely = simulated == Cycles::predicted(plan);
        let near = |found: &ErrorSummary| {
            let pairs = found.spreads().into_iter().zip(errors.spreads());
            found.frames == errors.frames && pairs.into_iter().all(|(one, other)| (one.max - other.max).abs() < SAME)
        };
        let same = self.frames == frames && self.true_force_errors.as_ref().is_some_and(near);
        if timely && same && self.status_counts == *counts {
            return Ok(());
        }
        Err("is the report of another design, of other frames, or of another version of this program".to_owned())
    }
}

impl Sweep {
    /// Writes a folder for each point that has hardware, with its design, frames and true forces: what `sptfra run`
    /// takes. Returns how many there are.
    ///
    /// # Errors
    /// [`SweepError`] if a file cannot be written.
    pub fn prepare(&self, out: &Path) -> Result<usize, SweepError> {
        let prepared = self.jobs.par_iter().map(|job| {
            if Plan::new(&job.design).is_err() {
                return Ok(0);
            }
            write_job(job, &self.scenes[job.scene], &out.join(JOBS).join(&job.key)).map(|()| 1)
        });
        prepared.collect::<Result<Vec<usize>, SweepError>>().map(|counts| counts.into_iter().sum())
    }

    /// The report of a point's run, if there is one.
    pub(super) fn report_of(&self, key: &str) -> Option<PathBuf> {
        let path = self.runs.as_ref()?.join(format!("{key}.json"));
        path.is_file().then_some(path)
    }
}

fn write_job(job: &Job, scene: &SweepScene, folder: &Path) -> Result<(), SweepError> {
    fs::create_dir_all(folder).map_err(io_error(folder, "make the folder"))?;
    let frames = folder.join("frames.csv");
    write_reference(&reference_path(&frames), &scene.made)?;
    write_frames(&frames, &scene.frames.clone().as_delivered(&job.design).stress)?;
    for (name, content) in job.design.files() {
        write_whole(&folder.join(name), content.as_bytes())?;
    }
    // The design last: where it is, all is.
    Ok(write_whole(&folder.join("design.toml"), job.design.to_toml().as_bytes())?)
}
