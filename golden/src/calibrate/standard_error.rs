//! The three numbers of a design's standard error, fitted to contacts of every kind, on which nothing else was trained.

use rayon::prelude::*;

use super::samples::stream;
use super::{CalibrateError, Stage};
use crate::design::{Design, Input, StandardError};
use crate::estimators::standard_error::Marks;
use crate::scene::{Kind, normal};
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

/// One frame's error and what it depends on.
struct Frame {
    error: f64,
    noise: f64,
    marks: Marks,
}

/// Fits the standard error of a design, whatever its estimator; `tick` is called after each frame.
///
/// # Errors
///
/// [`CalibrateError`]: a sensor without matrices, or no frame with an answer.
pub fn standard_error(
    design: &Design,
    seed: u64,
    tick: &mut dyn FnMut(Stage),
) -> Result<StandardError, CalibrateError> {
    let frames = frames(design, seed, tick)?;
    if frames.is_empty() {
        return Err(CalibrateError::NoAnswer { name: design.name.clone(), samples: ERROR_FRAMES });
    }
    Ok(fit(&frames))
}

fn frames(design: &Design, seed: u64, tick: &mut dyn FnMut(Stage)) -> Result<Vec<Frame>, CalibrateError> {
    let Input { tension, noise, .. } = design.input;
    // The contacts are in pascals, whatever the sensor counts.
    let design = &Design { input: Input { tension, noise, ..Input::default() }, ..design.clone() };
    let solver = Solver::new(design)?;
    let columns = design.sensor.columns;
    // Noise is added to every kind here.
    let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|&kind| kind != Kind::Noisy).collect();
    let largest = 0.5 * design.hardware.full_scale_pa;
    let frame = |index: usize| -> Result<Option<Frame>, CalibrateError> {
        let (kind, round) = (kinds[index % kinds.len()], index / kinds.len());
        let mut random = stream(seed, FIRST_STREAM + index as u64);
        let seeded = FIRST_SEED + (seed << 20) + index as u64;
        let scene = kind.frame(&design.sensor, FRICTIONS[round % FRICTIONS.len()], seeded)?;
        let share = NOISES[round % NOISES.len()] * noise.max(LEAST_NOISE);
        let peak = scene.stress.iter().fold(0.0_f64, |peak, stress| peak.max(tension.of(*stress).abs()));
        // Neither the full scale nor the noise floor matters to a frame in between.
        let scale = largest / peak;
        let noisy = scene.stress.iter().map(|stress| tension.of(scale * (stress + share * peak * normal(&mut random))));
        let frame: Vec<f64> = noisy.collect();
        let found = solver.solve(&frame)?;
        if found.status.contains(Status::NO_CONTACT) || found.status.contains(Status::DIRECTION_UNKNOWN) {
            return Ok(None);
        }
        let [x, y] = [0, 1].map(|axis| found.resultant[axis] - scale * scene.force[axis]);
        let error = x.hypot(y) / found.resultant[2].abs();
        Ok(Some(Frame { error, noise: share, marks: Marks::of(&frame, columns) }))
    };
    let mut frames = Vec::with_capacity(ERROR_FRAMES);
    for round in 0..ERROR_FRAMES / kinds.len() {
        let indices = round * kinds.len()..(round + 1) * kinds.len();
        let found: Vec<Option<Frame>> = indices.into_par_iter().map(frame).collect::<Result<_, _>>()?;
        for _ in 0..found.len() {
            tick(Stage::Sample);
        }
        frames.extend(found.into_iter().flatten());
    }
    Ok(frames)
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
    made(best.map(rounded))
}

/// To the digits that are written.
fn rounded(value: f64) -> f64 {
    let digits = DIGITS - 1 - value.abs().max(f64::MIN_POSITIVE).log10().floor() as i32;
    let scale = 10_f64.powi(digits.abs());
    if digits >= 0 { (value * scale).round() / scale } else { (value / scale).round() * scale }
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
        assert!((rounded(0.023_456) - 0.023_46).abs() < 1e-12 && (rounded(118.049) - 118.0).abs() < 1e-12);
    }
}
