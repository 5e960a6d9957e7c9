//! What only the templates of the reduced plan print: the folded grid, its products by role, its formats.

use golden::design::Optimise;
use serde::Serialize;

use crate::plan::Plan;
use crate::plan::format::address_bits;
use crate::plan::formats::field_shifts;
use crate::plan::product::{Coefficients, Epilogue, SUM_ROWS, Vector, mirror, sum_way};
use crate::plan::schedule::Rounds;

use super::expressions::{half, operand_base, sign_extend, slice, zero_extend};
use super::roms;

/// Products whose results take their classes from the ways in the same order.
#[derive(Serialize)]
struct Order {
    products: Vec<usize>,
    /// Way of class 3, 2, 1, 0.
    ways: Vec<usize>,
}

/// A frame sum in a row of sums: its place among `G10, G11, ... G32`, and the class that holds it.
#[derive(Serialize)]
struct SumView {
    slot: usize,
    class: usize,
}

/// A product whose results go to the operand memories as they come.
#[derive(Serialize)]
struct Store {
    product: usize,
    text: String,
    base: String,
}

/// A product that passes over zeros.
#[derive(Serialize)]
struct RoundsView {
    product: usize,
    /// First word of its dense rows in the values ROM.
    word: usize,
}

/// The data of the reduced plan's templates.
#[derive(Default, Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a question that a template asks")]
pub struct FoldedView {
    interval: bool,
    quads: usize,
    quad_columns: usize,
    quad_rows: usize,
    quad_x_width: u32,
    /// Quads on the centre line in x.
    centre_column: Vec<usize>,
    opposite_to_row: String,
    quad_x_to_row: String,
    /// Words from one bank to the next where the bank is part of the address.
    bank_stride: usize,

    orders: Vec<Order>,
    mirrors: bool,
    mirror: Vec<usize>,
    mirror_extended: String,
    column_to_row: String,
    has_friction: bool,
    friction_product: usize,
    unfolded_products: Vec<usize>,
    u_products: Vec<usize>,
    u0_product: usize,
    last_u_product: usize,
    last_residual_product: usize,
    force_products: Vec<usize>,
    sums_product: usize,
    sum_rows: Vec<Vec<SumView>>,
    stores: Vec<Store>,

    skips: bool,
    count_bits: u32,
    rounds: Vec<RoundsView>,
    rounds_without_lead: Vec<usize>,
    round_count: usize,
    /// Rows, and so lanes, in the last round.
    last_round_rows: usize,
    pull_products: Vec<usize>,
    skip_extended: String,
    skip_word_offset: String,
    word_to_value: String,

    folded_stress_lsb: i32,
    folded_weight_lsb: i32,
    /// Declarations that bring `stress_wide` to the step of u, as `scaled`.
    stress_to_u: String,
    weight_half: String,
    weight_shift: u32,
    force_shift: u32,
    share_shift: u32,
    force_address_width: u32,
    taxel_quad_to_force: String,
    quad_to_force: String,
    quad_3_extended: String,
    fold_quad_extended: String,
    u_member_extended: String,
}

impl FoldedView {
    /// Empty for the paper's plan.
    #[allow(clippy::too_many_lines)] // one line a field; splitting it would scatter the list
    pub fn new(plan: &Plan) -> Self {
        let Some(folded) = plan.formats.folded else { return Self::default() };
        let (columns, data) = (plan.design.sensor.columns, plan.design.hardware.data_bits);
        let quads = plan.quads();
        let (count, row_width) = (quads.count(), roms::row_bits(plan));
        let operand_width = address_bits(plan.operands.words());
        let force_width = address_bits(6 * count);
        let x_width = address_bits(columns);
        let weight_shift = (folded.weight.lsb - plan.formats.weight.lsb) as u32;
        let (force_shift, share_shift, _) = field_shifts(&plan.formats, &folded);
        let of = |condition: &dyn Fn(Vector) -> bool| -> Vec<usize> {
            let products = plan.products.iter().enumerate();
            products.filter(|(_, product)| condition(product.result)).map(|(index, _)| index).collect()
        };
        let the = |vector: Vector| of(&|result| result == vector).first().copied().unwrap_or(0);
        let of_operand = |vector: Vector| -> Vec<usize> {
            let products = plan.products.iter().enumerate();
            products.filter(|(_, product)| product.operand() == vector).map(|(index, _)| index).collect()
        };
        let rounds: Vec<(usize, Rounds)> = plan
            .schedule
            .windows
            .iter()
            .enumerate()
            .filter_map(|(index, window)| Some((index, window.rounds?)))
            .collect();
        let value_width = address_bits(plan.schedule.value_depth());
        let friction = plan.products.iter().position(|product| product.coefficients == Coefficients::Friction);
        let side = plan.products.iter().find_map(|product| product.mirrored);
        Self {
            interval: plan.design.hardware.optimise == Optimise::Interval,
            quads: count,
            quad_columns: quads.columns(),
            quad_rows: quads.rows(),
            quad_x_width: address_bits(quads.columns()),
            centre_column: if columns % 2 == 1 {
                (1..=quads.rows()).map(|row| row * quads.columns() - 1).collect()
            } else {
                Vec::new()
            },
            opposite_to_row: resized("opposite", x_width, row_width),
            quad_x_to_row: resized("quad_x", x_width, row_width),
            bank_stride: 1 << row_width,

            orders: orders(plan),
            mirrors: side.is_some(),
            mirror: side.map_or_else(Vec::new, |side| (0..count).map(|quad| mirror(quad, side)).collect()),
            mirror_extended: zero_extend(
                &format!("mirror_of({})", resized("column", roms::column_bits(plan), row_width)),
                row_width,
                operand_width,
            ),
            column_to_row: resized("column", roms::column_bits(plan), row_width),
            has_friction: friction.is_some(),
            friction_product: friction.unwrap_or(0),
            unfolded_products: plan
                .products
                .iter()
                .enumerate()
                .filter(|(_, product)| product.epilogue != Epilogue::Store)
                .map(|(index, _)| index)
                .collect(),
            u_products: (0..3).map(|q| the(Vector::U(q))).collect(),
            u0_product: the(Vector::U(0)),
            last_u_product: plan.schedule.programs[0].end - 1,
            last_residual_product: the(Vector::Residual(2)),
            force_products: of(&|result| matches!(result, Vector::Force(_))),
            sums_product: plan.products.len(),
            sum_rows: (0..SUM_ROWS - 1)
                .map(|q| (0..3).map(|p| SumView { slot: 3 * p + q, class: sum_way(p, q) }).collect())
                .collect(),
            stores: stores(plan),

            skips: !rounds.is_empty(),
            count_bits: address_bits(count.max(plan.walkers()) + 1).max(row_width + 1),
            rounds_without_lead: rounds.iter().filter(|(_, of)| of.lead == 0).map(|&(product, _)| product).collect(),
            round_count: count.div_ceil(plan.walkers()),
            last_round_rows: (count - 1) % plan.walkers() + 1,
            pull_products: of_operand(Vector::Pull),
            skip_extended: zero_extend("skip_quad_1", row_width, operand_width),
            skip_word_offset: skip_word_offset(plan, &rounds, value_width, row_width),
            word_to_value: zero_extend("word", address_bits(plan.schedule.word_depth()), value_width),
            rounds: rounds
                .iter()
                .map(|&(product, of)| RoundsView { product, word: plan.schedule.word_depth() + of.word })
                .collect(),

            folded_stress_lsb: folded.stress.lsb,
            folded_weight_lsb: folded.weight.lsb,
            stress_to_u: stress_to_u(folded.u.lsb - folded.stress.lsb, data),
            weight_half: if weight_shift == 0 {
                String::new()
            } else {
                format!(" + {}'d{}", data + 2, half(weight_shift))
            },
            weight_shift,
            force_shift,
            share_shift,
            force_address_width: force_width,
            taxel_quad_to_force: resized("taxel_quad", row_width, force_width),
            quad_to_force: resized("quad", row_width, force_width),
            quad_3_extended: zero_extend("quad_3", row_width, operand_width),
            fold_quad_extended: zero_extend("fold_write_quad", row_width, operand_width),
            u_member_extended: sign_extend("u_member", data, 27),
        }
    }

    /// Exponent of a taxel's force as the output puts it together.
    pub fn f_lsb(plan: &Plan) -> Option<i32> {
        plan.formats.folded.map(|folded| field_shifts(&plan.formats, &folded).2)
    }
}

/// A number of another width: cut, or extended by zeros.
fn resized(signal: &str, from: u32, to: u32) -> String {
    if to < from { slice(signal, from, to) } else { zero_extend(signal, from, to) }
}

/// The word of a nonzero quad in its row: the quad, or its mirror image where the stored matrix is mirrored.
fn skip_word_offset(plan: &Plan, rounds: &[(usize, Rounds)], value_width: u32, row_width: u32) -> String {
    let plain = resized("list_quad", row_width, value_width);
    let mirrored: Vec<String> = rounds
        .iter()
        .filter(|&&(product, _)| plan.products[product].mirrored.is_some())
        .map(|(product, _)| format!("(product == {}'d{product})", roms::product_bits(plan)))
        .collect();
    if mirrored.is_empty() {
        return plain;
    }
    let image = resized("mirror_of(list_quad)", row_width, value_width);
    format!("(({}) ? {image} : {plain})", mirrored.join(" || "))
}

fn orders(plan: &Plan) -> Vec<Order> {
    let mut orders: Vec<Order> = Vec::new();
    for (index, product) in plan.products.iter().enumerate() {
        let mut ways = product.ways().to_vec();
        ways.reverse();
        if ways == [3, 2, 1, 0] {
            continue; // as they come
        }
        match orders.iter_mut().find(|order| order.ways == ways) {
            Some(order) => order.products.push(index),
            None => orders.push(Order { products: vec![index], ways }),
        }
    }
    orders
}

fn stores(plan: &Plan) -> Vec<Store> {
    let products = plan.products.iter().enumerate().filter(|(_, product)| product.epilogue == Epilogue::Store);
    products
        .map(|(index, product)| Store {
            product: index,
            text: product.result.name(),
            base: operand_base(plan, product.result),
        })
        .collect()
}

/// The stress at the step of u, and the bit below it that rounds.
fn stress_to_u(shift: i32, data: u32) -> String {
    let scaled = format!("wire signed [{}:0] scaled", data - 1);
    match shift {
        1.. => format!(
            "{scaled} = stress_wide >>> {shift};\n            \
             wire half = stress_wide[{}];",
            shift - 1
        ),
        0 => format!("{scaled} = stress_wide;\n            wire half = 1'b0;"),
        _ => format!("{scaled} = stress_wide <<< {};\n            wire half = 1'b0;", -shift),
    }
}
