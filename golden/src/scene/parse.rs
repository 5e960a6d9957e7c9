//! From the TOML text of a scene to a checked [`Scene`].

use serde::Deserialize;

use super::parse_contact::{RawContact, angle_in_range, contact};
use super::{Converter, Medium, Scene, SensorErrors};
use crate::design::checks::Check;
use crate::design::{DEFAULT_FULL_SCALE_PA, DesignError, Sensor, Tension, syntax_position};

/// Most frames of a sweep.
const MAX_FRAMES: f64 = 100_000.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawScene {
    sensor: RawSceneSensor,
    medium: RawMedium,
    #[serde(default)]
    contact: Vec<RawContact>,
    sweep: Option<RawSweep>,
    sensor_errors: Option<RawSensorErrors>,
}

/// The sensor of a design, and how large its taxels are.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSceneSensor {
    columns: usize,
    rows: usize,
    pitch_mm: Vec<f64>,
    depth_mm: f64,
    taxel_mm: Option<Vec<f64>>,
    #[serde(default)]
    tension: Tension,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMedium {
    kind: String,
    poisson: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum MediumKind {
    BondedLayer,
    HalfSpace,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSweep {
    direction_deg: RawRange,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRange {
    from: f64,
    to: f64,
    step: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSensorErrors {
    seed: Option<i64>,
    depth: Option<f64>,
    gain_spread: Option<f64>,
    noise: Option<f64>,
    quantisation_bits: Option<i64>,
    full_scale_pa: Option<f64>,
    dead: Option<Vec<i64>>,
    saturated: Option<Vec<i64>>,
}

pub(super) fn scene(text: &str, origin: &str) -> Result<Scene, DesignError> {
    let raw: RawScene = toml::from_str(text).map_err(|error| syntax_position(&error, text, origin))?;
    let check = Check { origin };
    let sweep_deg = match raw.sweep {
        Some(sweep) => range(&check, &sweep.direction_deg)?,
        None => Vec::new(),
    };
    if raw.contact.is_empty() {
        return Err(check.value("contact", "is missing".to_owned(), "write at least one [[contact]] table".to_owned()));
    }
    let contacts = raw
        .contact
        .iter()
        .enumerate()
        .map(|(index, raw)| contact(&check, raw, &|key| format!("contact[{index}].{key}"), !sweep_deg.is_empty()))
        .collect::<Result<_, _>>()?;
    let RawSceneSensor { columns, rows, pitch_mm, depth_mm, taxel_mm, tension } = raw.sensor;
    let pitch_mm = check.pair("sensor.pitch_mm", &pitch_mm)?;
    let sensor = Sensor { columns, rows, pitch_mm, depth_mm }.checked(origin)?;
    let mut sensor_errors = match raw.sensor_errors {
        Some(raw) => sensor_errors(&check, &raw, sensor.taxels())?,
        None => SensorErrors::default(),
    };
    sensor_errors.tension = tension;
    sensor_errors.taxel_m = taxel_mm.map(|taxel_mm| taxel(&check, &taxel_mm, &sensor)).transpose()?;
    Ok(Scene { sensor, medium: medium(&check, &raw.medium)?, contacts, sweep_deg, sensor_errors })
}

/// The sides of a taxel in metres, which fits into its cell.
fn taxel(check: &Check, taxel_mm: &[f64], sensor: &Sensor) -> Result<[f64; 2], DesignError> {
    let [x, y] = check.pair("sensor.taxel_mm", taxel_mm)?;
    let side = |axis: usize, mm| {
        let key = format!("sensor.taxel_mm[{axis}]");
        check.real(&key, mm, 0.0, sensor.pitch_mm[axis], "mm, the pitch").map(|mm| mm * 1e-3)
    };
    Ok([side(0, x)?, side(1, y)?])
}

fn medium(check: &Check, raw: &RawMedium) -> Result<Medium, DesignError> {
    match (check.word("medium.kind", &raw.kind)?, raw.poisson) {
        (MediumKind::HalfSpace, None) => Ok(Medium::HalfSpace),
        (MediumKind::HalfSpace, Some(_)) => Err(check.value(
            "medium.poisson",
            "does not change the stress in a half-space".to_owned(),
            "remove it".to_owned(),
        )),
        (MediumKind::BondedLayer, Some(poisson)) => {
            Ok(Medium::BondedLayer { poisson: check.real("medium.poisson", poisson, 0.0, 0.5, "")? })
        }
        (MediumKind::BondedLayer, None) => Err(check.value(
            "medium.poisson",
            "is missing".to_owned(),
            "write Poisson's ratio of the layer, such as 0.49".to_owned(),
        )),
    }
}

fn sensor_errors(check: &Check, raw: &RawSensorErrors, taxels: usize) -> Result<SensorErrors, DesignError> {
    let share = |name: &str, value: Option<f64>| {
        check.real(&format!("sensor_errors.{name}"), value.unwrap_or(0.0), 0.0, 1.0, "(a share: 0.002 is 0.2 %)")
    };
    let list = |name: &str, taxels_given: &Option<Vec<i64>>| {
        let given = taxels_given.iter().flatten().enumerate();
        given
            .map(|(index, &taxel)| {
                let key = format!("sensor_errors.{name}[{index}]");
                check.integer(&key, taxel, 0, taxels as i64 - 1).map(|taxel| taxel as usize)
            })
            .collect::<Result<Vec<_>, _>>()
    };
    let full_scale_pa = check.above_zero(
        "sensor_errors.full_scale_pa",
        raw.full_scale_pa.unwrap_or(DEFAULT_FULL_SCALE_PA),
        1e9,
        "Pa",
    )?;
    let dead = list("dead", &raw.dead)?;
    let saturated = list("saturated", &raw.saturated)?;
    if let Some(taxel) = saturated.iter().find(|taxel| dead.contains(taxel)) {
        return Err(check.value(
            "sensor_errors.saturated",
            format!("has taxel {taxel}, which is dead"),
            "list a taxel under one of the two".to_owned(),
        ));
    }
    let converter = match raw.quantisation_bits {
        Some(bits) => {
            let bits = check.integer("sensor_errors.quantisation_bits", bits, 2, 32)? as u32;
            Some(Converter { bits, full_scale_pa })
        }
        None => None,
    };
    Ok(SensorErrors {
        seed: check.integer("sensor_errors.seed", raw.seed.unwrap_or(0), 0, i64::MAX)? as u64,
        taxel_m: None,
        depth: check.real(
            "sensor_errors.depth",
            raw.depth.unwrap_or(0.0),
            -0.5,
            0.5,
            "(a share: 0.05 is 5 % deeper)",
        )?,
        gain_spread: share("gain_spread", raw.gain_spread)?,
        noise: share("noise", raw.noise)?,
        converter,
        dead,
        // Pressed too hard: the end of the range for compression.
        stuck: saturated.into_iter().map(|taxel| (taxel, -full_scale_pa)).collect(),
        ..SensorErrors::default()
    })
}

fn range(check: &Check, raw: &RawRange) -> Result<Vec<f64>, DesignError> {
    let key = |name: &str| format!("sweep.direction_deg.{name}");
    let from = angle_in_range(check, &key("from"), raw.from)?;
    let to = angle_in_range(check, &key("to"), raw.to)?;
    let step = check.above_zero(&key("step"), raw.step, 3600.0, "degrees")?;
    if to < from {
        return Err(check.value(
            &key("to"),
            format!("is {to}, below from = {from}"),
            "use a range that goes up".to_owned(),
        ));
    }
    // The small addition keeps the last direction where the division of decimal numbers falls just short.
    let steps = ((to - from) / step + 1e-9).floor();
    if steps >= MAX_FRAMES {
        return Err(check.value(
            &key("step"),
            format!("makes {:.0} frames", steps + 1.0),
            format!("use a larger step, for at most {MAX_FRAMES} frames"),
        ));
    }
    Ok((0..=steps as u32).map(|index| from + f64::from(index) * step).collect())
}
