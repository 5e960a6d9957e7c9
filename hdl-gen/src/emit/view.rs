//! Everything the templates print, computed: they contain text, this contains numbers and widths.

use std::collections::BTreeSet;

use golden::design::Filter;
use serde::Serialize;

use crate::cores::{cordic, float_to_fixed};
use crate::estimators::line::timing::{DIRECTION_LATENCY, LINE_LATENCY, decision};
use crate::estimators::line::{
    CENTROID_FRACTION, HINGE_DROP, LEVEL_SHIFT, LINE_FRACTION, LINE_SUM_BITS, PITCH_FRACTION, SEARCH_STEPS,
};
use crate::model::inverse_gain;
use crate::plan::Plan;
use crate::plan::counts::input_stages;
use crate::plan::format::{ACCUMULATOR_BITS, FRICTION_FRACTION, address_bits};
use crate::plan::product::{Block, Vector};
use crate::plan::timing::{OUTPUT_DEPTH, SEQUENCER_TO_LANES, SUMMARY_LATENCY};

use super::counts_view::CountsView;
use super::expressions::{
    bits_outside, half, operand_base, shift_and_add, sign_extend, signed_literal, slice, zero_extend,
};
use super::folded_view::FoldedView;
use super::joint_view::{JointView, NetworkView};
use super::product_view::{ProductView, ProgramView, product_views, programs, reread};
use super::{registers, roms};

/// The data of all templates. Widths end in `_width`, counts of words in `_depth`.
#[derive(Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a question that a template asks")]
pub struct View {
    name: String,
    /// Whether a register bank is around the core, and then the core's own module.
    control: bool,
    core_module: String,
    /// Modules that multiply.
    mac: &'static str,
    multiply: &'static str,
    columns: usize,
    rows: usize,
    taxels: usize,
    filter: String,
    beats: usize,
    clock_mhz: f64,
    latency_cycles: u64,
    latency_us: String,
    interval_cycles: u64,
    interval_us: String,
    lanes: usize,
    coefficient_bits: u32,
    data_bits: u32,
    issue_cycles: u64,
    drained: u64,
    drain_cycles: u64,
    macs: u64,
    busy_percent: String,
    overlap: bool,
    reduced: bool,
    ways: usize,

    products: Vec<ProductView>,
    product_count: usize,
    programs: Vec<ProgramView>,
    program_count: usize,
    /// Products whose matrix is read again, and those that read it again.
    marks: Vec<usize>,
    rewinds: Vec<usize>,
    visit_width: u32,
    product_width: u32,
    co_first: usize,
    op_first: usize,
    last_product: usize,
    /// Highest and lowest bit of the rounded accumulator that is in any result.
    greatest_bit: u32,
    least_bit: u32,
    /// The other bits, as they join `_unused`.
    sum_unused: String,
    count_width: u32,

    lane_width: u32,
    /// Values that a lane number of `lane_width` bits can have.
    lane_codes: u32,
    pending_extended: String,
    row_width: u32,
    column_width: u32,
    index_width: u32,
    x_width: u32,
    y_width: u32,
    word_depth: usize,
    word_address_width: u32,
    value_depth: usize,
    value_address_width: u32,
    segment_depth: usize,
    segment_address_width: u32,
    operand_depth: usize,
    operand_address_width: u32,
    visit_depth: usize,
    visit_address_width: u32,
    field_depth: usize,
    field_width: u32,
    field_address_width: u32,
    beat_width: u32,
    g_total: usize,
    g_count_width: u32,

    column_extended: String,
    taxel_extended: String,
    row_extended: String,
    g_row_extended: String,
    row_to_field: String,
    coefficient_extended: String,
    operand_extended: String,
    u_extended: String,
    weight_extended: String,
    g1_extended: String,
    g2_extended: String,
    stress_data: String,
    beat_component: String,
    beat_unused: String,

    stress_lsb: i32,
    number_stages: u32,
    input_stages: u64,
    /// Of the number that the stream carries: stress or counts.
    number_shift: String,
    number_bound: i64,
    counts: Option<CountsView>,
    taxel_width: u32,
    stress_bound: i64,
    weight_lsb: i32,
    g_lsb: i32,
    f_lsb: i32,
    f_exponent: String,
    sum_exponent: String,
    weight_base: String,
    g30_base: String,
    g31_base: String,
    g32_base: String,

    /// Verilog sums of shifted `weight_1`: its products with the taxel's column and row.
    moment_x: String,
    moment_y: String,
    taxel_floor: i64,
    contact_floor: i64,
    pitch_x: i64,
    pitch_y: i64,
    pitch_fraction: u32,
    pitch_half: u64,
    centroid_fraction: u32,
    direction_latency: u64,

    friction_fraction: u32,
    line_fraction: u32,
    line_sum_bits: u32,
    line_latency: u64,
    one: i64,
    dependent_half: u64,
    hinge_drop: u32,
    level_exponent: i32,
    search_steps: u32,
    search_latency: u64,
    decision_cycles: u32,
    cells: usize,
    elements: usize,
    cell_address_width: u32,
    cell_depth: usize,
    element_width: u32,
    element_shift: u32,
    u_element: String,
    last_count: usize,
    tree_levels: u32,
    tree_leaves: usize,
    margin: String,
    search_unused: String,
    inverse_gain: i64,
    angle_fraction: u32,
    summary_latency: u64,
    output_depth: u64,

    field: bool,
    joint: Option<JointView>,
    network: Option<NetworkView>,
    #[serde(flatten)]
    folded: FoldedView,
}

impl View {
    /// Derives every number and width from the plan.
    #[allow(clippy::too_many_lines)] // one line a field; splitting it would scatter the list
    pub fn new(plan: &Plan) -> Self {
        let design = &plan.design;
        let hardware = &design.hardware;
        let schedule = &plan.schedule;
        let optimum = plan.estimator.slot().cells();
        let line = plan.estimator.line();
        let data = hardware.data_bits;
        let taxels = plan.taxels();
        let field_depth = 3 * taxels;
        let beats = plan.beats_out();
        let reduced = plan.ways() > 1;
        let row_width = roms::row_bits(plan);
        let folded = FoldedView::new(plan);
        let number = plan.counts.as_ref().map_or(plan.formats.stress, |counts| counts.count);
        let operand_depth = plan.operands.words();
        let operand_width = address_bits(operand_depth);
        let field_width = address_bits(field_depth);
        let beat_width = address_bits(beats);
        let sum_lsb = plan.formats.g.lsb - FRICTION_FRACTION as i32;
        let f_lsb = FoldedView::f_lsb(plan).unwrap_or(sum_lsb);
        let drain_cycles = (schedule.drained() + SEQUENCER_TO_LANES).saturating_sub(schedule.issue_cycles() - 1);
        let longest = schedule.windows.iter().map(|window| window.length.max(window.wait)).max().unwrap_or(1);
        let element_width = address_bits(optimum.elements);
        let leads = plan.products.iter().filter_map(|product| product.lead).map(|lead| lead.shift);
        let shifts = plan.products.iter().map(|product| product.shift).chain(leads);
        let greatest_bit = (shifts.clone().max().unwrap_or(0) + data - 1).min(ACCUMULATOR_BITS - 1);
        let least_bit = shifts.min().unwrap_or(0);
        let microseconds = |cycles: u64| format!("{:.2}", cycles as f64 / hardware.clock_mhz);
        Self {
            name: design.name.clone(),
            control: hardware.control,
            core_module: registers::core_module(plan),
            mac: "sptfra_mac",
            multiply: "sptfra_multiply",
            columns: design.sensor.columns,
            rows: design.sensor.rows,
            taxels,
            filter: filter_text(&design.algorithm.filter),
            beats,
            clock_mhz: hardware.clock_mhz,
            latency_cycles: plan.timeline.latency_cycles,
            latency_us: microseconds(plan.timeline.latency_cycles),
            interval_cycles: plan.timeline.interval_cycles,
            interval_us: microseconds(plan.timeline.interval_cycles),
            lanes: plan.walkers(),
            coefficient_bits: hardware.coefficient_bits,
            data_bits: data,
            issue_cycles: schedule.issue_cycles(),
            drained: schedule.drained(),
            drain_cycles,
            macs: schedule.windows.iter().map(|window| window.macs).sum(),
            busy_percent: format!("{:.1}", 100.0 * schedule.busy_fraction()),
            overlap: plan.timeline.overlap,
            reduced,
            ways: plan.ways(),

            products: product_views(plan),
            product_count: plan.products.len(),
            programs: programs(plan),
            program_count: schedule.programs.len(),
            marks: reread(plan).into_iter().map(|(mark, _)| mark).collect::<BTreeSet<_>>().into_iter().collect(),
            rewinds: reread(plan).into_iter().map(|(_, rewind)| rewind).collect(),
            visit_width: roms::visit_bits(plan),
            product_width: roms::product_bits(plan),
            co_first: plan.turn(Block::Co).0,
            op_first: plan.turn(Block::Op).0,
            last_product: plan.products.len() - 1,
            greatest_bit,
            least_bit,
            sum_unused: bits_outside("sum", ACCUMULATOR_BITS - 1, greatest_bit, least_bit),
            count_width: address_bits((longest + schedule.program_gap).max(drain_cycles) as usize + 1),

            lane_width: address_bits(plan.walkers()),
            lane_codes: 1 << address_bits(plan.walkers()),
            pending_extended: zero_extend("pending", plan.walkers() as u32, 1 << address_bits(plan.walkers())),
            row_width,
            column_width: roms::column_bits(plan),
            index_width: address_bits(taxels + 1),
            x_width: address_bits(design.sensor.columns),
            y_width: address_bits(design.sensor.rows),
            word_depth: schedule.word_depth(),
            word_address_width: address_bits(schedule.word_depth()),
            value_depth: schedule.value_depth(),
            value_address_width: address_bits(schedule.value_depth()),
            segment_depth: schedule.segment_depth(),
            segment_address_width: address_bits(schedule.segment_depth()),
            operand_depth,
            operand_address_width: operand_width,
            visit_depth: schedule.visits.len(),
            visit_address_width: address_bits(schedule.visits.len()),
            field_depth,
            field_width,
            field_address_width: address_bits(2 * field_depth),
            beat_width,
            g_total: 9 * taxels,
            g_count_width: address_bits(9 * taxels + 1),

            column_extended: zero_extend("column", roms::column_bits(plan), operand_width),
            taxel_extended: zero_extend("taxel", row_width, operand_width),
            row_extended: zero_extend("result_row", row_width, operand_width),
            g_row_extended: zero_extend("g_row", row_width, operand_width),
            row_to_field: zero_extend("result_row", row_width, field_width),
            coefficient_extended: sign_extend("way_coefficient", hardware.coefficient_bits, 18),
            operand_extended: sign_extend("way_operand", data, 27),
            u_extended: sign_extend("result_value", data, 27),
            weight_extended: sign_extend("weight_2", data, 27),
            g1_extended: sign_extend("g1_2", data, 27),
            g2_extended: sign_extend("g2_2", data, 27),
            stress_data: if data == 27 { "fixed".to_owned() } else { format!("fixed[{}:0]", data - 1) },
            beat_component: slice("beat_component", beat_width, field_width),
            // The reduced plan's field memory counts for itself.
            beat_unused: if plan.ways() == 1 && beat_width > field_width {
                format!(", beat_component[{}:{field_width}]", beat_width - 1)
            } else {
                String::new()
            },

            stress_lsb: plan.formats.stress.lsb,
            number_stages: float_to_fixed::LATENCY,
            input_stages: input_stages(plan.counts.is_some()),
            number_shift: signed_literal(10, -number.lsb),
            number_bound: number.bound,
            counts: plan.counts.as_ref().map(CountsView::new),
            taxel_width: address_bits(taxels),
            stress_bound: plan.formats.stress.bound,
            weight_lsb: plan.formats.weight.lsb,
            g_lsb: plan.formats.g.lsb,
            f_lsb,
            f_exponent: signed_literal(10, f_lsb),
            sum_exponent: signed_literal(10, sum_lsb),
            weight_base: operand_base(plan, Vector::Weight),
            g30_base: operand_base(plan, Vector::G(3, 0)),
            g31_base: operand_base(plan, Vector::G(3, 1)),
            g32_base: operand_base(plan, Vector::G(3, 2)),

            moment_x: shift_and_add("weight_1", "column_1", address_bits(design.sensor.columns)),
            moment_y: shift_and_add("weight_1", "row_1", address_bits(design.sensor.rows)),
            taxel_floor: plan.thresholds.taxel,
            contact_floor: plan.thresholds.contact,
            pitch_x: line.map_or(0, |line| line.pitch[0]),
            pitch_y: line.map_or(0, |line| line.pitch[1]),
            pitch_fraction: PITCH_FRACTION,
            pitch_half: half(PITCH_FRACTION),
            centroid_fraction: CENTROID_FRACTION,
            direction_latency: DIRECTION_LATENCY,

            friction_fraction: FRICTION_FRACTION,
            line_fraction: LINE_FRACTION,
            line_sum_bits: LINE_SUM_BITS,
            line_latency: LINE_LATENCY,
            one: 1 << FRICTION_FRACTION,
            dependent_half: half(LINE_FRACTION),
            hinge_drop: HINGE_DROP,
            level_exponent: LEVEL_SHIFT,
            search_steps: SEARCH_STEPS,
            search_latency: plan.timeline.search_cycles,
            decision_cycles: decision(optimum),
            cells: optimum.cells,
            elements: optimum.elements,
            cell_address_width: element_width + u32::from(reduced),
            cell_depth: if reduced { 2 << element_width } else { optimum.elements },
            element_width,
            element_shift: optimum.elements.trailing_zeros(),
            u_element: if optimum.elements == 1 {
                "1'b0".to_owned()
            } else {
                slice(if reduced { "u_quad" } else { "u_row" }, row_width, element_width)
            },
            last_count: plan.elements() - (optimum.cells / plan.ways() - 1) * optimum.elements,
            tree_levels: optimum.tree_levels(),
            tree_leaves: 1 << optimum.tree_levels(),
            margin: match line.map_or(0, |line| line.level_shift) {
                shift if shift >= 0 => format!("{{8'd0, stress_sum}} << {shift}"),
                shift => format!("{{8'd0, stress_sum}} >> {}", -shift),
            },
            search_unused: if optimum.tree_levels() == 0 { String::new() } else { ", nodes[47:0]".to_owned() },
            inverse_gain: inverse_gain(),
            angle_fraction: cordic::ANGLE_FRACTION_BITS,
            summary_latency: SUMMARY_LATENCY,
            output_depth: OUTPUT_DEPTH,

            field: plan.field_words() > 0,
            joint: JointView::new(plan),
            network: NetworkView::new(plan),
            folded,
        }
    }
}

fn filter_text(filter: &Filter) -> String {
    match filter {
        Filter::None => "none".to_owned(),
        Filter::F1 { l } => format!("F1 with L = {l}"),
        Filter::F2 { p } => format!("F2 with p = {p}"),
        Filter::F3 { .. } => "F3, chosen for each matrix".to_owned(),
    }
}
