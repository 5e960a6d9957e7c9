//! The register bank: its map against `SystemRDL`, its counters and interrupts under good and bad frames, soft resets.

mod counters;
mod map;
mod soft_reset;

use std::sync::OnceLock;

use crate::calibration;
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped};
use golden::design::{Design, Outputs, PlanKind};
use hdl_gen::plan::Plan;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use testbench::verilate::Built;

/// A design with a register bank, planned and compiled.
pub struct Subject {
    /// What it is.
    pub plan: Plan,
    /// What it became.
    pub built: Built,
}

/// The small design in every plan, and with its calibration in RAM.
pub fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(|| {
        let small = |kind, outputs| by_plan(shipped("small-control"), kind, outputs);
        let designs: [Design; 5] = [
            shipped("small-control"),
            small(PlanKind::Paper, Outputs::Field),
            small(PlanKind::Reduced, Outputs::Resultants),
            by_plan(
                Design { sensor: shipped("odd").sensor, ..shipped("small-control") },
                PlanKind::Reduced,
                Outputs::Field,
            ),
            calibration::design(Outputs::Resultants),
        ];
        in_parallel(&designs, |design| {
            let plan = planned(design);
            let built = built(&plan);
            Subject { plan, built }
        })
    })
}

/// Good frames and every kind of bad one, at random; the last one good, so that something follows each.
pub fn mixed(plan: &Plan, count: usize, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let taxels = plan.taxels();
    let mut packets: Vec<Vec<u32>> = (1..count)
        .map(|_| {
            let mut packet = frames::contact(plan, random);
            match random.random_range(0..8) {
                0 => packet[random.random_range(0..taxels)] = f32::NAN.to_bits(),
                1 => packet[random.random_range(0..taxels)] = f32::INFINITY.to_bits(),
                2 => packet.truncate(random.random_range(1..taxels)),
                3 => packet = packet.into_iter().cycle().take(random.random_range(taxels + 1..3 * taxels)).collect(),
                4 => packet = frames::empty(plan),
                _ => {}
            }
            packet
        })
        .collect();
    packets.push(frames::contact(plan, random));
    packets
}
