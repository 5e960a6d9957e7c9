//! The top of a design: its parameters and its wiring, around the modules of the library.

use serde::Serialize;
use tera::Context;

use golden::design::{Filter, Samples};

use crate::blocks::{
    array, bz, calibration, cean, co, contacts, field, frame_context, ingress_fifo, op, program_scheduler, row_width,
    unfold, we,
};
use crate::cores::LONG_BITS;
use crate::format::{SUM_BITS, address_bits};
use crate::plan::Plan;
use crate::plan::calibration::CalibrationPlan;
use crate::plan::streams::Intake;
use crate::plan::words::status_bits;

use super::instance::verilog;
use super::template::design_module;
use super::{EmitError, debug, registers};

/// One module, cut along the data's way: ports, Bz and `CeAn`; what shares the lanes; estimator, field and Op.
const TEMPLATE: &str = concat!(
    include_str!("../../templates/rtl/top/input.v.tera"),
    include_str!("../../templates/rtl/top/lanes.v.tera"),
    include_str!("../../templates/rtl/top/output.v.tera"),
);

/// The data of the template. Widths end in `_width`.
#[derive(Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a question that the template asks")]
struct View {
    /// Whether a register bank is around the core, and then the core's own module.
    control: bool,
    core_module: String,
    columns: usize,
    rows: usize,
    taxels: usize,
    plan: &'static str,
    estimator: &'static str,
    filter: String,
    counts: bool,
    /// Whether gains and offsets stand in RAM; bits of a taxel's number and of an offset there.
    calibration: bool,
    taxel_width: u32,
    offset_bits: u32,
    /// Bits of what goes between the banks' control and what they say of dead taxels, there and back.
    dead_command_bits: u32,
    dead_result_bits: u32,
    /// Of an ingress FIFO that drops frames, its parameters.
    overrun: Option<String>,
    /// Bits and bytes of a beat, 32-bit words of it, samples of it; bits of a sample and what it is.
    stream_bits: usize,
    stream_bytes: usize,
    words: usize,
    samples: usize,
    sample_bits: usize,
    sample: String,
    beats_in: usize,
    beats: usize,
    /// TKEEP of the last beat out.
    last_keep: String,
    /// Whether samples go to Bz one by one, and what the stream is called that does.
    unpack: bool,
    samples_from: &'static str,
    /// Whether each frame has a scale of its own.
    scaled: bool,
    context: String,
    /// Thresholds of every frame, unless a calibration in RAM brings them: a taxel's noise, the least sum `|b|` of a contact.
    noise: String,
    contact: String,
    /// Whether frames are averaged, and the rate, where no register has it.
    averages: bool,
    smoothing: String,
    /// Dead taxels of the design.
    dead: usize,
    field: bool,
    latency_cycles: u64,
    latency_us: String,
    interval_cycles: u64,
    interval_us: String,
    clock_mhz: f64,
    issue_cycles: u64,
    macs: u64,
    busy_percent: String,
    stress_lsb: i32,
    weight_lsb: i32,
    u_lsb: i32,
    g_lsb: i32,
    torque_lsb: i32,
    /// Status bits with their meanings, two in a line.
    status: Vec<String>,

    elements: usize,
    channels: usize,
    programs: usize,
    row_width: u32,
    operand_width: u32,
    component_width: u32,
    data_bits: u32,
    vector_bits: usize,
    u_values: String,

    bz: String,
    cean: String,
    program_scheduler: String,
    array: String,
    unfold: String,
    we: String,
    co: String,
    estimator_module: &'static str,
    estimator_parameters: String,
    field_module: &'static str,
    field_parameters: String,
    /// Of the contact counter, if there is one.
    contacts: Option<String>,
    op: String,
}

impl View {
    fn new(plan: &Plan) -> Self {
        let (design, hardware) = (&plan.design, &plan.design.hardware);
        let timeline = &plan.timeline;
        let estimator_block = plan.estimator.block();
        let folded = plan.channels() > 1;
        let streams = plan.streams();
        let unpack = streams.intake == Intake::Unpacked;
        let [dead_command_bits, dead_result_bits] = plan.calibration.as_ref().map_or([0, 0], calibration::dead_bits);
        let estimator = estimator_block.parameters(design, plan.channels());
        let estimator = plan.thresholds.error.iter().fold(estimator, |parameters, error| error.parameters(parameters));
        let microseconds = |cycles: u64| format!("{:.2}", cycles as f64 / hardware.clock_mhz);
        Self {
            control: hardware.control,
            core_module: registers::core_module(plan),
            columns: design.sensor.columns,
            rows: design.sensor.rows,
            taxels: plan.taxels(),
            plan: if folded { "reduced" } else { "paper's" },
            estimator: if design.algorithm.estimator.is_calibrated() { "grid search" } else { "line search" },
            filter: filter_text(&design.algorithm.filter),
            counts: design.input.counts(),
            calibration: plan.calibration.is_some(),
            taxel_width: address_bits(plan.taxels()),
            offset_bits: plan.calibration.as_ref().map_or(0, CalibrationPlan::offset_bits),
            dead_command_bits,
            dead_result_bits,
            overrun: streams.drops.then(|| verilog(&ingress_fifo::parameters(plan))),
            stream_bits: streams.bits,
            stream_bytes: streams.bits / 8,
            words: streams.words(),
            samples: streams.samples(),
            sample_bits: streams.sample_bits,
            sample: streams.sample.to_string(),
            beats_in: streams.beats_in(),
            beats: streams.beats_out(),
            last_keep: format!("{:x}", streams.last_keep()),
            unpack,
            samples_from: if unpack { "sample" } else { "in" },
            scaled: plan.scales_frames(),
            context: verilog(&frame_context::parameters(plan)),
            noise: format!("{LONG_BITS}'d{}", plan.thresholds.taxel),
            contact: format!("{SUM_BITS}'d{}", plan.thresholds.contact),
            averages: plan.smoothing.is_some(),
            smoothing: match &plan.smoothing {
                Some(_) if hardware.control => "smoothing".to_owned(),
                of => format!("4'd{}", of.as_ref().map_or(0, |of| of.rate)),
            },
            dead: plan.dead.as_ref().map_or(0, |dead| dead.taxels.len()),
            field: plan.has_field(),
            latency_cycles: timeline.latency_cycles,
            latency_us: microseconds(timeline.latency_cycles),
            interval_cycles: timeline.interval_cycles,
            interval_us: microseconds(timeline.interval_cycles),
            clock_mhz: hardware.clock_mhz,
            issue_cycles: plan.schedule.issue_cycles(),
            macs: plan.macs(),
            busy_percent: format!("{:.1}", 100.0 * plan.schedule.busy_fraction()),
            stress_lsb: plan.formats.stress.lsb,
            weight_lsb: plan.formats.weight.lsb,
            u_lsb: plan.formats.u.lsb,
            g_lsb: plan.formats.g.lsb,
            torque_lsb: plan.formats.torque_lsb,
            status: status_lines(),

            elements: plan.elements(),
            channels: plan.channels(),
            programs: plan.schedule.programs.len(),
            row_width: row_width(plan),
            operand_width: address_bits(plan.operands.words()),
            component_width: address_bits(3 * plan.elements()),
            data_bits: hardware.data_bits,
            vector_bits: plan.channels() * hardware.data_bits as usize,
            u_values: u_values(plan),

            bz: verilog(&bz::parameters(plan)),
            cean: verilog(&cean::parameters(plan)),
            program_scheduler: verilog(&program_scheduler::parameters(plan)),
            array: verilog(&array::parameters(plan)),
            unfold: verilog(&unfold::parameters(plan)),
            we: verilog(&we::parameters(plan)),
            co: verilog(&co::parameters(plan)),
            estimator_module: estimator_block.module(),
            estimator_parameters: verilog(&estimator),
            field_module: field::module(plan),
            field_parameters: verilog(&field::parameters(plan)),
            contacts: design.algorithm.count_contacts.then(|| verilog(&contacts::parameters(plan))),
            op: verilog(&op::parameters(plan)),
        }
    }
}

/// The status bits as a table of two columns.
fn status_lines() -> Vec<String> {
    let bits: Vec<_> = status_bits().map(|(bit, meaning)| format!("{bit:>2}  {meaning:<22}")).collect();
    let rows = bits.len().div_ceil(2);
    (0..rows)
        .map(|row| bits[row..].iter().step_by(rows).map(String::as_str).collect::<String>().trim_end().to_owned())
        .collect()
}

/// What the estimator has of the taxels: the upper bits of each, where there are more than it takes.
fn u_values(plan: &Plan) -> String {
    let factors = plan.factors();
    if !factors.has_wide_data() {
        return "taxels".to_owned();
    }
    let upper = |channel: usize| {
        let end = (channel + 1) * factors.data_bits as usize;
        format!("taxels[{}:{}]", end - 1, end - factors.outside_bits() as usize)
    };
    format!("{{{}}}", (0..plan.channels()).rev().map(upper).collect::<Vec<_>>().join(", "))
}

/// The module of the core and its text, with nets marked for a logic analyser if `debug`.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit the view.
pub(super) fn render(plan: &Plan, debug: bool) -> Result<(String, String), EmitError> {
    let view = View::new(plan);
    let context =
        Context::from_serialize(&view).map_err(|source| EmitError::Template { template: "top".to_owned(), source })?;
    let text = design_module(&view.core_module, TEMPLATE, &context)?;
    let text = if debug { debug::marked(&text, debug::always_zero(plan)) } else { text };
    Ok((view.core_module, text))
}

/// Modules of the library that stand only in a `generate if` that neither the design takes nor the default parameters.
pub(super) fn without(plan: &Plan) -> Vec<&'static str> {
    let mut without = plan.estimator.block().without();
    if plan.thresholds.error.is_none() {
        without.push("sptfra_standard_error");
    }
    let curve = plan.design.input.curve.is_some();
    if !plan.design.input.counts() {
        without.push("sptfra_counts");
    }
    if !curve {
        without.push("sptfra_curve");
    }
    if plan.streams().sample == Samples::Float32 {
        without.push("sptfra_int_to_fixed");
    }
    if plan.calibration.is_none() {
        without.extend(["sptfra_banks", "sptfra_curve_bank", "sptfra_tare"]);
    } else if !curve {
        without.push("sptfra_curve_bank");
    }
    if plan.crosstalk.is_none() {
        without.push("sptfra_crosstalk");
    }
    if plan.creep.is_none() {
        without.push("sptfra_creep");
    }
    if plan.smoothing.is_none() {
        without.push("sptfra_smoothing");
    }
    if !plan.scales_frames() {
        without.push("sptfra_frame_scale");
    }
    if plan.places_for_dead() == 0 {
        without.push("sptfra_replace");
    }
    if plan.calibration.as_ref().is_none_or(|of| of.power_up.dead.room == 0) {
        without.push("sptfra_dead_bank");
    }
    if plan.channels() > 1 {
        without.push("sptfra_coefficients");
    }
    without
}

fn filter_text(filter: &Filter) -> String {
    match filter {
        Filter::None => "none".to_owned(),
        Filter::F1 { l } => format!("F1 with L = {l}"),
        Filter::F2 { p } => format!("F2 with p = {p}"),
        Filter::F3 { .. } => "F3, chosen for each matrix".to_owned(),
    }
}
