//! The constants of the grid search as keys of a design.

use std::path::Path;

use super::checks::Check;
use super::files::{FileSource, sha256};
use super::keys::{AlgorithmKeys, CorrectionKeys};
use super::{DesignError, Kernel, Regularisation, Sensor, Tension};
use crate::estimators::joint::{CUBIC_LIMIT, Correction, JointConstants, TrainingSet};

/// What the constants depend on, for people and for comparison.
pub fn conditions(
    sensor: &Sensor,
    Reads { tension, noise, smoothing }: Reads,
    kernel: Kernel,
    regularisation: Regularisation,
    training_set: TrainingSet,
) -> String {
    let tension = if tension == Tension::Clipped { ", tension clipped" } else { "" };
    let smoothing = if smoothing > 0 { format!(", smoothing {smoothing}") } else { String::new() };
    let factor = regularisation.factor();
    format!("{sensor}, {kernel}, {factor}{tension}, noise {noise}{smoothing}, {training_set}")
}

/// What a sensor reads, as far as constants depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reads {
    /// Whether it reads what pulls.
    pub tension: Tension,
    /// Share of the largest reading.
    pub noise: f64,
    /// Frames are averaged with the weight `2^-k`; 0: they are not.
    pub smoothing: u32,
}

/// From the keys; the constants must belong to `conditions`, those of the design with its training set, for what it reads.
///
/// Those of single frames serve averages too, with larger errors than those of averages. The reverse spoils single frames.
pub(super) fn constants(
    check: &Check,
    keys: &AlgorithmKeys,
    reads: Reads,
    conditions: impl Fn(Reads, TrainingSet) -> String,
) -> Result<JointConstants, DesignError> {
    let training_set = keys.training_set.unwrap_or_default();
    let [single, conditions] =
        [0, reads.smoothing].map(|smoothing| conditions(Reads { smoothing, ..reads }, training_set));
    if let Some(other) = keys.calibrated_for.as_ref().filter(|&other| ![&single, &conditions].contains(&other)) {
        return Err(check.value(
            "algorithm.calibrated_for",
            format!("says that the constants belong to \"{other}\", but the design is \"{conditions}\""),
            format!("run `{}`, which fits new ones", fit(check.origin)),
        ));
    }
    let missing = |key: &str| {
        check.value(
            &format!("algorithm.{key}"),
            "is missing, and the grid search needs it",
            format!("run `{}`, which fits it, or write estimator = \"line\"", fit(check.origin)),
        )
    };
    let gain = keys.gain.ok_or_else(|| missing("gain"))?;
    let [c1, c3] = keys.friction_correction.ok_or_else(|| missing("friction_correction"))?;
    check.real("algorithm.friction_correction[0]", c1, 0.1, 10.0, "")?;
    check.real("algorithm.friction_correction[1]", c3, -CUBIC_LIMIT, CUBIC_LIMIT, "")?;
    Ok(JointConstants {
        training_set,
        gain,
        friction_correction: [c1, c3],
        correction: None,
        calibrated_for: keys.calibrated_for.clone(),
    })
}

/// The command that fits the constants of the design at `origin`.
fn fit(origin: &str) -> String {
    let path = Path::new(origin);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let calibrated = path.with_file_name(format!("{stem}-calibrated.toml"));
    format!("sptfra calibrate {origin} --out {}", calibrated.display())
}

/// Refuses the keys of the grid search beside another one.
pub(super) fn refuse(check: &Check, keys: &AlgorithmKeys) -> Result<(), DesignError> {
    let given = [
        ("training_set", keys.training_set.is_some()),
        ("gain", keys.gain.is_some()),
        ("friction_correction", keys.friction_correction.is_some()),
        ("correction", keys.correction.is_some()),
        ("calibrated_for", keys.calibrated_for.is_some()),
    ];
    let given: Vec<&str> = given.into_iter().filter_map(|(key, given)| given.then_some(key)).collect();
    let Some((key, others)) = given.split_first() else { return Ok(()) };
    let more = if others.is_empty() { String::new() } else { format!(", and so do {}", others.join(", ")) };
    Err(check.value(
        &format!("algorithm.{key}"),
        format!("belongs to the grid search{more}"),
        "remove what belongs to it, or write estimator = \"joint\"",
    ))
}

/// What to do about weights that are not there, or others than those of the design.
const RESTORE: &str = "copy the file that was written with the design to its side, or remove [algorithm.correction] and run `sptfra calibrate`";

/// The correction with the weights of its file, which must be those that the design was written with.
pub(super) fn correction(
    check: &Check,
    keys: &CorrectionKeys,
    sensor: &Sensor,
    beside: FileSource<'_>,
) -> Result<Correction, DesignError> {
    const KEY: &str = "algorithm.correction";
    let CorrectionKeys { half_window: [x, y], file, sha256: hash } = keys;
    let half = |axis: usize, value: i64, side: usize| {
        let key = format!("{KEY}.half_window[{axis}]");
        check.integer(&key, value, 0, side as i64 - 1).map(|half| half as usize)
    };
    let half_window = [half(0, *x, sensor.columns)?, half(1, *y, sensor.rows)?];
    let path = beside.path(file);
    let text = beside.read(file).map_err(|source| {
        let problem = format!("names {}, which cannot be read: {source}", path.display());
        check.value(&format!("{KEY}.file"), problem, RESTORE)
    })?;
    let found = sha256(&text);
    if found != *hash {
        let shown: String = hash.chars().take(found.len()).collect();
        let problem = format!("is {shown:?}, but {} has {found}: it holds other weights", path.display());
        return Err(check.value(&format!("{KEY}.sha256"), problem, RESTORE));
    }
    Correction::read_csv(&text, half_window).map_err(|(line, problem)| {
        let remedy =
            "take the file that was written with the design, or remove [algorithm.correction] and run `sptfra calibrate`";
        DesignError::line(&path, line, problem, remedy)
    })
}

/// Writes the constants into `keys`, with the weights in the file named `weights`.
pub(super) fn state(constants: &JointConstants, weights: String, keys: &mut AlgorithmKeys) {
    let JointConstants { training_set, gain, friction_correction, correction, calibrated_for } = constants;
    keys.training_set = Some(*training_set);
    keys.calibrated_for.clone_from(calibrated_for);
    keys.gain = Some(*gain);
    keys.friction_correction = Some(*friction_correction);
    keys.correction = correction.as_ref().map(|correction| CorrectionKeys {
        half_window: correction.half_window.map(|half| half as i64),
        file: weights,
        sha256: sha256(&correction.to_csv()),
    });
}
