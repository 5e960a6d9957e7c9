//! The commands, one file each.

pub mod choose;
pub mod scene;
pub mod solve;

use std::path::Path;

/// Refuses an output that is one of the inputs.
pub fn keep_apart(out: &Path, inputs: &[&Path]) -> Result<(), String> {
    let same = |input: &&&Path| match (out.canonicalize(), input.canonicalize()) {
        (Ok(out), Ok(input)) => out == input,
        _ => false,
    };
    match inputs.iter().find(same) {
        Some(input) => Err(format!(
            "{}: the output would overwrite the input {}; choose another name",
            out.display(),
            input.display()
        )),
        None => Ok(()),
    }
}
