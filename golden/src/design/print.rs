//! The resolved design as TOML text.

use std::fmt::Write;

use toml::Value;

use super::{
    Algorithm, CalibrationIn, Choices, Design, FileNames, Filter, FilterKind, Hardware, InputRange, Overrun, Samples,
    Slip, Tension, joint, regularisation,
};
use crate::estimators::Constants;
use crate::names::MatrixName;

// Written by hand, not by serde, so that the order and the layout are those of the documentation. `{:?}` of an f64
// always has a point or an exponent, so it reads back as the same float.
pub(super) fn to_toml(design: &Design, names: &FileNames) -> String {
    let Design { name, sensor, input, algorithm, hardware } = design;
    let regularisation = regularisation::print(algorithm.regularisation);
    let Algorithm { plan, kernel, estimator, outputs, .. } = algorithm;
    let Hardware { optimise, .. } = hardware;
    let kind = algorithm.filter.kind();
    // A filter for each matrix is too long for one line, and a table can only follow the other keys.
    let (filter, filter_table) = match &algorithm.filter {
        Filter::None => (format!("filter = {{ kind = \"{kind}\" }}\n"), String::new()),
        Filter::F1 { l } => (format!("filter = {{ kind = \"{kind}\", l = {l} }}\n"), String::new()),
        Filter::F2 { p } => (format!("filter = {{ kind = \"{kind}\", p = {p:?} }}\n"), String::new()),
        Filter::F3 { scenes, choices } => (String::new(), f3(scenes, choices.as_deref())),
    };
    let [constants, correction] = match algorithm.constants() {
        Constants::Line => [String::new(), String::new()],
        Constants::Joint(constants) => joint::print(constants, &names.weights),
    };
    // As with control below.
    let tension = match input.tension {
        Tension::Read => String::new(),
        Tension::Clipped => format!("tension = \"{}\"\n", input.tension),
    };
    let noise = format!("noise = {:?}\n", input.noise);
    let slip = algorithm.slip.map_or_else(String::new, |Slip { limit, hysteresis }| {
        format!("slip = {{ limit = {limit:?}, hysteresis = {hysteresis:?} }}\n")
    });
    let contacts = match algorithm.contacts {
        1 => String::new(),
        contacts => format!("contacts = {contacts}\n"),
    };
    let count_contacts = if algorithm.count_contacts { "count_contacts = true\n" } else { "" };
    let counts = match input.pa_per_count {
        Some(value) => format!("pa_per_count = {value:?}\n"),
        None => String::new(),
    };
    let curve = match input.curve.as_ref().map(|curve| curve.law) {
        Some(Some([power, scale])) => format!("curve = {{ power = {power:?}, scale = {scale:?} }}\n"),
        Some(None) => format!("curve = {}\n", Value::from(names.curve.as_str())),
        None => String::new(),
    };
    let calibration = match input.calibration {
        Some(_) => format!("calibration = {}\n", Value::from(names.calibration.as_str())),
        None => String::new(),
    };
    let dead = match input.dead.as_slice() {
        [] => String::new(),
        dead => format!("dead = {dead:?}\n"),
    };
    let speed = match hardware.target_us {
        Some(target) => format!("target_us = {target:?}"),
        None => format!("lanes = {}", hardware.lanes),
    };
    // Only where it is there: a design without it keeps the hash that it had before there was such a key.
    let control = if hardware.control { "control = true\n" } else { "" };
    let banks = match hardware.calibration {
        CalibrationIn::Rom => String::new(),
        place @ CalibrationIn::Ram => format!("calibration = \"{place}\"\n"),
    };
    let map = match hardware.replaceable {
        0 => String::new(),
        room => format!("replaceable = {room}\n"),
    };
    let streams = match hardware.stream_bits {
        32 => String::new(),
        bits => format!("stream_bits = {bits}\n"),
    };
    let samples = match hardware.samples {
        Samples::Float32 => String::new(),
        samples => format!("samples = \"{samples}\"\n"),
    };
    let overrun = match hardware.overrun {
        Overrun::Stall => String::new(),
        overrun @ Overrun::Drop => format!("overrun = \"{overrun}\"\n"),
    };
    let range = match hardware.range {
        InputRange::FullScale => String::new(),
        range @ InputRange::Frame => format!("range = \"{range}\"\n"),
    };
    let debug = if hardware.debug { "debug = true\n" } else { "" };
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "name = \"{name}\"\n\n\
         [sensor]\ncolumns = {}\nrows = {}\npitch_mm = [{:?}, {:?}]\ndepth_mm = {:?}\n{tension}{noise}{counts}{curve}{calibration}{dead}\n\
         [algorithm]\nplan = \"{plan}\"\nkernel = \"{kernel}\"\n{regularisation}{filter}estimator = \"{estimator}\"\n\
         {constants}{contacts}{count_contacts}outputs = \"{outputs}\"\nnoise_floor_pa = {:?}\n{slip}{filter_table}{correction}\n\
         [hardware]\ncoefficient_bits = {}\ndata_bits = {}\n\
         full_scale_pa = {:?}\n{range}{speed}\noptimise = \"{optimise}\"\n{streams}{samples}{overrun}{control}{banks}{map}{debug}clock_mhz = {:?}\npart = \"{}\"\n",
        sensor.columns,
        sensor.rows,
        sensor.pitch_mm[0],
        sensor.pitch_mm[1],
        sensor.depth_mm,
        algorithm.noise_floor_pa,
        hardware.coefficient_bits,
        hardware.data_bits,
        hardware.full_scale_pa,
        hardware.clock_mhz,
        hardware.part,
    );
    text
}

/// The `[algorithm.filter]` table of F3.
fn f3(scenes: &[String], choices: Option<&Choices>) -> String {
    let scenes = Value::Array(scenes.iter().cloned().map(Value::String).collect());
    let kind = FilterKind::F3;
    let mut text = format!("\n[algorithm.filter]\nkind = \"{kind}\"\nscenes = {scenes}\n");
    if let Some(choices) = choices {
        text.push_str("\n[algorithm.filter.choices]\n");
        for matrix in MatrixName::ALL {
            let _ = writeln!(text, "{matrix} = \"{}\"", choices.of(matrix));
        }
    }
    text
}
