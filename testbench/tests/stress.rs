//! Thousands of frames, good and bad, with pauses and resets; and faults in the RTL, which the testbench must notice.

mod support;

use golden::design::{Outputs, PlanKind};
use support::{by_plan, in_parallel, shipped};
use testbench::mutants::{self, Fate, Kind, mutants};
use testbench::progress::Progress;
use testbench::stress::{self, StressError, stress};

const FRAMES: u64 = 3000;

#[test]
fn every_answer_is_right_and_none_is_lost() {
    let designs = [
        by_plan(shipped("small"), PlanKind::Paper, Outputs::Field),
        by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field),
        by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants),
    ];
    let options = stress::Options { frames: FRAMES, seed: 5 };
    in_parallel(&designs, |design| {
        let report = stress(design, &options, &Progress::hidden()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.sent.total(), FRAMES);
        assert_eq!(report.sent, report.answered.plus(report.lost_to_resets));
        assert_eq!(report.resets, FRAMES / 100);
        let counts = report.answered;
        for count in [counts.good, counts.short, counts.long, counts.not_finite] {
            assert!(count > FRAMES / 20, "{report}");
        }
        // A reset costs the frames inside, eight at most.
        assert!(report.lost_to_resets.total() <= 8 * report.resets, "{report}");
    });
}

#[test]
fn the_seed_decides_everything() {
    let design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let run = |seed| stress(&design, &stress::Options { frames: 300, seed }, &Progress::hidden()).expect("runs");
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).cycles, run(2).cycles);
    let none = stress(&design, &stress::Options { frames: 0, seed: 1 }, &Progress::hidden());
    assert!(matches!(none, Err(StressError::NoFrames)));
}

/// A sample of `make mutants`: one of each kind. The survivors among 220 are explained in docs/trust.md.
#[test]
fn faults_in_the_rtl_are_noticed() {
    let design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let options = mutants::Options { count: Kind::ALL.len(), seed: 1 };
    let report = mutants(&design, &options, &Progress::hidden()).expect("runs");
    let built = report.mutants.iter().filter(|mutant| mutant.fate != Fate::Rejected).count();
    assert_eq!(built, Kind::ALL.len());
    // Some faults change nothing: among 220 one in ten.
    assert!(report.survivors().count() <= 3, "{report}");
}
