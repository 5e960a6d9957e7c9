//! What only the templates of the joint estimator print.

use golden::estimators::joint::REACH;
use serde::Serialize;

use crate::estimators::joint::{
    CENTRE_HALF, CORRECTION_LIMIT, CUBIC_FRACTION, DEPTH_BITS, FACTOR_FRACTION, INPUT_BITS, INPUT_FRACTION,
    LINEAR_FRACTION, NORMAL_DROP, NetworkPlan, POINT_BITS, POINTS, RECIPROCAL_BITS, SIDE, STEP_SHIFT, STRESS_BITS,
    UNIT_BITS, UNITS, WEIGHT_DROP, timing,
};
use crate::plan::Plan;
use crate::plan::format::address_bits;
use crate::plan::format::{FRICTION_FRACTION, SUM_BITS};

use super::expressions::{half, shift_and_add_of, signed_literal, slice, zero_extend};
use super::roms;

/// Bits of a stress times the reciprocal.
const PRODUCT_BITS: u32 = 45;

/// Constants of the grid, the level set and the friction.
#[derive(Serialize)]
pub struct JointView {
    /// Whether there is a correction.
    network: bool,
    contact_latency: u64,
    /// From the start to the first value, and from the last value to the centroid.
    first_value: u64,
    level_latency: u64,
    friction_latency: u64,
    side: usize,
    points: usize,
    reach: i32,
    point_bits: u32,
    value_bits: u32,
    share_shift: u32,
    depth_bits: u32,
    weight_drop: u32,
    quotient_fraction: u32,
    /// `u_wide` times the reach, as shifts and additions.
    u_times_reach: String,
    /// `sum |b|` as a margin.
    margin: String,
    /// Bits of `sum |b|` that the margin drops on top, as they join `_unused`.
    margin_unused: String,
    total_depth: u32,
    look_element: String,
    look_cell: String,
    group_width: u32,
    cell_width: u32,
    linear: i64,
    cubic: String,
    cubic_one: i64,
    linear_fraction: u32,
    cubic_fraction: u32,
    factor_fraction: u32,
    factor_half: u64,
    square_shift: u32,
    factor_shift: u32,
}

impl JointView {
    pub fn new(plan: &Plan) -> Option<Self> {
        let joint = plan.estimator.joint()?;
        let cells = joint.cells;
        let row_width = roms::row_bits(plan);
        let group_width = address_bits(cells.cells / plan.ways());
        let margin_top = (joint.value_bits + joint.share_shift).min(SUM_BITS);
        Some(Self {
            network: joint.network.is_some(),
            contact_latency: timing::CONTACT_LATENCY,
            first_value: timing::first_value(cells),
            level_latency: timing::LEVEL,
            friction_latency: timing::FRICTION,
            side: SIDE,
            points: POINTS,
            reach: REACH,
            point_bits: POINT_BITS,
            value_bits: joint.value_bits,
            share_shift: joint.share_shift,
            depth_bits: DEPTH_BITS,
            weight_drop: WEIGHT_DROP,
            quotient_fraction: FRICTION_FRACTION - STEP_SHIFT,
            u_times_reach: times_reach(),
            margin: zero_extend(
                &format!("stress_sum[{}:{}]", margin_top - 1, joint.share_shift),
                margin_top - joint.share_shift,
                joint.value_bits,
            ),
            margin_unused: if margin_top < SUM_BITS {
                format!(", stress_sum[{}:{margin_top}]", SUM_BITS - 1)
            } else {
                String::new()
            },
            total_depth: 3 + cells.tree_levels(),
            look_element: slice("look_quad", row_width, address_bits(cells.elements)),
            look_cell: format!("{{look_group[{}:0], look_member}}", group_width - 1),
            group_width,
            cell_width: group_width + 2,
            linear: joint.linear,
            cubic: signed_literal(18, joint.cubic as i32),
            cubic_one: 1 << CUBIC_FRACTION,
            linear_fraction: LINEAR_FRACTION,
            cubic_fraction: CUBIC_FRACTION,
            factor_fraction: FACTOR_FRACTION,
            factor_half: half(FACTOR_FRACTION),
            square_shift: 2 * FRICTION_FRACTION - LINEAR_FRACTION,
            factor_shift: LINEAR_FRACTION + CUBIC_FRACTION - FACTOR_FRACTION,
        })
    }
}

fn times_reach() -> String {
    let bits = (0..POINT_BITS).filter(|bit| REACH >> bit & 1 == 1);
    bits.map(|bit| if bit == 0 { "u_wide".to_owned() } else { format!("(u_wide <<< {bit})") })
        .collect::<Vec<_>>()
        .join(" + ")
}

/// Constants of the correction.
#[derive(Serialize)]
pub struct NetworkView {
    half_x: usize,
    half_y: usize,
    x_width: u32,
    y_width: u32,
    places: usize,
    length: usize,
    word_width: u32,
    passes: usize,
    units_at_a_time: usize,
    units: usize,
    weight_depth: usize,
    weight_address_width: u32,
    readout_address_width: u32,
    weight_lsb: i32,
    input_bits: u32,
    input_fraction: u32,
    input_one: u64,
    /// Bits by which an input is finer than a friction component.
    finer: u32,
    stress_bits: u32,
    share_bits: u32,
    /// A product with the reciprocal, at the width in which it is shifted.
    share_wide: String,
    reciprocal_numerator: u64,
    normal_shift: u32,
    normal_half: u64,
    centre_half: i64,
    seen_depth: usize,
    /// `quad_y` times the quads of a row.
    quad_row: String,
    unit_bits: u32,
    unit_shift: u32,
    unit_half: String,
    unit_unused: String,
    limit: i64,
    exact_x: String,
    exact_y: String,
    look_latency: u64,
    latency: u64,
}

impl NetworkView {
    pub fn new(plan: &Plan) -> Option<Self> {
        let network = plan.estimator.joint()?.network.as_ref()?;
        let sensor = &plan.design.sensor;
        let [half_x, half_y] = network.half_window;
        let normal_shift = FRICTION_FRACTION + NORMAL_DROP;
        let unit_shift = network.unit_shift;
        Some(Self {
            half_x,
            half_y,
            x_width: address_bits(half_x + 1),
            y_width: address_bits(half_y + 1),
            places: network.places(),
            length: network.length,
            word_width: address_bits(network.length),
            passes: network.passes,
            units_at_a_time: UNITS,
            units: network.units(),
            weight_depth: network.weights.len(),
            weight_address_width: address_bits(network.weights.len()),
            readout_address_width: address_bits(network.units()),
            weight_lsb: network.weight_lsb,
            input_bits: INPUT_BITS,
            input_fraction: INPUT_FRACTION,
            input_one: 1 << INPUT_FRACTION,
            finer: INPUT_FRACTION - FRICTION_FRACTION,
            stress_bits: STRESS_BITS,
            share_bits: PRODUCT_BITS + network.stress_left,
            share_wide: match network.stress_left {
                0 => "share_2".to_owned(),
                left => format!("{{share_2, {left}'d0}}"),
            },
            reciprocal_numerator: 1 << (SUM_BITS + RECIPROCAL_BITS),
            normal_shift,
            normal_half: half(normal_shift),
            centre_half: CENTRE_HALF,
            seen_depth: sensor.rows << address_bits(sensor.columns),
            quad_row: shift_and_add_of(plan.quads().columns(), "quad_y", address_bits(sensor.rows)),
            unit_bits: UNIT_BITS,
            unit_shift,
            unit_half: if unit_shift == 0 { String::new() } else { format!(" + 48'sd{}", half(unit_shift)) },
            unit_unused: if unit_shift == 0 { String::new() } else { format!(", rounded[{}:0]", unit_shift - 1) },
            limit: CORRECTION_LIMIT,
            exact_x: exact(network, "wide_x"),
            exact_y: exact(network, "wide_y"),
            look_latency: timing::look(plan.taxels(), network),
            latency: timing::network(network),
        })
    }
}

/// A sum of the output as a friction component.
fn exact(network: &NetworkPlan, sum: &str) -> String {
    match network.correction_shift {
        0 => sum.to_owned(),
        shift if shift > 0 => format!("({sum} + 64'sd{}) >>> {shift}", half(shift as u32)),
        shift => format!("{sum} <<< {}", -shift),
    }
}
