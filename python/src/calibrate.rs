//! The grid search's constants and network, fitted to a sensor.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use golden::calibrate::{CalibrateError, ERROR_FRAMES, Settings, calibrate as fit, state_errors};
use golden::design::{Design as Checked, Estimator, TrainingSet};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::design::{Design, named_anew, word};
use crate::errors::{look_up, raised, without_lock};

/// How often Python hears of the progress, and is asked for signals.
const PAUSE: Duration = Duration::from_millis(100);

/// A design with constants and network fitted to its sensor. Ctrl-C ends it.
#[pyfunction]
#[pyo3(signature = (design, *, name = None, training_set = None, seed = 1, hidden = None, quick = false, thorough = false, progress = None))]
#[allow(clippy::too_many_arguments, reason = "keywords, most of them left out")]
pub fn calibrate(
    py: Python<'_>,
    design: &Bound<'_, PyAny>,
    name: Option<String>,
    training_set: Option<&str>,
    seed: u64,
    hidden: Option<usize>,
    quick: bool,
    thorough: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Design> {
    let mut design = unfitted(design)?;
    if let Some(training_set) = training_set {
        design.algorithm.joint.training_set = word::<TrainingSet>("training_set", training_set)?;
    }
    let training_set = design.algorithm.joint.training_set;
    let settings = Settings::of(training_set, seed, hidden, quick, thorough).map_err(raised)?;
    // The line search has a standard error only.
    let has_constants = design.algorithm.estimator == Estimator::Joint;
    let all = ERROR_FRAMES + if has_constants { settings.work() } else { 0 };
    let (mut done, mut told) = (0, Instant::now());
    let mut tick = || {
        done += 1;
        if told.elapsed() >= PAUSE || done == all {
            told = Instant::now();
            look_up(|py| progress.as_ref().map_or(Ok(()), |tell| tell.call1(py, (done, all)).map(drop)));
        }
    };
    let design = without_lock(py, || {
        if has_constants {
            *design.algorithm.joint = fit(&design, &settings, &mut tick)?;
        }
        state_errors(&mut design, seed, &mut tick)?;
        Ok::<_, CalibrateError>(design)
    })?;
    named_anew(design, name)
}

/// The design, or that of a file, whose constants may be those of another sensor.
fn unfitted(design: &Bound<'_, PyAny>) -> PyResult<Checked> {
    if let Ok(design) = design.cast::<Design>() {
        return Ok(design.get().inner.clone());
    }
    let Ok(path) = design.extract::<PathBuf>() else {
        let found = design.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "design is of type {found}; give a Design, or the path of a design file"
        )));
    };
    Checked::load_unfitted(&sptfra::arguments::with_ending(path)).map_err(raised)
}
