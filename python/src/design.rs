//! Designs: loaded, made from what is known of a sensor, or calibrated.

use std::path::PathBuf;

use golden::design::{Design as Checked, Estimator, Samples, Tension};
use golden::output::write_together;
use golden::resolved::Resolved;
use golden::tune_filter::rebase;
use golden::words;
use hdl_gen::new_design::NewDesign;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::{Error, raised, without_lock};

/// What a pickle holds: the function that makes the design, and its text with the files that it names.
type Pickle<'py> = (Bound<'py, PyAny>, (String, Vec<(&'static str, String)>));

/// A sensor, the algorithm for it, and its hardware; every key is checked.
#[pyclass(frozen, eq, module = "sptfra")]
pub struct Design {
    /// What the other crates take.
    pub inner: Checked,
    /// The file that it was loaded from.
    source: Option<PathBuf>,
}

impl PartialEq for Design {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl Design {
    /// A design that was not loaded.
    pub fn new(inner: Checked) -> Self {
        Self { inner, source: None }
    }
}

/// What the name of a design that was fitted ends with, if it is given none: its folder is not that of the one before.
const FITTED: &str = "_calibrated";

/// A design that was fitted, under a name of its own. That may be the caller's, so all of it is checked once more.
pub fn named_anew(mut design: Checked, name: Option<String>) -> PyResult<Design> {
    design.name = match name {
        Some(name) => name,
        None if design.name.ends_with(FITTED) => design.name,
        None => design.name + FITTED,
    };
    let files = design.files();
    Ok(Design::new(Checked::from_parts(&design.to_toml(), "calibrate", &files).map_err(raised)?))
}

/// What is given as a pitch: along x and along y, or one number for both.
struct Pitch([f64; 2]);

impl<'a, 'py> FromPyObject<'a, 'py> for Pitch {
    type Error = PyErr;

    fn extract(value: pyo3::Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(both) = value.extract::<f64>() {
            return Ok(Self([both; 2]));
        }
        let lengths = value.extract::<Vec<f64>>().ok();
        match lengths.as_deref() {
            Some(&[x, y]) => Ok(Self([x, y])),
            Some(more) => Err(Error::new_err(format!(
                "pitch_mm: {} lengths; write two, for x and y, or one for both",
                more.len()
            ))),
            None => Err(Error::new_err(
                "pitch_mm is no length in mm; write two, for x and y, as (4, 2), or one for both, as 4",
            )),
        }
    }
}

/// The word as the value that it means; `key` says in a message what it was given for.
pub fn word<T: serde::de::DeserializeOwned>(key: &str, word: &str) -> PyResult<T> {
    words::read(word).map_err(|allowed| Error::new_err(format!("{key} is {word:?}; choose one of: {allowed}")))
}

#[pymethods]
impl Design {
    #[new]
    #[pyo3(signature = (
        name = "my_sensor", *, columns, rows, pitch_mm, depth_mm, tension, estimator = "joint", counts = None, full_scale_pa = golden::design::DEFAULT_FULL_SCALE_PA,
        noise = golden::design::DEFAULT_NOISE
    ))]
    #[allow(clippy::too_many_arguments, reason = "keywords, most of them left out")]
    fn of_sensor(
        py: Python<'_>,
        name: &str,
        columns: usize,
        rows: usize,
        pitch_mm: Pitch,
        depth_mm: f64,
        tension: &str,
        estimator: &str,
        counts: Option<u32>,
        full_scale_pa: f64,
        noise: f64,
    ) -> PyResult<Self> {
        let estimator: Estimator = word("estimator", estimator)?;
        let tension: Tension = word("tension", tension)?;
        let Pitch(pitch_mm) = pitch_mm;
        let name = name.to_owned();
        let new =
            NewDesign { name, estimator, columns, rows, pitch_mm, depth_mm, tension, counts, full_scale_pa, noise };
        let text = without_lock(py, || new.text(&mut |_| ()))?;
        Ok(Self::new(Checked::from_toml(&text, &new.name).map_err(raised)?))
    }

    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let path = sptfra::arguments::with_ending(path);
        let inner = without_lock(py, || Checked::load(&path))?;
        Ok(Self { inner, source: Some(path) })
    }

    #[classmethod]
    #[pyo3(signature = (text, origin = "design"))]
    fn from_toml(_class: &Bound<'_, PyType>, text: &str, origin: &str) -> PyResult<Self> {
        Ok(Self::new(Checked::from_toml(text, origin).map_err(raised)?))
    }

    /// What pickles are read by.
    #[classmethod]
    fn _from_parts(_class: &Bound<'_, PyType>, text: &str, files: Vec<(String, String)>) -> PyResult<Self> {
        let files: Vec<(&str, String)> = files.iter().map(|(name, content)| (name.as_str(), content.clone())).collect();
        Ok(Self::new(Checked::from_parts(text, "design", &files).map_err(raised)?))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Pickle<'py>> {
        let design = &slf.get().inner;
        Ok((slf.get_type().getattr("_from_parts")?, (design.to_toml(), design.files())))
    }

    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    fn save(&self, path: PathBuf) -> PyResult<()> {
        let mut design = self.inner.clone();
        if let Some(source) = &self.source {
            rebase(&mut design, source, &path);
        }
        let inputs = self.source.as_deref().map_or_else(|| Ok(Vec::new()), Checked::inputs_at).map_err(raised)?;
        let resolved = Resolved::beside(&design, &inputs, &path).map_err(raised)?;
        write_together(&resolved.contents(&design, "Written by Design.save of the Python package.")).map_err(raised)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    #[getter]
    fn columns(&self) -> usize {
        self.inner.sensor.columns
    }

    #[getter]
    fn rows(&self) -> usize {
        self.inner.sensor.rows
    }

    #[getter]
    fn taxels(&self) -> usize {
        self.inner.sensor.taxels()
    }

    #[getter]
    fn pitch_mm(&self) -> (f64, f64) {
        self.inner.sensor.pitch_mm.into()
    }

    #[getter]
    fn depth_mm(&self) -> f64 {
        self.inner.sensor.depth_mm
    }

    #[getter]
    fn tension(&self) -> String {
        self.inner.input.tension.to_string()
    }

    #[getter]
    fn counts(&self) -> bool {
        self.inner.input.counts()
    }

    #[getter]
    fn samples(&self) -> &'static str {
        match self.inner.hardware.samples {
            Samples::Float32 => "float32",
            Samples::Int16 => "int16",
            Samples::Uint16 => "uint16",
        }
    }

    #[getter]
    fn plan(&self) -> String {
        self.inner.algorithm.plan.to_string()
    }

    #[getter]
    fn estimator(&self) -> String {
        self.inner.algorithm.estimator.to_string()
    }

    #[getter]
    fn contacts(&self) -> usize {
        self.inner.algorithm.contacts
    }

    #[getter]
    fn outputs(&self) -> String {
        self.inner.algorithm.outputs.to_string()
    }

    #[getter]
    fn noise_floor_pa(&self) -> f64 {
        self.inner.algorithm.noise_floor_pa
    }

    #[getter]
    fn full_scale_pa(&self) -> f64 {
        self.inner.hardware.full_scale_pa
    }

    #[getter]
    fn lanes(&self) -> usize {
        self.inner.hardware.lanes
    }

    #[getter]
    fn clock_mhz(&self) -> f64 {
        self.inner.hardware.clock_mhz
    }

    #[getter]
    fn part(&self) -> &str {
        &self.inner.hardware.part
    }

    fn __repr__(&self) -> String {
        let algorithm = &self.inner.algorithm;
        format!(
            "<sptfra.Design {}: {}, {}, {}>",
            self.inner.name, self.inner.sensor, algorithm.estimator, algorithm.plan
        )
    }
}
