//! Tera templates to text: a module of Verilog, or any other file.

use tera::{Context, Tera};

use super::EmitError;

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

/// Puts the directives that no module should miss behind the leading comment of `body`.
fn framed(body: &str) -> String {
    let comment_end = body.find("\nmodule ").map_or(0, |position| position + 1);
    let (comment, code) = body.split_at(comment_end);
    let code = code.trim_end();
    format!("{comment}\n`default_nettype none\n\n{code}\n\n`default_nettype wire\n")
}
