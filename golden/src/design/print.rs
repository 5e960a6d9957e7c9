//! The resolved design as TOML text.

use std::fmt::Write;

use toml::Value;

use super::{Arithmetic, Choices, Design, Estimator, Filter, Kernel, Outputs};
use crate::matrices::MatrixName;

// Written by hand, not by serde, so that the order and the layout are those of the documentation. `{:?}` of an f64
// always has a point or an exponent, so it reads back as the same float.
pub(super) fn to_toml(design: &Design) -> String {
    let Design { name, sensor, algorithm, hardware } = design;
    let kernel = match algorithm.kernel {
        Kernel::Point => "point",
        Kernel::Cell => "cell",
    };
    // A filter for each matrix is too long for one line, and a table can only follow the other keys.
    let (filter, filter_table) = match &algorithm.filter {
        Filter::None => ("filter = { kind = \"none\" }\n".to_owned(), String::new()),
        Filter::F1 { l } => (format!("filter = {{ kind = \"f1\", l = {l} }}\n"), String::new()),
        Filter::F2 { p } => (format!("filter = {{ kind = \"f2\", p = {p:?} }}\n"), String::new()),
        Filter::F3 { scenes, choices } => (String::new(), f3(scenes, choices.as_deref())),
    };
    let estimator = match algorithm.estimator {
        Estimator::Line => "line",
    };
    let outputs = match algorithm.outputs {
        Outputs::Field => "field",
    };
    let arithmetic = match hardware.arithmetic {
        Arithmetic::Fixed => "fixed",
    };
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "name = \"{name}\"\n\n\
         [sensor]\ncolumns = {}\nrows = {}\npitch_mm = [{:?}, {:?}]\ndepth_mm = {:?}\n\n\
         [algorithm]\nkernel = \"{kernel}\"\n{filter}estimator = \"{estimator}\"\n\
         outputs = \"{outputs}\"\nnoise_floor_pa = {:?}\n{filter_table}\n\
         [hardware]\narithmetic = \"{arithmetic}\"\ncoefficient_bits = {}\ndata_bits = {}\n\
         full_scale_pa = {:?}\nlanes = {}\nclock_mhz = {:?}\npart = \"{}\"\n",
        sensor.columns,
        sensor.rows,
        sensor.pitch_mm[0],
        sensor.pitch_mm[1],
        sensor.depth_mm,
        algorithm.noise_floor_pa,
        hardware.coefficient_bits,
        hardware.data_bits,
        hardware.full_scale_pa,
        hardware.lanes,
        hardware.clock_mhz,
        hardware.part,
    );
    text
}

/// The `[algorithm.filter]` table of F3.
fn f3(scenes: &[String], choices: Option<&Choices>) -> String {
    let scenes = Value::Array(scenes.iter().cloned().map(Value::String).collect());
    let mut text = format!("\n[algorithm.filter]\nkind = \"f3\"\nscenes = {scenes}\n");
    if let Some(choices) = choices {
        text.push_str("\n[algorithm.filter.choices]\n");
        for matrix in MatrixName::ALL {
            let _ = writeln!(text, "{matrix} = \"{}\"", choices.of(matrix));
        }
    }
    text
}
