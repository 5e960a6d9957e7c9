//! How right a standard error is: shares of errors within it, by noise and kind of contact.

use std::fmt::Write;
use std::ops::Range;

use golden::design::Design;
use golden::scene::Kind;
use golden::smoothing::noise_left;
use golden::solver::{Solver, Status};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::noise::noisy;
use super::{Fallible, Rows};

/// Standard deviations of a reading in percent of the frame's largest; the design is told each.
const NOISE_PERCENT: [f64; 4] = [0.2, 0.5, 1.0, 2.0];
/// Friction of the contacts.
const FRICTION: f64 = 0.5;
/// A contact of each kind, which no calibration draws.
const SEEDS: Range<u64> = 91_000..91_200;
/// Parts of the frames sorted by standard error.
const PARTS: usize = 5;

/// A frame's error and standard error as shares of the normal force found, whether it has low confidence, and the share of the
/// taxels' normal forces that pull.
struct Frame {
    error: f64,
    standard_error: f64,
    low: bool,
    pulling: f64,
}

/// The columns of [`rows`].
pub const COLUMNS: &str = "design,noise,kind,within_one,within_two,low,least,most,pulling";

/// The table of some designs, which go by the names of their files.
pub fn rows(designs: &[(String, Design)]) -> Rows {
    let mut text = String::new();
    for (name, design) in designs {
        for percent in NOISE_PERCENT {
            let left = percent * noise_left(design.input.smoothing);
            let mut told = design.clone();
            (told.input.noise, told.input.smoothing) = (0.01 * left, 0);
            let solver = Solver::new(&told)?;
            let mut inside = Vec::new();
            for kind in Kind::all().filter(|&kind| kind != Kind::Noisy) {
                let found = frames(&told, &solver, kind, left)?;
                row(&mut text, &format!("{name},{percent},{kind}"), &found, "");
                if !matches!(kind, Kind::Border | Kind::Mixed) {
                    inside.extend(found);
                }
            }
            inside.sort_by(|one, other| one.standard_error.total_cmp(&other.standard_error));
            let ratios: Vec<f64> = inside.chunks(inside.len().div_ceil(PARTS).max(1)).map(ratio).collect();
            let [least, most] = [f64::min, f64::max].map(|of| ratios.iter().copied().reduce(of).unwrap_or_default());
            row(
                &mut text,
                &format!("{name},{percent},inside"),
                &inside,
                &format!("{least:.2},{most:.2},{}", by_pulling(&inside)),
            );
        }
    }
    Ok(text)
}

fn frames(design: &Design, solver: &Solver, kind: Kind, percent: f64) -> Fallible<Vec<Frame>> {
    let mut random = ChaCha8Rng::seed_from_u64(SEEDS.start);
    let mut found = Vec::new();
    for frame in kind.frames(&design.sensor, FRICTION, SEEDS)? {
        let solution = solver.solve(&noisy(design, &frame.stress, percent, &mut random))?;
        let [x, y] = [0, 1].map(|axis| solution.resultant[axis] - frame.force[axis]);
        let [error, standard_error] =
            [x.hypot(y), solution.standard_error].map(|newtons| newtons / solution.resultant[2].abs());
        let [mut pull, mut all] = [0.0, 0.0];
        for &normal in &solution.field[2] {
            pull += normal.max(0.0);
            all += normal.abs();
        }
        let (low, pulling) = (solution.status.contains(Status::LOW_CONFIDENCE), pull / all);
        found.push(Frame { error, standard_error, low, pulling });
    }
    Ok(found)
}

/// Root mean square of the errors over the mean of the standard errors.
fn ratio(frames: &[Frame]) -> f64 {
    let count = frames.len() as f64;
    let square = frames.iter().map(|frame| frame.error.powi(2)).sum::<f64>() / count;
    square.sqrt() / (frames.iter().map(|frame| frame.standard_error).sum::<f64>() / count)
}

/// Correlation of the errors over their standard errors with the share of normal forces that pull; blank without a field.
fn by_pulling(frames: &[Frame]) -> String {
    let count = frames.len() as f64;
    let pairs = || frames.iter().map(|frame| [frame.error / frame.standard_error, frame.pulling]);
    let mean: [f64; 2] = [0, 1].map(|of| pairs().map(|pair| pair[of]).sum::<f64>() / count);
    let product = |one: usize, other: usize| {
        pairs().map(|pair| (pair[one] - mean[one]) * (pair[other] - mean[other])).sum::<f64>()
    };
    let correlation = product(0, 1) / (product(0, 0) * product(1, 1)).sqrt();
    if correlation.is_finite() { format!("{correlation:.2}") } else { String::new() }
}

fn row(text: &mut String, head: &str, frames: &[Frame], ratios: &str) {
    let share = |is: &dyn Fn(&Frame) -> bool| {
        100.0 * frames.iter().filter(|frame| is(frame)).count() as f64 / frames.len().max(1) as f64
    };
    let within = |errors: f64| share(&move |frame: &Frame| frame.error <= errors * frame.standard_error);
    let ratios = if ratios.is_empty() { ",," } else { ratios };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{head},{:.0},{:.0},{:.0},{ratios}", within(1.0), within(2.0), share(&|frame| frame.low));
}
