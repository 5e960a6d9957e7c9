//! The integer model against the f64 solver, and on frames without an answer.

#![allow(clippy::float_cmp)] // the same bits are meant

mod banks;
mod range;
mod statuses;

use std::f64::consts::TAU;

use golden::design::{Design, PlanKind};
use golden::parity::FoldedMatrix;
use golden::solver::cean::cean;
use golden::solver::{Solution, Solver};
use hdl_gen::format::pow2;
use hdl_gen::model::{AT_BOUND, Model, SUMMARY_WORDS};
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::QuantisedMatrix;
use hdl_gen::plan::product::Vector;
use nalgebra::DVector;
use proptest::prelude::*;

use crate::stages::{co, we};
use crate::support::{any_design, any_paper_design, design_text};

/// A sliding contact: an ellipsoid of pressure, and friction along one direction.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Centre and radius as shares of the grid's size.
    pub centre: [f64; 2],
    pub radius: f64,
    pub friction: f64,
    pub direction: f64,
    /// Largest stress over full scale.
    pub strength: f64,
}

pub fn any_contact() -> impl Strategy<Value = Contact> {
    (0.2..0.8_f64, 0.2..0.8_f64, 0.3..0.7_f64, 0.2..0.9_f64, 0.0..TAU, 0.02..0.95_f64).prop_map(
        |(x, y, radius, friction, direction, strength)| Contact {
            centre: [x, y],
            radius,
            friction,
            direction,
            strength,
        },
    )
}

/// The frame that a contact causes by the sensor's own matrices.
pub fn frame(contact: &Contact, design: &Design, solver: &Solver) -> Vec<f32> {
    let sensor = &design.sensor;
    let size = [sensor.columns as f64 - 1.0, sensor.rows as f64 - 1.0];
    let pressure = DVector::from_fn(sensor.taxels(), |i, _| {
        let place = [(i % sensor.columns) as f64, (i / sensor.columns) as f64];
        let square: f64 =
            (0..2).map(|axis| ((place[axis] / size[axis] - contact.centre[axis]) / contact.radius).powi(2)).sum();
        // Never nothing at all, whatever the grid.
        (1.0 - square).max(0.0).sqrt() + 1e-6
    });
    let matrices = solver.matrices();
    let [c31, c32, c33] = [&matrices.c31, &matrices.c32, &matrices.c33].map(FoldedMatrix::dense);
    let (sine, cosine) = contact.direction.sin_cos();
    let stress = (c31 * cosine + c32 * sine) * &pressure * contact.friction - c33 * &pressure;
    let scale = contact.strength * design.hardware.full_scale_pa / stress.amax();
    stress.iter().map(|value| (value * scale) as f32).collect()
}

/// An output frame in numbers; without a field where the design has none.
pub struct Decoded {
    pub status: u32,
    /// Forces, friction, direction, components of the friction.
    pub summary: [f64; 7],
    pub torque: [f64; 3],
    pub field: [Vec<f64>; 3],
}

pub fn answer(plan: &Plan, frame: &[f32]) -> Decoded {
    let words = Model::new(plan).process(&frame.iter().map(|stress| stress.to_bits()).collect::<Vec<_>>());
    assert_eq!(words.len(), plan.words_out());
    let values: Vec<f64> = words.iter().map(|&word| f64::from(f32::from_bits(word))).collect();
    let component = |p: usize| values[SUMMARY_WORDS..].iter().skip(p).step_by(3).copied().collect();
    Decoded {
        status: words[0],
        summary: [2, 3, 4, 8, 9, 10, 11].map(|index| values[index]),
        torque: [5, 6, 7].map(|index| values[index]),
        field: std::array::from_fn(component),
    }
}

pub fn reference(solver: &Solver, frame: &[f32]) -> Solution {
    solver.solve(&frame.iter().map(|&stress| f64::from(stress)).collect::<Vec<_>>()).unwrap()
}

fn prepare(text: &str) -> (Design, Solver, Plan) {
    prepare_as(text, PlanKind::Paper)
}

/// A design by a plan, whatever plan it names, with solver and hardware.
pub fn prepare_as(text: &str, kind: PlanKind) -> (Design, Solver, Plan) {
    let mut design = Design::from_toml(text, "test.toml").unwrap();
    design.algorithm.plan = kind;
    let solver = Solver::new(&design).unwrap();
    let plan = Plan::new(&design).unwrap();
    (design, solver, plan)
}

/// Largest error of each force vector for the model's own friction components, from rounding alone: half a step of
/// every coefficient, operand and result, through the row sums.
fn rounding_bounds(plan: &Plan, frame: &[f32], friction: [f64; 2]) -> [f64; 3] {
    let half = |lsb: i32| 0.5 * pow2(lsb);
    let row_sum = |matrix: &QuantisedMatrix| matrix.row_sum as f64 * pow2(matrix.lsb);
    let formats = &plan.formats;
    let stress_sum: f64 = frame.iter().map(|stress| f64::from(stress.abs())).sum();
    let mut weight_error = 0.0;
    let mut bounds = [0.0; 3];
    for product in &plan.products {
        let matrix = &plan.matrices[product.matrix];
        let step = half(formats.of(product.result).lsb);
        let of_stress = half(matrix.lsb) * stress_sum + row_sum(matrix) * half(formats.stress.lsb) + step;
        // Every weight is at most the largest row sum times the largest stress.
        let inverse = &plan.matrices[0];
        let top = frame.iter().fold(0.0_f64, |top, stress| top.max(f64::from(stress.abs())));
        let weight_sum = plan.taxels() as f64 * row_sum(inverse) * top;
        let of_weight = half(matrix.lsb) * weight_sum + row_sum(matrix) * weight_error + step;
        match product.result {
            Vector::Weight => weight_error = of_stress,
            Vector::Partial(p) => bounds[usize::from(p) - 1] += of_stress,
            Vector::G(p, 0) => bounds[usize::from(p) - 1] += of_weight,
            Vector::G(p, q) => bounds[usize::from(p) - 1] += of_weight * friction[usize::from(q) - 1].abs(),
            // Only those are results of the paper's plan that come into the field.
            _ => {}
        }
    }
    bounds
}

/// The design with the usual widths.
pub fn full_width(text: &str) -> String {
    text.lines().filter(|line| !line.contains("_bits")).map(|line| line.to_owned() + "\n").collect()
}

/// Largest magnitude.
pub fn top(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |top, value| top.max(value.abs()))
}

/// Largest `|c0|` and `|c1|` of the line, which beyond 4 has no sense.
pub fn line_ratio(frame: &[f32], design: &Design, solver: &Solver) -> f64 {
    let b = DVector::from_iterator(frame.len(), frame.iter().map(|&stress| f64::from(stress)));
    let sums = co(&b, &we(&b, solver.filtered().unwrap()), solver.filtered().unwrap()).sums;
    let positions: Vec<[f64; 2]> = (0..frame.len()).map(|taxel| design.sensor.position_m(taxel)).collect();
    let Some([x, y]) = cean(&b, &positions, design.algorithm.noise_floor_pa).direction else { return 0.0 };
    let a = sums[0][1] * y - sums[1][1] * x;
    let e = sums[0][2] * y - sums[1][2] * x;
    let k = sums[1][0] * x - sums[0][0] * y;
    let (other, denominator) = if x.abs() >= y.abs() { (a, e) } else { (e, a) };
    (k / denominator).abs().max((other / denominator).abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn forces_are_exact_but_for_rounding(
        text in any_paper_design(), contacts in proptest::collection::vec(any_contact(), 4),
    ) {
        let (design, solver, plan) = prepare(&text);
        for contact in contacts {
            let frame = frame(&contact, &design, &solver);
            let found = answer(&plan, &frame);
            let b = DVector::from_iterator(frame.len(), frame.iter().map(|&stress| f64::from(stress)));
            let g = co(&b, &we(&b, solver.filtered().unwrap()), solver.filtered().unwrap()).g;
            let friction = [found.summary[5], found.summary[6]];
            for (p, bound) in rounding_bounds(&plan, &frame, friction).into_iter().enumerate() {
                let exact = &g[p][0] + &g[p][1] * friction[0] + &g[p][2] * friction[1];
                for (found, exact) in found.field[p].iter().zip(exact.iter()) {
                    let bound = bound + exact.abs() * f64::from(f32::EPSILON);
                    prop_assert!((found - exact).abs() <= bound, "{found} for {exact}, bound {bound:e}");
                }
                // The resultant is the sum of the forces before they are rounded to float32.
                let error = (found.summary[p] - found.field[p].iter().sum::<f64>()).abs();
                prop_assert!(error <= plan.taxels() as f64 * top(&found.field[p]) * f64::from(f32::EPSILON));
            }
            // The torque is that of the forces, but for the steps of an arm and of a sum's parts.
            let sensor = &design.sensor;
            let mut torque = [0.0; 3];
            for taxel in 0..frame.len() {
                let force = found.field.each_ref().map(|component| component[taxel]);
                let part = sensor.torque_of(sensor.position_m(taxel), force);
                torque.iter_mut().zip(part).for_each(|(torque, part)| *torque += part);
            }
            let [x, y] = sensor.arm_m(0).map(f64::abs);
            let arm = x.max(y);
            let largest = found.field.each_ref().map(|component| top(component));
            let all = plan.taxels() as f64 * (largest[0] + largest[1] + largest[2]);
            let bound = all * arm * pow2(-16) + 8.0 * plan.taxels() as f64 * pow2(plan.formats.torque_lsb);
            for (found, exact) in found.torque.into_iter().zip(torque) {
                prop_assert!((found - exact).abs() <= bound, "{found} for {exact}, bound {bound:e}");
            }
        }
    }

    #[test]
    fn friction_and_status_agree_with_the_solver(
        text in any_paper_design(), contacts in proptest::collection::vec(any_contact(), 4),
    ) {
        let (design, solver, plan) = prepare(&full_width(&text));
        for contact in contacts {
            let frame = frame(&contact, &design, &solver);
            let near = |value: f64, limit: f64| (value / limit - 1.0).abs() < 0.02;
            let floor = design.algorithm.noise_floor_pa;
            if frame.iter().any(|&stress| near(f64::from(stress.abs()), floor))
                || near(line_ratio(&frame, &design, &solver), 4.0)
            {
                continue; // either answer is right
            }
            let found = answer(&plan, &frame);
            let expected = reference(&solver, &frame);
            prop_assert_eq!(found.status & !AT_BOUND, expected.status.0 & !AT_BOUND);
            let error = (found.summary[5] - expected.mu_x).abs().max((found.summary[6] - expected.mu_y).abs());
            prop_assert!(error <= 0.02, "friction off by {error}");
            for p in 0..3 {
                let scale = top(&expected.field[2]);
                let pairs = found.field[p].iter().zip(&expected.field[p]);
                let error = pairs.map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                prop_assert!(error <= 0.03 * scale, "component {p} off by {error} N of {scale} N");
            }
        }
    }

    #[test]
    fn no_frame_gives_a_nan(
        text in any_design(),
        packets in proptest::collection::vec(proptest::collection::vec(any::<u32>(), 0..80), 3),
        stresses in proptest::collection::vec(-3.0e5..3.0e5_f32, 81),
    ) {
        let plan = crate::support::plan(&text);
        let fitting = stresses[..plan.taxels()].iter().map(|stress| stress.to_bits()).collect();
        // The same with one word in three that is not an ordinary number.
        let odd = [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN, f32::from_bits(1), -0.0].map(f32::to_bits);
        let mixed = (0..plan.taxels())
            .map(|taxel| if taxel % 3 == 0 { odd[taxel / 3 % 6] } else { stresses[taxel].to_bits() })
            .collect();
        let full = (0..plan.taxels()).map(|taxel| odd[2 + taxel % 4]).collect();
        let mut model = Model::new(&plan);
        for packet in packets.into_iter().chain([fitting, mixed, full]) {
            let words = model.process(&packet);
            prop_assert_eq!(words.len(), plan.words_out());
            prop_assert!(words[1..].iter().all(|&word| f32::from_bits(word).is_finite()));
        }
    }
}

#[test]
fn the_papers_sensors_keep_within_two_thousandths() {
    for (pitch, filter) in [
        ([4.0, 2.0], "{ kind = \"none\" }"),
        ([4.0, 2.0], "{ kind = \"f1\", l = 40 }"),
        ([4.0, 2.0], "{ kind = \"f2\", p = 30 }"),
        ([4.0, 4.0], "{ kind = \"none\" }"),
        ([4.0, 4.0], "{ kind = \"f2\", p = 50 }"),
    ] {
        let (design, solver, plan) = prepare(&design_text(
            "paper",
            [10, 10],
            pitch,
            3.0,
            &format!("[algorithm]\nplan = \"paper\"\nfilter = {filter}"),
        ));
        for step in 0..36 {
            let direction = f64::from(step * 10).to_radians();
            let contact = Contact { centre: [0.48, 0.5], radius: 0.3, friction: 0.5, direction, strength: 0.3 };
            let frame = frame(&contact, &design, &solver);
            let (found, expected) = (answer(&plan, &frame), reference(&solver, &frame));
            let scale = top(&expected.field[2]);
            for p in 0..3 {
                for (found, expected) in found.field[p].iter().zip(&expected.field[p]) {
                    assert!((found - expected).abs() <= 2e-3 * scale, "{pitch:?} {filter} at {step}0 degrees");
                }
                let error = (found.summary[p] - expected.resultant[p]).abs();
                assert!(error <= 2e-3 * expected.resultant[2].abs(), "F[{p}] off by {error} N");
                let error = (found.torque[p] - expected.torque[p]).abs();
                assert!(error <= 2e-5 * expected.resultant[2].abs(), "T[{p}] off by {error} N m");
            }
            assert!((found.summary[3] - expected.mu).abs() <= 2e-3);
            let turn = (found.summary[4] - expected.phi).abs();
            assert!(turn.min(TAU - turn) <= 4e-3, "phi off by {turn}");
            assert_eq!(found.status, expected.status.0, "{pitch:?} {filter} at {step}0 degrees");
        }
    }
}
