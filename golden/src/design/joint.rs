//! The constants of the joint estimator as keys of a design.

use std::path::{Path, PathBuf};

use super::checks::Check;
use super::files::{Beside, sha256};
use super::keys::{AlgorithmKeys, CorrectionKeys};
use super::{DesignError, Kernel, Regularisation, Sensor, Tension};
use crate::estimators::joint::{
    CUBIC_LIMIT, Correction, DEFAULT_DOUBT, Family, Grid, JointConstants, MAX_HIDDEN, WEIGHT_LIMIT,
};

/// What the constants depend on, for people and for comparison.
pub fn conditions(
    sensor: &Sensor,
    tension: Tension,
    kernel: Kernel,
    regularisation: Regularisation,
    (grid, family): (Grid, Family),
) -> String {
    let reads = if tension == Tension::Clipped { ", tension clipped" } else { "" };
    // Constants of the fine grid were fitted before there was another one.
    let of_grid = if grid == Grid::FINE { String::new() } else { format!(", grid {}", grid.side()) };
    // Nor was there another family than the narrow one.
    let of_family = if family == Family::Narrow { String::new() } else { format!(", {family}") };
    format!("{sensor}, {kernel}, {}{reads}{of_grid}{of_family}", regularisation.factor())
}

/// The grid that a design names by its points along an axis; the fine one if it names none.
pub(super) fn grid(check: &Check, side: Option<i64>) -> Result<Grid, DesignError> {
    let Some(side) = side else { return Ok(Grid::FINE) };
    usize::try_from(side).ok().and_then(Grid::of_side).ok_or_else(|| {
        let sides = Grid::ALL.map(|grid| grid.side().to_string()).join(" or ");
        check.value("algorithm.grid", format!("is {side}"), format!("use {sides}"))
    })
}

/// From the keys; the constants must belong to `conditions`, those of the design with its grid and training set.
pub(super) fn constants(
    check: &Check,
    keys: &AlgorithmKeys,
    conditions: impl Fn(Grid, Family) -> String,
) -> Result<JointConstants, DesignError> {
    let grid = grid(check, keys.grid)?;
    let family = keys.training_set.unwrap_or_default();
    let conditions = conditions(grid, family);
    if let Some(other) = keys.calibrated_for.as_ref().filter(|&calibrated_for| *calibrated_for != conditions) {
        return Err(check.value(
            "algorithm.calibrated_for",
            format!("says that the constants belong to \"{other}\", but the design is \"{conditions}\""),
            format!(
                "run `golden calibrate {0} --out {1}`, which fits new ones",
                check.origin,
                resolved_name(check.origin).display()
            ),
        ));
    }
    let [c1, c3] = keys.friction_correction.unwrap_or([1.0, 0.0]);
    let tangential = [
        check.real("algorithm.friction_correction[0]", c1, 0.1, 10.0, "")?,
        check.real("algorithm.friction_correction[1]", c3, -CUBIC_LIMIT, CUBIC_LIMIT, "")?,
    ];
    if keys.max_standard_error.is_some() && family == Family::Narrow {
        return Err(check.value(
            "algorithm.max_standard_error",
            "is a limit for an error that the design does not estimate".to_owned(),
            "remove it, or write training_set = \"general\" and run `golden calibrate`".to_owned(),
        ));
    }
    Ok(JointConstants {
        grid,
        family,
        gain: keys.gain.unwrap_or(1.0),
        tangential,
        correction: None,
        doubt: keys.max_standard_error.unwrap_or(DEFAULT_DOUBT),
        fitted_to: keys.calibrated_for.clone(),
    })
}

/// A name for the calibrated design beside the one at `origin`.
fn resolved_name(origin: &str) -> PathBuf {
    let path = Path::new(origin);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-calibrated.toml"))
}

/// Refuses the keys of the joint estimator beside another one.
pub(super) fn refuse(check: &Check, keys: &AlgorithmKeys) -> Result<(), DesignError> {
    let given = [
        ("grid", keys.grid.is_some()),
        ("training_set", keys.training_set.is_some()),
        ("max_standard_error", keys.max_standard_error.is_some()),
        ("gain", keys.gain.is_some()),
        ("friction_correction", keys.friction_correction.is_some()),
        ("correction", keys.correction.is_some()),
        ("calibrated_for", keys.calibrated_for.is_some()),
    ];
    let given: Vec<&str> = given.into_iter().filter_map(|(key, given)| given.then_some(key)).collect();
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
const RESTORE: &str = "copy the file that was written with the design to its side, or remove [algorithm.correction] and run `golden calibrate`";

/// Checks the correction, and reads its file if it has one.
pub(super) fn correction(
    check: &Check,
    keys: CorrectionKeys,
    sensor: &Sensor,
    beside: Beside<'_>,
) -> Result<Correction, DesignError> {
    let [x, y] = keys.half_window;
    let half = |name: &str, value, side: usize| check.integer(&key(name), value, 0, side as i64 - 1);
    let half_window =
        [half("half_window[0]", x, sensor.columns)? as usize, half("half_window[1]", y, sensor.rows)? as usize];
    let refuse = |name: &str, problem: &str, remedy: String| Err(check.value(&key(name), problem.to_owned(), remedy));
    match (keys.file, keys.sha256, keys.hidden, keys.output) {
        (Some(file), Some(hash), None, None) => {
            let limit = i64::from(WEIGHT_LIMIT);
            let base = keys.error_base.map(|base| check.integer(&key("error_base"), base, -limit, limit - 1));
            from_file(check, (&file, &hash), half_window, base.transpose()?.map(|base| base as i32), beside)
        }
        (None, ..) if keys.error_base.is_some() => {
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
            "name the file of weights, or remove [algorithm.correction] and run `golden calibrate`".to_owned(),
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
    let again = || "remove [algorithm.correction] and run `golden calibrate`".to_owned();
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
    Ok(Correction { half_window, hidden, output, doubt: None })
}

/// Two values, where a TOML reader would drop a third without a word.
fn two<T: Clone>(check: &Check, key: &str, values: &[T], which: &str) -> Result<[T; 2], DesignError> {
    match values {
        [first, second] => Ok([first.clone(), second.clone()]),
        _ => Err(check.value(key, format!("has {} values", values.len()), format!("use two, {which}"))),
    }
}

/// Writes the constants into `keys`, with the weights in the file named `weights`.
pub(super) fn state(constants: &JointConstants, weights: &str, keys: &mut AlgorithmKeys) {
    let JointConstants { grid, family, gain, tangential, correction, doubt, fitted_to } = constants;
    let estimated = correction.as_ref().and_then(|correction| correction.doubt.as_ref());
    keys.grid = Some(grid.side() as i64);
    keys.training_set = Some(*family);
    // A limit for an error that is not estimated is refused.
    keys.max_standard_error = (*family == Family::Wide).then_some(*doubt);
    keys.calibrated_for.clone_from(fitted_to);
    keys.gain = Some(*gain);
    keys.friction_correction = Some(*tangential);
    keys.correction = correction.as_ref().map(|correction| CorrectionKeys {
        half_window: correction.half_window.map(|half| half as i64),
        file: Some(weights.to_owned()),
        sha256: Some(sha256(&correction.to_csv())),
        error_base: estimated.map(|doubt| i64::from(doubt.base)),
        hidden: None,
        output: None,
    });
}
