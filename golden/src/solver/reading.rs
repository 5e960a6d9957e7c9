//! From the values of a frame to what can be solved.

use nalgebra::DVector;

use super::cean::{self, Contact};
use super::{SolverError, Status};
use crate::creep::Creep;
use crate::crosstalk::Crosstalk;
use crate::dead_taxels::{DeadTaxels, GUESSED};
use crate::design::{Design, Input, Tension};
use crate::smoothing::{Average, Smoothing};

/// What the frames of a stream leave to the next ones: how far each taxel has crept, and their average.
#[derive(Clone, Debug, Default)]
pub struct Past {
    /// In pascals; empty before the first frame.
    creep: Vec<f64>,
    average: Average,
}

/// Reads the frames of one sensor.
#[derive(Clone, Debug)]
pub(crate) struct Reader {
    input: Input,
    dead: DeadTaxels,
    crosstalk: Option<Crosstalk>,
    creep: Option<Creep>,
    smoothing: Option<Smoothing>,
    positions: Vec<[f64; 2]>,
    noise_floor: f64,
    full_scale: f64,
    flagged: f64,
    /// Whether contacts fall between the taxels, so that no answer is to be trusted.
    thin: bool,
}

/// A frame to be solved.
#[derive(Clone, Copy)]
pub(crate) enum FrameInput<'a> {
    /// Values as the sensor delivers them.
    Values(&'a [f64]),
    /// What [`Reader::decode`] and [`Reader::follow`] have made of them, and the noise left in it.
    Decoded(&'a [f64], Status, f64),
}

/// A frame as the solver takes it.
pub(crate) enum Reading {
    /// Something presses.
    Contact {
        /// What the contact analysis finds.
        contact: Contact,
        /// Bits raised so far.
        status: Status,
    },
    /// The result is this status, and zeros.
    Nothing(Status),
}

impl Reader {
    pub(crate) fn new(design: &Design) -> Self {
        let sensor = &design.sensor;
        Self {
            input: design.input.clone(),
            dead: DeadTaxels::new(sensor, design.algorithm.kernel, &design.input.dead),
            crosstalk: design.crosstalk(),
            creep: design.input.creep,
            smoothing: design.smoothing(),
            positions: (0..sensor.taxels()).map(|i| sensor.position_m(i)).collect(),
            noise_floor: design.algorithm.noise_floor_pa,
            full_scale: design.hardware.full_scale_pa,
            flagged: design.hardware.full_scale_in_frames(),
            thin: design.thin_layer().is_some(),
        }
    }

    /// Number of values in a frame.
    pub(crate) fn taxels(&self) -> usize {
        self.positions.len()
    }

    /// Whether the sensor reads what pulls.
    pub(crate) fn reads_tension(&self) -> bool {
        self.input.tension == Tension::Read
    }

    /// What the contact analysis finds of the stress `b` in pascals.
    pub(crate) fn analyse(&self, b: &DVector<f64>) -> Contact {
        cean::cean(b, &self.positions, self.noise_floor)
    }

    /// Whether a frame depends on those before it.
    pub(crate) fn follows(&self) -> bool {
        self.creep.is_some() || self.smoothing.is_some()
    }

    /// Reads a frame into `b` of length m.
    pub(crate) fn read(&self, frame: FrameInput<'_>, b: &mut DVector<f64>) -> Result<Reading, SolverError> {
        let (status, noise_left) = match frame {
            FrameInput::Values(values) => (self.decode(values, b.as_mut_slice())?, 1.0),
            FrameInput::Decoded(stress, status, noise_left) => {
                b.as_mut_slice().copy_from_slice(stress);
                (status, noise_left)
            }
        };
        Ok(self.judge(status, b, noise_left))
    }

    /// Converts a frame to pascals within the full scale, replaces dead taxels and removes crosstalk. Its status is
    /// [`Status::NOT_FINITE`] where it is a bad one.
    pub(crate) fn decode(&self, frame: &[f64], b: &mut [f64]) -> Result<Status, SolverError> {
        let taxels = self.taxels();
        if frame.len() != taxels {
            return Err(SolverError::length(frame.len(), taxels));
        }
        let is_dead = |taxel| self.dead.contains(taxel);
        if frame.iter().enumerate().any(|(taxel, value)| !value.is_finite() && !is_dead(taxel)) {
            return Ok(Status::NOT_FINITE);
        }
        let mut status = Status::default();
        for (taxel, (stress, &value)) in b.iter_mut().zip(frame).enumerate() {
            *stress = self.input.to_pa(taxel, value);
        }
        // What reads full scale may have been clipped by the converter: nobody can tell.
        let beyond = |(taxel, &value): (usize, &f64)| !is_dead(taxel) && self.input.is_beyond(value);
        if b.iter().any(|stress| stress.abs() >= self.flagged) || frame.iter().enumerate().any(beyond) {
            status.insert(Status::SATURATED);
        }
        self.clamp(b);
        self.dead.replace(b);
        if self.dead.taxels().iter().any(|&taxel| b[taxel].abs() > self.full_scale) {
            status.insert(Status::SATURATED);
        }
        self.clamp(b);
        if let Some(crosstalk) = &self.crosstalk {
            crosstalk.remove(b);
            self.clamp(b);
        }
        Ok(status)
    }

    /// Takes the creep of its stream off a decoded frame, and puts the average in its place; returns the noise that is left
    /// of a frame's. A bad frame leaves all as it was.
    pub(crate) fn follow(&self, past: &mut Past, status: Status, b: &mut [f64]) -> f64 {
        if status.contains(Status::NOT_FINITE) {
            return 1.0;
        }
        if let Some(creep) = &self.creep {
            creep.remove(&mut past.creep, b, self.full_scale);
        }
        self.smoothing.map_or(1.0, |smoothing| smoothing.take(&mut past.average, b, self.dead.taxels()))
    }

    fn clamp(&self, b: &mut [f64]) {
        for stress in b {
            *stress = stress.clamp(-self.full_scale, self.full_scale);
        }
    }

    /// Analyses a decoded frame, in which this much is left of a frame's noise.
    pub(crate) fn judge(&self, mut status: Status, b: &DVector<f64>, noise_left: f64) -> Reading {
        if status.contains(Status::NOT_FINITE) {
            return Reading::Nothing(status);
        }
        let contact = Contact { noise_left, ..self.analyse(b) };
        if !contact.touched {
            return Reading::Nothing(Status::NO_CONTACT);
        }
        if self.reads_tension() && b.iter().all(|&stress| stress <= self.noise_floor) {
            status.insert(Status::NO_TENSION);
        }
        if self.thin {
            status.insert(Status::LOW_CONFIDENCE);
        }
        if !self.dead.taxels().is_empty() {
            status.insert(Status::REPLACED);
        }
        let guessed: f64 = self.dead.taxels().iter().map(|&taxel| b[taxel].abs()).sum();
        if guessed > GUESSED * contact.stress_sum {
            status.insert(Status::TOO_MANY_REPLACED);
        }
        Reading::Contact { contact, status }
    }
}
