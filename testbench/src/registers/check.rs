//! What `sptfra run` asks of a register bank: who it is, and whether it counts what happens.

use hdl_gen::blocks::registers::{self, MAP_VERSION};
use hdl_gen::emit::VERSION;
use hdl_gen::model::{BAD_LENGTH, NOT_FINITE};
use hdl_gen::plan::Plan;
use serde::Serialize;

use crate::co_simulation::{CoSimulation, pacing, timeout};
use crate::simulate::SimulationError;
use crate::stream::{Mode, Traffic, exchange};
use crate::verilate::Built;

use super::{Access, Controlled, address};

/// Cycles between two reads while frames run.
const READ_EVERY: u64 = 97;

/// What the bank said.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RegisterReport {
    /// Accesses.
    pub accesses: usize,
    /// Registers with another value than they should have: name, expected, found.
    pub wrong: Vec<String>,
}

/// Sends a co-simulation's packets with pauses on all sides, reads counters meanwhile and every register afterwards. `progress`
/// is called once a frame answered.
///
/// # Errors
/// [`SimulationError`] if a stream or the register port breaks a rule.
pub fn check(
    co_simulation: &CoSimulation<'_>,
    built: &Built,
    progress: impl Fn(),
) -> Result<RegisterReport, SimulationError> {
    let CoSimulation { plan, packets, expected, seed } = co_simulation;
    let mut core = Controlled::new(built.load(*seed)?, u64::from(*seed))?;
    let [.., mode] = Mode::all(u64::from(*seed));
    let enable = Access::Write { address: address::INTERRUPT_ENABLE, data: 3, strobes: 0xF };
    core.plan(0, enable);
    let cycles = packets.len() as u64 * plan.timeline.interval_cycles;
    for cycle in (0..cycles).step_by(READ_EVERY as usize) {
        core.plan(cycle, Access::Read { address: address::FRAMES_OUT });
    }
    let traffic = Traffic::new(packets, timeout(plan)).with_mode(&mode).with_pacing(pacing(plan));
    let outcome = exchange(&mut core, &traffic, |_| progress())
        .map_err(|source| SimulationError::Stream { mode: "with register accesses", source })?;

    let mut report = RegisterReport::default();
    let mut counted = 0;
    for reply in core.replies() {
        report.accesses += 1;
        let falls = matches!(reply.access, Access::Read { .. }) && reply.data < counted;
        if falls {
            report.wrong.push(format!("FRAMES_OUT while frames run: {} after {counted}", reply.data));
        }
        counted = counted.max(reply.data);
    }
    let bad = expected.iter().filter(|words| words[0] & (NOT_FINITE | BAD_LENGTH) != 0).count() as u32;
    let frames = packets.len() as u32;
    let last = expected.last().map_or(0, |words| words[0]);
    let latency = outcome.exchanges.last().map_or(0, |exchange| exchange.latency() as u32);
    let ends: Vec<u64> = outcome.exchanges.iter().rev().take(2).map(|exchange| exchange.last_out).collect();
    let interval = if let [end, before] = ends[..] { (end - before) as u32 } else { 0 };
    let events = u32::from(frames > 0) | u32::from(bad > 0) << 1;
    let figures = [
        ("STATUS", address::STATUS, 0),
        ("INTERRUPT_ENABLE", address::INTERRUPT_ENABLE, 3),
        ("INTERRUPT_STATUS", address::INTERRUPT_STATUS, events),
        ("FRAMES_IN", address::FRAMES_IN, frames),
        ("FRAMES_OUT", address::FRAMES_OUT, frames),
        ("FRAMES_BAD", address::FRAMES_BAD, bad),
        ("LAST_STATUS", address::LAST_STATUS, last),
        ("LAST_LATENCY", address::LAST_LATENCY, latency),
        ("LAST_INTERVAL", address::LAST_INTERVAL, interval),
    ];
    // Elsewhere an address without a register, which the check of the port looks at.
    let dropped = plan.streams().drops.then_some(("FRAMES_DROPPED", address::FRAMES_DROPPED, 0));
    for (name, address, expected) in constants(plan).into_iter().chain(figures).chain(dropped) {
        report.accesses += 1;
        let found = core.read(address)?;
        if found != expected {
            report.wrong.push(format!("{name}: expected {expected:#010x}, found {found:#010x}"));
        }
    }
    if !core.interrupt() {
        report.wrong.push("interrupt is low with an enabled event pending".to_owned());
    }
    core.write(address::INTERRUPT_STATUS, 3)?;
    report.accesses += 1;
    if core.read(address::INTERRUPT_STATUS)? != 0 || core.interrupt() {
        report.wrong.push("INTERRUPT_STATUS is not cleared by writing ones".to_owned());
    }
    Ok(report)
}

/// Name, address and value of the registers that say what the core is.
fn constants(plan: &Plan) -> Vec<(&'static str, u32, u32)> {
    let (sensor, hardware) = (&plan.design.sensor, &plan.design.hardware);
    let hash = u64::from_str_radix(&plan.design.hash(), 16).unwrap_or_default();
    let part = |index| VERSION.split('.').nth(index).and_then(|text| text.parse::<u32>().ok()).unwrap_or_default();
    // From bit 8 on, behind eight features.
    let stream = (hardware.stream_bits / 8) | (u32::from(registers::samples(plan)) << 8);
    let features = [
        plan.field_words() > 0,
        plan.channels() > 1,
        plan.design.input.counts(),
        false,
        plan.calibration.is_some(),
        plan.streams().drops,
        plan.calibration.as_ref().is_some_and(|of| of.curve().is_some()),
        plan.smoothing.is_some(),
    ];
    let stream = stream | (plan.design.input.room as u32) << 12;
    vec![
        ("IDENTITY", address::IDENTITY, u32::from_be_bytes(*b"TFRA")),
        ("VERSION", address::VERSION, u32::from(MAP_VERSION) << 24 | part(0) << 16 | part(1) << 8 | part(2)),
        ("HASH_LOW", address::HASH_LOW, hash as u32),
        ("HASH_HIGH", address::HASH_HIGH, (hash >> 32) as u32),
        ("GEOMETRY", address::GEOMETRY, (hardware.lanes << 16 | sensor.rows << 8 | sensor.columns) as u32),
        ("FRAME", address::FRAME, (plan.words_out() << 16 | plan.streams().words_in()) as u32),
        ("FEATURES", address::FEATURES, features.iter().rev().fold(stream, |word, &is| word << 1 | u32::from(is))),
        ("CLOCK", address::CLOCK, (hardware.clock_mhz * 1e3).round() as u32),
        ("FULL_SCALE", address::FULL_SCALE, (hardware.full_scale_pa as f32).to_bits()),
        ("PREDICTED_LATENCY", address::PREDICTED_LATENCY, plan.timeline.latency_cycles as u32),
        ("PREDICTED_INTERVAL", address::PREDICTED_INTERVAL, plan.timeline.interval_cycles as u32),
    ]
}
