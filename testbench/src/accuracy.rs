//! The core's answers against the f64 solver and against the true forces.

use golden::metrics::{ErrorSummary, Outcome, field_error};
use golden::solver::{Solution, Status};
use serde::{Deserialize, Serialize};

/// Largest errors against the f64 solver with the same filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SolverError {
    /// Over frames and axes: `|F - F_ref| / |F_z,ref|` of the same frame.
    pub resultant_max: f64,
    /// Over frames, taxels and axes: `|f - f_ref|` relative to the largest `|f_z,ref|` of the same frame.
    pub field_max: f64,
}

impl SolverError {
    /// Compares answers with solutions, pair by pair. A frame that the solver calls empty and the core does not has an
    /// infinite error.
    pub fn new(answers: &[Solution], solutions: &[Solution]) -> Self {
        answers.iter().zip(solutions).fold(Self::default(), |worst, (answer, solution)| {
            let field = if answer.field[2].is_empty() { 0.0 } else { field_error(&solution.field, &answer.field) };
            Self {
                resultant_max: worst.resultant_max.max(resultant_error(&solution.resultant, &answer.resultant)),
                field_max: worst.field_max.max(field),
            }
        })
    }
}

fn resultant_error(reference: &[f64; 3], found: &[f64; 3]) -> f64 {
    let difference = reference.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if difference == 0.0 { 0.0 } else { difference / reference[2].abs() }
}

/// Number of frames by status; a frame with several bits set counts under each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub struct StatusCounts {
    /// No bit set.
    pub good: usize,
    /// Bit 0.
    pub no_contact: usize,
    /// Bit 1.
    pub direction_unknown: usize,
    /// Bit 2.
    pub at_bound: usize,
    /// Bit 3.
    pub saturated: usize,
    /// Bit 4.
    pub not_finite: usize,
    /// Bit 5.
    pub bad_length: usize,
    /// Bit 6.
    #[serde(default)]
    pub low_confidence: usize,
    /// Bit 7.
    #[serde(default)]
    pub several_contacts: usize,
    /// Bit 8.
    #[serde(default)]
    pub replaced: usize,
    /// Bit 9.
    #[serde(default)]
    pub too_many_replaced: usize,
    /// Bit 10.
    #[serde(default)]
    pub slip: usize,
    /// Bit 11.
    #[serde(default)]
    pub no_tension: usize,
}

impl StatusCounts {
    /// Counts the answers.
    pub fn new(answers: &[Solution]) -> Self {
        Self::of(&answers.iter().map(|answer| answer.status).collect::<Vec<_>>())
    }

    /// Counts statuses.
    pub fn of(statuses: &[Status]) -> Self {
        let good = statuses.iter().filter(|status| status.0 == 0).count();
        let mut counts = Self { good, ..Self::default() };
        for (bit, count) in counts.by_bit() {
            *count = statuses.iter().filter(|status| status.contains(bit)).count();
        }
        counts
    }

    /// The counts that are not zero, with words for people.
    pub fn present(mut self) -> Vec<(&'static str, usize)> {
        let good = self.good;
        let bits = self.by_bit();
        let count = |bit: Status| bits.iter().find(|(of, _)| *of == bit).map_or(0, |(_, count)| **count);
        let named = Status::NAMED.into_iter().map(|(bit, name)| (name, count(bit)));
        std::iter::once(("good", good)).chain(named).filter(|&(_, count)| count > 0).collect()
    }

    fn by_bit(&mut self) -> [(Status, &mut usize); 12] {
        [
            (Status::NO_CONTACT, &mut self.no_contact),
            (Status::DIRECTION_UNKNOWN, &mut self.direction_unknown),
            (Status::AT_BOUND, &mut self.at_bound),
            (Status::SATURATED, &mut self.saturated),
            (Status::NOT_FINITE, &mut self.not_finite),
            (Status::BAD_LENGTH, &mut self.bad_length),
            (Status::LOW_CONFIDENCE, &mut self.low_confidence),
            (Status::SEVERAL_CONTACTS, &mut self.several_contacts),
            (Status::REPLACED, &mut self.replaced),
            (Status::TOO_MANY_REPLACED, &mut self.too_many_replaced),
            (Status::SLIP, &mut self.slip),
            (Status::NO_TENSION, &mut self.no_tension),
        ]
    }
}

/// Errors of answers against true forces, in percent.
pub fn against_truth(found: &[Solution], truth: &[Outcome]) -> ErrorSummary {
    ErrorSummary::new(&truth.iter().copied().zip(found.iter().map(Outcome::from)).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(status: u32) -> Solution {
        Solution {
            resultant: [3.0, 0.0, -6.0],
            mu: 0.5,
            mu_x: 0.5,
            field: [vec![1.0, 2.0], vec![0.0, 0.0], vec![-2.0, -4.0]],
            ..Solution::zeros(Status(status), 2)
        }
    }

    #[test]
    fn equal_results_have_no_error() {
        let error = SolverError::new(&[answer(0)], &[answer(0)]);
        assert_eq!(error, SolverError { resultant_max: 0.0, field_max: 0.0 });
    }

    #[test]
    fn the_worst_frame_counts() {
        let mut wrong = answer(0);
        wrong.resultant[1] = 0.6;
        wrong.field[0][1] = 2.4;
        let error = SolverError::new(&[answer(0), wrong, answer(0)], &[answer(0), answer(0), answer(0)]);
        assert!((error.resultant_max - 0.1).abs() < 1e-12, "{error:?}");
        assert!((error.field_max - 0.1).abs() < 1e-12, "{error:?}");
    }

    #[test]
    fn statuses_are_counted_by_bit() {
        let counts = StatusCounts::new(&[answer(0), answer(0b1010), answer(1 << 3), answer(1)]);
        let expected =
            StatusCounts { good: 1, no_contact: 1, direction_unknown: 1, saturated: 2, ..Default::default() };
        assert_eq!(counts, expected);
        assert_eq!(counts.present()[0], ("good", 1));
        assert_eq!(counts.present().len(), 4);
    }

    #[test]
    fn truth_is_compared_in_percent() {
        let truth = Outcome { force: [3.6, 0.0, -6.0], friction: 0.6, direction: 0.0 };
        let summary = against_truth(&[answer(0)], &[truth]);
        assert!((summary.e_fx.max - 10.0).abs() < 1e-9 && (summary.e_mu.max - 10.0).abs() < 1e-9);
    }

    /// A count of each bit that a frame's own matter is; dropped frames are the stream's.
    #[test]
    fn every_status_is_counted() {
        let bits: Vec<Status> =
            Status::NAMED.into_iter().map(|(bit, _)| bit).filter(|bit| *bit != Status::DROPPED).collect();
        let present = StatusCounts::of(&bits).present();
        assert_eq!(present.len(), bits.len(), "{present:?}");
        assert!(present.iter().all(|&(_, count)| count == 1), "{present:?}");
    }
}
