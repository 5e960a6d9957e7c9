//! Around the core for one body: what parts the forces of several.

use serde::Serialize;
use tera::Context;

use super::template::design_module;
use super::{EmitError, registers};
use crate::blocks::{Parameters, contacts, overrun};
use crate::plan::Plan;

const TEMPLATE: &str = include_str!("../../templates/rtl/contacts.v.tera");

#[derive(Serialize)]
struct View {
    /// Whether a register bank is around this.
    control: bool,
    core_module: String,
    one: String,
    columns: usize,
    rows: usize,
    taxels: usize,
    contacts: usize,
    /// Bits and bytes of a beat, words of it, beats of a frame in and out, TKEEP of the last one out.
    stream_bits: usize,
    stream_bytes: usize,
    words: usize,
    beats_in: usize,
    beats: usize,
    last_keep: String,
    /// What the streams are called whose beats are words.
    samples_from: &'static str,
    words_to: &'static str,
    /// Of a door that drops frames, its parameters.
    overrun: Option<Parameters>,
    slips: bool,
    field: bool,
    first_record: usize,
    first_force: usize,
    latency_cycles: u64,
    interval_cycles: u64,
    parameters: Parameters,
}

/// Module of the core for one body.
pub(super) fn one(plan: &Plan) -> String {
    format!("{}_one", plan.design.name)
}

/// `(module, text)` of what is around the core; none for one body.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit the view.
pub(super) fn render(plan: &Plan) -> Result<Option<(String, String)>, EmitError> {
    let Some(of) = &plan.contacts else { return Ok(None) };
    let streams = plan.streams();
    let [samples_from, words_to] = if streams.words() > 1 { ["sample", "word"] } else { ["in", "out"] };
    let view = View {
        control: plan.design.hardware.control,
        core_module: registers::core_module(plan),
        one: one(plan),
        columns: plan.design.sensor.columns,
        rows: plan.design.sensor.rows,
        taxels: plan.taxels(),
        contacts: of.contacts,
        stream_bits: streams.bits,
        stream_bytes: streams.bits / 8,
        words: streams.words(),
        beats_in: streams.beats_in(),
        beats: streams.beats_out(),
        last_keep: format!("{:x}", streams.last_keep()),
        samples_from,
        words_to,
        overrun: streams.drops.then(|| overrun::parameters(plan)),
        slips: plan.design.algorithm.slip.is_some(),
        field: plan.field_words() > 0,
        first_record: crate::plan::SUMMARY_WORDS,
        first_force: plan.words_out() - plan.field_words(),
        latency_cycles: plan.timeline.latency_cycles,
        interval_cycles: plan.timeline.interval_cycles,
        parameters: contacts::parameters(plan, of),
    };
    let context = Context::from_serialize(&view)
        .map_err(|source| EmitError::Template { template: "contacts".to_owned(), source })?;
    let text = design_module(&view.core_module, TEMPLATE, &context)?;
    Ok(Some((view.core_module, text)))
}
