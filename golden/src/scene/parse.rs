//! From the TOML text of a scene to a checked [`Scene`].

use std::sync::LazyLock;

use serde_json::Value as Schema;

use super::keys::{
    ContactKeys, MediumKeys, MediumKind, RangeKeys, SceneKeys, SensorErrorsKeys, SensorKeys, ShapeKind, ShearKind,
};
use super::{Contact, Converter, Medium, Scene, SensorErrors, Shape, Shear, Traction};
use crate::design::checks::Check;
use crate::design::{DEFAULT_FULL_SCALE_PA, DesignError, Sensor, schema, syntax_position};

/// Most frames of a sweep.
const MAX_FRAMES: f64 = 100_000.0;

static SCHEMA: LazyLock<Schema> = LazyLock::new(schema::of::<SceneKeys>);

pub(super) fn scene(text: &str, origin: &str) -> Result<Scene, DesignError> {
    let syntax = |error| syntax_position(&error, text, origin);
    schema::check(origin, &toml::from_str(text).map_err(syntax)?, &SCHEMA)?;
    let keys: SceneKeys = toml::from_str(text).map_err(syntax)?;
    let check = Check { origin };
    let sweep_deg = match keys.sweep {
        Some(sweep) => range(&check, &sweep.direction_deg)?,
        None => Vec::new(),
    };
    if keys.contact.is_empty() {
        return Err(check.value("contact", "is missing", "write at least one [[contact]] table"));
    }
    let contacts = keys
        .contact
        .iter()
        .enumerate()
        .map(|(index, keys)| contact(&check, keys, &|key| format!("contact[{index}].{key}"), !sweep_deg.is_empty()))
        .collect::<Result<_, _>>()?;
    let SensorKeys { columns, rows, pitch_mm, depth_mm, taxel_mm, tension } = keys.sensor;
    let sensor = Sensor { columns, rows, pitch_mm, depth_mm }.checked(origin)?;
    let mut sensor_errors = sensor_errors(&check, keys.sensor_errors, sensor.taxels())?;
    sensor_errors.tension = tension;
    sensor_errors.taxel_m = taxel_mm.map(|sides| taxel(&check, sides, &sensor)).transpose()?;
    Ok(Scene { sensor, medium: medium(&check, &keys.medium)?, contacts, sweep_deg, sensor_errors })
}

/// The sides of a taxel in metres, which fits into its cell.
fn taxel(check: &Check, sides_mm: [f64; 2], sensor: &Sensor) -> Result<[f64; 2], DesignError> {
    for (axis, (mm, pitch_mm)) in sides_mm.into_iter().zip(sensor.pitch_mm).enumerate() {
        check.real(&format!("sensor.taxel_mm[{axis}]"), mm, 0.0, pitch_mm, "mm, the pitch")?;
    }
    Ok(metres(sides_mm))
}

fn metres<const N: usize>(mm: [f64; N]) -> [f64; N] {
    mm.map(|mm| mm * 1e-3)
}

fn medium(check: &Check, keys: &MediumKeys) -> Result<Medium, DesignError> {
    let wrong = |problem, remedy| Err(check.value("medium.poisson", problem, remedy));
    match (&keys.kind, keys.poisson) {
        (MediumKind::HalfSpace, None) => Ok(Medium::HalfSpace),
        (MediumKind::HalfSpace, Some(_)) => wrong("does not change the stress in a half-space", "remove it"),
        (MediumKind::BondedLayer, Some(poisson)) => Ok(Medium::BondedLayer { poisson }),
        (MediumKind::BondedLayer, None) => wrong("is missing", "write Poisson's ratio of the layer, such as 0.49"),
    }
}

/// A contact; `key` makes the name of a key for messages. A sweep gives it directions.
fn contact(
    check: &Check,
    keys: &ContactKeys,
    key: &impl Fn(&str) -> String,
    swept: bool,
) -> Result<Contact, DesignError> {
    let shape = shape(check, keys, key)?;
    if !swept && keys.direction_deg.is_none() {
        let remedy = "write the direction of the tangential force, or add a [sweep]";
        return Err(check.value(&key("direction_deg"), "is missing", remedy));
    }
    Ok(Contact {
        shape,
        centre_m: metres(keys.centre_mm),
        normal_force_n: keys.normal_force_n,
        friction: keys.friction,
        traction: traction(check, keys, shape, key)?,
        direction_deg: keys.direction_deg.unwrap_or(0.0),
    })
}

fn shape(check: &Check, keys: &ContactKeys, key: &impl Fn(&str) -> String) -> Result<Shape, DesignError> {
    let ContactKeys { shape, semi_axes_mm, sides_mm, radius_mm, .. } = *keys;
    let (name, wanted, example) = match shape {
        ShapeKind::Hertz => ("hertz", "semi_axes_mm", "both semi-axes of the ellipse, such as [7.0, 7.0]"),
        ShapeKind::Rectangle => ("rectangle", "sides_mm", "the lengths of both sides, such as [10.0, 6.0]"),
        ShapeKind::Disc => ("disc", "radius_mm", "the radius, such as 10.0"),
        ShapeKind::Punch => ("punch", "radius_mm", "the radius, such as 10.0"),
    };
    let given = [
        ("semi_axes_mm", semi_axes_mm.is_some()),
        ("sides_mm", sides_mm.is_some()),
        ("radius_mm", radius_mm.is_some()),
    ];
    if let Some((foreign, _)) = given.into_iter().find(|&(name, given)| given && name != wanted) {
        let problem = format!("does not belong to a contact of shape \"{name}\"");
        return Err(check.value(&key(foreign), problem, format!("remove it; the size of this shape is {wanted}")));
    }
    let missing = || check.value(&key(wanted), "is missing", format!("write {example}"));
    let pair = |sides: Option<[f64; 2]>| sides.map(metres).ok_or_else(missing);
    let radius = || radius_mm.map(|mm| mm * 1e-3).ok_or_else(missing);
    Ok(match shape {
        ShapeKind::Hertz => Shape::Hertz { semi_axes_m: pair(semi_axes_mm)? },
        ShapeKind::Rectangle => Shape::Rectangle { sides_m: pair(sides_mm)? },
        ShapeKind::Disc => Shape::Disc { radius_m: radius()? },
        ShapeKind::Punch => Shape::Punch { radius_m: radius()? },
    })
}

/// How the load of a contact is spread, beyond its shape.
fn traction(
    check: &Check,
    keys: &ContactKeys,
    shape: Shape,
    key: &impl Fn(&str) -> String,
) -> Result<Traction, DesignError> {
    let ContactKeys { turn_deg, edge, tilt, shear, held, spin, .. } = *keys;
    let refuse = |name: &str, problem: &str, remedy: &str| Err(check.value(&key(name), problem, remedy));
    let bent = edge.is_some() || tilt.is_some() || !matches!(shape, Shape::Hertz { .. });
    let tilt = tilt.unwrap_or_default();
    if tilt[0].abs() + tilt[1].abs() > 1.0 {
        let remedy = "use two numbers whose magnitudes add up to at most 1";
        return refuse("tilt", "makes the pressure a pull at one side", remedy);
    }
    if spin.is_some() && shear != ShearKind::Sliding {
        return refuse("spin", "belongs to a contact that slides", "remove it or write shear = \"sliding\"");
    }
    if held.is_some() && shear != ShearKind::Held {
        return refuse("held", "belongs to a contact that is held", "remove it or write shear = \"held\"");
    }
    let shear = match shear {
        ShearKind::Sliding => Shear::Sliding { spin: spin.unwrap_or(0.0) },
        ShearKind::Even => Shear::Even,
        ShearKind::Held => {
            let Some(share) = held else {
                let remedy = "write the tangential force as a share of the largest, such as 0.5";
                return refuse("held", "is missing", remedy);
            };
            if bent {
                let remedy = "use shape = \"hertz\" without edge and tilt";
                return refuse("shear", "is \"held\", which is known for Hertz's pressure alone", remedy);
            }
            Shear::Held { share }
        }
    };
    Ok(Traction { turn_deg, edge, tilt, shear })
}

fn sensor_errors(check: &Check, keys: SensorErrorsKeys, taxels: usize) -> Result<SensorErrors, DesignError> {
    let SensorErrorsKeys { seed, depth, gain_spread, noise, quantisation_bits, full_scale_pa, dead, saturated } = keys;
    let list = |name: &str, given: &[i64]| {
        let taxel = |(index, &taxel)| {
            let key = format!("sensor_errors.{name}[{index}]");
            check.integer(&key, taxel, 0, taxels as i64 - 1).map(|taxel| taxel as usize)
        };
        given.iter().enumerate().map(taxel).collect::<Result<Vec<_>, _>>()
    };
    let full_scale_pa = full_scale_pa.unwrap_or(DEFAULT_FULL_SCALE_PA);
    let dead = list("dead", &dead)?;
    let saturated = list("saturated", &saturated)?;
    if let Some(taxel) = saturated.iter().find(|taxel| dead.contains(taxel)) {
        return Err(check.value(
            "sensor_errors.saturated",
            format!("has taxel {taxel}, which is dead"),
            "list a taxel under one of the two",
        ));
    }
    Ok(SensorErrors {
        depth,
        seed,
        gain_spread,
        noise,
        converter: quantisation_bits.map(|bits| Converter { bits, full_scale_pa }),
        dead,
        // Pressed too hard: the end of the range for compression.
        stuck: saturated.into_iter().map(|taxel| (taxel, -full_scale_pa)).collect(),
        ..SensorErrors::default()
    })
}

fn range(check: &Check, &RangeKeys { from, to, step }: &RangeKeys) -> Result<Vec<f64>, DesignError> {
    let key = |name: &str| format!("sweep.direction_deg.{name}");
    if to < from {
        return Err(check.value(&key("to"), format!("is {to}, below from = {from}"), "use a range that goes up"));
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
