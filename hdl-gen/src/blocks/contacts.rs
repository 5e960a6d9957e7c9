//! What is around the core for several bodies: `sptfra_contacts`, where the design asks for them.

use golden::design::{Design, Tension};

use super::{Parameters, latency, records, regions};
use crate::cores::SHORT_BITS;
use crate::plan::Plan;
use crate::plan::SUMMARY_WORDS;
use crate::plan::contacts::records::Program;
use crate::plan::contacts::{ContactsPlan, FORCE_BITS, PART_BITS};
use crate::plan::format::address_bits;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;
use crate::plan::streams::{Streams, WORD_BITS};
use crate::plan::timing::Timeline;

/// Bits of a power of two, of a step for instance.
const EXPONENT_BITS: u32 = 10;

/// Multipliers of a column of the grid: one for each component of a force.
const LANE_MULTIPLIERS: usize = 3;

/// The instance's parameters.
pub fn parameters(plan: &Plan, of: &ContactsPlan) -> Parameters {
    let sensor = &plan.design.sensor;
    let [x, y, diagonal] = regions::steps(sensor);
    records::parameters(&plan.design)
        .count("COLUMNS", sensor.columns)
        .count("ROWS", sensor.rows)
        .flag("FIELD", plan.field_words() > 0)
        .count("BANKS", of.banks)
        .number("STEP_X", x.into())
        .number("STEP_Y", y.into())
        .number("STEP_DIAGONAL", diagonal.into())
        .cycles("EXPECTED_COUNTED", regions::counted(sensor, regions::WEIGHT_LATENCY))
        .cycles("EXPECTED_PARTED", regions::parted(sensor, of.contacts))
        .wide("COEFFICIENT_UNIT", EXPONENT_BITS, of.unit.into())
        .flag("CLIPPED", plan.design.input.tension == Tension::Clipped)
        .expression("ROM_DIR", "ROM_DIR")
        .expression("PARTING_FILE", format!("\"{}\"", rom_file(plan)))
        .expression("RECORDS_FILE", format!("\"{}\"", program_file(plan)))
}

/// The file of the coefficients by distance.
pub fn rom_file(plan: &Plan) -> String {
    format!("{}_parting.mem", plan.design.name)
}

/// The file of the program that makes the words before the field.
pub fn program_file(plan: &Plan) -> String {
    format!("{}_records.mem", plan.design.name)
}

/// Words of the coefficients' file: columns and rows apart, each as many bits as it takes.
pub fn rom_depth(plan: &Plan) -> usize {
    let [columns, rows] = widths(plan);
    1 << (columns + rows)
}

/// Bits of such a word: a coefficient for each component of a force.
pub fn rom_bits() -> u32 {
    3 * SHORT_BITS
}

/// Bits of a taxel's column, and of its row.
pub fn widths(plan: &Plan) -> [u32; 2] {
    [plan.design.sensor.columns, plan.design.sensor.rows].map(address_bits)
}

/// Multipliers and memories.
pub fn costs(plan: &Plan) -> Vec<BlockCost> {
    let Some(of) = &plan.contacts else { return Vec::new() };
    let columns = plan.design.sensor.columns;
    let taxels = 1 << address_bits(plan.taxels());
    let field = 1 << address_bits(3 * plan.taxels());
    let bodies = of.contacts.next_power_of_two();
    let word = WORD_BITS as u32;
    vec![
        BlockCost::new("contacts", &["sptfra_contacts_intake", "sptfra_contacts_answers"], 0).with([
            memory("frames", 1, of.banks * taxels, word, false),
            memory("headers", 1, of.banks * SUMMARY_WORDS, word, false),
            memory("normals", 1, of.banks * taxels, word, false),
            memory("fields", 1, of.banks * field, word, false),
        ]),
        BlockCost::new("parting", &["sptfra_contacts_parts"], LANE_MULTIPLIERS * columns).with([
            memory("forces", 3, 2 * taxels, FORCE_BITS, false),
            memory("parting", columns, rom_depth(plan), rom_bits(), true),
            memory("parts", 1, bodies * taxels, PART_BITS, false),
        ]),
        regions::cost(&plan.design.sensor),
        records::cost(Program::of(&plan.design)),
    ]
}

/// From a frame's last word in to the core's first, and from the core's last word to what is done with it, and from there
/// to the first word out, all but what follows.
const AROUND: u64 = 22;

/// Latency and interval of frames of one body: those of the core, and what is around it.
pub fn timeline(design: &Design, core: &Timeline) -> Timeline {
    let sensor = &design.sensor;
    let taxels = sensor.taxels() as u64;
    let streams = Streams::of(design);
    let words = streams.words_out as u64;
    let looked_at = regions::counted(sensor, regions::WEIGHT_LATENCY) + Program::of(design).cycles(1);
    Timeline {
        latency_cycles: core.latency_cycles + taxels + looked_at + words + AROUND + at_the_doors(streams),
        interval_cycles: core.interval_cycles.max(words + BETWEEN_OUTPUTS).max(looked_at + BETWEEN_LOOKS),
        ..core.clone()
    }
}

/// What streams wider than a word, and a door that drops frames, add to the way through a skid buffer.
fn at_the_doors(streams: Streams) -> u64 {
    let packed = if streams.words() > 1 { UNPACKED + PACKED } else { 0 };
    packed + if streams.drops { latency::OVERRUN } else { 0 }
}

/// From a beat to its first sample (`sptfra_unpack`), and from the last word of a beat to that (`sptfra_pack`).
const UNPACKED: u64 = 1;
const PACKED: u64 = 1;

/// From a frame's last word out to the next one's first.
const BETWEEN_OUTPUTS: u64 = 10;

/// Steps between what is done with a frame and the next one.
const BETWEEN_LOOKS: u64 = 9;
