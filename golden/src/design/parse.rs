//! From TOML text to a checked [`Design`].

use std::path::PathBuf;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::calibration_in_ram::{calibration_in_ram, replaceable};
use super::checks::{self, Check};
use super::curve::RawCurve;
use super::files::Beside;
use super::input::{self, RawInput};
use super::joint::{self, RawCorrection};
use super::lengths::Lengths;
use super::parse_filter::{self, RawFilter};
use super::parse_plan::{self, PlanKeys};
use super::{
    Algorithm, DEFAULT_FULL_SCALE_PA, Design, DesignError, Estimator, Filter, Hardware, Input, JointConstants, Kernel,
    MAX_LANES, MAX_SIDE, NOISE_FLOOR_DIVISOR, Optimise, Outputs, STREAM_BITS, Samples, Sensor, Slip, Tension,
};
use super::{regularisation, renamed};
use crate::{bodies, words};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDesign {
    name: String,
    sensor: RawDesignSensor,
    #[serde(default)]
    algorithm: RawAlgorithm,
    #[serde(default)]
    hardware: RawHardware,
}

// Counts are read as `i64` so that a negative one gets a message about its range, not about its type.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawSensor {
    pub(crate) columns: i64,
    pub(crate) rows: i64,
    pub(crate) pitch_mm: Lengths,
    pub(crate) depth_mm: f64,
}

/// The sensor of a design; unknown keys would pass if this held a flattened [`RawSensor`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDesignSensor {
    columns: i64,
    rows: i64,
    pitch_mm: Lengths,
    depth_mm: f64,
    tension: Option<String>,
    noise: Option<f64>,
    pa_per_count: Option<f64>,
    curve: Option<RawCurve>,
    calibration: Option<String>,
    #[serde(default)]
    dead: Vec<i64>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct RawAlgorithm {
    plan: Option<String>,
    kernel: Option<String>,
    regularisation: Option<toml::Value>,
    filter: Option<RawFilter>,
    estimator: Option<String>,
    training_set: Option<String>,
    max_standard_error: Option<f64>,
    gain: Option<f64>,
    friction_correction: Option<Vec<f64>>,
    correction: Option<RawCorrection>,
    calibrated_for: Option<String>,
    contacts: Option<i64>,
    count_contacts: Option<bool>,
    outputs: Option<String>,
    noise_floor_pa: Option<f64>,
    slip: Option<RawSlip>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSlip {
    limit: f64,
    hysteresis: Option<f64>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct RawHardware {
    coefficient_bits: Option<i64>,
    data_bits: Option<i64>,
    full_scale_pa: Option<f64>,
    range: Option<String>,
    lanes: Option<i64>,
    target_us: Option<f64>,
    optimise: Option<String>,
    stream_bits: Option<i64>,
    samples: Option<String>,
    overrun: Option<String>,
    control: Option<bool>,
    calibration: Option<String>,
    replaceable: Option<i64>,
    debug: Option<bool>,
    clock_mhz: Option<f64>,
    part: Option<String>,
    // Keys of old design files, refused by name.
    arithmetic: Option<IgnoredAny>,
    skip_zeros: Option<IgnoredAny>,
}

fn raw(text: &str, origin: &str) -> Result<RawDesign, DesignError> {
    renamed::refuse(text, origin)?;
    toml::from_str(text).map_err(|error| syntax_position(&error, text, origin))
}

/// The files that a design names.
pub(super) fn files_named_in(text: &str, origin: &str, beside: Beside<'_>) -> Result<Vec<PathBuf>, DesignError> {
    let RawDesign { sensor, algorithm, .. } = raw(text, origin)?;
    let weights = algorithm.correction.and_then(|correction| correction.file);
    let points = match sensor.curve {
        Some(RawCurve::File(file)) => Some(file),
        _ => None,
    };
    Ok([sensor.calibration, points, weights].into_iter().flatten().map(|name| beside.path(&name)).collect())
}

/// `beside` are the files that the design names.
pub(super) fn design(text: &str, origin: &str, beside: Beside<'_>) -> Result<Design, DesignError> {
    checked(raw(text, origin)?, origin, beside)
}

/// As [`design`], without what was fitted to the sensor: a design to fit it to.
pub(super) fn unfitted(text: &str, origin: &str, beside: Beside<'_>) -> Result<Design, DesignError> {
    let mut raw = raw(text, origin)?;
    // Of another estimator they stay, to be refused.
    let estimator = raw.algorithm.estimator.as_deref().map(words::read::<Estimator>);
    if matches!(estimator, Some(Ok(Estimator::Joint))) {
        let RawAlgorithm { gain, friction_correction, correction, calibrated_for, .. } = &mut raw.algorithm;
        (*gain, *friction_correction, *correction, *calibrated_for) = (None, None, None, None);
    }
    checked(raw, origin, beside)
}

fn checked(raw: RawDesign, origin: &str, beside: Beside<'_>) -> Result<Design, DesignError> {
    let check = Check { origin };
    checks::name(&check, &raw.name)?;
    let RawDesignSensor { columns, rows, pitch_mm, depth_mm, tension, noise, pa_per_count, curve, calibration, dead } =
        raw.sensor;
    let tension = check.optional_word("sensor.tension", tension.as_deref())?.unwrap_or_default();
    let noise = input::noise(&check, noise)?;
    let sensor = RawSensor { columns, rows, pitch_mm, depth_mm }.check(origin)?;
    let lanes_given = raw.hardware.lanes.is_some();
    let hardware = hardware(&check, raw.hardware)?;
    let (mut algorithm, correction) = algorithm(&check, raw.algorithm, (&sensor, tension, noise), &hardware)?;
    parse_plan::check(&check, &PlanKeys { sensor: &sensor, algorithm: &algorithm, hardware: &hardware, lanes_given })?;
    // Last, so that what is wrong with the design itself is said before its files are read.
    let input = Input::new(
        &check,
        RawInput { pa_per_count, curve, calibration, dead, tension, noise },
        beside,
        &sensor,
        &hardware,
    )?;
    if hardware.samples != Samples::Float32 && !input.counts() {
        return Err(check.value(
            "hardware.samples",
            format!("is \"{}\", and frames are in pascals", hardware.samples),
            "integers are counts: add sensor.pa_per_count or sensor.curve".to_owned(),
        ));
    }
    calibration_in_ram(&check, &hardware, &input)?;
    algorithm.joint.correction = correction.map(|raw| joint::correction(&check, raw, &sensor, beside)).transpose()?;
    Ok(Design { name: raw.name, sensor, input, algorithm, hardware })
}

/// Turns an error of the TOML reader about a `text` that is from `origin` into one with line and column.
pub fn syntax_position(error: &toml::de::Error, text: &str, origin: &str) -> DesignError {
    let offset = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |position| position + 1);
    let context = text.get(line_start..).and_then(|rest| rest.lines().next()).unwrap_or("").trim();
    DesignError::Syntax {
        origin: origin.to_owned(),
        line: before.matches('\n').count() + 1,
        column: before.get(line_start..).map_or(0, |text| text.chars().count()) + 1,
        context: context.chars().take(80).collect(),
        message: plain(error.message()),
    }
}

/// A message of the parser without the names that types have in Rust.
fn plain(message: &str) -> String {
    const WORDS: [(&str, &str); 3] =
        [("expected f64", "expected a number"), ("expected i64", "expected a whole number"), ("\n", ", ")];
    WORDS.iter().fold(message.to_owned(), |message, (rust, word)| message.replace(rust, word))
}

impl RawSensor {
    pub(crate) fn check(self, origin: &str) -> Result<Sensor, DesignError> {
        let check = Check { origin };
        let side = |key, value| check.integer(key, value, 2, MAX_SIDE as i64);
        let length = |key, value| check.real(key, value, 0.01, 1000.0, "mm");
        let pitch_mm = self.pitch_mm.pair(&check, "sensor.pitch_mm")?;
        Ok(Sensor {
            columns: side("sensor.columns", self.columns)? as usize,
            rows: side("sensor.rows", self.rows)? as usize,
            pitch_mm: [length("sensor.pitch_mm[0]", pitch_mm[0])?, length("sensor.pitch_mm[1]", pitch_mm[1])?],
            depth_mm: length("sensor.depth_mm", self.depth_mm)?,
        })
    }
}

/// The table, and the correction, whose file is not read yet.
fn algorithm(
    check: &Check,
    raw: RawAlgorithm,
    (sensor, tension, noise): (&Sensor, Tension, f64),
    hardware: &Hardware,
) -> Result<(Algorithm, Option<RawCorrection>), DesignError> {
    let full_scale_pa = hardware.full_scale_pa;
    let filter = match raw.filter {
        Some(raw) => parse_filter::filter(check, &raw, sensor)?,
        None => Filter::None,
    };
    let kernel: Kernel = check.optional_word("algorithm.kernel", raw.kernel.as_deref())?.unwrap_or_default();
    let regularisation = regularisation::parse(check, raw.regularisation.as_ref())?;
    let estimator: Estimator =
        check.optional_word("algorithm.estimator", raw.estimator.as_deref())?.unwrap_or_default();
    let joint = if estimator == Estimator::Joint {
        let training_set =
            check.optional_word("algorithm.training_set", raw.training_set.as_deref())?.unwrap_or_default();
        let conditions = joint::conditions(sensor, tension, kernel, regularisation, noise, training_set);
        let constants = joint::Raw {
            training_set,
            max_standard_error: raw.max_standard_error,
            gain: raw.gain,
            friction_correction: raw.friction_correction.as_deref(),
            calibrated_for: raw.calibrated_for,
        };
        joint::constants(check, constants, &conditions)?
    } else {
        joint::refuse(
            check,
            [
                raw.training_set.is_some(),
                raw.max_standard_error.is_some(),
                raw.gain.is_some(),
                raw.friction_correction.is_some(),
                raw.correction.is_some(),
                raw.calibrated_for.is_some(),
            ],
        )?;
        JointConstants::default()
    };
    let contacts =
        raw.contacts.map_or(Ok(1), |contacts| check.integer("algorithm.contacts", contacts, 1, bodies::MOST as i64))?;
    let contacts = contacts as usize;
    let count_contacts = raw.count_contacts.unwrap_or(false);
    let outputs: Outputs = check.optional_word("algorithm.outputs", raw.outputs.as_deref())?.unwrap_or_default();
    let noise_floor_pa = match raw.noise_floor_pa {
        Some(value) => check.above_zero("algorithm.noise_floor_pa", value, full_scale_pa, "Pa")?,
        None => full_scale_pa / NOISE_FLOOR_DIVISOR,
    };
    let plan = parse_plan::kind(check, raw.plan.as_deref(), &filter, hardware)?;
    let slip = raw.slip.map(|raw| slip(check, &raw)).transpose()?;
    let joint = Box::new(joint);
    let algorithm = Algorithm {
        plan,
        kernel,
        regularisation,
        filter,
        estimator,
        joint,
        contacts,
        count_contacts,
        outputs,
        noise_floor_pa,
        slip,
    };
    Ok((algorithm, raw.correction))
}

fn slip(check: &Check, raw: &RawSlip) -> Result<Slip, DesignError> {
    let limit = check.real("algorithm.slip.limit", raw.limit, 0.01, Slip::LARGEST, "")?;
    let hysteresis = raw.hysteresis.unwrap_or(0.1 * limit);
    Ok(Slip { limit, hysteresis: check.real("algorithm.slip.hysteresis", hysteresis, 0.0, limit, "")? })
}

fn hardware(check: &Check, raw: RawHardware) -> Result<Hardware, DesignError> {
    let integer = |key, value: Option<i64>, default, low, high| match value {
        Some(value) => check.integer(key, value, low, high),
        None => Ok(default),
    };
    let gone = [("hardware.arithmetic", raw.arithmetic.is_some()), ("hardware.skip_zeros", raw.skip_zeros.is_some())];
    if let Some((key, _)) = gone.into_iter().find(|&(_, is_there)| is_there) {
        return Err(check.value(key, "is no longer a key".to_owned(), "remove the line".to_owned()));
    }
    let optimise: Optimise = check.optional_word("hardware.optimise", raw.optimise.as_deref())?.unwrap_or_default();
    let target_us = raw.target_us.map(|target| check.above_zero("hardware.target_us", target, f64::MAX, ""));
    let stream_bits = raw.stream_bits.map_or(Ok(STREAM_BITS[0]), |bits| {
        STREAM_BITS
            .into_iter()
            .find(|&width| i64::from(width) == bits)
            .ok_or_else(|| check.value("hardware.stream_bits", format!("is {bits}"), "use 32, 64 or 128".to_owned()))
    })?;
    let part = raw.part.unwrap_or_else(|| "xczu9eg-ffvb1156-2-e".to_owned());
    checks::part(check, &part)?;
    Ok(Hardware {
        coefficient_bits: integer("hardware.coefficient_bits", raw.coefficient_bits, 18, 8, 27)? as u32,
        data_bits: integer("hardware.data_bits", raw.data_bits, 27, 16, 35)? as u32,
        // Far above the smallest float32, so that a stress or a force of one step has no denormal.
        full_scale_pa: check.real(
            "hardware.full_scale_pa",
            raw.full_scale_pa.unwrap_or(DEFAULT_FULL_SCALE_PA),
            1e-3,
            1e9,
            "Pa",
        )?,
        range: check.optional_word("hardware.range", raw.range.as_deref())?.unwrap_or_default(),
        lanes: integer("hardware.lanes", raw.lanes, 16, 1, MAX_LANES as i64)? as usize,
        target_us: target_us.transpose()?,
        optimise,
        stream_bits,
        samples: check.optional_word("hardware.samples", raw.samples.as_deref())?.unwrap_or_default(),
        overrun: check.optional_word("hardware.overrun", raw.overrun.as_deref())?.unwrap_or_default(),
        control: raw.control.unwrap_or(false),
        calibration: check.optional_word("hardware.calibration", raw.calibration.as_deref())?.unwrap_or_default(),
        replaceable: replaceable(check, raw.replaceable)?,
        debug: raw.debug.unwrap_or(false),
        clock_mhz: check.real("hardware.clock_mhz", raw.clock_mhz.unwrap_or(125.0), 1.0, 1000.0, "MHz")?,
        part,
    })
}
