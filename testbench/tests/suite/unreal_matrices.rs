//! Plans whose matrices belong to no sensor. Formats are chosen for the worst case and forces rarely vanish, so some
//! of the hardware (clipping in the search, division by no force) is out of the reach of real geometries.

use std::collections::BTreeSet;

use crate::support::{built, frames, planned, shipped, simulate_exactly};
use golden::design::PlanKind;
use golden::solver::Solution;
use hdl_gen::model::{AT_BOUND, DIRECTION_UNKNOWN, NO_CONTACT, NOT_FINITE, SATURATED};
use hdl_gen::plan::Plan;
use hdl_gen::plan::product::Vector;
use hdl_gen::plan::schedule::Schedule;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::model_answers;
use testbench::stream_words::decode;

/// The small design with another plan.
fn changed(name: &str, change: impl Fn(&mut Plan)) -> Plan {
    let mut design = shipped("small");
    design.algorithm.plan = PlanKind::Paper;
    name.clone_into(&mut design.name);
    let mut plan = planned(&design);
    change(&mut plan);
    plan.schedule = Schedule::new(&plan.products, &plan.matrices, plan.design.hardware.lanes, false);
    plan
}

/// Divides the results that satisfy the condition, by way of their products' coefficients.
fn weaken(plan: &mut Plan, divisor: i32, condition: impl Fn(Vector) -> bool) {
    let products = plan.products.iter().filter(|product| condition(product.result));
    let matrices: BTreeSet<usize> = products.map(|product| product.matrix).collect();
    for matrix in matrices {
        for (_, channels) in plan.matrices[matrix].rows.iter_mut().flatten() {
            *channels = channels.map(|coefficient| coefficient / divisor);
        }
    }
}

/// Makes them zero.
fn silence(plan: &mut Plan, condition: impl Fn(Vector) -> bool) {
    weaken(plan, i32::MAX, condition);
}

/// Frames of noise through RTL and model, which agree; the answers that are no zeros by status.
fn answers(plan: &Plan) -> Vec<Solution> {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let packets: Vec<Vec<u32>> = (0..40).map(|_| frames::noise(plan, 1.0, &mut random)).collect();
    simulate_exactly(plan, &built(plan), &packets, 3).unwrap_or_else(|error| panic!("{}: {error}", plan.design.name));
    let answers = model_answers(plan, &packets).into_iter().map(|words| decode(&words).expect("a whole frame"));
    answers.filter(|answer| answer.status.0 & (NO_CONTACT | NOT_FINITE) == 0).collect()
}

/// Asserts that some but not all answers have the status.
fn assert_some(answers: &[Solution], status: u32) {
    let with = answers.iter().filter(|answer| answer.status.0 & status != 0).count();
    assert!(with >= 3 && answers.len() - with >= 3, "{with} of {} with the status {status}", answers.len());
}

/// With `u1` and `u2` sixteen times as large as they should be, and a line that is steep, `u1 + c1 u2` leaves its 27
/// bits in some frames and not in others.
#[test]
fn clipping_in_the_search_is_the_models_and_is_said() {
    let plan = changed("large_u", |plan| {
        for product in plan.products.iter_mut().filter(|product| matches!(product.result, Vector::U(1 | 2))) {
            product.shift -= 4;
        }
        weaken(plan, 4, |result| matches!(result, Vector::G(1 | 2, 2)));
    });
    assert_some(&answers(&plan), SATURATED);
}

/// A line steeper than 4, in one of its two quotients at a time, has no sense; one that is less steep takes the
/// dependent component out of its range.
fn assert_steep(plan: &Plan) {
    let answers = answers(plan);
    assert_some(&answers, DIRECTION_UNKNOWN);
    assert_some(&answers, AT_BOUND);
    assert!(answers.iter().any(|answer| [answer.mu_x, answer.mu_y].contains(&-2.0)), "{} clips", plan.design.name);
}

#[test]
fn steep_lines_give_no_direction() {
    assert_steep(&changed("steep_slope", |plan| {
        silence(plan, |result| matches!(result, Vector::G(1 | 2, 0) | Vector::Partial(1 | 2)));
        weaken(plan, 8, |result| matches!(result, Vector::G(1 | 2, 2)));
    }));
}

#[test]
fn lines_that_are_far_off_give_no_direction() {
    assert_steep(&changed("far_offset", |plan| weaken(plan, 128, |result| matches!(result, Vector::G(1 | 2, 1 | 2)))));
}

#[test]
fn no_normal_force_gives_no_friction_coefficient() {
    let plan = changed("no_normal_force", |plan| {
        silence(plan, |result| matches!(result, Vector::G(3, _) | Vector::Partial(3)));
    });
    let answers = answers(&plan);
    assert!(answers.len() >= 10);
    for answer in answers {
        assert_eq!((answer.resultant[2], answer.mu), (0.0, 0.0));
        assert!(answer.resultant[0] != 0.0 || answer.resultant[1] != 0.0, "{answer:?}");
    }
}

#[test]
fn no_tangential_force_gives_neither_friction_nor_angle() {
    let tangential = |result| matches!(result, Vector::G(1 | 2, _) | Vector::Partial(1 | 2));
    let plan = changed("no_tangential_force", |plan| silence(plan, tangential));
    let answers = answers(&plan);
    assert!(answers.len() >= 10);
    for answer in answers {
        assert_ne!(answer.status.0 & DIRECTION_UNKNOWN, 0, "a line needs tangential coefficients");
        assert_eq!((answer.resultant[0], answer.resultant[1], answer.mu, answer.phi), (0.0, 0.0, 0.0, 0.0));
        assert!(answer.resultant[2] != 0.0, "{answer:?}");
    }
}

#[test]
fn no_base_stress_leaves_the_friction_in_the_middle() {
    let plan = changed("no_base_stress", |plan| silence(plan, |result| matches!(result, Vector::U(_))));
    let answers = answers(&plan);
    assert!(answers.len() >= 10);
    // B is zero everywhere: its slope is nowhere negative, so the minimum is the left end.
    assert!(answers.iter().any(|answer| answer.status.0 & DIRECTION_UNKNOWN == 0), "some have a line");
}
