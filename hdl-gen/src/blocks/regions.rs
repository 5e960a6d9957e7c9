//! Where several bodies are: `sptfra_regions`, its steps, its cycles, its memories.

use golden::sensor::Sensor;

use crate::plan::format::address_bits;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::Parameters;

/// Bits of `|w|`.
pub const WEIGHT_BITS: u32 = 26;

/// From the address of a weight to the weight, unless the instance says otherwise.
pub const WEIGHT_LATENCY: u64 = 4;

/// Shortest row of a sweep: a taxel is written before the next row reads it.
const SWEPT_ROW: usize = 4;

/// Distances of neighbours along x, along y and along the diagonal, in whole micrometres, as the solver has them.
pub fn steps(sensor: &Sensor) -> [u32; 3] {
    let [x, y] = sensor.pitch_mm;
    [x, y, x.hypot(y)].map(|millimetres| (1e3 * millimetres).round() as u32)
}

/// Cycles of a frame from its start to its count: every taxel and the end of each row, twice.
pub fn counted(sensor: &Sensor, weight_latency: u64) -> u64 {
    2 * pass(sensor) + weight_latency + 7
}

/// Cycles from a count of several bodies to their regions and lists: two sweeps of two cycles a taxel, and a pass.
pub fn parted(sensor: &Sensor, contacts: usize) -> u64 {
    let sweep = 2 * (sensor.columns + 1).max(SWEPT_ROW) * sensor.rows;
    2 * sweep as u64 + pass(sensor) + contacts as u64 + 6
}

/// A step for each taxel and for the end of each row.
fn pass(sensor: &Sensor) -> u64 {
    ((sensor.columns + 1) * sensor.rows) as u64
}

/// The instance's parameters for that many bodies with a region.
pub fn parameters(sensor: &Sensor, contacts: usize, weight_latency: u64) -> Parameters {
    let [x, y, diagonal] = steps(sensor);
    Parameters::new()
        .count("COLUMNS", sensor.columns)
        .count("ROWS", sensor.rows)
        .count("CONTACTS", contacts)
        .number("STEP_X", x.into())
        .number("STEP_Y", y.into())
        .number("STEP_DIAGONAL", diagonal.into())
        .cycles("WEIGHT_LATENCY", weight_latency)
        .cycles("EXPECTED_COUNTED", counted(sensor, weight_latency))
        .cycles("EXPECTED_PARTED", parted(sensor, contacts))
}

/// A word and a place in the list for each taxel.
pub fn cost(sensor: &Sensor) -> BlockCost {
    let address = address_bits(sensor.taxels()).max(3);
    let of_taxels = |name, bits| memory(name, 1, 1 << address, bits, false);
    BlockCost::new("regions", &["sptfra_regions"], 0)
        .with([of_taxels("regions", record_bits(sensor)), of_taxels("list", address)])
}

/// Bits of a taxel's word: sum and taxels of its blob, two names, two flags.
fn record_bits(sensor: &Sensor) -> u32 {
    let bits = |numbers: usize| numbers.next_power_of_two().ilog2();
    let name = if sensor.columns > 4 { bits(sensor.columns.div_ceil(2)) + 1 } else { 2 };
    let sum = WEIGHT_BITS + bits(sensor.taxels());
    sum + bits(sensor.taxels() + 1) + 2 * name + 2
}
