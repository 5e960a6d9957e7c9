//! The resolved design as TOML text.

use std::fmt::Write;

use super::{Arithmetic, Design, Estimator, Filter, Kernel, Outputs};

// Written by hand, not by serde, so that the order and the layout are those of the documentation. `{:?}` of an f64
// always has a point or an exponent, so it reads back as the same float.
pub(super) fn to_toml(design: &Design) -> String {
    let Design { name, sensor, algorithm, hardware } = design;
    let kernel = match algorithm.kernel {
        Kernel::Point => "point",
    };
    let filter = match algorithm.filter {
        Filter::None => "{ kind = \"none\" }".to_owned(),
        Filter::F1 { l } => format!("{{ kind = \"f1\", l = {l} }}"),
        Filter::F2 { p } => format!("{{ kind = \"f2\", p = {p:?} }}"),
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
         [algorithm]\nkernel = \"{kernel}\"\nfilter = {filter}\nestimator = \"{estimator}\"\n\
         outputs = \"{outputs}\"\nnoise_floor_pa = {:?}\n\n\
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
