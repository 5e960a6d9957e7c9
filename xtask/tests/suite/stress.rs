//! Thousands of frames, good and bad, with pauses and resets; and faults in the RTL, which the testbench must notice.

use std::path::Path;

use crate::support::calibrated;
use crate::support::effort::{all, half_of, share_of, some_of};
use crate::support::faults::broken;
use crate::support::{by_plan, in_parallel, planned, shipped, with_joint};
use golden::design::{Design, Estimator, Outputs, Overrun, PlanKind};
use golden::progress::Progress;
use hdl_gen::cores::Multiplier;
use hdl_gen::emit::rtl::library;
use xtask::mutants::{self, Kind, mutants};
use xtask::stress::{self, Commits, StressError, stress};

const FRAMES: u64 = 3000;
/// Of them `make test` sends so many to cores with banks, of which each is written once in some frames.
const FEW_FRAMES: u64 = 1000;

#[test]
fn every_answer_is_right_and_none_is_lost() {
    // With a standard error, and several words a beat.
    let mut with_error = with_joint(shipped("small"));
    with_error.name += "_with_error";
    with_error.hardware.stream_bits = 128;
    let designs = [
        by_plan(shipped("small"), PlanKind::Paper, Outputs::Field),
        by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field),
        by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants),
        // Search, look and correction a frame each.
        shipped("small-joint"),
        with_error,
    ];
    let frames = share_of(FRAMES as usize) as u64;
    let options = stress::Options { frames, seed: 5 };
    in_parallel(&half_of(designs), |design| {
        let report = stress(design, &options, &Progress::hidden()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.sent.total(), frames);
        assert_eq!(report.sent, report.answered.plus(report.lost_to_resets));
        assert_eq!(report.resets, frames / 100);
        let counts = report.answered;
        for count in [counts.good, counts.short, counts.long, counts.not_finite] {
            assert!(count > frames / 20, "{report}");
        }
        // A reset costs the frames inside, eight at most.
        assert!(report.lost_to_resets.total() <= 8 * report.resets, "{report}");
    });
}

/// Cores that drop what they have no room for: no frame is lost without a reason, no part of one is left behind.
#[test]
fn what_is_dropped_had_no_room() {
    let [mut one_by_one, mut at_once] =
        [PlanKind::Paper, PlanKind::Reduced].map(|kind| by_plan(shipped("small"), kind, Outputs::Field));
    one_by_one.hardware.stream_bits = 64;
    at_once.hardware.stream_bits = 128;
    for design in [&mut one_by_one, &mut at_once] {
        design.name += "_scanned";
        design.hardware.overrun = Overrun::Drop;
    }
    let options = stress::Options { frames: FRAMES, seed: 5 };
    in_parallel(&[one_by_one, at_once], |design| {
        let report = stress(design, &options, &Progress::hidden()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.sent, report.answered.plus(report.dropped).plus(report.lost_to_resets));
        for counts in [report.answered, report.dropped] {
            for count in [counts.good, counts.short, counts.long, counts.not_finite] {
                assert!(count > FRAMES / 100, "{report}");
            }
        }
    });
}

/// A calibration in RAM of all that one can have: along a curve, with dead taxels; behind a scanner that is not held, with
/// ranges of their own.
fn with_banks() -> Vec<Design> {
    let mut curved = calibrated::design_with_curve();
    curved.name += "_stressed";
    curved.input.room = 1;
    let mut joint = calibrated::design(Outputs::Field);
    "joint_stressed".clone_into(&mut joint.name);
    joint.algorithm.estimator = Estimator::Joint;
    vec![shipped("small-scanner"), curved, joint]
}

/// Banks, commits and tares among the frames, some of them wrong: every answer is that of one whole bank, the one that
/// acted when its frame began.
#[test]
fn no_frame_is_computed_with_half_a_bank() {
    let frames = if all() { FRAMES } else { FEW_FRAMES };
    let options = stress::Options { frames, seed: 5 };
    in_parallel(&with_banks(), |design| {
        let report = stress(design, &options, &Progress::hidden()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.sent, report.answered.plus(report.dropped).plus(report.lost_to_resets));
        let Commits { banks, banks_refused, tares, tares_refused, lost_to_resets } =
            report.calibration.expect("in RAM");
        assert!(banks > frames / 40 && banks_refused > frames / 100 && tares_refused > frames / 200, "{report}");
        assert!(tares > frames / 500 && lost_to_resets > 0, "{report}");
        assert!(report.to_string().contains("banks acted"));
    });
}

#[test]
fn the_seed_decides_everything() {
    let design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let run = |seed| stress(&design, &stress::Options { frames: 300, seed }, &Progress::hidden()).expect("runs");
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).cycles, run(2).cycles);
    let banks = shipped("small-scanner");
    let run = |seed| stress(&banks, &stress::Options { frames: 300, seed }, &Progress::hidden()).expect("runs");
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).calibration, run(2).calibration);
    let none = stress(&design, &stress::Options { frames: 0, seed: 1 }, &Progress::hidden());
    assert!(matches!(none, Err(StressError::NoFrames)));
}

/// Faults that a run of `make mutants` once did not notice, because no frame and no pause reached them.
#[test]
fn faults_at_rare_moments_are_noticed() {
    let [paper, reduced] =
        [PlanKind::Paper, PlanKind::Reduced].map(|kind| by_plan(shipped("small"), kind, Outputs::Field));
    let joint = shipped("small-joint");
    let cases = [
        // The least value on the border is that of the rows' ends, or of the outer rows, alone.
        (
            &joint,
            "sptfra_grid_level",
            "outers[LEVELS]) ? least_between : least_of_ends",
            "outers[LEVELS]) ? least_of_ends : least_of_ends",
        ),
        (
            &joint,
            "sptfra_grid_level",
            "outers[LEVELS]) ? least_between : least_of_ends",
            "outers[LEVELS]) ? least_between : {VALUE_BITS{1'b1}}",
        ),
        // A direction that comes in the cycle in which the one before is taken is lost.
        (
            &paper,
            "sptfra_cean",
            "if (direction_take || !direction_valid) begin",
            "if ((direction_take && !push) || !direction_valid) begin",
        ),
        (
            &reduced,
            "sptfra_cean",
            "if (direction_take || !direction_valid) begin",
            "if ((direction_take && !push) || !direction_valid) begin",
        ),
        // No quotient although there is no force along z.
        (&reduced, "sptfra_summary", "(bits_z == 7'd0) || (bits_xy == 7'd0)", "(bits_z == 7'd0) && (bits_xy == 7'd0)"),
    ];
    assert_eq!(missed(&cases), Vec::<String>::new());
}

/// Cores that mix banks, keep none for their frames, take half of one, or change too late.
#[test]
fn faults_in_the_banks_are_noticed() {
    let [scanner, curved, _] = &with_banks()[..] else { panic!("three") };
    let cases = [
        (scanner, "sptfra_bz", "wire bank = in_frame ? bank_held : active;", "wire bank = active;"),
        (scanner, "sptfra_frame_context", "thresholds <= of_cean;", "thresholds <= {in_contact, of_cean[26:0]};"),
        (scanner, "sptfra_frame_context", "thresholds <= of_cean;", "thresholds <= {of_cean[58:27], in_noise};"),
        (scanner, "sptfra_frame_context", "assign dropped =", "assign dropped = 1'b1 ||"),
        (scanner, "sptfra_calibration", "wire wrong = checks && (", "wire wrong = checks && !expected[0] && ("),
        (scanner, "sptfra_calibration", "if (!old_in_use) begin", "if (!reset) begin"),
        (curved, "sptfra_bz", "((CURVE_LEVELS == 0) ? bank : bank_held)", "(active)"),
        (curved, "sptfra_bz", ".bank           (bank_held)", ".bank           (active)"),
    ];
    assert_eq!(missed(&cases), Vec::<String>::new());
}

/// A design, one of its modules, what stands there and what does in a copy.
type Fault<'a> = (&'a Design, &'a str, &'a str, &'a str);

/// Copies with a fault each that no batch notices.
fn missed(cases: &[Fault<'_>]) -> Vec<String> {
    let library = library(Multiplier::Whole);
    for (_, module, from, _) in cases {
        let text = library.get(module).expect("a module of the library");
        assert_eq!(text.matches(from).count(), 1, "{from:?} in {module}");
    }
    let cases = some_of(cases);
    let noticed = in_parallel(&cases, |&&(design, module, from, to)| {
        let plan = planned(design);
        let built = broken(&plan, module, from, to);
        let wrong = |batch: u64| {
            let core = built.load(batch as u32).expect("loaded");
            stress::run_batch(&plan, core, batch, stress::BATCH, 1, &|| ()).is_err()
        };
        // What is rare comes within some batches.
        (0..100).any(wrong)
    });
    let names = cases.iter().map(|(design, module, _, to)| format!("{to:?} in {module} of {}", design.name));
    names.zip(noticed).filter(|(_, noticed)| !noticed).map(|(name, _)| name).collect()
}

/// A sample of `make mutants`: one of each kind. Survivors that somebody has looked into stand in `survivors.toml`; one
/// in twenty of the others changes nothing either, and any change of the RTL draws others.
#[test]
fn faults_in_the_rtl_are_noticed() {
    let design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let explained = mutants::Explained::load(Path::new("survivors.toml")).expect("a list of survivors");
    let kinds = share_of(Kind::ALL.len());
    let options = mutants::Options { count: kinds, seed: 1, explained };
    let report = mutants(&design, &options, &Progress::hidden()).expect("runs");
    assert_eq!(report.mutants.iter().filter(|mutant| mutant.fate.counts()).count(), kinds);

    assert!(report.survivors().count() <= 2, "{report}");
}

#[test]
fn streams_with_pauses_faults_and_resets_are_counted() {
    let mut design = by_plan(shipped("odd"), PlanKind::Reduced, Outputs::Field);
    design.name += "_counting";
    design.algorithm.count_contacts = true;
    let report = stress(&design, &stress::Options { frames: 600, seed: 3 }, &Progress::hidden());
    let report = report.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(report.sent, report.answered.plus(report.lost_to_resets));
}
