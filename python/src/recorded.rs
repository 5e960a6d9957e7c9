//! Constants from recordings with measured forces or pressures.

use std::path::PathBuf;

use golden::calibrate::recorded::{Measured, fit_forces, fit_uniform, read_forces, read_pressures};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use testbench::calibration_page::page;

use crate::arrays::Frames;
use crate::design::{Design, named_anew};
use crate::errors::{raised, without_lock};

/// A design with constants from frames under uniform pressure, or from contacts with known forces; what the recording could
/// tell, as JSON; and a page with plots. What was measured is the path of a file, as the commands read it, or a pressure
/// or three forces of each frame, NaN where one is not known.
#[pyfunction]
#[pyo3(signature = (design, frames, measured, *, uniform, name = None))]
pub fn calibrate_recorded(
    py: Python<'_>,
    design: &Design,
    frames: &Bound<'_, PyAny>,
    measured: &Bound<'_, PyAny>,
    uniform: bool,
    name: Option<String>,
) -> PyResult<(Design, String, String)> {
    let frames = Frames::of(&design.inner, frames)?;
    frames.finite()?;
    let rows = frames.rows();
    let measured = if let Ok(path) = measured.extract::<PathBuf>() {
        if uniform { read_pressures(&path) } else { read_forces(&path) }.map_err(raised)?
    } else {
        let values: PyReadonlyArray1<'_, f64> = measured.extract()?;
        let values: Vec<Option<f64>> = values.as_array().iter().map(|&x| (!x.is_nan()).then_some(x)).collect();
        if uniform { Measured::of_pressures(values) } else { Measured::of_forces(values.as_chunks::<3>().0.to_vec()) }
    };
    let fit = if uniform { fit_uniform } else { fit_forces };
    let found = without_lock(py, || fit(&design.inner, &rows, &measured))?;
    let missing = found.refuse_missing(&measured);
    missing.map_err(|problem| PyValueError::new_err(format!("{}: {problem}", design.inner.name)))?;
    let json = serde_json::to_string(&found).map_err(raised)?;
    let page = page(&found.design, if uniform { [Some(&found), None] } else { [None, Some(&found)] });
    Ok((named_anew(found.design, name)?, json, page))
}
