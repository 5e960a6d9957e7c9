//! Around the core for one body: what parts the forces of several.

use serde::Serialize;
use tera::Context;

use super::template::design_module;
use super::{EmitError, registers};
use crate::blocks::{Parameters, contacts};
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
    field: bool,
    words_out: usize,
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
    let view = View {
        control: plan.design.hardware.control,
        core_module: registers::core_module(plan),
        one: one(plan),
        columns: plan.design.sensor.columns,
        rows: plan.design.sensor.rows,
        taxels: plan.taxels(),
        contacts: of.contacts,
        field: plan.field_words() > 0,
        words_out: plan.words_out(),
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
