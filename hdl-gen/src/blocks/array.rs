//! The array of SpMV PEs, which issues the products, and its collector: `sptfra_spmv_array`.

use crate::format::address_bits;
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::layout::Place;
use crate::plan::product::{Coefficients, DESTINATIONS, SUMS_DESTINATION, destination, destination_bits};
use crate::resources::BlockCost;
use crate::resources::memory::memory;

use super::row_width;
use crate::timing::latency::PROGRAM_GAP;

/// Bits of a word in the MACs-per-row ROM: a count and what becomes of the sum.
const SEGMENT_BITS: u32 = 16;

/// Bits of a column number: of the largest number of vectors that one product reads.
pub fn column_bits(plan: &Plan) -> u32 {
    address_bits(vectors(plan) * plan.elements())
}

/// The PEs' numbers in the names of their ROM files: all have as many digits, two or three.
pub fn pe_numbers(plan: &Plan) -> Vec<String> {
    let pes = plan.pes();
    let digits = if pes > 100 { 3 } else { 2 };
    (0..pes).map(|pe| format!("{pe:0digits$}")).collect()
}

/// The instance's parameters: sizes, then the products and programs as tables.
pub fn parameters(plan: &Plan) -> Parameters {
    let (hardware, schedule) = (&plan.design.hardware, &plan.schedule);
    let parameters = Parameters::new()
        .count("PES", plan.pes())
        .count("CHANNELS", plan.channels())
        .number("COEFFICIENT_BITS", hardware.coefficient_bits.into())
        .number("DATA_BITS", hardware.data_bits.into())
        .count("ELEMENTS", plan.elements())
        .count("VECTORS", vectors(plan))
        .count("WORD_DEPTH", schedule.word_depth())
        .count("SEGMENT_DEPTH", schedule.segment_depth())
        .count("OPERAND_DEPTH", plan.operands.words())
        .count("SLOT_DEPTH", schedule.slots.len())
        .count("MIRROR_SIDE", mirror_side(plan));
    let shifts = shifts(plan);
    let each_shift = || shifts.iter().map(|&(shift, _)| shift as usize);
    programs(plan, products(plan, parameters))
        .when(schedule.ahead, |all| all.flag("AHEAD", true))
        .number("DESTINATION_BITS", destination_bits(plan.has_field()).into())
        .count("LEAST_SHIFT", each_shift().min().unwrap_or(0))
        .count("LARGEST_SHIFT", each_shift().max().unwrap_or(0))
        .table("SHIFTS", 6, &shifts)
        .outer("ROM_DIR")
        .text("ROM_NAME", &plan.design.name)
        .count("NUMBER_BITS", 8 * pe_numbers(plan)[0].len())
        .texts("PE_NUMBERS", pe_numbers(plan))
}

/// A multiplier a lane, or two; the PEs' programs and operands.
pub fn cost(plan: &Plan) -> BlockCost {
    let (hardware, schedule, pes) = (&plan.design.hardware, &plan.schedule, plan.pes());
    let channels = plan.channels() as u32;
    // The PE, the destination, the row, and whether a program ends.
    let slot = 1 + address_bits(pes) + destination_bits(plan.has_field()) + row_width(plan);
    let multipliers = hardware.lanes * plan.factors().multipliers();
    let narrow = if plan.factors().lane_is_narrow() { multipliers } else { 0 };
    BlockCost::new("lanes", &["sptfra_spmv_array"], multipliers).narrow(narrow).with([
        memory("values", pes, schedule.word_depth(), channels * hardware.coefficient_bits, true),
        memory("columns", pes, schedule.word_depth(), column_bits(plan), true),
        memory("MACs per row", pes, schedule.segment_depth(), SEGMENT_BITS, true),
        memory("slots", 1, schedule.slots.len(), slot, true),
        memory("operands", pes, plan.operands.words(), channels * hardware.data_bits, false),
    ])
}

fn vectors(plan: &Plan) -> usize {
    plan.products.iter().map(|product| product.operands.len()).max().unwrap_or(1)
}

/// Orbits along a side of the grid, if some products are mirrored at its diagonal.
fn mirror_side(plan: &Plan) -> usize {
    plan.products.iter().find_map(|product| product.mirrored).unwrap_or(0)
}

fn products(plan: &Plan, parameters: Parameters) -> Parameters {
    let (products, windows, programs) = (&plan.products, &plan.schedule.windows, &plan.schedule.programs);
    let gap = |index| programs.iter().find(|program| program.first == index).map_or(0, |next| next.gap - PROGRAM_GAP);
    let length = |index: usize| windows[index].length.max(1);
    let wait = |index: usize| windows[index].wait + gap(index);
    let longest = (0..products.len()).map(|index| length(index).max(wait(index))).max().unwrap_or(1);
    let bits = address_bits(longest as usize + 1);
    let name = |index: usize| {
        let product = &products[index];
        let mirror = if product.mirrored.is_some() { " mirrored" } else { "" };
        format!(
            "{}{mirror} {} -> {}",
            plan.matrices[product.matrix].name,
            product.operand().name(),
            product.result.name()
        )
    };
    let lengths: Vec<(u64, String)> = (0..products.len()).map(|index| (length(index), name(index))).collect();
    let place = |index: usize| plan.operands.place(products[index].operand());
    let base = |index: usize| match place(index) {
        Some(Place::Fixed(word)) => word as u64,
        Some(Place::StressBank) | None => 0,
    };
    let rereads = |index: usize| products[..index].iter().position(|other| other.matrix == products[index].matrix);
    let is_read_again = |index: usize| (index + 1..products.len()).any(|later| rereads(later) == Some(index));
    let mask = |condition: &dyn Fn(usize) -> bool| -> Vec<bool> { (0..products.len()).map(condition).collect() };
    parameters
        .count("PRODUCTS", products.len())
        .number("COUNT_BITS", bits.into())
        .table("LENGTHS", bits, &lengths)
        .list("WAITS", bits, (0..products.len()).map(wait))
        .list("BASES", 16, (0..products.len()).map(base))
        .mask("OF_STRESS", &mask(&|index| place(index) == Some(Place::StressBank)))
        .mask("MARKS", &mask(&is_read_again))
        .mask("REWINDS", &mask(&|index| rereads(index).is_some()))
        .mask("MIRRORED", &mask(&|index| products[index].mirrored.is_some()))
        .mask("FRICTIONS", &mask(&|index| products[index].coefficients == Coefficients::Friction))
        .signed("RESIDUAL_BANK", 16, plan.operands.residual_bank() as i64)
        .mask("LASTS", &mask(&|index| programs.iter().any(|program| program.end == index + 1)))
}

fn programs(plan: &Plan, parameters: Parameters) -> Parameters {
    let programs = &plan.schedule.programs;
    parameters
        .count("PROGRAMS", programs.len())
        .list("FIRSTS", 8, programs.iter().map(|program| program.first as u64))
        .list("START_WORDS", 32, programs.iter().map(|program| program.word as u64))
        .list("START_SEGMENTS", 16, programs.iter().map(|program| program.segment as u64))
        .list("START_SLOTS", 32, programs.iter().map(|program| program.slot as u64))
}

/// Bits dropped by destination. One that no product has repeats the one before, so that it costs nothing.
fn shifts(plan: &Plan) -> Vec<(u64, String)> {
    let mut known = vec![None; DESTINATIONS];
    for product in &plan.products {
        known[destination(product.result)] = Some((u64::from(product.shift), product.result.name()));
        if let Some(preload) = product.preload {
            known[SUMS_DESTINATION] = Some((u64::from(preload.shift), "sums of the frame".to_owned()));
        }
    }
    let mut last = 0;
    let filled = known.into_iter().map(|entry| {
        let (shift, name) = entry.unwrap_or((last, String::new()));
        last = shift;
        (shift, name)
    });
    filled.collect()
}
