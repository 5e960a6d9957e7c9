//! The f64 solver on all cores.

use golden::solver::{Solver as Inner, SolverError};
use pyo3::prelude::*;

use crate::arrays::{Forces, Frames, Piece};
use crate::design::Design;
use crate::errors::without_lock;

/// Forces from frames in double precision.
#[pyclass(frozen, module = "sptfra")]
pub struct Solver {
    design: Py<Design>,
    inner: Inner,
}

#[pymethods]
impl Solver {
    #[new]
    fn new(py: Python<'_>, design: Py<Design>) -> PyResult<Self> {
        let of = &design.get().inner;
        let inner = without_lock(py, || Inner::new(of))?;
        Ok(Self { design, inner })
    }

    #[getter]
    fn design(&self, py: Python<'_>) -> Py<Design> {
        self.design.clone_ref(py)
    }

    #[pyo3(signature = (frames, *, slips = false))]
    fn solve<'py>(&self, py: Python<'py>, frames: &Bound<'py, PyAny>, slips: bool) -> PyResult<Bound<'py, PyAny>> {
        let design = &self.design.get().inner;
        let frames = Frames::of(design, frames)?;
        let forces = without_lock(py, || {
            let mut forces = Forces::zeros(&design.sensor, frames.count(), self.inner.field_length() > 0);
            self.inner.solve_on_all_cores(&frames.values, forces.pieces(), Piece::put)?;
            let mut slips = slips;
            self.inner.follow_slips(&mut slips, forces.status.iter_mut().zip(forces.friction.iter().copied()));
            Ok::<_, SolverError>(forces)
        })?;
        forces.into_python(py)
    }

    fn __repr__(&self) -> String {
        format!("<sptfra.Solver of {}>", self.design.get().inner.name)
    }
}
