//! The constants of friction, where tangential forces were measured.

use super::folds::Folds;
use super::holds::Hold;
use crate::calibrate::observer::{Observer, Sample};
use crate::calibrate::samples::target;
use crate::calibrate::{CalibrateError, contacts, fit_friction_correction};
use crate::design::{Design, Estimator};
use crate::estimators::joint::{CUBIC_LIMIT, Joint, JointConstants, NetworkScratch, scaled};
use crate::scene::stream;

use super::RecordedError;

/// Holds dragged by less than this share of the load tell nothing of friction.
const DRAGGED: f64 = 0.05;
/// Fewer holds, or groups of them, tell no constants.
const FEWEST: [usize; 2] = [6, 3];
/// Other constants must lower the error to this share.
const BETTER: f64 = 0.95;
/// Ranges of c1, as in the design file.
const LINEAR: [f64; 2] = [0.1, 10.0];

/// What was made of the tangential forces, or why nothing was.
pub(super) type Verdict = Result<String, String>;

/// Fits `friction_correction` of a calibrated design to holds with their stress that presses.
pub(super) fn fit(
    design: &mut Design,
    holds: &[Hold],
    stresses: &[Vec<f64>],
    folds: Option<&Folds>,
) -> Result<Verdict, RecordedError> {
    let not = |words: String| Ok(Err(format!("friction: {words}")));
    let known: Vec<usize> =
        (0..holds.len()).filter(|&h| holds[h].force[0].is_some() && holds[h].force[1].is_some()).collect();
    if known.is_empty() {
        let one = holds.iter().any(|hold| hold.force[0].is_some() || hold.force[1].is_some());
        let why = if one { "only one tangential component is known" } else { "no tangential forces are known" };
        return not(format!("{why}; its constants stay. Pull the contact sideways with known forces (F_x, F_y)"));
    }
    if design.algorithm.estimator != Estimator::Joint {
        return not("the line search has no constants; write estimator = \"joint\" to have some".to_owned());
    }
    let drag = |h: usize| holds[h].force[0].unwrap_or(0.0).hypot(holds[h].force[1].unwrap_or(0.0)) / holds[h].load;
    let dragged: Vec<usize> = known.into_iter().filter(|&h| drag(h) >= DRAGGED).collect();
    let Some(folds) = folds.filter(|_| dragged.len() >= FEWEST[0]) else {
        return not(format!(
            "{} holds are dragged by more than 5 % of their load; its constants stay. Record at least {}, at three places or loads",
            dragged.len(),
            FEWEST[0]
        ));
    };
    let samples = match samples(design, holds, stresses, &dragged) {
        Ok(samples) => samples,
        Err(CalibrateError::Solver(error)) => return Err(error.into()),
        Err(error) => return not(error.to_string()),
    };
    let within =
        |part: &[usize]| -> Vec<usize> { (0..samples.len()).filter(|&s| part.contains(&samples[s].hold)).collect() };
    let parts: Vec<[Vec<usize>; 2]> = folds.parts().map(|part| part.map(|holds| within(&holds))).collect();
    if samples.len() < FEWEST[0] || parts.iter().filter(|[_, left]| !left.is_empty()).count() < FEWEST[1] {
        return not(format!("{} holds at too few places or loads have an answer; its constants stay", samples.len()));
    }
    let along: f64 = samples.iter().map(|s| s.sample.mu[0] * s.target[0] + s.sample.mu[1] * s.target[1]).sum();
    if along <= 0.0 {
        return not("F_x and F_y point against what the sensor finds: they must be what the object exerts on the sensor, along its columns and rows. Its constants stay".to_owned());
    }
    let before = design.algorithm.joint.friction_correction;
    let gain = design.algorithm.joint.gain;
    let all: Vec<usize> = (0..samples.len()).collect();
    let error = |constants: [f64; 2], of: &[usize]| -> f64 {
        of.iter().map(|&s| samples[s].sample.error(samples[s].with(constants), gain).powi(2)).sum()
    };
    let score = |fit: &dyn Fn(&[usize]) -> [f64; 2]| {
        let sum: f64 = parts.iter().map(|[kept, left]| error(fit(kept), left)).sum();
        (sum / samples.len() as f64).sqrt()
    };
    // The same shape, larger or smaller; then both constants.
    let scaled = |of: &[usize]| {
        let (mut a, mut b) = (0.0, 0.0);
        for s in of.iter().map(|&s| &samples[s]) {
            let curve = scaled(s.sample.mu, before);
            a += curve[0] * s.wanted()[0] + curve[1] * s.wanted()[1];
            b += curve[0] * curve[0] + curve[1] * curve[1];
        }
        before.map(|constant| constant * if b > 0.0 { a / b } else { 1.0 })
    };
    let free = |of: &[usize]| {
        let kept: Vec<&Sample> = of.iter().map(|&s| &samples[s].sample).collect();
        let targets: Vec<[f64; 2]> = of.iter().map(|&s| samples[s].wanted()).collect();
        fit_friction_correction(&kept, &targets)
    };
    let legal = |[c1, c3]: [f64; 2]| (LINEAR[0]..=LINEAR[1]).contains(&c1) && c3.abs() <= CUBIC_LIMIT;
    let as_it_was = score(&|_| before);
    let candidates = [(score(&scaled), scaled(&all)), (score(&free), free(&all))];
    let mut best = (as_it_was, before);
    for (score, constants) in candidates {
        if score < BETTER * best.0 && legal(constants) {
            best = (score, constants);
        }
    }
    let (now, constants) = best;
    if constants.map(f64::to_bits) == before.map(f64::to_bits) {
        return not(format!(
            "other constants do no better; they stay, with errors of (F_x, F_y) of {:.1} % of F_z (root mean square of {} holds)",
            100.0 * as_it_was,
            samples.len()
        ));
    }
    design.algorithm.joint.friction_correction = constants;
    let [c1, c3] = constants;
    Ok(Ok(format!(
        "friction: friction_correction = [{c1:.3}, {c3:.3}]; (F_x, F_y) have an error of {:.1} % of F_z where left out, {:.1} % with the old constants (root mean square of {} holds)",
        100.0 * now,
        100.0 * as_it_was,
        samples.len()
    )))
}

/// A hold as the estimator sees it.
struct DraggedHold {
    hold: usize,
    sample: Sample,
    /// Friction components that make its tangential force right.
    target: [f64; 2],
    /// What the correction adds, as it is.
    added: [f64; 2],
}

impl DraggedHold {
    /// What is left for the constants to say.
    fn wanted(&self) -> [f64; 2] {
        [self.target[0] - self.added[0], self.target[1] - self.added[1]]
    }

    fn with(&self, constants: [f64; 2]) -> [f64; 2] {
        let [x, y] = scaled(self.sample.mu, constants);
        [x + self.added[0], y + self.added[1]]
    }
}

fn samples(
    design: &Design,
    holds: &[Hold],
    stresses: &[Vec<f64>],
    dragged: &[usize],
) -> Result<Vec<DraggedHold>, CalibrateError> {
    let constants = &design.algorithm.joint;
    let plain = Design { input: design.input.of_pascals(), ..design.clone() };
    let half_window = constants
        .correction
        .as_ref()
        .map_or_else(|| contacts::half_window(&design.sensor), |correction| correction.half_window);
    let mut observer = Observer::new(&plain, 0, half_window)?;
    let bare =
        Joint::new(&JointConstants { friction_correction: [0.0, 0.0], ..(**constants).clone() }, design.sensor.columns);
    let mut scratch = NetworkScratch::default();
    // Without noise nothing is drawn that counts.
    let mut random = stream(0, 0);
    let mut seen = Vec::new();
    for &hold in dragged {
        let frame = stresses[hold].iter().map(|stress| -stress).collect();
        let [x, y, _] = holds[hold].force.map(Option::unwrap_or_default);
        let force = [x, y, -holds[hold].load];
        if let Some(sample) = observer.sample(frame, force, 0.0, &mut random)? {
            let added = bare.corrected(sample.mu, &sample.features, &mut scratch);
            seen.push(DraggedHold { hold, target: target(&sample, constants.gain), added, sample });
        }
    }
    Ok(seen)
}
