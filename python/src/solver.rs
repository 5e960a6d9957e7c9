//! The f64 solver on all cores.

use std::sync::{Mutex, PoisonError};

use golden::contacts::ContactForces;
use golden::solver::{PIECE, Past as InnerPast, Slips, Solver as Inner, SolverError, Status};
use pyo3::prelude::*;

use crate::arrays::{Forces, Frames, Piece};
use crate::design::Design;
use crate::errors::{look_up, without_lock};

/// Values, and for each core pieces of frames, that are solved before Python is asked for signals: tenths of a second.
const VALUES: usize = 1 << 18;
const PIECES: usize = 4;

/// What the frames of a stream leave to the next ones, in a design with smoothing or creep.
#[pyclass(frozen, module = "sptfra")]
#[derive(Default)]
pub struct Past {
    inner: Mutex<InnerPast>,
}

#[pymethods]
impl Past {
    #[new]
    fn new() -> Self {
        Self::default()
    }
}

/// Forces from frames in double precision.
#[pyclass(frozen, module = "sptfra")]
pub struct Solver {
    design: Py<Design>,
    inner: Inner,
    cores: usize,
}

#[pymethods]
impl Solver {
    #[new]
    fn new(py: Python<'_>, design: Py<Design>) -> PyResult<Self> {
        let of = &design.get().inner;
        let inner = without_lock(py, || Inner::new(of))?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Ok(Self { design, inner, cores })
    }

    #[getter]
    fn design(&self, py: Python<'_>) -> Py<Design> {
        self.design.clone_ref(py)
    }

    #[pyo3(signature = (frames, *, slips = None, past = None))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        frames: &Bound<'py, PyAny>,
        slips: Option<&Bound<'py, PyAny>>,
        past: Option<&Past>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut slips = slips.map_or(Ok(Slips::default()), slips_of)?;
        let design = &self.design.get().inner;
        let frames = Frames::of(design, frames)?;
        let own = Past::default();
        let past = &past.unwrap_or(&own).inner;
        let forces = without_lock(py, || {
            let (records, has_field) = (self.inner.records(), self.inner.field_length() > 0);
            let mut forces = Forces::zeros(&design.sensor, frames.count(), records, has_field);
            let (mut pieces, taxels) = (forces.pieces().into_iter(), design.sensor.taxels());
            let mut past = past.lock().unwrap_or_else(PoisonError::into_inner);
            let at_a_time = (VALUES / (PIECE * taxels)).max(PIECES * self.cores);
            for values in frames.values.chunks(at_a_time * PIECE * taxels) {
                self.inner.solve_on_all_cores(values, &mut past, pieces.by_ref().take(at_a_time), Piece::put)?;
                look_up(|_| Ok(()));
            }
            drop(pieces);
            self.inner.follow_slips(&mut slips, forces.of_slips());
            Ok::<_, SolverError>(forces)
        })?;
        forces.into_python(py)
    }

    fn __repr__(&self) -> String {
        format!("<sptfra.Solver of {}>", self.design.get().inner.name)
    }
}

/// What slipped in the frame before: whether anything did, or the last of these forces that is of a finite frame.
fn slips_of(before: &Bound<'_, PyAny>) -> PyResult<Slips> {
    if let Ok(slips) = before.extract::<bool>() {
        return Ok(slips.into());
    }
    let status: Vec<u32> = before.getattr("status")?.call_method1("tolist", ())?.extract()?;
    // A frame that is not finite says nothing of slip: the one before it does.
    let unread = Status::NOT_FINITE.0 | Status::BAD_LENGTH.0;
    let Some(last) = status.iter().rposition(|status| status & unread == 0) else { return Ok(Slips::default()) };
    let status = status[last];
    let records = before.getattr("records")?;
    let mut contacts = Vec::new();
    if !records.is_none() {
        for record in records.get_item(last)?.try_iter()? {
            let record = record?;
            let value = |name: &str| record.get_item(name)?.extract::<f64>();
            contacts.push(ContactForces {
                taxels: value("taxels")? as usize,
                status: Status(value("status")? as u32),
                centre_m: [value("x")?, value("y")?],
                ..ContactForces::default()
            });
        }
    }
    Ok(Slips::of(Status(status), &contacts))
}
