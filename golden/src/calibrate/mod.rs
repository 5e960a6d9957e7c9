//! Constants of the grid search, fitted to contacts with known forces.
//!
//! Everything comes from the design and a seed: contacts at random on a bonded layer, their stress, the estimate
//! before it is calibrated, then a gain, two constants for the friction, and the weights of the correction.

mod contacts;
mod diagonal;
mod general;
mod observer;
pub mod recorded;
mod samples;
mod standard_error;
mod train;
mod whitening;

pub use contacts::random_contacts;
pub use standard_error::{ERROR_FRAMES, state_errors};

use crate::design::{Design, Estimator, Input, JointConstants, Reads, conditions};
use crate::estimators::joint::{CUBIC_LIMIT, MAX_HIDDEN, TrainingSet};
use crate::scene::SceneError;
use crate::solver::SolverError;
use observer::{Observer, Sample};

/// Hidden units for sliding contacts: with twice as many a frame takes a quarter longer on 16 lanes.
const HIDDEN_SLIDING: usize = 64;

/// How much work the calibration takes on; more of each makes better constants, slowly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Seed of all that is random.
    pub seed: u64,
    /// Contacts whose stress is computed.
    pub contacts: usize,
    /// Frames made from them, each with a friction, a direction and noise of its own.
    pub samples: usize,
    /// Hidden units of the correction; 0 for none.
    pub hidden: usize,
    /// Hidden units that its training begins with beside those, and leaves out one by one, the least of them first.
    pub spare: usize,
    /// Steps of its training.
    pub steps: usize,
    /// Whether pressures of sliding contacts go as far as one that is nothing in a contact's middle.
    pub hollow: bool,
}

impl Settings {
    /// What a user asks for: `hidden` units if the usual number is not wanted, `quick` for a tenth of the work, `thorough`
    /// for four times as much and more.
    ///
    /// # Errors
    ///
    /// [`CalibrateError::Wrong`] for more units than the hardware has room for.
    pub fn of(
        training_set: TrainingSet,
        seed: u64,
        hidden: Option<usize>,
        quick: bool,
        thorough: bool,
    ) -> Result<Self, CalibrateError> {
        if let Some(hidden) = hidden.filter(|&hidden| hidden > MAX_HIDDEN) {
            return Err(CalibrateError::Wrong(format!(
                "--hidden {hidden}: the hardware has room for {MAX_HIDDEN}; use at most {MAX_HIDDEN}"
            )));
        }
        let usual = if quick { Self::quick() } else { Self::default() };
        let usual = match training_set {
            TrainingSet::Sliding => Self { hidden: usual.hidden.min(HIDDEN_SLIDING), ..usual },
            // A contact has one direction only, so there are more of them.
            TrainingSet::General => {
                Self { contacts: 2 * usual.contacts, samples: usual.samples + usual.samples / 5, ..usual }
            }
        };
        let settings = Self { seed, hidden: hidden.unwrap_or(usual.hidden), ..usual };
        Ok(if thorough { settings.thorough() } else { settings })
    }

    /// The same with four times the contacts, frames and steps, as many spare units as there are to be, and pressures
    /// that rise further towards the edge: for a network that must do with few units.
    #[must_use]
    pub fn thorough(self) -> Self {
        let Self { contacts, samples, steps, hidden, .. } = self;
        // An even number, so that an odd one without a partner stays.
        let spare = hidden.next_multiple_of(2);
        Self { contacts: 4 * contacts, samples: 4 * samples, steps: 4 * steps, spare, hollow: true, ..self }
    }

    /// Pieces of work, each of which is reported.
    pub fn work(&self) -> usize {
        // Without hidden units nothing is trained.
        let training = if self.hidden > 0 { self.steps } else { 0 };
        self.contacts + self.samples + training
    }

    /// A tenth of the work, for a first look: errors are up to twice as large.
    pub fn quick() -> Self {
        Self { contacts: 2000, samples: 10_000, hidden: 24, steps: 3000, ..Self::default() }
    }

    /// The gain and the constants of friction alone, without a correction: about a second.
    pub fn constants() -> Self {
        Self { contacts: 400, samples: 2000, hidden: 0, steps: 0, ..Self::default() }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 1, contacts: 20_000, samples: 100_000, hidden: 128, spare: 0, steps: 40_000, hollow: false }
    }
}

/// Why a design cannot be calibrated.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// The sensor's matrices or the filter.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// The sensor is too deep or too shallow for scenes.
    #[error("contacts for the calibration: {0}")]
    Scene(#[from] SceneError),
    /// What else is wrong and what to do, in words.
    #[error("{0}")]
    Wrong(String),
}

impl CalibrateError {
    fn no_answer(name: &str, samples: usize) -> Self {
        Self::Wrong(format!(
            "{name}: none of the {samples} frames made for the calibration has an answer; lower algorithm.noise_floor_pa or \
             check the filter"
        ))
    }
}

/// Fits the constants of the grid search to a design; `tick` is called after each piece of work: a contact's stress, a
/// frame's estimate, a step of the training.
///
/// The same design and settings give the same constants on the same machine; another processor may round the sums of
/// the training differently, which changes a few weights by little.
///
/// # Errors
///
/// [`CalibrateError`]: another estimator, a sensor without matrices or scenes, or one on which the fit fails.
pub fn calibrate(
    design: &Design,
    settings: &Settings,
    tick: &mut dyn FnMut(),
) -> Result<JointConstants, CalibrateError> {
    let name = &design.name;
    if design.algorithm.estimator != Estimator::Joint {
        return Err(CalibrateError::Wrong(format!(
            "{name}: the estimator is \"line\", which has no constants; write estimator = \"joint\" under [algorithm]"
        )));
    }
    // The contacts are in pascals, whatever the sensor counts, and frames do not follow each other.
    let Input { tension, noise, smoothing, .. } = design.input;
    let design = &Design { input: Input { tension, noise, ..Input::default() }, ..design.clone() };
    let half_window = contacts::half_window(&design.sensor);
    let mut observer = Observer::new(design, smoothing, half_window)?;
    let samples = samples::make(&mut observer, settings, tick)?;
    if samples.is_empty() {
        return Err(CalibrateError::no_answer(name, settings.samples));
    }
    let (gain, targets) = samples::gain_and_targets(&samples);
    let friction_correction = fit_friction_correction(&samples, &targets);
    let [c1, c3] = friction_correction;
    let legal = (0.1..=10.0).contains(&gain) && (0.1..=10.0).contains(&c1) && c3.abs() <= CUBIC_LIMIT;
    if !legal {
        return Err(CalibrateError::Wrong(format!(
            "{name}: the calibration finds gain {gain:.3} and friction_correction = [{c1:.3}, {c3:.3}], which is out of range: \
             this sensor cannot be calibrated; check its pitch and depth"
        )));
    }
    let (sensor, training_set) = (&design.sensor, design.algorithm.joint.training_set);
    let correction = (settings.hidden > 0).then(|| {
        train::train((sensor, training_set), &samples, &targets, friction_correction, half_window, settings, tick)
    });
    let algorithm = &design.algorithm;
    let reads = Reads { tension, noise, smoothing };
    let conditions = conditions(sensor, reads, algorithm.kernel, algorithm.regularisation, training_set);
    Ok(JointConstants { training_set, gain, friction_correction, correction, calibrated_for: Some(conditions) })
}

/// The constants `c1, c3` that bring `c1 mu + c3 mu |mu|^2` closest to the targets, by least squares.
fn fit_friction_correction<S: std::borrow::Borrow<Sample>>(samples: &[S], targets: &[[f64; 2]]) -> [f64; 2] {
    let (mut a, mut b, mut c, mut p, mut q) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (sample, target) in samples.iter().map(std::borrow::Borrow::borrow).zip(targets) {
        let square = sample.mu[0].powi(2) + sample.mu[1].powi(2);
        let product = sample.mu[0] * target[0] + sample.mu[1] * target[1];
        a += square;
        b += square * square;
        c += square.powi(3);
        p += product;
        q += product * square;
    }
    let determinant = a * c - b * b;
    [(p * c - q * b) / determinant, (a * q - b * p) / determinant]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliding_contacts_have_fewer_units() {
        let units = |training_set, quick, hidden| Settings::of(training_set, 1, hidden, quick, false).unwrap().hidden;
        assert_eq!(units(TrainingSet::Sliding, false, None), 64);
        assert_eq!(units(TrainingSet::General, false, None), 128);
        assert_eq!(units(TrainingSet::Sliding, true, None), 24);
        assert_eq!(units(TrainingSet::Sliding, false, Some(200)), 200);
    }
}
