//! The status word of the integer model: frames without an answer, and marks of the others.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Design, PlanKind, Tension};
use golden::solver::{Solution, Status};
use hdl_gen::model::{
    BAD_LENGTH, DIRECTION_UNKNOWN, LOW_CONFIDENCE, Model, NO_CONTACT, NO_TENSION, NOT_FINITE, SATURATED, SLIP,
};
use hdl_gen::plan::Plan;

use super::{Contact, answer, frame, prepare_as, reference};
use crate::support::{design_text, small_plan, small_reduced};

#[test]
fn frames_without_an_answer_get_a_status() {
    let resultants = "[algorithm]\nplan = \"reduced\"\noutputs = \"resultants\"";
    let resultants = crate::support::plan(&design_text("pad", [4, 3], [4.0, 2.0], 3.0, resultants));
    for plan in [small_plan(""), small_reduced(""), resultants] {
        check_frames_without_an_answer(&plan);
    }
}

fn check_frames_without_an_answer(plan: &Plan) {
    let taxels = plan.taxels();
    let floor = plan.design.algorithm.noise_floor_pa as f32;
    let all = |stress: f32| vec![stress; taxels];
    let with = |stress: f32| [vec![stress], vec![-500.0; taxels - 1]].concat();
    for (frame, status) in [
        (all(0.0), NO_CONTACT),
        (all(-0.0), NO_CONTACT),
        (all(0.98 * floor), NO_CONTACT),
        (all(f32::from_bits(1)), NO_CONTACT),
        (with(f32::NAN), NOT_FINITE),
        (with(f32::INFINITY), NOT_FINITE),
        (all(f32::NEG_INFINITY), NOT_FINITE),
        (all(-500.0)[1..].to_vec(), BAD_LENGTH),
        (vec![-500.0; taxels + 1], BAD_LENGTH),
        (Vec::new(), BAD_LENGTH),
        (vec![f32::NAN; 2 * taxels], BAD_LENGTH | NOT_FINITE),
    ] {
        let found = answer(plan, &frame);
        assert_eq!(found.status, status, "{frame:?}");
        assert_eq!(found.summary, [0.0; 7]);
        assert!(found.field.concat().iter().all(|&force| force == 0.0));
    }
}

#[test]
fn without_tension_only_the_direction_is_unknown() {
    for kind in [PlanKind::Paper, PlanKind::Reduced] {
        check_without_tension(kind);
    }
}

fn check_without_tension(kind: PlanKind) {
    let (_, solver, plan) = prepare_as(&design_text("pad", [4, 3], [4.0, 2.0], 3.0, ""), kind);
    for stress in [-500.0, 1.02 * -plan.design.algorithm.noise_floor_pa as f32, 500.0, 99_999.0] {
        let frame = vec![stress; plan.taxels()];
        let found = answer(&plan, &frame);
        // What pushes everywhere pulls nowhere.
        let status = DIRECTION_UNKNOWN | if stress < 0.0 { NO_TENSION } else { 0 };
        assert_eq!(found.status, status, "{stress} Pa");
        assert_eq!(reference(&solver, &frame).status.0, status);
        assert_eq!(found.summary[5..], [0.0, 0.0]);
        assert!(found.summary[2] * f64::from(stress) > 0.0, "pressed by compression");
    }
}

/// With another tension the same frame has another status; nothing else changes.
#[test]
fn a_sensor_that_reads_no_tension_is_not_asked_for_it() {
    let mut design = Design::from_toml(&design_text("pad", [4, 3], [4.0, 2.0], 3.0, ""), "pad.toml").unwrap();
    let frame: Vec<f32> = (0..12).map(|taxel| -500.0 - 30.0 * taxel as f32).collect();
    let read = answer(&Plan::new(&design).unwrap(), &frame);
    design.input.tension = Tension::Clipped;
    let clipped = answer(&Plan::new(&design).unwrap(), &frame);
    assert_eq!((read.status, clipped.status), (DIRECTION_UNKNOWN | NO_TENSION, DIRECTION_UNKNOWN));
    assert_eq!((read.summary, read.field), (clipped.summary, clipped.field));
}

/// A layer too thin for its taxels gives every answer low confidence, in the model and in the core, and no frame without one.
#[test]
fn answers_of_a_thin_layer_have_low_confidence() {
    for (depth, estimator, thin) in
        [(2.9, "line", true), (3.1, "line", false), (1.9, "joint", true), (2.1, "joint", false)]
    {
        let constants = if estimator == "joint" { "gain = 1\nfriction_correction = [1, 0]" } else { "" };
        let more = format!("[algorithm]\nestimator = \"{estimator}\"\n{constants}");
        // The paper's plan has the line search alone.
        let kinds = if estimator == "line" { &[PlanKind::Paper, PlanKind::Reduced][..] } else { &[PlanKind::Reduced] };
        for &kind in kinds {
            let (design, solver, plan) = prepare_as(&design_text("pad", [8, 6], [4.0, 3.0], depth, &more), kind);
            let contact = Contact { centre: [0.48, 0.5], radius: 0.3, friction: 0.5, direction: 0.4, strength: 0.3 };
            let touched = frame(&contact, &design, &solver);
            let (found, exact) = (answer(&plan, &touched), reference(&solver, &touched));
            assert_eq!(
                (found.status & LOW_CONFIDENCE != 0, exact.status.0 & LOW_CONFIDENCE != 0),
                (thin, thin),
                "{depth} {estimator}"
            );
            let empty = vec![0.0; plan.taxels()];
            assert_eq!(answer(&plan, &empty).status, NO_CONTACT, "{depth} {estimator}");
            assert_eq!(reference(&solver, &empty).status.0, NO_CONTACT, "{depth} {estimator}");
            let written = hdl_gen::blocks::op::parameters(&plan);
            assert_eq!(format!("{written:?}").contains("THIN"), thin, "{written:?}");
        }
    }
}

/// Friction that rises and falls: the bit comes at the limit and goes below the release, in the model as in the solver.
#[test]
fn slip_has_a_hysteresis() {
    for plan in [PlanKind::Paper, PlanKind::Reduced] {
        let more = "[algorithm]\nslip = { limit = 0.3, hysteresis = 0.12 }";
        let (design, solver, plan) = prepare_as(&design_text("pad", [8, 6], [4.0, 3.0], 3.0, more), plan);
        let mut model = Model::new(&plan);
        let (mut workspace, mut solution) = (solver.workspace(), Solution::zeros(Status::default(), 0));
        let mut seen = Vec::new();
        let path = [0.1, 0.3, 0.5, 0.36, 0.3, 0.1, 0.3, 0.36, 0.6];
        for friction in path {
            let contact = Contact { centre: [0.48, 0.5], radius: 0.3, friction, direction: 0.4, strength: 0.3 };
            let frame = frame(&contact, &design, &solver);
            let words = model.process(&frame.iter().map(|stress| stress.to_bits()).collect::<Vec<_>>());
            let values: Vec<f64> = frame.iter().map(|&stress| f64::from(stress)).collect();
            solver.solve_into(&mut workspace, &values, &mut solution).unwrap();
            assert_eq!(words[0] & 0xFFFF, solution.status.0, "{friction}");
            let (mu, before) = (f64::from(f32::from_bits(words[8])), seen.last().is_some_and(|&slips| slips));
            let slips = words[0] & SLIP != 0;
            assert_eq!(slips, mu >= if before { 0.18 } else { 0.3 }, "{friction}: {mu}");
            seen.push(slips);
        }
        // Neither always nor never, and at one friction once so and once so.
        assert!(seen[2] && seen[8] && !seen[0] && !seen[5], "{seen:?}");
        assert_ne!(seen[3], seen[7], "{seen:?}");
        // Nothing in touch slips, and nothing is remembered of before.
        assert_eq!(model.process(&vec![0; plan.taxels()])[0] & SLIP, 0);
    }
}

#[test]
fn stress_beyond_full_scale_counts_as_full_scale() {
    for plan in [small_plan("full_scale_pa = 2000.0"), small_reduced("full_scale_pa = 2000.0")] {
        check_beyond_full_scale(&plan);
    }
}

fn check_beyond_full_scale(plan: &Plan) {
    let contact = |peak: f32| {
        let mut frame: Vec<f32> = (0..12).map(|taxel| if taxel % 4 < 2 { 90.0 } else { -700.0 }).collect();
        frame[6] = peak;
        answer(plan, &frame)
    };
    let (within, at) = (contact(-1999.9), contact(-2000.0));
    let (beyond, far) = (contact(-2001.0), contact(f32::MIN));
    // A reading of full scale may be a clipped one.
    assert_eq!(within.status & SATURATED, 0);
    assert_eq!(at.status, within.status | SATURATED);
    assert_eq!((beyond.status, far.status), (at.status, at.status));
    for clipped in [&beyond, &far] {
        assert_eq!((&clipped.summary, &clipped.field), (&at.summary, &at.field));
    }
}

#[test]
fn frames_are_counted_until_reset() {
    let plan = small_plan("");
    let mut model = Model::new(&plan);
    for frame in 0..65_538_u32 {
        let words = model.process(&[]);
        assert_eq!(words[0], (frame % 65_536) << 16 | BAD_LENGTH);
    }
    model.reset();
    assert_eq!(model.process(&[])[0], BAD_LENGTH);
}
