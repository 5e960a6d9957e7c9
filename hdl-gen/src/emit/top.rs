//! The top of a design: its parameters and its wiring, around the modules of the library.

use tera::{Context, context};

use golden::design::{Filter, Samples};

use crate::blocks::{
    array, bz, calibration, cean, co, contacts, field, frame_context, ingress_fifo, op, program_scheduler, row_width,
    unfold, we,
};
use crate::cores::LONG_BITS;
use crate::format::{SUM_BITS, address_bits};
use crate::plan::Plan;
use crate::plan::streams::Intake;
use crate::plan::words::status_bits;

use super::template::design_module;
use super::{EmitError, debug, registers};

/// One module, cut along the data's way: ports, Bz and `CeAn`; what shares the lanes; estimator, field and Op.
const TEMPLATE: &str = concat!(
    include_str!("../../templates/rtl/top/input.v.tera"),
    include_str!("../../templates/rtl/top/lanes.v.tera"),
    include_str!("../../templates/rtl/top/output.v.tera"),
);

/// The data of the template. Widths end in `_width`.
fn context(plan: &Plan) -> Context {
    let (design, hardware) = (&plan.design, &plan.design.hardware);
    let timeline = &plan.timeline;
    let estimator_block = plan.estimator.block();
    let folded = plan.channels() > 1;
    let streams = plan.streams();
    let unpack = streams.intake == Intake::Unpacked;
    let [bank_command_bits, bank_words_bits] = plan.calibration.as_ref().map_or([1, 1], calibration::bank_bits);
    let estimator = estimator_block.parameters(design, plan.channels());
    let estimator = estimator.some(plan.thresholds.error.as_ref(), |all, error| error.parameters(all));
    let microseconds = |cycles: u64| format!("{:.2}", cycles as f64 / hardware.clock_mhz);
    context! {
        // Whether a register bank is around the core, and then the core's own module.
        control => &hardware.control,
        core_module => &registers::core_module(plan),
        columns => &design.sensor.columns,
        rows => &design.sensor.rows,
        taxels => &plan.taxels(),
        plan => if folded { "reduced" } else { "paper's" },
        estimator => if design.algorithm.estimator.is_calibrated() { "grid search" } else { "line search" },
        filter => &filter_text(&design.algorithm.filter),
        counts => &design.input.counts(),
        // Whether gains and offsets stand in RAM; bits of what goes between the banks and their control.
        calibration => &plan.calibration.is_some(),
        bank_command_bits,
        bank_words_bits,
        tare_command_bits => &calibration::tare_bits(plan.taxels()),
        // Of an ingress FIFO that drops frames, its parameters.
        overrun => &streams.drops.then(|| ingress_fifo::parameters(plan).verilog()),
        // Bits and bytes of a beat, 32-bit words of it, samples of it; bits of a sample and what it is.
        stream_bits => &streams.bits,
        stream_bytes => &(streams.bits / 8),
        words => &streams.words(),
        samples => &streams.samples(),
        sample_bits => &streams.sample_bits,
        sample => &streams.sample.to_string(),
        beats_in => &streams.beats_in(),
        beats => &streams.beats_out(),
        // TKEEP of the last beat out.
        last_keep => &format!("{:x}", streams.last_keep()),
        // Whether samples go to Bz one by one, and what the stream is called that does.
        unpack,
        samples_from => if unpack { "sample" } else { "in" },
        // Whether each frame has a scale of its own.
        scaled => &plan.scales_frames(),
        context => &frame_context::parameters(plan).verilog(),
        // Thresholds of every frame, unless a calibration in RAM brings them: a taxel's noise, the least sum `|b|` of a
        // contact.
        noise => &format!("{LONG_BITS}'d{}", plan.thresholds.taxel),
        contact => &format!("{SUM_BITS}'d{}", plan.thresholds.contact),
        // Whether frames are averaged, and the rate, where no register has it.
        averages => &plan.smoothing.is_some(),
        smoothing => &match &plan.smoothing {
            Some(_) if hardware.control => "smoothing".to_owned(),
            of => format!("4'd{}", of.as_ref().map_or(0, |of| of.rate)),
        },
        // Dead taxels of the design.
        dead => &plan.dead.as_ref().map_or(0, |dead| dead.taxels.len()),
        field => &plan.has_field(),
        latency_cycles => &timeline.latency_cycles,
        latency_us => &microseconds(timeline.latency_cycles),
        interval_cycles => &timeline.interval_cycles,
        interval_us => &microseconds(timeline.interval_cycles),
        clock_mhz => &hardware.clock_mhz,
        issue_cycles => &plan.schedule.issue_cycles(),
        macs => &plan.macs(),
        busy_percent => &format!("{:.1}", 100.0 * plan.schedule.busy_fraction()),
        stress_lsb => &plan.formats.stress.lsb,
        weight_lsb => &plan.formats.weight.lsb,
        u_lsb => &plan.formats.u.lsb,
        g_lsb => &plan.formats.g.lsb,
        torque_lsb => &plan.formats.torque_lsb,
        // Status bits with their meanings, two in a line.
        status => &status_lines(),

        elements => &plan.elements(),
        channels => &plan.channels(),
        programs => &plan.schedule.programs.len(),
        row_width => &row_width(plan),
        operand_width => &address_bits(plan.operands.words()),
        component_width => &address_bits(3 * plan.elements()),
        data_bits => &hardware.data_bits,
        vector_bits => &(plan.channels() * hardware.data_bits as usize),
        u_values => &u_values(plan),

        bz => &bz::parameters(plan).verilog(),
        cean => &cean::parameters(plan).verilog(),
        program_scheduler => &program_scheduler::parameters(plan).verilog(),
        array => &array::parameters(plan).verilog(),
        unfold => &unfold::parameters(plan).verilog(),
        we => &we::parameters(plan).verilog(),
        co => &co::parameters(plan).verilog(),
        estimator_module => estimator_block.module(),
        estimator_parameters => &estimator.verilog(),
        field_module => field::module(plan),
        field_parameters => &field::parameters(plan).verilog(),
        // Of the contact counter, if there is one.
        contacts => &design.algorithm.count_contacts.then(|| contacts::parameters(plan).verilog()),
        op => &op::parameters(plan).verilog(),
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
/// [`EmitError::Template`] if the template does not fit its data.
pub(super) fn render(plan: &Plan, debug: bool) -> Result<(String, String), EmitError> {
    let module = registers::core_module(plan);
    let text = design_module(&module, TEMPLATE, &context(plan))?;
    let text = if debug { debug::marked(&text, debug::always_zero(plan)) } else { text };
    Ok((module, text))
}

/// Modules of the library that stand only in a conditional block that neither the design takes nor the default parameters.
pub(super) fn without(plan: &Plan) -> Vec<&'static str> {
    let curve = plan.design.input.curve.is_some();
    let calibration = plan.calibration.as_ref();
    let taken: [(bool, &str); 14] = [
        (plan.thresholds.error.is_some(), "sptfra_standard_error"),
        (plan.design.input.counts(), "sptfra_counts"),
        (curve, "sptfra_curve"),
        (plan.streams().sample != Samples::Float32, "sptfra_int_to_fixed"),
        (calibration.is_some(), "sptfra_banks"),
        (calibration.is_some(), "sptfra_tare"),
        (calibration.is_some() && curve, "sptfra_curve_bank"),
        (plan.crosstalk.is_some(), "sptfra_crosstalk"),
        (plan.creep.is_some(), "sptfra_creep"),
        (plan.smoothing.is_some(), "sptfra_smoothing"),
        (plan.scales_frames(), "sptfra_frame_scale"),
        (plan.places_for_dead() > 0, "sptfra_replace"),
        (calibration.is_some_and(|of| of.power_up.dead.room > 0), "sptfra_dead_bank"),
        (plan.channels() == 1, "sptfra_coefficients"),
    ];
    let missing = taken.into_iter().filter(|&(taken, _)| !taken).map(|(_, module)| module);
    plan.estimator.block().without().into_iter().chain(missing).collect()
}

fn filter_text(filter: &Filter) -> String {
    match filter {
        Filter::None => "none".to_owned(),
        Filter::F1 { l } => format!("F1 with L = {l}"),
        Filter::F2 { p } => format!("F2 with p = {p}"),
        Filter::F3 { .. } => "F3, chosen for each matrix".to_owned(),
    }
}
