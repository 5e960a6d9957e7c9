//! Errors against the noise of a reading: round sliding contacts on which no design was trained.

use std::fmt::Write;
use std::ops::{Range, RangeInclusive};

use golden::design::{Design, Input};
use golden::estimators::joint::TrainingSet;
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame, bound, normal};
use golden::smoothing::{Average, Smoothing};
use golden::solver::{Solver, SolverError};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Rows, shear_error};

/// Standard deviations of a reading in percent of the frame's largest.
const NOISE_PERCENT: [f64; 5] = [0.0, 0.2, 0.5, 1.0, 2.0];
/// Friction of the contacts.
const FRICTION: f64 = 0.5;
/// A contact each, which no calibration draws.
const SEEDS: Range<u64> = 90_000..90_200;
/// Draws of the noise of each contact: the 95 % of one draw differ by a tenth from those of another.
const DRAWS: usize = 5;

/// Noises of the table of smoothing.
const SMOOTHED_PERCENT: [f64; 4] = [0.2, 0.5, 1.0, 2.0];
/// Keys `smoothing` of it; 0: one frame.
const SMOOTHING: RangeInclusive<u32> = 0..=8;
/// Frames of a contact from the first one on: the average of the slowest has forgotten all but 1 % of it.
const FRAMES: usize = 1200;

/// What the design's sensor reads of stresses in pascals, with noise in percent of the largest reading.
pub fn noisy(design: &Design, stress: &[f64], percent: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut stress = stress.to_vec();
    let tension = design.input.tension;
    let largest = stress.iter().fold(0.0_f64, |largest, stress| largest.max(tension.of(*stress).abs()));
    for stress in &mut stress {
        *stress += 0.01 * percent * largest * normal(random);
    }
    design.deliver(&mut stress);
    stress
}

/// Errors of the tangential force of a design on frames in percent of the normal force, at a noise in percent.
fn errors(design: &Design, frames: &[SceneFrame], percent: f64) -> Result<Quantiles, SolverError> {
    let solver = Solver::new(design)?;
    let mut random = ChaCha8Rng::seed_from_u64(SEEDS.start);
    let mut errors = Vec::new();
    for frame in frames.iter().flat_map(|frame| std::iter::repeat_n(frame, DRAWS)) {
        let found = solver.solve(&noisy(design, &frame.stress, percent, &mut random))?.resultant;
        errors.push(shear_error(found, frame.force));
    }
    Ok(Quantiles::of(errors))
}

/// Errors of the tangential force where each contact is averaged over frames with each key `smoothing`, in percent of the
/// normal force, at a noise in percent.
fn smoothed(
    design: &Design,
    frames: &[SceneFrame],
    percent: f64,
    smoothing: &[u32],
) -> Result<Vec<Quantiles>, SolverError> {
    let solver = Solver::new(design)?;
    let tension = design.input.tension;
    let of_contact = |(index, frame): (usize, &SceneFrame)| -> Result<Vec<f64>, SolverError> {
        let mut random = ChaCha8Rng::seed_from_u64(SEEDS.start + index as u64);
        let largest = frame.stress.iter().fold(0.0_f64, |largest, stress| largest.max(tension.of(*stress).abs()));
        let mut averages: Vec<(Option<Smoothing>, Average, Vec<f64>)> = smoothing
            .iter()
            .map(|&k| ((k > 0).then(|| Smoothing::new(k, 0.01 * percent, None)), Average::default(), Vec::new()))
            .collect();
        for _ in 0..FRAMES {
            let mut read = frame.stress.clone();
            for stress in &mut read {
                *stress += 0.01 * percent * largest * normal(&mut random);
            }
            design.deliver(&mut read);
            for (smoothing, average, last) in &mut averages {
                last.clone_from(&read);
                if let Some(smoothing) = smoothing {
                    smoothing.take(average, last, &[]);
                }
            }
        }
        let error = |(_, _, last): &(Option<Smoothing>, Average, Vec<f64>)| {
            Ok(shear_error(solver.solve(last)?.resultant, frame.force))
        };
        averages.iter().map(error).collect()
    };
    let errors: Vec<Vec<f64>> = frames.par_iter().enumerate().map(of_contact).collect::<Result<_, _>>()?;
    Ok((0..smoothing.len()).map(|k| Quantiles::of(errors.iter().map(|of| of[k]).collect())).collect())
}

/// The columns of [`smoothing_rows`].
pub const SMOOTHING_COLUMNS: &str = "design,noise,k,frames,median,p95,bound";

/// The table of smoothing of some designs, each with the bound of the median error on its sensor. A design with `smoothing`,
/// which is trained for it, is measured at its own noise: averaged as it says, and on single frames, as a restart leaves them.
pub fn smoothing_rows(designs: &[(String, Design)]) -> Rows {
    let mut text = String::new();
    for (name, design) in designs {
        let [bound, _] = bound(&design.sensor, FRICTION, SEEDS)?;
        let frames = Kind::Sliding.frames(&design.sensor, FRICTION, SEEDS)?;
        let Input { noise, smoothing: own, .. } = design.input;
        let (noises, smoothing) = match own {
            0 => (SMOOTHED_PERCENT.to_vec(), SMOOTHING.collect()),
            own => (vec![100.0 * noise], vec![0, own]),
        };
        for percent in noises {
            let errors = smoothed(design, &frames, percent, &smoothing)?;
            for (&k, Quantiles { median, most, .. }) in smoothing.iter().zip(errors) {
                let count = 2_u32.pow(k + 1) - 1;
                let bound = bound * percent / f64::from(count).sqrt();
                let _ = writeln!(text, "{name},{percent},{k},{count},{median:.2},{most:.2},{bound:.2}");
            }
        }
    }
    Ok(text)
}

/// The columns of [`rows`].
pub const COLUMNS: &str = "design,noise,median,p95,worst,bound,bound_p95";

/// The table of some designs, which go by the names of their files, each with the bound of median and 95 % on its sensor.
/// A design that is trained on contacts of any kind has rows of mixed ones too, without a bound.
pub fn rows(designs: &[(String, Design)]) -> Rows {
    let mut text = String::new();
    for (name, design) in designs {
        let frames = Kind::Sliding.frames(&design.sensor, FRICTION, SEEDS)?;
        let bound = bound(&design.sensor, FRICTION, SEEDS)?;
        for percent in NOISE_PERCENT {
            let [bound, bound_most] = bound.map(|error| percent * error);
            let Quantiles { median, most, worst } = errors(design, &frames, percent)?;
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name},{percent},{median:.1},{most:.1},{worst:.1},{bound:.2},{bound_most:.2}");
        }
        if design.algorithm.joint.training_set == TrainingSet::General {
            let frames = Kind::MixedInside.frames(&design.sensor, FRICTION, SEEDS)?;
            for percent in NOISE_PERCENT {
                let Quantiles { median, most, worst } = errors(design, &frames, percent)?;
                let _ = writeln!(text, "{name}-mixed,{percent},{median:.1},{most:.1},{worst:.1},,");
            }
        }
    }
    Ok(text)
}
