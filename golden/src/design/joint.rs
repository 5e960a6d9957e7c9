//! The constants of the joint estimator as keys of a design.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::checks::Check;
use super::files::{Beside, sha256};
use super::{DesignError, Kernel, Regularisation, Sensor, Tension};
use crate::estimators::joint::{
    CUBIC_LIMIT, Correction, DEFAULT_MAX_STANDARD_ERROR, JointConstants, MAX_HIDDEN, TrainingSet, WEIGHT_LIMIT,
};

/// What the constants depend on, for people and for comparison.
pub fn conditions(
    sensor: &Sensor,
    tension: Tension,
    kernel: Kernel,
    regularisation: Regularisation,
    noise: f64,
    training_set: TrainingSet,
) -> String {
    let reads = if tension == Tension::Clipped { ", tension clipped" } else { "" };
    format!("{sensor}, {kernel}, {}{reads}, noise {noise}, {training_set}", regularisation.factor())
}

/// The `[algorithm.correction]` table: the weights in a file with its hash, or in the table itself.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCorrection {
    half_window: Vec<i64>,
    pub(super) file: Option<String>,
    sha256: Option<String>,
    error_base: Option<i64>,
    hidden: Option<Vec<Vec<i64>>>,
    output: Option<Vec<Vec<i64>>>,
}

/// The constants as a file has them, without the correction.
pub(super) struct Raw<'a> {
    pub training_set: TrainingSet,
    pub max_standard_error: Option<f64>,
    pub gain: Option<f64>,
    pub friction_correction: Option<&'a [f64]>,
    pub calibrated_for: Option<String>,
}

/// Checks the constants; a design without any has the default ones. `conditions` are those of the design.
pub(super) fn constants(check: &Check, raw: Raw<'_>, conditions: &str) -> Result<JointConstants, DesignError> {
    if let Some(other) = raw.calibrated_for.as_ref().filter(|&calibrated_for| calibrated_for != conditions) {
        return Err(check.value(
            "algorithm.calibrated_for",
            format!("says that the constants belong to \"{other}\", but the design is \"{conditions}\""),
            format!(
                "run `sptfra calibrate {0} --out {1}`, which fits new ones",
                check.origin,
                resolved_name(check.origin).display()
            ),
        ));
    }
    let gain = check.real("algorithm.gain", raw.gain.unwrap_or(1.0), 0.1, 10.0, "")?;
    let [c1, c3] =
        two(check, "algorithm.friction_correction", raw.friction_correction.unwrap_or(&[1.0, 0.0]), "c1 and c3")?;
    let friction_correction = [
        check.real("algorithm.friction_correction[0]", c1, 0.1, 10.0, "")?,
        check.real("algorithm.friction_correction[1]", c3, -CUBIC_LIMIT, CUBIC_LIMIT, "")?,
    ];
    if raw.max_standard_error.is_some() && raw.training_set == TrainingSet::Sliding {
        return Err(check.value(
            "algorithm.max_standard_error",
            "limits a standard error that the design does not estimate".to_owned(),
            "remove it, or write training_set = \"general\" and run `sptfra calibrate`".to_owned(),
        ));
    }
    let limit = raw.max_standard_error.unwrap_or(DEFAULT_MAX_STANDARD_ERROR);
    let max_standard_error = check.real("algorithm.max_standard_error", limit, 0.001, 3.9, "")?;
    let Raw { training_set, calibrated_for, .. } = raw;
    Ok(JointConstants { training_set, gain, friction_correction, correction: None, max_standard_error, calibrated_for })
}

/// A name for the calibrated design beside the one at `origin`.
fn resolved_name(origin: &str) -> PathBuf {
    let path = Path::new(origin);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-calibrated.toml"))
}

/// Refuses the keys of the joint estimator, of which those marked are there, beside another one.
pub(super) fn refuse(check: &Check, given: [bool; 6]) -> Result<(), DesignError> {
    let keys = ["training_set", "max_standard_error", "gain", "friction_correction", "correction", "calibrated_for"];
    let given: Vec<&str> = keys.into_iter().zip(given).filter_map(|(key, given)| given.then_some(key)).collect();
    match given.as_slice() {
        [] => Ok(()),
        [key] => Err(check.value(
            &format!("algorithm.{key}"),
            "belongs to the joint estimator".to_owned(),
            "remove it or write estimator = \"joint\"".to_owned(),
        )),
        [key, others @ ..] => Err(check.value(
            &format!("algorithm.{key}"),
            format!("belongs to the joint estimator, and so do {}", others.join(", ")),
            "remove all of them or write estimator = \"joint\"".to_owned(),
        )),
    }
}

fn key(name: &str) -> String {
    format!("algorithm.correction.{name}")
}

/// What to do about weights that are not there, or others than those of the design.
const RESTORE: &str = "copy the file that was written with the design to its side, or remove [algorithm.correction] and run `sptfra calibrate`";

/// Checks the correction, and reads its file if it has one.
pub(super) fn correction(
    check: &Check,
    raw: RawCorrection,
    sensor: &Sensor,
    beside: Beside<'_>,
) -> Result<Correction, DesignError> {
    let [x, y] = two(check, &key("half_window"), &raw.half_window, "for x and y")?;
    let half = |name: &str, value, side: usize| check.integer(&key(name), value, 0, side as i64 - 1);
    let half_window =
        [half("half_window[0]", x, sensor.columns)? as usize, half("half_window[1]", y, sensor.rows)? as usize];
    let refuse = |name: &str, problem: &str, remedy: String| Err(check.value(&key(name), problem.to_owned(), remedy));
    match (raw.file, raw.sha256, raw.hidden, raw.output) {
        (Some(file), Some(hash), None, None) => {
            let limit = i64::from(WEIGHT_LIMIT);
            let base = raw.error_base.map(|base| check.integer(&key("error_base"), base, -limit, limit - 1));
            from_file(check, (&file, &hash), half_window, base.transpose()?.map(|base| base as i32), beside)
        }
        (None, ..) if raw.error_base.is_some() => {
            refuse("error_base", "is given without a file", "add the key file, or remove it".to_owned())
        }
        (None, None, Some(hidden), Some(output)) => from_table(check, half_window, &hidden, &output),
        (Some(file), None, None, None) => {
            refuse("sha256", "is missing", format!("write what `sha256sum {file}` prints"))
        }
        (None, Some(_), ..) => refuse("sha256", "is given without a file", "add the key file".to_owned()),
        (Some(_), ..) => refuse("file", "is given beside weights", "remove hidden and output, or file".to_owned()),
        (None, None, ..) => refuse(
            "file",
            "is missing",
            "name the file of weights, or remove [algorithm.correction] and run `sptfra calibrate`".to_owned(),
        ),
    }
}

/// The weights of a file, which must be those that the design was written with.
fn from_file(
    check: &Check,
    (file, hash): (&str, &str),
    half_window: [usize; 2],
    error_base: Option<i32>,
    beside: Beside<'_>,
) -> Result<Correction, DesignError> {
    let path = beside.path(file);
    let text = beside.read(file).map_err(|source| {
        let problem = format!("names {}, which cannot be read: {source}", path.display());
        check.value(&key("file"), problem, RESTORE.to_owned())
    })?;
    let found = sha256(&text);
    if found != hash {
        let shown: String = hash.chars().take(found.len()).collect();
        let problem = format!("is {shown:?}, but {} has {found}: it holds other weights", path.display());
        return Err(check.value(&key("sha256"), problem, RESTORE.to_owned()));
    }
    Correction::read_csv(&text, half_window, error_base).map_err(|error| DesignError::Table {
        path,
        line: error.line,
        problem: error.problem,
        remedy: error.remedy,
    })
}

/// The weights of the table itself.
fn from_table(
    check: &Check,
    half_window: [usize; 2],
    hidden: &[Vec<i64>],
    output: &[Vec<i64>],
) -> Result<Correction, DesignError> {
    let again = || "remove [algorithm.correction] and run `sptfra calibrate`".to_owned();
    check.integer(&key("hidden (number of rows)"), hidden.len() as i64, 1, MAX_HIDDEN as i64)?;
    let row = |name: String, row: &[i64], length: usize| -> Result<Vec<i32>, DesignError> {
        if row.len() != length {
            return Err(check.value(&key(&name), format!("has {} weights, not {length}", row.len()), again()));
        }
        let limit = i64::from(WEIGHT_LIMIT);
        let checked = row.iter().map(|&weight| check.integer(&key(&name), weight, -limit, limit - 1));
        checked.map(|weight| weight.map(|weight| weight as i32)).collect()
    };
    let inputs = Correction::inputs(half_window);
    let hidden: Vec<Vec<i32>> = hidden
        .iter()
        .enumerate()
        .map(|(index, weights)| row(format!("hidden[{index}]"), weights, inputs))
        .collect::<Result<_, _>>()?;
    let [along_x, along_y] = two(check, &key("output"), output, "for x and y")?;
    let output =
        [row("output[0]".to_owned(), &along_x, hidden.len())?, row("output[1]".to_owned(), &along_y, hidden.len())?];
    Ok(Correction { half_window, hidden, output, error: None })
}

/// Two values, where a TOML reader would drop a third without a word.
fn two<T: Clone>(check: &Check, key: &str, values: &[T], which: &str) -> Result<[T; 2], DesignError> {
    match values {
        [first, second] => Ok([first.clone(), second.clone()]),
        _ => Err(check.value(key, format!("has {} values", values.len()), format!("use two, {which}"))),
    }
}

/// The keys of `[algorithm]`, and the table that follows all of them, with the weights in the file named `weights`.
pub(super) fn print(constants: &JointConstants, weights: &str) -> [String; 2] {
    let JointConstants { training_set, gain, friction_correction: [c1, c3], correction, .. } = constants;
    let output = correction.as_ref().and_then(|correction| correction.error.as_ref());
    let limit = constants.max_standard_error;
    // A design of sliding contacts estimates no error, and a limit for one is refused.
    let is_limited = *training_set == TrainingSet::General
        && (output.is_some() || limit.to_bits() != DEFAULT_MAX_STANDARD_ERROR.to_bits());
    let limit = if is_limited { format!("max_standard_error = {limit:?}\n") } else { String::new() };
    let calibrated_for = constants
        .calibrated_for
        .as_ref()
        .map_or_else(String::new, |conditions| format!("calibrated_for = {conditions:?}\n"));
    let keys = format!(
        "training_set = \"{training_set}\"\n{limit}{calibrated_for}gain = {gain:?}\n\
         friction_correction = [{c1:?}, {c3:?}]\n"
    );
    let table = correction.as_ref().map_or_else(String::new, |correction| {
        let ([x, y], hash) = (correction.half_window, sha256(&correction.to_csv()));
        let file = toml::Value::from(weights);
        let base = output.map_or_else(String::new, |output| format!("error_base = {}\n", output.base));
        format!("\n[algorithm.correction]\nhalf_window = [{x}, {y}]\nfile = {file}\nsha256 = \"{hash}\"\n{base}")
    });
    [keys, table]
}
