//! Dead taxels in the RTL: alone, side by side, in corners, eight at once; whatever they read, even no number.

use golden::design::{Calibration, Design, Input, Outputs, PlanKind};
use hdl_gen::model::{NOT_FINITE, REPLACED, SATURATED, TOO_MANY_REPLACED};
use hdl_gen::plan::Plan;
use hdl_gen::plan::dead::DeadPlan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::model_answers;

use crate::support::effort::half_of;
use crate::support::faults::broken;
use crate::support::frames::encode;
use crate::support::{built, by_plan, frames, in_parallel, planned, resets, shipped, simulate_exactly, with_joint};

fn with_dead(mut design: Design, name: &str, dead: &[usize]) -> Design {
    name.clone_into(&mut design.name);
    design.input.dead = dead.to_vec();
    design
}

/// Each kind of design that takes stresses on in another way; `make test` plays every second.
fn designs() -> Vec<Design> {
    let odd = |plan, outputs| by_plan(shipped("odd"), plan, outputs);
    let small = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let taxels = small.sensor.taxels();
    let mut counts = with_dead(odd(PlanKind::Reduced, Outputs::Resultants), "dead_counts", &[3, 4]);
    let gain =
        (0..counts.sensor.taxels()).map(|taxel| if taxel == 4 { 0.0 } else { 0.5 + 0.1 * taxel as f64 }).collect();
    let offset = (0..counts.sensor.taxels()).map(|taxel| taxel as f64 - 9.5).collect();
    counts.input = Input { pa_per_count: Some(-12.5), calibration: Some(Calibration { gain, offset }), ..counts.input };
    let mut pair = with_dead(odd(PlanKind::Paper, Outputs::Field), "dead_pair", &[6, 7]);
    pair.input.crosstalk = 0.05;
    vec![
        pair,
        with_dead(small, "dead_corner", &[taxels - 1]),
        with_joint(with_dead(shipped("small"), "dead_joint", &[0, 5])),
        counts,
        with_dead(odd(PlanKind::Reduced, Outputs::Field), "dead_eight", &[0, 1, 6, 7, 8, 12, 13, 18]),
    ]
}

/// The full scale, in the values of a frame.
fn full_scale(plan: &Plan) -> f64 {
    plan.design.hardware.full_scale_pa / plan.design.input.pa_per_count.unwrap_or(1.0)
}

fn packets(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let dead = plan.design.input.dead.clone();
    let mut packets: Vec<Vec<u32>> = (0..5).map(|_| frames::contact(plan, random)).collect();
    packets.extend([1e-5, 0.03, 1.0, 1.3].map(|share| frames::noise(plan, share, random)));
    packets.extend(frames::extremes(plan, random).into_iter().step_by(3));
    // All that presses stands where a dead taxel's stress comes from, within the full scale and beyond it.
    for share in [0.1, 0.9] {
        let DeadPlan { weights, shift, .. } = plan.dead.as_ref().expect("dead taxels");
        let load = |&weight: &i32| if weight > 1 << (shift - 3) { share } else { 0.0 };
        packets.push(encode(&weights[0].iter().map(load).map(|share| -share * full_scale(plan)).collect::<Vec<_>>()));
    }
    // What a dead taxel reads is nothing.
    for reading in [f32::NAN, f32::INFINITY, 1e30, -1e5, 0.0] {
        let mut packet = packets[0].clone();
        for &taxel in &dead {
            packet[taxel] = reading.to_bits();
        }
        packets.push(packet);
    }
    let mut not_finite = packets[1].clone();
    let alive = (0..plan.taxels()).find(|taxel| !dead.contains(taxel)).expect("one that is alive");
    not_finite[alive] = f32::NAN.to_bits();
    // Too short, too long, by one and by far.
    let whole = packets[2].clone();
    let lengths = [1, whole.len() - 1, whole.len() + 1, 2 * whole.len() + 3];
    packets.extend(lengths.map(|length| whole.iter().copied().cycle().take(length).collect()));
    packets.push(not_finite);
    for index in (1..packets.len()).rev() {
        packets.swap(index, random.random_range(0..=index));
    }
    packets
}

#[test]
fn replaced_in_the_rtl_as_in_the_model() {
    let failures: Vec<String> = in_parallel(&half_of(designs()), |design| {
        let plan = planned(design);
        let packets = packets(&plan, &mut ChaCha8Rng::seed_from_u64(3));
        let answers = model_answers(&plan, &packets);
        let with = |bit: u32| answers.iter().filter(|words| words[0] & bit != 0).count();
        let (guessed, all) = (with(TOO_MANY_REPLACED), with(REPLACED));
        assert!(guessed > 0 && guessed < all && all < packets.len(), "{}: {guessed} of {all}", design.name);
        assert_eq!(with(NOT_FINITE), 1, "{}", design.name);
        assert!(with(SATURATED) > 0, "{}", design.name);
        simulate_exactly(&plan, &built(&plan), &packets, 5).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_reset_leaves_no_end_of_a_frame() {
    let design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants);
    let plan = planned(&with_dead(design, "dead_reset", &[5]));
    resets::in_each_cycle(&plan, &built(&plan)).unwrap();
    let left = broken(&plan, "sptfra_replace", "            lasts <= 4'd0;\n", "");
    assert!(resets::in_each_cycle(&plan, &left).is_err(), "the end of a frame passes a reset");
}
