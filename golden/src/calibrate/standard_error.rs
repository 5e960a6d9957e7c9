//! The standard error and the expected error of a design, by contacts of every kind, on which nothing else was trained.

use rayon::prelude::*;

use super::CalibrateError;
use crate::design::{Design, ExpectedError, Input, StandardError};
use crate::estimators::standard_error::Marks;
use crate::metrics::Quantiles;
use crate::numbers::rounded;
use crate::scene::{Kind, normal, stream};
use crate::smoothing::noise_left;
use crate::solver::{Solver, Status};

/// Frames, each of a contact of its own; the kinds in turn.
pub const ERROR_FRAMES: usize = 850;
/// Friction of the contacts.
const FRICTIONS: [f64; 3] = [0.3, 0.5, 0.7];
/// Seeds of the contacts begin here, so that scenes of users and tests hold others.
const FIRST_SEED: u64 = 1 << 40;
/// The streams of random numbers of their noise.
const FIRST_STREAM: u64 = 1 << 32;
/// Noise of a frame over the design's, in turn.
const NOISES: [f64; 4] = [0.25, 0.5, 1.0, 1.0];
/// Noise of a design that has none: the number for noise is fitted to something.
const LEAST_NOISE: f64 = 1e-3;
/// A frame counts as at most so many times as far off, squared, as it should be.
const FARTHEST: f64 = 16.0;
/// First numbers, and their least and largest: model, noise, border.
const FIRST: [f64; 3] = [0.05, 100.0, 1.0];
const RANGES: [[f64; 2]; 3] = [[1e-3, 3.9], [0.0, 1e4], [0.0, 15.9]];
/// The search doubles and halves the numbers, then takes ever smaller steps, down to this many halvings.
const HALVINGS: i32 = 10;
/// Significant digits that are written.
const DIGITS: i32 = 4;

/// Noises of the expected error, and digits that are written of it.
const EXPECTED_NOISES: [f64; 5] = [0.0, 0.002, 0.005, 0.01, 0.02];
const EXPECTED_DIGITS: i32 = 3;

/// One frame's error and what it depends on.
struct Frame {
    error: f64,
    noise: f64,
    marks: Marks,
}

/// What one contact tells: of the frame for the standard error, and, inside the grid, the errors by noise.
struct Contact {
    frame: Option<Frame>,
    errors: Vec<Option<f64>>,
}

/// Finds the standard error and the expected error of a design, whatever its estimator; `tick` is called after each
/// contact.
///
/// # Errors
///
/// [`CalibrateError`]: a sensor without matrices, or no frame with an answer.
pub fn state_errors(design: &mut Design, seed: u64, tick: &mut dyn FnMut()) -> Result<(), CalibrateError> {
    let contacts = contacts(design, seed, tick)?;
    let of_noise = |at: usize| -> Vec<f64> {
        contacts
            .iter()
            .filter_map(|contact| contact.errors.get(at).copied().flatten())
            .map(|error| 100.0 * error)
            .collect()
    };
    let by_noise: Vec<Quantiles> = (0..EXPECTED_NOISES.len()).map(|at| Quantiles::of(of_noise(at))).collect();
    let frames: Vec<Frame> = contacts.into_iter().filter_map(|contact| contact.frame).collect();
    if frames.is_empty() || by_noise.iter().any(|errors| errors.median.is_nan()) {
        return Err(CalibrateError::no_answer(&design.name, ERROR_FRAMES));
    }
    design.algorithm.standard_error = Some(fit(&frames));
    let row = |of: fn(&Quantiles) -> f64| by_noise.iter().map(|errors| rounded(of(errors), EXPECTED_DIGITS)).collect();
    design.algorithm.expected_error = Some(ExpectedError {
        noise: EXPECTED_NOISES.to_vec(),
        median: row(|errors| errors.median),
        p95: row(|errors| errors.most),
    });
    Ok(())
}

fn contacts(design: &Design, seed: u64, tick: &mut dyn FnMut()) -> Result<Vec<Contact>, CalibrateError> {
    let Input { tension, noise, smoothing, .. } = design.input;
    // The contacts are in pascals, whatever the sensor counts, and each frame stands alone.
    let design = &Design { input: Input { tension, noise, ..Input::default() }, ..design.clone() };
    let solver = Solver::new(design)?;
    let columns = design.sensor.columns;
    // Noise is added to every kind here.
    let kinds: Vec<Kind> = Kind::all().filter(|&kind| kind != Kind::Noisy).collect();
    let largest = 0.5 * design.hardware.full_scale_pa;
    let contact = |index: usize| -> Result<Contact, CalibrateError> {
        let (kind, round) = (kinds[index % kinds.len()], index / kinds.len());
        let mut random = stream(seed, FIRST_STREAM + index as u64);
        let seeded = FIRST_SEED + (seed << 20) + index as u64;
        let scene = kind.frame(&design.sensor, FRICTIONS[round % FRICTIONS.len()], seeded)?;
        let peak = scene.stress.iter().fold(0.0_f64, |peak, stress| peak.max(tension.of(*stress).abs()));
        // Neither the full scale nor the noise floor matters to a frame in between.
        let scale = largest / peak;
        let unit: Vec<f64> = scene.stress.iter().map(|_| normal(&mut random)).collect();
        let frame = |noise: f64| -> Result<Option<Frame>, CalibrateError> {
            let noisy = scene.stress.iter().zip(&unit);
            let frame: Vec<f64> =
                noisy.map(|(stress, unit)| tension.of(scale * (stress + noise * peak * unit))).collect();
            let found = solver.solve(&frame)?;
            if found.status.contains(Status::NO_CONTACT) || found.status.contains(Status::DIRECTION_UNKNOWN) {
                return Ok(None);
            }
            let [x, y] = [0, 1].map(|axis| found.resultant[axis] - scale * scene.force[axis]);
            let error = x.hypot(y) / found.resultant[2].abs();
            Ok(Some(Frame { error, noise, marks: Marks::of(&frame, columns, None) }))
        };
        // Half of the rounds have the noise that an average leaves, half that of a frame after a restart.
        let left = if (round / NOISES.len()).is_multiple_of(2) { noise_left(smoothing) } else { 1.0 };
        let inside = !matches!(kind, Kind::Border | Kind::Mixed);
        let expected = if inside { &EXPECTED_NOISES[..] } else { &[] };
        let error = |&noise: &f64| Ok::<_, CalibrateError>(frame(noise)?.map(|frame| frame.error));
        Ok(Contact {
            frame: frame(NOISES[round % NOISES.len()] * left * noise.max(LEAST_NOISE))?,
            errors: expected.iter().map(error).collect::<Result<_, _>>()?,
        })
    };
    let mut contacts = Vec::with_capacity(ERROR_FRAMES);
    for round in 0..ERROR_FRAMES / kinds.len() {
        let indices = round * kinds.len()..(round + 1) * kinds.len();
        let found: Vec<Contact> = indices.into_par_iter().map(contact).collect::<Result<_, _>>()?;
        for _ in 0..found.len() {
            tick();
        }
        contacts.extend(found);
    }
    Ok(contacts)
}

/// The numbers under which the errors, as normal in the plane, are most likely.
fn fit(frames: &[Frame]) -> StandardError {
    let made = |[model, noise, border]: [f64; 3]| StandardError { model, noise, border };
    let loss = |numbers: [f64; 3]| -> f64 {
        let of = made(numbers);
        let each = frames.iter().map(|frame| {
            let share = of.share(frame.noise, frame.marks);
            2.0 * share.ln() + (frame.error / share).powi(2).min(FARTHEST)
        });
        each.sum()
    };
    let (mut best, mut least) = (FIRST, loss(FIRST));
    for halving in 0..HALVINGS {
        let factor = (1.0 - f64::from(halving)).exp2().exp();
        let mut found = true;
        while found {
            found = false;
            for (at, [low, high]) in RANGES.into_iter().enumerate() {
                for factor in [factor, 1.0 / factor] {
                    let mut tried = best;
                    tried[at] = (best[at] * factor).clamp(low.max(1e-6), high);
                    let value = loss(tried);
                    if value < least {
                        (best, least, found) = (tried, value, true);
                    }
                }
            }
        }
    }
    made(best.map(|number| rounded(number, DIGITS)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_behind_errors_are_found() {
        let of = StandardError { model: 0.02, noise: 80.0, border: 1.5 };
        let mut random = stream(1, 0);
        let frames: Vec<Frame> = (0..4000)
            .map(|index| {
                let border = if index % 4 == 0 { 0.1 * f64::from(index % 7) } else { 0.0 };
                let marks = Marks { peak: 0.05 + 0.03 * f64::from(index % 5), border };
                let noise = 0.01 * NOISES[index as usize % 4];
                let length = normal(&mut random).hypot(normal(&mut random));
                let share = of.share(noise, marks);
                Frame { error: std::f64::consts::FRAC_1_SQRT_2 * length * share, noise, marks }
            })
            .collect();
        let found = fit(&frames);
        let ratios = [found.model / of.model, found.noise / of.noise, found.border / of.border];
        assert!(ratios.iter().all(|ratio| (0.93..1.07).contains(ratio)), "{found:?}");
        assert!((rounded(0.023_456, 4) - 0.023_46).abs() < 1e-12 && (rounded(118.049, 4) - 118.0).abs() < 1e-12);
    }
}
