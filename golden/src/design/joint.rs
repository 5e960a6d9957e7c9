//! The constants of the joint estimator as keys of a design.

use std::fmt::Write;

use serde::Deserialize;

use super::checks::Check;
use super::{DesignError, Kernel, Regularisation, Sensor};
use crate::estimators::joint::{Correction, JointConstants, MAX_HIDDEN, WEIGHT_BITS};

/// What the constants depend on, for people and for comparison.
pub fn conditions(sensor: &Sensor, kernel: Kernel, regularisation: Regularisation) -> String {
    let Sensor { columns, rows, pitch_mm: [x, y], depth_mm } = sensor;
    format!("{columns} x {rows} taxels of {x} x {y} mm, {depth_mm} mm deep, {kernel}, {}", regularisation.factor())
}

/// The `[algorithm.correction]` table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCorrection {
    half_window: Vec<i64>,
    hidden: Vec<Vec<i64>>,
    output: Vec<Vec<i64>>,
}

/// The constants as a file has them.
pub(super) struct Raw<'a> {
    pub gain: Option<f64>,
    pub tangential: Option<&'a [f64]>,
    pub correction: Option<&'a RawCorrection>,
    pub fitted_to: Option<String>,
}

/// Checks the constants; a design without any has the default ones. `conditions` are those of the design.
pub(super) fn constants(
    check: &Check,
    raw: Raw<'_>,
    sensor: &Sensor,
    conditions: &str,
) -> Result<JointConstants, DesignError> {
    if let Some(other) = raw.fitted_to.as_ref().filter(|&fitted_to| fitted_to != conditions) {
        return Err(check.value(
            "algorithm.fitted_to",
            format!("says that the constants belong to \"{other}\", but the design is \"{conditions}\""),
            "remove fitted_to, gain, tangential and [algorithm.correction], and run `golden calibrate`".to_owned(),
        ));
    }
    let gain = check.real("algorithm.gain", raw.gain.unwrap_or(1.0), 0.1, 10.0, "")?;
    let [c1, c3] = two(check, "algorithm.tangential", raw.tangential.unwrap_or(&[1.0, 0.0]), "c1 and c3")?;
    let tangential = [
        check.real("algorithm.tangential[0]", c1, 0.1, 10.0, "")?,
        check.real("algorithm.tangential[1]", c3, -2.0, 2.0, "")?,
    ];
    let correction = raw.correction.map(|raw| correction(check, raw, sensor)).transpose()?;
    Ok(JointConstants { gain, tangential, correction, fitted_to: raw.fitted_to })
}

/// Refuses the keys of the joint estimator, of which those marked are there, beside another one.
pub(super) fn refuse(check: &Check, given: [bool; 4]) -> Result<(), DesignError> {
    match ["gain", "tangential", "correction", "fitted_to"].into_iter().zip(given).find(|(_, given)| *given) {
        Some((key, _)) => Err(check.value(
            &format!("algorithm.{key}"),
            "belongs to the joint estimator".to_owned(),
            "remove it or write estimator = \"joint\"".to_owned(),
        )),
        None => Ok(()),
    }
}

fn correction(check: &Check, raw: &RawCorrection, sensor: &Sensor) -> Result<Correction, DesignError> {
    let key = |name: &str| format!("algorithm.correction.{name}");
    let again = || "run `golden calibrate` again".to_owned();
    let [x, y] = two(check, &key("half_window"), &raw.half_window, "for x and y")?;
    let half = |name: &str, value, side: usize| check.integer(&key(name), value, 0, side as i64 - 1);
    let half_window =
        [half("half_window[0]", x, sensor.columns)? as usize, half("half_window[1]", y, sensor.rows)? as usize];
    let inputs = Correction::inputs(half_window);
    check.integer(&key("hidden (number of rows)"), raw.hidden.len() as i64, 1, MAX_HIDDEN as i64)?;
    let row = |name: String, row: &[i64], length: usize| -> Result<Vec<i32>, DesignError> {
        if row.len() != length {
            return Err(check.value(&key(&name), format!("has {} weights, not {length}", row.len()), again()));
        }
        let limit = 1_i64 << (WEIGHT_BITS - 1);
        let checked = row.iter().map(|&weight| check.integer(&key(&name), weight, -limit, limit - 1));
        checked.map(|weight| weight.map(|weight| weight as i32)).collect()
    };
    let hidden: Vec<Vec<i32>> = raw
        .hidden
        .iter()
        .enumerate()
        .map(|(index, weights)| row(format!("hidden[{index}]"), weights, inputs))
        .collect::<Result<_, _>>()?;
    let [along_x, along_y] = two(check, &key("output"), &raw.output, "for x and y")?;
    let output =
        [row("output[0]".to_owned(), &along_x, hidden.len())?, row("output[1]".to_owned(), &along_y, hidden.len())?];
    Ok(Correction { half_window, hidden, output })
}

/// Two values, where a TOML reader would drop a third without a word.
fn two<T: Clone>(check: &Check, key: &str, values: &[T], which: &str) -> Result<[T; 2], DesignError> {
    match values {
        [first, second] => Ok([first.clone(), second.clone()]),
        _ => Err(check.value(key, format!("has {} values", values.len()), format!("use two, {which}"))),
    }
}

/// The keys of `[algorithm]`, and the table that follows all of them.
pub(super) fn print(constants: &JointConstants) -> [String; 2] {
    let JointConstants { gain, tangential: [c1, c3], correction, fitted_to } = constants;
    let fitted_to = fitted_to.as_ref().map_or_else(String::new, |conditions| format!("fitted_to = {conditions:?}\n"));
    let keys = format!("{fitted_to}gain = {gain:?}\ntangential = [{c1:?}, {c3:?}]\n");
    let mut table = String::new();
    if let Some(Correction { half_window: [x, y], hidden, output }) = correction {
        let rows = |rows: &[Vec<i32>]| -> String { rows.iter().map(|row| format!("    {row:?},\n")).collect() };
        // Writing to a String cannot fail.
        let _ = write!(
            table,
            "\n[algorithm.correction]\nhalf_window = [{x}, {y}]\nhidden = [\n{}]\noutput = [\n{}]\n",
            rows(hidden),
            rows(output)
        );
    }
    [keys, table]
}
