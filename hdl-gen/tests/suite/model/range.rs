//! A range of its own for each frame: homogeneity to the last bit, what stays as it is, and what is gained.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Design, Outputs, PlanKind, Scaling};
use golden::metrics::field_error;
use golden::solver::Solver;
use hdl_gen::format::pow2;
use hdl_gen::model::{Model, NO_CONTACT, SATURATED};
use hdl_gen::plan::Plan;
use hdl_gen::plan::words::{FORCE, MU, STANDARD_ERROR, SUMMARY_WORDS, TIMESTAMP};

use super::{Contact, frame};
use crate::support::designs::design as shipped;

const CONTACT: Contact = Contact { centre: [0.43, 0.56], radius: 0.45, friction: 0.5, direction: 0.7, strength: 0.9 };

fn scaled_by(range: Scaling, mut design: Design) -> Design {
    design.hardware.scaling = range;
    design
}

/// Both plans, both estimators with all that they have, field and resultants, odd and even sides, fewer bits.
fn designs() -> Vec<Design> {
    let mut paper = shipped("odd");
    paper.algorithm.plan = PlanKind::Paper;
    let mut resultants = shipped("sensor1-reduced");
    resultants.algorithm.outputs = Outputs::Resultants;
    let mut narrow = shipped("sensor2-reduced");
    narrow.hardware.data_bits = 23;
    let shipped = ["sensor1-reduced", "sensor1-fast", "sensor1-wide", "sensor1-clipped-wide"].map(shipped);
    [paper, resultants, narrow].into_iter().chain(shipped).collect()
}

fn answer(plan: &Plan, frame: &[f32]) -> Vec<u32> {
    Model::new(plan).process(&frame.iter().map(|stress| stress.to_bits()).collect::<Vec<_>>())
}

/// The contact in steps of the stress, of which the last `zeros` bits are zero.
fn in_steps(plan: &Plan, solver: &Solver, zeros: i32) -> Vec<f32> {
    let step = pow2(plan.formats.stress.lsb + zeros);
    let read = |stress: f32| plan.design.input.tension.of(f64::from(stress));
    frame(&CONTACT, &plan.design, solver)
        .into_iter()
        .map(|stress| ((read(stress) / step).round() * step) as f32)
        .collect()
}

fn is_force(index: usize) -> bool {
    (FORCE..MU).contains(&index) || index == STANDARD_ERROR || index >= SUMMARY_WORDS
}

/// Words that are not those of a frame `2^by` times as strong, forces over that.
fn differences(strong: &[u32], faint: &[u32], by: i32) -> usize {
    let value = |word: u32| f64::from(f32::from_bits(word));
    let same = |(index, (&one, &other)): (usize, (&u32, &u32))| {
        if is_force(index) { value(one) * pow2(-by) == value(other) } else { one == other }
    };
    strong.iter().zip(faint).enumerate().filter(|pair| !same(*pair)).count()
}

#[test]
fn a_fainter_frame_has_the_same_answer_to_the_last_bit() {
    for design in designs() {
        let solver = Solver::new(&design).unwrap();
        let [fixed, own] =
            [Scaling::Fixed, Scaling::PerFrame].map(|range| Plan::new(&scaled_by(range, design.clone())).unwrap());
        for by in [1, 3, 6] {
            let strong = in_steps(&own, &solver, by);
            let faint: Vec<f32> = strong.iter().map(|stress| stress * pow2(-by) as f32).collect();
            let of = |plan: &Plan| differences(&answer(plan, &strong), &answer(plan, &faint), by);
            assert_eq!(of(&own), 0, "{}, 2^-{by}", design.name);
            assert!(of(&fixed) > 2, "{}, 2^-{by}: the full scale's range shows no rounding", design.name);
        }
    }
}

#[test]
fn a_frame_of_the_upper_half_of_the_range_is_answered_as_without_the_key() {
    for design in designs() {
        let solver = Solver::new(&design).unwrap();
        let [fixed, own] =
            [Scaling::Fixed, Scaling::PerFrame].map(|range| Plan::new(&scaled_by(range, design.clone())).unwrap());
        let bound = own.formats.stress.bound;
        let mut frame = in_steps(&own, &solver, 0);
        assert_eq!(answer(&own, &frame), answer(&fixed, &frame), "{}", design.name);
        // The last stress that float32 knows and that is not scaled, and the first that is.
        frame.fill(0.0);
        for (largest, same) in [(bound, true), (bound / 2 + 2, true), (bound / 2, false)] {
            frame[0] = -(largest as f64 * own.formats.stress.step()) as f32;
            frame[1] = -frame[0] / 3.0;
            let [own, fixed] = [&own, &fixed].map(|plan| answer(plan, &frame));
            assert!(!same || own == fixed, "{}, {largest}", design.name);
            assert!(own[TIMESTAMP] == 0 && own[0] & NO_CONTACT == 0, "{}", design.name);
        }
    }
}

/// Thresholds are pascals whatever the range, and so is what is clipped.
#[test]
fn what_a_frame_is_said_to_be_does_not_depend_on_its_range() {
    for design in designs() {
        let [fixed, own] =
            [Scaling::Fixed, Scaling::PerFrame].map(|range| Plan::new(&scaled_by(range, design.clone())).unwrap());
        let (taxels, step) = (own.taxels(), own.formats.stress.step());
        let read = |stress: f64| design.input.tension.of(stress) as f32;
        let full = design.hardware.full_scale_pa;
        let [floor, contact] = [own.thresholds.taxel, own.thresholds.contact].map(|steps| steps as f64 * step);
        let one = |stress: f64| [vec![read(stress)], vec![0.0; taxels - 1]].concat();
        let around = |stress: f64| [vec![read(stress)], vec![read(-9.0 * floor); taxels - 1]].concat();
        for frame in [
            vec![0.0; taxels],
            one(-step),
            one(-contact),
            one(step - contact),
            around(floor),
            around(floor + step),
            around(-floor - step),
            one(-full),
            one(-3.0 * full),
            around(3.0 * full),
            vec![f32::NAN; taxels],
        ] {
            let [own, fixed] = [&own, &fixed].map(|plan| answer(plan, &frame)[0]);
            // Of the estimator's own bits only those of what is there at all are the frame's.
            let of_frame = NO_CONTACT | SATURATED | hdl_gen::model::NOT_FINITE | hdl_gen::model::NO_TENSION;
            assert_eq!(own & of_frame, fixed & of_frame, "{}: {own:x} {fixed:x}, {:?}", design.name, &frame[..2]);
        }
    }
}

/// The figures of results/README.md, in short.
#[test]
fn faint_contacts_are_as_exact_as_strong_ones() {
    for name in ["sensor1-reduced", "sensor1-fast"] {
        let design = shipped(name);
        let solver = Solver::new(&design).unwrap();
        let error = |range: Scaling, peak_pa: f64| {
            let plan = Plan::new(&scaled_by(range, design.clone())).unwrap();
            let strength = peak_pa / design.hardware.full_scale_pa;
            let frame = frame(&Contact { strength, ..CONTACT }, &design, &solver);
            let exact = solver.solve(&frame.iter().map(|&stress| f64::from(stress)).collect::<Vec<_>>()).unwrap();
            let found = super::answer(&plan, &frame);
            field_error(&exact.field, &found.field)
        };
        let faint = 100.0 * design.algorithm.noise_floor_pa;
        let strong = error(Scaling::Fixed, 0.9 * design.hardware.full_scale_pa);
        let (before, after) = (error(Scaling::Fixed, faint), error(Scaling::PerFrame, faint));
        assert!(before > 10.0 * strong, "{name}: {before:e} {strong:e}");
        assert!(after < 3.0 * strong, "{name}: {after:e} {strong:e}");
    }
}
