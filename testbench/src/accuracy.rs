//! The core's answers against the f64 solver and against the true forces.

use golden::metrics::{ErrorSummary, Outcome, field_error};
use golden::solver::{Solution, Status};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

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

/// Keys of the counts in reports, each with its bit; of `good` none is set.
const COUNTED: [(&str, Status); 13] = [
    ("good", Status(0)),
    ("no_contact", Status::NO_CONTACT),
    ("direction_unknown", Status::DIRECTION_UNKNOWN),
    ("at_bound", Status::AT_BOUND),
    ("saturated", Status::SATURATED),
    ("not_finite", Status::NOT_FINITE),
    ("bad_length", Status::BAD_LENGTH),
    ("low_confidence", Status::LOW_CONFIDENCE),
    ("several_contacts", Status::SEVERAL_CONTACTS),
    ("replaced", Status::REPLACED),
    ("too_many_replaced", Status::TOO_MANY_REPLACED),
    ("slip", Status::SLIP),
    ("no_tension", Status::NO_TENSION),
];

/// Number of frames by status, in the order of [`COUNTED`]; a frame with several bits set counts under each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(from = "Map<String, Value>", into = "Map<String, Value>")]
pub struct StatusCounts([usize; COUNTED.len()]);

impl StatusCounts {
    /// Counts the answers.
    pub fn new(answers: &[Solution]) -> Self {
        Self::of(&answers.iter().map(|answer| answer.status).collect::<Vec<_>>())
    }

    /// Counts statuses.
    pub fn of(statuses: &[Status]) -> Self {
        let is = |status: Status, bit: Status| if bit.0 == 0 { status.0 == 0 } else { status.contains(bit) };
        Self(COUNTED.map(|(_, bit)| statuses.iter().filter(|&&status| is(status, bit)).count()))
    }

    /// The counts that are not zero, with words for people.
    pub fn present(self) -> Vec<(String, usize)> {
        let all = COUNTED.into_iter().zip(self.0).filter(|&(_, count)| count > 0);
        all.map(|((_, bit), count)| (bit.to_string(), count)).collect()
    }
}

/// From a report, which may be one of before there were all of these bits.
impl From<Map<String, Value>> for StatusCounts {
    fn from(map: Map<String, Value>) -> Self {
        Self(COUNTED.map(|(key, _)| map.get(key).and_then(Value::as_u64).unwrap_or(0) as usize))
    }
}

impl From<StatusCounts> for Map<String, Value> {
    fn from(counts: StatusCounts) -> Self {
        COUNTED.into_iter().zip(counts.0).map(|((key, _), count)| (key.to_owned(), count.into())).collect()
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
        let expected = StatusCounts([1, 1, 1, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(counts, expected);
        let json = serde_json::to_string(&counts).unwrap();
        assert!(
            json.starts_with(r#"{"good":1,"no_contact":1,"direction_unknown":1,"at_bound":0,"saturated":2,"#),
            "{json}"
        );
        assert_eq!(serde_json::from_str::<StatusCounts>(&json).unwrap(), counts);
        assert_eq!(counts.present()[0], ("good".to_owned(), 1));
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
        assert!(present.iter().all(|(_, count)| *count == 1), "{present:?}");
    }
}
