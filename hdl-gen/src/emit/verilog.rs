//! Renders the Tera templates into Verilog modules.

use tera::{Context, Tera};

use crate::cores::Multiplier;
use crate::plan::Plan;

use super::EmitError;
use super::columns::wrap;
use super::{registers, rtl, top};

/// `(module, text)` of every module of the design: the top, the register bank if there is one, and what they use of the
/// library.
///
/// # Errors
/// [`EmitError::Template`] if a template does not fit its view.
pub fn render(plan: &Plan, hash: &str) -> Result<Vec<(String, String)>, EmitError> {
    let mut modules = vec![top::render(plan)?];
    modules.extend(registers::render(plan, hash)?);
    let multiplier = Multiplier::of_part(&plan.design.hardware.part);
    let library = rtl::used_by(modules.iter().map(|(_, text)| text.as_str()), &top::without(plan), multiplier);
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
