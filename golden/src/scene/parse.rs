//! From the TOML text of a scene to a checked [`Scene`].

use serde::Deserialize;

use super::{Contact, Medium, Scene, Shape};
use crate::design::checks::Check;
use crate::design::{DesignError, RawSensor, syntax_position};

/// Most frames of a sweep.
const MAX_FRAMES: f64 = 100_000.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawScene {
    sensor: RawSensor,
    medium: RawMedium,
    #[serde(default)]
    contact: Vec<RawContact>,
    sweep: Option<RawSweep>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMedium {
    kind: String,
    poisson: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawContact {
    shape: String,
    semi_axes_mm: Option<Vec<f64>>,
    radius_mm: Option<f64>,
    centre_mm: Vec<f64>,
    normal_force_n: f64,
    friction: f64,
    direction_deg: Option<f64>,
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
        .map(|(index, raw)| {
            let keys = |key: &str| format!("contact[{index}].{key}");
            contact(&check, raw, &keys, !sweep_deg.is_empty())
        })
        .collect::<Result<_, _>>()?;
    Ok(Scene { sensor: raw.sensor.check(origin)?, medium: medium(&check, &raw.medium)?, contacts, sweep_deg })
}

fn medium(check: &Check, raw: &RawMedium) -> Result<Medium, DesignError> {
    check.choice("medium.kind", Some(&raw.kind), &["bonded_layer", "half_space"])?;
    match (raw.kind == "half_space", raw.poisson) {
        (true, None) => Ok(Medium::HalfSpace),
        (true, Some(_)) => Err(check.value(
            "medium.poisson",
            "does not change the stress in a half-space".to_owned(),
            "remove it".to_owned(),
        )),
        (false, Some(poisson)) => {
            Ok(Medium::BondedLayer { poisson: check.real("medium.poisson", poisson, 0.0, 0.5, "")? })
        }
        (false, None) => Err(check.value(
            "medium.poisson",
            "is missing".to_owned(),
            "write Poisson's ratio of the layer, such as 0.49".to_owned(),
        )),
    }
}

fn contact(
    check: &Check,
    raw: &RawContact,
    key: &impl Fn(&str) -> String,
    swept: bool,
) -> Result<Contact, DesignError> {
    let foreign = |name: &str| {
        check.value(
            &key(name),
            format!("does not belong to a contact of shape \"{}\"", raw.shape),
            "a hertz contact has semi_axes_mm, a disc has radius_mm".to_owned(),
        )
    };
    let missing = |name: &str, remedy: &str| check.value(&key(name), "is missing".to_owned(), remedy.to_owned());
    let metres = |name: &str, length: f64| check.real(&key(name), length, 0.01, 1000.0, "mm").map(|mm| mm * 1e-3);
    check.choice(&key("shape"), Some(&raw.shape), &["hertz", "disc"])?;
    let shape = match (raw.shape == "disc", &raw.semi_axes_mm, raw.radius_mm) {
        (false, Some(semi_axes), None) => {
            let [a, b] = check.pair(&key("semi_axes_mm"), semi_axes)?;
            Shape::Hertz { semi_axes_m: [metres("semi_axes_mm[0]", a)?, metres("semi_axes_mm[1]", b)?] }
        }
        (true, None, Some(radius)) => Shape::Disc { radius_m: metres("radius_mm", radius)? },
        (false, None, None) => {
            return Err(missing("semi_axes_mm", "write both semi-axes of the ellipse, such as [7.0, 7.0]"));
        }
        (true, None, None) => {
            return Err(missing("radius_mm", "write the radius, such as 10.0"));
        }
        (false, _, Some(_)) => return Err(foreign("radius_mm")),
        (true, Some(_), _) => return Err(foreign("semi_axes_mm")),
    };
    let direction_deg = match (swept, raw.direction_deg) {
        (true, None) => 0.0,
        (true, Some(_)) => {
            return Err(check.value(
                &key("direction_deg"),
                "contradicts the sweep".to_owned(),
                "remove it, or remove [sweep]".to_owned(),
            ));
        }
        (false, Some(angle)) => angle_in_range(check, &key("direction_deg"), angle)?,
        (false, None) => {
            return Err(missing("direction_deg", "write the direction of the tangential force, or add a [sweep]"));
        }
    };
    let [x, y] = check.pair(&key("centre_mm"), &raw.centre_mm)?;
    let centre = |name: &str, mm: f64| check.real(&key(name), mm, -100_000.0, 100_000.0, "mm").map(|mm| mm * 1e-3);
    Ok(Contact {
        shape,
        centre_m: [centre("centre_mm[0]", x)?, centre("centre_mm[1]", y)?],
        normal_force_n: check.above_zero(&key("normal_force_n"), raw.normal_force_n, 1e6, "N (it presses)")?,
        friction: check.real(&key("friction"), raw.friction, 0.0, 10.0, "")?,
        direction_deg,
    })
}

fn angle_in_range(check: &Check, key: &str, angle: f64) -> Result<f64, DesignError> {
    check.real(key, angle, -3600.0, 3600.0, "degrees")
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
