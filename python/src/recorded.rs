//! Constants from recordings with measured forces or pressures.

use std::path::PathBuf;

use golden::calibrate::recorded::{Measured, fit_forces, fit_uniform, read_forces, read_pressures};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use testbench::calibration_page::page;

use crate::arrays::{Frames, unmasked};
use crate::design::{Design, named_anew};
use crate::errors::{raised, without_lock};

/// What was measured with frames.
#[derive(Clone, Copy)]
enum Kind {
    Forces,
    Pressures,
}

impl Kind {
    /// What it is called, on the page of plots, and its unit.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Forces => ["forces", "Contacts with known forces", "N"],
            Self::Pressures => ["pressures", "Uniform pressure", "Pa"],
        }
    }

    /// Numbers (n,), or forces (n, 3), of which NaN is unknown; or the path of a file, as the commands read it.
    fn read(self, measured: &Bound<'_, PyAny>) -> PyResult<Measured> {
        let py = measured.py();
        if let Ok(path) = measured.extract::<PathBuf>() {
            return match self {
                Self::Forces => read_forces(&path),
                Self::Pressures => read_pressures(&path),
            }
            .map_err(raised);
        }
        let numpy = py.import(intern!(py, "numpy"))?;
        let double = numpy.getattr(intern!(py, "float64"))?;
        let array = numpy.call_method1(intern!(py, "asarray"), (unmasked(measured)?, double))?;
        let array: PyReadonlyArrayDyn<'_, f64> = array.extract()?;
        let values: Vec<Option<f64>> = array.as_array().iter().map(|&x| (!x.is_nan()).then_some(x)).collect();
        match (self, array.shape()) {
            (Self::Pressures, [_]) => Ok(Measured::of_pressures(values)),
            (Self::Forces, [_]) => Ok(Measured::of_forces(values.into_iter().map(|z| [None, None, z]).collect())),
            (Self::Forces, [_, 3]) => Ok(Measured::of_forces(values.as_chunks::<3>().0.to_vec())),
            (_, shape) => {
                let [name, ..] = self.words();
                let wanted = match self {
                    Self::Forces => "(n,), the normal force, or (n, 3)",
                    Self::Pressures => "(n,)",
                };
                Err(PyValueError::new_err(format!(
                    "{name} of {} axes; give an array of shape {wanted}, one entry a frame, NaN where it is not known",
                    shape.len()
                )))
            }
        }
    }
}

/// A design with constants from a recording; what it could tell, as JSON; and a page with plots.
type Found = (Design, String, String);

fn fit(
    py: Python<'_>,
    design: &Design,
    frames: &Bound<'_, PyAny>,
    measured: &Bound<'_, PyAny>,
    name: Option<String>,
    kind: Kind,
) -> PyResult<Found> {
    let frames = Frames::of(&design.inner, frames)?;
    frames.finite()?;
    let (rows, measured) = (frames.rows(), kind.read(measured)?);
    let found = without_lock(py, || match kind {
        Kind::Forces => fit_forces(&design.inner, &rows, &measured),
        Kind::Pressures => fit_uniform(&design.inner, &rows, &measured),
    })?;
    let missing = found.refuse_missing(&measured);
    missing.map_err(|problem| PyValueError::new_err(format!("{}: {problem}", design.inner.name)))?;
    let json = serde_json::to_string(&found).map_err(raised)?;
    let [_, title, unit] = kind.words();
    let page = page(&found.design, &[(title, unit, &found)]);
    Ok((named_anew(found.design, name)?, json, page))
}

/// From contacts with known forces.
#[pyfunction]
#[pyo3(signature = (design, frames, forces, *, name = None))]
pub fn calibrate_forces(
    py: Python<'_>,
    design: &Design,
    frames: &Bound<'_, PyAny>,
    forces: &Bound<'_, PyAny>,
    name: Option<String>,
) -> PyResult<Found> {
    fit(py, design, frames, forces, name, Kind::Forces)
}

/// From uniform pressure.
#[pyfunction]
#[pyo3(signature = (design, frames, pressures, *, name = None))]
pub fn calibrate_uniform(
    py: Python<'_>,
    design: &Design,
    frames: &Bound<'_, PyAny>,
    pressures: &Bound<'_, PyAny>,
    name: Option<String>,
) -> PyResult<Found> {
    fit(py, design, frames, pressures, name, Kind::Pressures)
}
