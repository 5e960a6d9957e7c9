//! How far a result is from the truth.

mod contacts;

pub use contacts::{ContactErrors, Quantiles, pairs};

use serde::{Deserialize, Serialize};

use crate::scene::SceneFrame;
use crate::solver::Solution;

/// The summary of a frame that truth and estimate have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Resultant force in newtons.
    pub force: [f64; 3],
    /// Tangential over normal resultant.
    pub friction: f64,
    /// Direction of the tangential resultant in radians.
    pub direction: f64,
}

impl From<&SceneFrame> for Outcome {
    fn from(frame: &SceneFrame) -> Self {
        Self { force: frame.force, friction: frame.friction, direction: frame.direction }
    }
}

impl From<&Solution> for Outcome {
    fn from(solution: &Solution) -> Self {
        Self { force: solution.resultant, friction: solution.mu, direction: solution.phi }
    }
}

/// Names of the errors, in the order in which [`errors`] gives them.
pub const ERROR_NAMES: [&str; 5] = ["e_Fx", "e_Fy", "e_Fz", "e_mu", "e_phi"];

/// Errors of one frame in percent, in the order of [`ERROR_NAMES`] (Pinto-Salamanca et al., Sensors 2024, section 5).
///
/// Forces are relative to the true normal force, the friction to 1 (Eq. 28), the direction to a full turn.
pub fn errors(truth: &Outcome, found: &Outcome) -> [f64; 5] {
    let full_scale = truth.force[2].abs();
    let force = |axis: usize| 100.0 * (found.force[axis] - truth.force[axis]).abs() / full_scale;
    let turn = (found.direction - truth.direction).to_degrees() / 360.0;
    [
        force(0),
        force(1),
        force(2),
        100.0 * (found.friction - truth.friction).abs(),
        // Both directions may differ by whole turns.
        100.0 * (turn - turn.round()).abs(),
    ]
}

/// One kind of error over many frames, in percent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Spread {
    /// The largest.
    pub max: f64,
    /// The standard deviation over the frames. This is what Table 3 of the paper calls the standard error: its
    /// figures are too large for a deviation of the mean.
    pub standard_error: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count();
        let max = values.clone().fold(0.0, f64::max);
        if count < 2 {
            return Self { max, standard_error: 0.0 };
        }
        let mean = values.clone().sum::<f64>() / count as f64;
        let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
        Self { max, standard_error: (squares / (count - 1) as f64).sqrt() }
    }
}

/// All errors over many frames, in percent.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct ErrorSummary {
    /// Number of frames.
    pub frames: usize,
    /// Resultant along x.
    pub e_fx: Spread,
    /// Resultant along y.
    pub e_fy: Spread,
    /// Resultant along z.
    pub e_fz: Spread,
    /// Friction.
    pub e_mu: Spread,
    /// Direction.
    pub e_phi: Spread,
}

impl ErrorSummary {
    /// Summarises pairs of truth and estimate.
    pub fn new(pairs: &[(Outcome, Outcome)]) -> Self {
        let all: Vec<[f64; 5]> = pairs.iter().map(|(truth, found)| errors(truth, found)).collect();
        let spread = |index: usize| Spread::of(all.iter().map(move |errors| errors[index]));
        Self { frames: all.len(), e_fx: spread(0), e_fy: spread(1), e_fz: spread(2), e_mu: spread(3), e_phi: spread(4) }
    }

    /// The spreads in the order of [`ERROR_NAMES`].
    pub fn spreads(&self) -> [Spread; 5] {
        [self.e_fx, self.e_fy, self.e_fz, self.e_mu, self.e_phi]
    }
}

/// Largest difference between two force fields over all taxels and axes, relative to the largest `|f_z|` of the
/// reference; 0 if both fields are zero, infinite if only the reference is.
pub fn field_error(reference: &[Vec<f64>; 3], found: &[Vec<f64>; 3]) -> f64 {
    let largest = reference[2].iter().fold(0.0_f64, |max, f| max.max(f.abs()));
    let difference =
        reference.iter().flatten().zip(found.iter().flatten()).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
    if difference == 0.0 { 0.0 } else { difference / largest }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: Outcome = Outcome { force: [3.0, 0.0, -6.0], friction: 0.5, direction: 0.0 };

    #[test]
    fn forces_are_relative_to_the_normal_force() {
        let found = Outcome { force: [2.7, -0.6, -6.6], friction: 0.45, direction: -0.1 };
        let expected = [5.0, 10.0, 10.0, 5.0, 100.0 * 0.1_f64.to_degrees() / 360.0];
        for (found, expected) in errors(&TRUTH, &found).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn directions_either_side_of_the_cut_are_close() {
        let truth = Outcome { direction: 179_f64.to_radians(), ..TRUTH };
        let found = Outcome { direction: -179_f64.to_radians(), ..TRUTH };
        assert!((errors(&truth, &found)[4] - 100.0 * 2.0 / 360.0).abs() < 1e-12);
    }

    #[test]
    fn the_summary_has_maximum_and_deviation() {
        let with = |friction| Outcome { friction, ..TRUTH };
        let pairs = [0.51, 0.47, 0.55].map(|friction| (TRUTH, with(friction)));
        let spread = ErrorSummary::new(&pairs).e_mu;
        // Errors 1, 3, 5.
        assert!((spread.max - 5.0).abs() < 1e-12);
        assert!((spread.standard_error - 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_field_error_is_relative_to_the_largest_normal_force() {
        let reference = [vec![0.0, 1.0], vec![0.0, 0.0], vec![-2.0, -4.0]];
        let mut found = reference.clone();
        assert_eq!(field_error(&reference, &found).to_bits(), 0);
        found[0][1] = 1.5;
        assert!((field_error(&reference, &found) - 0.125).abs() < 1e-15);
    }
}
