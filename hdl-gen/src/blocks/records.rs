//! The words of several bodies: `sptfra_records`, in the shell of a design with more than one.

use golden::design::Design;

use crate::plan::SUMMARY_WORDS;
use crate::plan::contacts::records::{Constants, INSTRUCTION_BITS, Program, RECORD_WORDS};
use crate::plan::format::address_bits;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::Parameters;

/// Pages of sixteen words: of eight bodies, the frame, what is between, and two for the next frame, and room.
const WORDS: usize = 256;

/// Words before the field.
pub fn words(contacts: usize) -> usize {
    SUMMARY_WORDS + RECORD_WORDS * contacts
}

/// The instance's parameters but for the program's folder and file.
pub fn parameters(design: &Design) -> Parameters {
    let contacts = design.algorithm.contacts;
    let program = Program::of(design);
    let [_, _, change_squared, middle_x, middle_y, nearness, limit, _, slips_from, slips_still] =
        Constants::of(design).words();
    let float = |bits: u32| format!("32'h{bits:08x}");
    let latencies: Vec<(u64, String)> = (0..=contacts).map(|kept| (program.cycles(kept), String::new())).collect();
    let parameters = Parameters::new()
        .count("CONTACTS", contacts)
        .expression("MIDDLE_X", float(middle_x))
        .expression("MIDDLE_Y", float(middle_y))
        .expression("CHANGE_SQUARED", float(change_squared))
        .expression("NEARNESS", float(nearness))
        .expression("LIMIT", float(limit))
        .count("PROGRAM_LENGTH", program.rom().len())
        .table("LATENCIES", 16, &latencies);
    if program.slips {
        parameters.expression("SLIPS_FROM", float(slips_from)).expression("SLIPS_STILL", float(slips_still))
    } else {
        parameters
    }
}

/// One multiplier, of significands; headers, the program, two banks of results.
pub fn cost(program: Program) -> BlockCost {
    let results = memory("results", 1, 2 << address_bits(words(program.contacts)), 32, false);
    // Halves of a float's 24 bits.
    BlockCost::new("records", &["sptfra_records"], 1).narrow(1).with([
        memory("headers", 1, WORDS, 32, false),
        memory("records_program", 1, program.rom().len(), INSTRUCTION_BITS, true),
        results,
    ])
}
