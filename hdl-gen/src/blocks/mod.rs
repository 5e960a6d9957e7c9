//! The hardware's blocks: one file each, with what a design decides of it.
//!
//! The Verilog of a block is the same in every design (`hdl-gen/rtl`). Its file here states the parameters of its
//! instance and what it costs, multipliers and memories. The cycles that it takes, which the schedule counts with before
//! there is an instance, stand in [`crate::timing::latency`].

pub mod array;
pub mod bz;
pub mod calibration;
pub mod cean;
pub mod co;
pub mod contacts;
pub mod field;
pub mod frame_context;
pub mod ingress_fifo;
pub mod op;
pub mod program_scheduler;
pub mod registers;
pub mod unfold;
pub mod we;

use crate::format::{FEWEST_ELEMENTS, address_bits};
use crate::plan::Plan;
use crate::plan::layout::Place;
use crate::plan::product::Vector;
use crate::resources::BlockCost;

/// What each block of the design takes, in the data's order.
pub fn costs(plan: &Plan) -> Vec<BlockCost> {
    let estimator_block = plan.estimator.block();
    let mut costs: Vec<BlockCost> = ingress_fifo::cost(plan).into_iter().chain(calibration::cost(plan)).collect();
    costs.extend([bz::cost(plan), estimator_block.contact_block()]);
    costs.extend([array::cost(plan), we::cost(), co::cost(plan), field::cost(plan)]);
    costs.extend(contacts::cost(plan));
    costs.extend(estimator_block.search_blocks(&plan.design.sensor));
    costs.push(op::cost());
    costs
}

/// Where a vector stands in the lanes' operand memories: its first word, and whether that is in the stress's bank. One
/// that no product reads is at 0.
fn place(plan: &Plan, vector: Vector) -> (usize, bool) {
    match plan.operands.place(vector) {
        Some(Place::Fixed(word)) => (word, false),
        Some(Place::StressBank) => (0, true),
        None => (0, false),
    }
}

/// Bits of the number of an element, or of a row of sums.
pub fn row_width(plan: &Plan) -> u32 {
    address_bits(plan.elements().max(FEWEST_ELEMENTS))
}
