//! Arrays: frames on their way in, forces on their way out.

use golden::contacts::ContactForces;
use golden::design::Design;
use golden::frames::of_grid;
use golden::sensor::Sensor;
use golden::solver::{PIECE, Solution, Status};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;

/// Frames, m values each, one after the other.
pub struct Frames {
    /// The values in taxel order.
    pub values: Vec<f64>,
    taxels: usize,
}

impl Frames {
    /// A copy of an array of numbers of shape (n, rows, columns) or (n, taxels); (rows, columns) and (taxels,) are one frame.
    ///
    /// # Errors
    ///
    /// `TypeError` for something else than numbers, `ValueError` for another shape, and for values that the design's
    /// integer samples cannot be.
    pub fn of(design: &Design, frames: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = frames.py();
        let double = py.import(intern!(py, "sptfra.forces"))?.call_method1(intern!(py, "_double"), (frames,))?;
        let array: PyReadonlyArrayDyn<'_, f64> = double.extract()?;
        let sensor = &design.sensor;
        check_shape(array.shape(), sensor, &design.name)?;
        // Whatever the memory's order, the values come in that of the indices.
        let array = array.as_array();
        let values = array.as_slice().map_or_else(|| array.iter().copied().collect(), <[f64]>::to_vec);
        let samples = design.hardware.samples;
        if let Some(wrong) = values.iter().position(|&value| !samples.takes(value)) {
            return Err(PyValueError::new_err(format!(
                "frame {}, taxel {}: {} is no {samples}, as hardware.samples says that the sensor's counts are; {}",
                wrong / sensor.taxels(),
                wrong % sensor.taxels(),
                values[wrong],
                samples.remedy()
            )));
        }
        Ok(Self { values, taxels: sensor.taxels() })
    }

    /// Number of frames.
    pub fn count(&self) -> usize {
        self.values.len() / self.taxels
    }

    /// Each frame by itself, for those who keep them.
    pub fn rows(&self) -> Vec<Vec<f64>> {
        self.values.chunks(self.taxels).map(<[f64]>::to_vec).collect()
    }

    /// Refuses what is no finite number.
    ///
    /// # Errors
    ///
    /// `ValueError` with frame and taxel.
    pub fn finite(&self) -> PyResult<()> {
        match self.values.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(at) => Err(PyValueError::new_err(format!(
                "frame {}, taxel {}: {} is no finite number; leave such frames out",
                at / self.taxels,
                at % self.taxels,
                self.values[at]
            ))),
        }
    }
}

fn check_shape(shape: &[usize], sensor: &Sensor, name: &str) -> PyResult<()> {
    let Sensor { columns, rows, .. } = *sensor;
    let taxels = sensor.taxels();
    let grid = [rows, columns];
    let problem = match shape {
        [a, b] if [*a, *b] == grid => return Ok(()),
        [found] | [_, found] if *found == taxels => return Ok(()),
        [_, grid @ ..] if grid.len() == 2 => match of_grid(grid, sensor) {
            Ok(()) => return Ok(()),
            Err(problem) => format!(": {problem}"),
        },
        _ => String::new(),
    };
    Err(PyValueError::new_err(format!(
        "frames of shape {}{problem}; {name} takes (n, {rows}, {columns}) or (n, {taxels}), and one frame as \
         ({rows}, {columns}) or ({taxels},)",
        tuple(shape)
    )))
}

/// A shape as Python prints it.
fn tuple(shape: &[usize]) -> String {
    let sides: Vec<String> = shape.iter().map(ToString::to_string).collect();
    format!("({}{})", sides.join(", "), if sides.len() == 1 { "," } else { "" })
}

/// Numbers of a frame besides its field and the forces of its contacts, and the place of the friction coefficient.
const NUMBERS: usize = 11;
const FRICTION: usize = 6;

/// What a frame yields besides those.
#[derive(Clone, Default)]
struct Summary {
    status: Status,
    /// Resultant, torque, friction, direction, friction along x and y, standard error.
    numbers: [f64; NUMBERS],
    contacts: u8,
}

/// Forces of n frames.
pub struct Forces {
    sensor: Sensor,
    summaries: Vec<Summary>,
    /// So many of each frame.
    records: Vec<ContactForces>,
    of_frame: usize,
    field: Vec<f64>,
    has_field: bool,
}

/// Where the forces of [`PIECE`] frames go.
pub struct Piece<'a> {
    summaries: &'a mut [Summary],
    records: &'a mut [ContactForces],
    field: &'a mut [f64],
}

impl Forces {
    /// Zeros for so many frames, each with so many records of contacts, with a field or without.
    pub fn zeros(sensor: &Sensor, frames: usize, records: usize, with_field: bool) -> Self {
        Self {
            summaries: vec![Summary::default(); frames],
            records: vec![ContactForces::default(); frames * records],
            of_frame: records,
            field: vec![0.0; if with_field { 3 * sensor.taxels() * frames } else { 0 }],
            has_field: with_field,
            sensor: sensor.clone(),
        }
    }

    /// The places of every [`PIECE`] frames, in order.
    pub fn pieces(&mut self) -> Vec<Piece<'_>> {
        let of_frame = if self.has_field { 3 * self.sensor.taxels() } else { 0 };
        let counts: Vec<usize> = self.summaries.chunks(PIECE).map(<[Summary]>::len).collect();
        let fields = split(&mut self.field, of_frame, &counts);
        let records = split(&mut self.records, self.of_frame, &counts);
        let places = self.summaries.chunks_mut(PIECE).zip(records).zip(fields);
        places.map(|((summaries, records), field)| Piece { summaries, records, field }).collect()
    }

    /// What decides which frames and contacts slip.
    pub fn of_slips(&mut self) -> impl Iterator<Item = (&mut Status, f64, &mut [ContactForces])> {
        let records = split(&mut self.records, self.of_frame, &vec![1; self.summaries.len()]);
        let frames = self.summaries.iter_mut().zip(records);
        frames.map(|(summary, records)| (&mut summary.status, summary.numbers[FRICTION], records))
    }

    /// The arrays in the package's class `sptfra.Forces`.
    pub fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let Sensor { columns, rows, .. } = self.sensor;
        let all = &self.summaries;
        let frames = all.len();
        let status: Vec<u16> = all.iter().map(|of| of.status.0 as u16).collect();
        let contacts: Vec<u8> = all.iter().map(|of| of.contacts).collect();
        let numbers = array(py, all.iter().flat_map(|of| of.numbers).collect(), &[frames, NUMBERS])?;
        let of_contact = |contact| golden::forces::record(contact).into_iter().chain(contact.torque);
        let records: Vec<f64> = self.records.iter().flat_map(of_contact).collect();
        let each = golden::forces::OF_CONTACT.len() + golden::forces::TORQUE_OF_CONTACT.len();
        let records = (self.of_frame > 0).then(|| array(py, records, &[frames, self.of_frame, each])).transpose()?;
        let field = self.has_field.then(|| array(py, self.field, &[frames, rows, columns, 3])).transpose()?;
        let parts = (status.into_pyarray(py), numbers, contacts.into_pyarray(py), records, field);
        py.import("sptfra.forces")?.getattr("_forces")?.call1(parts)
    }
}

impl Piece<'_> {
    /// Puts a solution in its place.
    pub fn put(&mut self, index: usize, solution: &Solution) {
        let Solution { status, resultant, torque, standard_error, contacts, records, mu, phi, mu_x, mu_y, field } =
            solution;
        let [[f_x, f_y, f_z], [t_x, t_y, t_z]] = [*resultant, *torque];
        let numbers = [f_x, f_y, f_z, t_x, t_y, t_z, *mu, *phi, *mu_x, *mu_y, *standard_error];
        self.summaries[index] = Summary { status: *status, numbers, contacts: *contacts as u8 };
        self.records[records.len() * index..][..records.len()].copy_from_slice(records);
        let taxels = field[0].len();
        if self.field.is_empty() {
            return;
        }
        let [x, y, z] = field;
        let place = &mut self.field[3 * taxels * index..][..3 * taxels];
        for (place, ((x, y), z)) in place.as_chunks_mut::<3>().0.iter_mut().zip(x.iter().zip(y).zip(z)) {
            *place = [*x, *y, *z];
        }
    }
}

/// The parts of frames that have `each` values, in pieces of so many frames.
fn split<'a, T>(mut values: &'a mut [T], each: usize, counts: &[usize]) -> Vec<&'a mut [T]> {
    let mut parts = Vec::with_capacity(counts.len());
    for count in counts {
        let (first, rest) = values.split_at_mut(each * count);
        parts.push(first);
        values = rest;
    }
    parts
}

/// An array of this shape.
pub fn array<'py>(py: Python<'py>, values: Vec<f64>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape.to_vec())?.into_any())
}
