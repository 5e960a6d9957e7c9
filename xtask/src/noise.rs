//! Errors against the noise of a reading: round sliding contacts on which no design was trained.

use std::fmt::Write;
use std::ops::Range;

use golden::design::Design;
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneError, SceneFrame, normal};
use golden::solver::{Solver, SolverError};
use hdl_gen::emit::resolved_hash;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Standard deviations of a reading in percent of the frame's largest.
pub const NOISE_PERCENT: [f64; 5] = [0.0, 0.2, 0.5, 1.0, 2.0];
/// Friction of the contacts.
const FRICTION: f64 = 0.5;
/// A contact each, which no calibration draws.
const SEEDS: Range<u64> = 90_000..90_200;

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum NoiseError {
    /// The sensor is too deep or too shallow for scenes.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The sensor's matrices, or a frame.
    #[error(transparent)]
    Solver(#[from] SolverError),
}

/// What the design's sensor reads of a frame, with noise in percent of its largest reading.
pub(crate) fn noisy(design: &Design, frame: &SceneFrame, percent: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut stress = frame.stress.clone();
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
    for frame in frames {
        let found = solver.solve(&noisy(design, frame, percent, &mut random))?.resultant;
        let [x, y] = [0, 1].map(|axis| found[axis] - frame.force[axis]);
        errors.push(100.0 * x.hypot(y) / frame.force[2].abs());
    }
    Ok(Quantiles::of(errors))
}

/// The table of some designs, which go by the names of their files.
///
/// # Errors
///
/// [`NoiseError`]: a sensor without matrices or scenes.
pub fn csv(designs: &[(String, Design)]) -> Result<String, NoiseError> {
    let hashes: Vec<String> =
        designs.iter().map(|(name, design)| format!("{name} {}", resolved_hash(design))).collect();
    let mut text = format!(
        "# Error of the tangential force against noise, in percent of the normal force, by the f64 solver.\n\
         # {} round sliding contacts at a friction of {FRICTION}, none of them drawn by a calibration.\n\
         # noise: standard deviation in percent of the largest reading of a frame.\n\
         # command: cargo xtask noise DESIGNS --out results/noise.csv\n\
         # designs: {}\n\
         design,noise,median,p95,worst\n",
        SEEDS.count(),
        hashes.join(", ")
    );
    for (name, design) in designs {
        let frames = Kind::Sliding.frames(&design.sensor, FRICTION, SEEDS)?;
        for percent in NOISE_PERCENT {
            let Quantiles { median, most, worst } = errors(design, &frames, percent)?;
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name},{percent},{median:.1},{most:.1},{worst:.1}");
        }
    }
    Ok(text)
}
