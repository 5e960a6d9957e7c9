//! The Verilog of a design: which modules there are.

use crate::cores::Multiplier;
use crate::plan::Plan;

use super::EmitError;
use super::{registers, rtl, top};

/// `(module, text)` of every module of the design: the top, the register bank if there is one, and what they use of the
/// library.
///
/// # Errors
/// [`EmitError::Template`] if a template does not fit its data.
pub fn render(plan: &Plan, hash: &str, debug: bool) -> Result<Vec<(String, String)>, EmitError> {
    let mut modules = vec![top::render(plan, debug)?];
    modules.extend(registers::render(plan, hash)?);
    let multiplier = Multiplier::of_part(&plan.design.hardware.part);
    let library = rtl::used_by(modules.iter().map(|(_, text)| text.as_str()), &top::without(plan), multiplier);
    modules.extend(library.into_iter().map(|(module, text)| (module.to_owned(), text.to_owned())));
    Ok(modules)
}
