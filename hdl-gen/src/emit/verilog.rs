//! Renders the Tera templates into Verilog modules.

use tera::{Context, Tera};

use crate::cores::Multiplier;
use crate::plan::Plan;

use super::EmitError;
use super::columns::wrap;
use super::view::View;
use super::{registers, rtl};

/// `(suffix, template)` of the modules that carry the design's name, in either plan.
const DESIGN_MODULES: [(&str, &str); 7] = [
    ("_bz", include_str!("../../templates/rtl/bz.v.tera")),
    ("_op_summary", include_str!("../../templates/rtl/op_summary.v.tera")),
    ("_op_output", include_str!("../../templates/rtl/op_output.v.tera")),
    ("_spmv_array", include_str!("../../templates/rtl/spmv_array.v.tera")),
    ("_spmv_sequencer", include_str!("../../templates/rtl/spmv_sequencer.v.tera")),
    ("_spmv_lane", include_str!("../../templates/rtl/spmv_lane.v.tera")),
    ("_spmv_collector", include_str!("../../templates/rtl/spmv_collector.v.tera")),
];

/// Those of the paper's plan.
const PAPER_MODULES: [(&str, &str); 4] = [
    ("", include_str!("../../templates/rtl/paper/top.v.tera")),
    ("_we", include_str!("../../templates/rtl/paper/we.v.tera")),
    ("_co", include_str!("../../templates/rtl/paper/co.v.tera")),
    ("_op", include_str!("../../templates/rtl/paper/op.v.tera")),
];

/// The top of the reduced plan, along the data's way.
const REDUCED_TOP: &str = concat!(
    include_str!("../../templates/rtl/reduced/top/streams.v.tera"),
    include_str!("../../templates/rtl/reduced/top/input.v.tera"),
    include_str!("../../templates/rtl/reduced/top/lanes.v.tera"),
    include_str!("../../templates/rtl/reduced/top/output.v.tera"),
);

/// Op of the reduced plan, along a frame's way: the search is the joint estimator's or the line's.
const REDUCED_OP: &str = concat!(
    include_str!("../../templates/rtl/reduced/op/ports.v.tera"),
    include_str!("../../templates/rtl/reduced/op/plane.v.tera"),
    include_str!("../../templates/rtl/reduced/op/line.v.tera"),
    include_str!("../../templates/rtl/reduced/op/answer.v.tera"),
);

/// Those of the reduced plan.
const REDUCED_MODULES: [(&str, &str); 7] = [
    ("", REDUCED_TOP),
    ("_fold", include_str!("../../templates/rtl/reduced/fold.v.tera")),
    ("_turns", include_str!("../../templates/rtl/reduced/turns.v.tera")),
    ("_unfold", include_str!("../../templates/rtl/reduced/unfold.v.tera")),
    ("_we", include_str!("../../templates/rtl/reduced/we.v.tera")),
    ("_co", include_str!("../../templates/rtl/reduced/co.v.tera")),
    ("_op", REDUCED_OP),
];

/// The field memory of the reduced plan.
const FIELD_MODULE: (&str, &str) = ("_field", include_str!("../../templates/rtl/reduced/field.v.tera"));

/// The list of nonzeros, where zeros are passed over.
const NONZEROS_MODULE: (&str, &str) = ("_nonzeros", include_str!("../../templates/rtl/reduced/nonzeros.v.tera"));

/// `(module, text)` of every templated module.
///
/// # Errors
/// [`EmitError::Template`] if a template does not fit the view.
pub fn render(plan: &Plan, hash: &str) -> Result<Vec<(String, String)>, EmitError> {
    let name = &plan.design.name;
    let view = View::new(plan);
    let context =
        Context::from_serialize(&view).map_err(|source| EmitError::Template { template: "view".to_owned(), source })?;
    let mut modules = Vec::with_capacity(DESIGN_MODULES.len());
    let reduced = plan.ways() > 1;
    let of_plan = if reduced { &REDUCED_MODULES[..] } else { &PAPER_MODULES[..] };
    let field = (reduced && plan.field_words() > 0).then_some(FIELD_MODULE);
    let nonzeros = plan.design.hardware.skip_zeros.then_some(NONZEROS_MODULE);
    let of_estimator = plan.estimator.slot().modules();
    let fixed = DESIGN_MODULES.iter().chain(&of_estimator).chain(of_plan).copied();
    for (suffix, template) in fixed.chain(field).chain(nonzeros) {
        let module = if suffix.is_empty() { registers::core_module(plan) } else { format!("{name}{suffix}") };
        let text = design_module(&module, template, &context)?;
        modules.push((module, text));
    }
    modules.extend(registers::render(plan, hash)?);
    let multiplier = Multiplier::of_part(&plan.design.hardware.part);
    let library = rtl::used_by(modules.iter().map(|(_, text)| text.as_str()), &[], multiplier);
    modules.extend(library.into_iter().map(|(module, text)| (module.to_owned(), text.to_owned())));
    Ok(modules)
}

/// The text of one module of the design.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit the context.
pub fn design_module(module: &str, template: &str, context: &Context) -> Result<String, EmitError> {
    Ok(framed(&one(module, template, context)?))
}

pub(super) fn one(module: &str, template: &str, context: &Context) -> Result<String, EmitError> {
    Tera::one_off(template, context, false)
        .map_err(|source| EmitError::Template { template: module.to_owned(), source })
}

/// Puts the directives that no module should miss behind the leading comment of `body`, and breaks long lines.
fn framed(body: &str) -> String {
    let comment_end = body.find("\nmodule ").map_or(0, |position| position + 1);
    let (comment, code) = body.split_at(comment_end);
    let code = code.trim_end();
    wrap(&format!("{comment}\n`default_nettype none\n\n{code}\n\n`default_nettype wire\n"))
}
