//! Products and programs as the templates see them.

use serde::Serialize;

use crate::plan::Plan;
use crate::plan::product::{Epilogue, Product, Vector};
use crate::plan::schedule::TURN_GAP;

use super::expressions::{half, operand_base, result_slice};

/// One sparse product as the templates see it.
#[derive(Serialize)]
pub struct ProductView {
    index: usize,
    text: String,
    operand: String,
    length: u64,
    wait: u64,
    /// Verilog expression of the operand's first word in the lanes' memories.
    base: String,
    shift: u32,
    half: u64,
    /// Verilog slice that drops `shift` bits.
    slice: String,
    /// Co's role bits, where the result is Co's.
    role: Option<String>,
}

/// A program as the sequencer sees it.
#[derive(Serialize)]
pub struct ProgramView {
    first: usize,
    end: usize,
    word: usize,
    segment: usize,
    visit: usize,
}

/// Every product; the rows of sums count as one more.
pub(super) fn product_views(plan: &Plan) -> Vec<ProductView> {
    let own = (0..plan.products.len()).map(|index| product_view(plan, index));
    let lead = plan.products.iter().find_map(|product| product.lead).map(|lead| {
        let (data, index) = (plan.design.hardware.data_bits, plan.products.len());
        let slice = result_slice(lead.shift, data);
        let half = if lead.shift == 0 { 0 } else { half(lead.shift) };
        let text = "sums of the frame".to_owned();
        let (operand, base) = (String::new(), String::new());
        ProductView { index, text, operand, length: 0, wait: 0, base, shift: lead.shift, half, slice, role: None }
    });
    own.chain(lead).collect()
}

/// `(product whose matrix is read again, product that reads it again)`.
pub(super) fn reread(plan: &Plan) -> Vec<(usize, usize)> {
    let first = |matrix| plan.products.iter().position(|product| product.matrix == matrix).unwrap_or(0);
    let pairs = plan.products.iter().enumerate().map(|(index, product)| (first(product.matrix), index));
    pairs.filter(|(mark, rewind)| mark < rewind).collect()
}

pub(super) fn programs(plan: &Plan) -> Vec<ProgramView> {
    let programs = plan.schedule.programs.iter();
    programs
        .map(|program| ProgramView {
            first: program.first,
            end: program.end,
            word: program.word,
            segment: program.segment,
            visit: program.visit,
        })
        .collect()
}

fn product_view(plan: &Plan, index: usize) -> ProductView {
    let product = &plan.products[index];
    let window = plan.schedule.windows[index];
    let matrix = &plan.matrices[product.matrix].name;
    let data = plan.design.hardware.data_bits;
    let mirror = if product.mirrored.is_some() { " mirrored" } else { "" };
    // The paper's next frame waits for the last result of the one before.
    let begins = plan.ways() > 1 && plan.schedule.programs.iter().any(|program| program.first == index);
    ProductView {
        index,
        text: format!("{matrix}{mirror} {} -> {}", product.operand().name(), product.result.name()),
        operand: product.operand().name(),
        // Rounds take as long as the data say; only what is in front of them is counted here.
        length: window.rounds.map_or(window.length, |rounds| rounds.lead),
        wait: window.wait + if begins { plan.schedule.program_gap - TURN_GAP } else { 0 },
        base: operand_base(plan, product.operand()),
        shift: product.shift,
        half: if product.shift == 0 { 0 } else { half(product.shift) },
        slice: result_slice(product.shift, data),
        role: role(product),
    }
}

/// `{is A_p b, is g, add A_p b, p - 1, q}`.
fn role(product: &Product) -> Option<String> {
    let adds = u8::from(matches!(product.epilogue, Epilogue::Add(_)));
    match product.result {
        Vector::Partial(p) => Some(format!("7'b100_{:02b}_00", p - 1)),
        Vector::G(p, q) => Some(format!("7'b01{adds}_{:02b}_{q:02b}", p - 1)),
        _ => None,
    }
}
