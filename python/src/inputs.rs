//! Frames: of files, of scenes, and what is wrong with them.

use std::path::{Path, PathBuf};

use golden::check::{Beyond, beyond as count_beyond, check as look_for_faults};
use golden::design::Calibration;
use golden::frames::{Layout, read_recording};
use golden::geometry;
use golden::matrices::Matrices;
use golden::metrics::{ERROR_NAMES, ErrorSummary, Outcome};
use golden::scene::{ChoiceError, Kind, Scene, SceneFrame};
use golden::solver::{Solution, Status};
use golden::unloaded::{Unloaded, UnloadedTaxel};
use golden::words;
use numpy::PyReadonlyArray2;
use numpy::ndarray::ArrayView1;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{Forces, Frames, array};
use crate::design::Design;
use crate::errors::{raised, without_lock};

/// Frames of a file, as the commands read them.
#[pyfunction]
#[pyo3(signature = (path, design, *, labels = 0, columns = None, skip_lines = 0, skip_bad = false))]
pub fn load_frames<'py>(
    py: Python<'py>,
    path: PathBuf,
    design: &Design,
    labels: usize,
    columns: Option<[usize; 2]>,
    skip_lines: usize,
    skip_bad: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let design = &design.inner;
    if columns.is_some_and(|[first, last]| labels > 0 || !(1..=last).contains(&first)) {
        return Err(PyValueError::new_err(
            "columns are (first, last) of the values, from 1, and take the place of labels",
        ));
    }
    let layout = Layout { labels, columns, skip_lines, skip_bad };
    let recording = without_lock(py, || {
        geometry::compare(&path, &design.name, &design.sensor)?;
        read_recording(&path, design, layout)
    })?;
    warn(py, recording.remark)?;
    let shape = [recording.frames.len(), design.sensor.rows, design.sensor.columns];
    let frames = array(py, recording.frames.concat(), &shape)?;
    if skip_bad { (frames, recording.skipped).into_bound_py_any(py) } else { Ok(frames) }
}

/// Says what is to be known of a header.
fn warn(py: Python<'_>, remark: Option<String>) -> PyResult<()> {
    remark.map_or(Ok(()), |remark| py.import("warnings")?.call_method1("warn", (remark,)).map(drop))
}

/// Frames from lines of text, as a sensor sends them.
#[pyclass(module = "sptfra")]
pub struct FrameLines {
    inner: golden::frames::FrameLines,
    shape: [usize; 2],
}

#[pymethods]
impl FrameLines {
    #[new]
    #[pyo3(signature = (design, *, labels = 0, origin = "standard input"))]
    fn new(design: &Design, labels: usize, origin: &str) -> Self {
        let sensor = &design.inner.sensor;
        let inner = golden::frames::FrameLines::new(Path::new(origin), &design.inner, labels);
        Self { inner, shape: [sensor.rows, sensor.columns] }
    }

    fn frame<'py>(&mut self, py: Python<'py>, line: &[u8]) -> PyResult<Option<Bound<'py, PyAny>>> {
        let known = self.inner.remark().is_some();
        let frame = self.inner.frame(line).map_err(raised)?;
        warn(py, self.inner.remark().filter(|_| !known))?;
        frame.map(|values| array(py, values, &self.shape)).transpose()
    }
}

/// What is wrong with frames, as far as they tell.
#[pyfunction]
pub fn check<'py>(py: Python<'py>, design: &Design, frames: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
    let design = &design.inner;
    let frames = Frames::of(design, frames)?;
    frames.finite()?;
    let findings = without_lock(py, || {
        let matrices = Matrices::of(design).map_err(|error| format!("{}: {error}", design.name))?;
        Ok::<_, String>(look_for_faults(design, &frames.rows(), Some(&matrices)))
    })?;
    let class = py.import("sptfra.results")?.getattr("Finding")?;
    let found: Vec<_> = findings
        .iter()
        .map(|finding| class.call1((finding.kind.to_string(), finding.to_string())))
        .collect::<PyResult<_>>()?;
    PyList::new(py, found)
}

/// How many readings lie beyond what the design is calibrated for.
#[pyfunction]
pub fn beyond<'py>(py: Python<'py>, design: &Design, frames: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let design = &design.inner;
    let frames = Frames::of(design, frames)?;
    frames.finite()?;
    let Beyond { readings, share, frames } = count_beyond(design, &frames.rows());
    py.import("sptfra.results")?.getattr("Beyond")?.call1((readings, share, frames))
}

/// What frames of an unloaded sensor measure.
#[pyfunction]
pub fn unloaded<'py>(py: Python<'py>, design: &Design, frames: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let design = &design.inner;
    let frames = Frames::of(design, frames)?;
    frames.finite()?;
    let frames = frames.rows();
    let named = |error: String| format!("{}: {error}", design.name);
    let found = Unloaded::of(design, &frames).map_err(|error| raised(named(error)))?;
    let (calibration, tared, refused) = match found.calibration(design, &frames) {
        Ok(calibration) => (calibration.to_csv(), Some(tared(design, calibration, &found)?), String::new()),
        Err(error) => (String::new(), None, named(error)),
    };
    let shape = [design.sensor.rows, design.sensor.columns];
    let of = |value: fn(&UnloadedTaxel) -> f64| array(py, found.taxels.iter().map(value).collect(), &shape);
    let fields = PyDict::new(py);
    fields.set_item("offset", of(|each| each.offset)?)?;
    fields.set_item("noise", of(|each| each.noise)?)?;
    fields.set_item("drift", of(|each| each.drift)?)?;
    for (name, taxels) in [("dead", &found.dead), ("stuck", &found.stuck), ("noisy", &found.noisy)] {
        fields.set_item(name, PyTuple::new(py, taxels)?)?;
    }
    fields.set_item("median_noise", found.noise)?;
    fields.set_item("median_drift", found.drift)?;
    fields.set_item("noise_pa", found.noise_pa)?;
    fields.set_item("noise_floor_pa", found.noise_floor_pa)?;
    fields.set_item("noise_of_full_scale", found.noise_of_full_scale)?;
    fields.set_item("warnings", PyTuple::new(py, &found.warnings)?)?;
    fields.set_item("_calibration", calibration)?;
    fields.set_item("_tared", tared)?;
    fields.set_item("_refused", refused)?;
    py.import("sptfra.results")?.getattr("Unloaded")?.call((), Some(&fields))
}

/// The design with the calibration of an unloaded sensor and the noise floor that suits it.
fn tared(design: &golden::design::Design, calibration: Calibration, measured: &Unloaded) -> PyResult<Design> {
    let mut tared = design.clone();
    tared.input.calibration = Some(calibration);
    tared.algorithm.noise_floor_pa = measured.noise_floor_pa;
    let checked = golden::design::Design::from_parts(&tared.to_toml(), &design.name, &tared.files());
    Ok(Design::new(checked.map_err(raised)?))
}

/// Frames with their true forces.
#[pyfunction]
#[pyo3(signature = (design = None, path = None, *, kind = None, count = 60, friction = 0.5, seed = 1))]
pub fn scene<'py>(
    py: Python<'py>,
    design: Option<&Design>,
    path: Option<PathBuf>,
    kind: Option<&str>,
    count: u32,
    friction: f64,
    seed: u32,
) -> PyResult<Bound<'py, PyAny>> {
    let design = design.map(|design| &design.inner);
    if design.is_none() && path.is_none() {
        return Err(raised("nothing to make frames of; give a design, or the path of a scene file"));
    }
    let kind = kind.map(|word| {
        words::read::<Kind>(word)
            .map_err(|words| raised(format!("kind = {word:?} is no kind of contact; use one of {words}")))
    });
    let kind = match (kind.transpose()?, design) {
        (Some(_), None) => return Err(raised("contacts of a kind are for the sensor of a design; give one")),
        (Some(_), Some(_)) if path.is_some() => return Err(raised("a scene file or a kind of contact, not both")),
        (Some(_), Some(_)) if !(0.0..=2.0).contains(&friction) => return Err(raised("friction is from 0 to 2")),
        (kind, design) => kind.zip(design),
    };
    let (sensor, made) = without_lock(py, || {
        let (sensor, mut frames) = if let Some((kind, design)) = kind {
            let seeds = u64::from(seed)..u64::from(seed) + u64::from(count);
            (design.sensor.clone(), kind.frames(&design.sensor, friction, seeds)?)
        } else {
            let scene = Scene::for_design(path.as_deref(), design)?;
            (scene.sensor.clone(), scene.frames()?)
        };
        if let Some(design) = design {
            design.deliver_in_order(frames.iter_mut().map(|frame| &mut frame.stress));
        }
        Ok::<_, ChoiceError>((sensor, frames))
    })?;
    let shape = [made.len(), sensor.rows, sensor.columns];
    let stress: Vec<f64> = made.iter().flat_map(|frame| frame.stress.iter().copied()).collect();
    let records = made.iter().map(|frame| known(frame).records.len()).max().unwrap_or(0);
    let mut truth = Forces::zeros(&sensor, made.len(), records, false);
    for (piece, frames) in truth.pieces().iter_mut().zip(made.chunks(golden::solver::PIECE)) {
        frames.iter().enumerate().for_each(|(index, frame)| piece.put(index, &known(frame)));
    }
    let class = py.import("sptfra.results")?.getattr("Scene")?;
    class.call1((array(py, stress, &shape)?, truth.into_python(py)?))
}

/// The truth in the form of a solution.
fn known(frame: &SceneFrame) -> Solution {
    let [fx, fy, fz] = frame.force;
    Solution {
        resultant: frame.force,
        torque: frame.torque,
        mu: frame.friction,
        phi: frame.direction,
        mu_x: fx / fz.abs(),
        mu_y: fy / fz.abs(),
        contacts: frame.contacts.len(),
        records: if frame.contacts.len() > 1 { frame.contacts.clone() } else { Vec::new() },
        ..Solution::zeros(Status::default(), 0)
    }
}

/// Errors of forces against the true ones, in percent: name, largest one, standard error. A row has `F_x`, `F_y` and `F_z`,
/// then friction and direction, unless they are to follow from those.
#[pyfunction]
pub fn errors(forces: PyReadonlyArray2<'_, f64>, truth: PyReadonlyArray2<'_, f64>) -> Vec<(&'static str, f64, f64)> {
    let pairs: Vec<_> = outcomes(&truth).into_iter().zip(outcomes(&forces)).collect();
    let spreads = ErrorSummary::new(&pairs).spreads();
    ERROR_NAMES.into_iter().zip(spreads).map(|(name, spread)| (name, spread.max, spread.standard_error)).collect()
}

fn outcomes(rows: &PyReadonlyArray2<'_, f64>) -> Vec<Outcome> {
    let outcome = |row: ArrayView1<'_, f64>| {
        let [x, y, z] = [row[0], row[1], row[2]];
        let follow = || [x.hypot(y) / z.abs(), y.atan2(x)];
        let [friction, direction] = if row.len() == 5 { [row[3], row[4]] } else { follow() };
        Outcome { force: [x, y, z], friction, direction }
    };
    rows.as_array().rows().into_iter().map(outcome).collect()
}
