//! The keys of a contact: its shape, and how its load is spread.

use serde::Deserialize;

use super::{Contact, Shape, Shear, Traction};
use crate::design::DesignError;
use crate::design::checks::Check;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawContact {
    shape: String,
    semi_axes_mm: Option<Vec<f64>>,
    sides_mm: Option<Vec<f64>>,
    radius_mm: Option<f64>,
    centre_mm: Vec<f64>,
    normal_force_n: f64,
    friction: f64,
    direction_deg: Option<f64>,
    turn_deg: Option<f64>,
    edge: Option<f64>,
    tilt: Option<Vec<f64>>,
    shear: Option<String>,
    held: Option<f64>,
    spin: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum ShapeKind {
    Hertz,
    Rectangle,
    Disc,
    Punch,
}

#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
enum ShearKind {
    Sliding,
    Held,
    Even,
}

/// A contact; `key` makes the name of a key for messages. A sweep gives it directions.
pub(super) fn contact(
    check: &Check,
    raw: &RawContact,
    key: &impl Fn(&str) -> String,
    swept: bool,
) -> Result<Contact, DesignError> {
    let shape = shape(check, raw, key)?;
    let direction_deg = match (swept, raw.direction_deg) {
        (_, Some(angle)) => angle_in_range(check, &key("direction_deg"), angle)?,
        (true, None) => 0.0,
        (false, None) => {
            return Err(check.value(
                &key("direction_deg"),
                "is missing".to_owned(),
                "write the direction of the tangential force, or add a [sweep]".to_owned(),
            ));
        }
    };
    let traction = traction(check, raw, shape, key)?;
    let [x, y] = check.pair(&key("centre_mm"), &raw.centre_mm)?;
    let centre = |name: &str, mm: f64| check.real(&key(name), mm, -100_000.0, 100_000.0, "mm").map(|mm| mm * 1e-3);
    Ok(Contact {
        shape,
        centre_m: [centre("centre_mm[0]", x)?, centre("centre_mm[1]", y)?],
        normal_force_n: check.above_zero(&key("normal_force_n"), raw.normal_force_n, 1e6, "N (it presses)")?,
        friction: check.real(&key("friction"), raw.friction, 0.0, 10.0, "")?,
        traction,
        direction_deg,
    })
}

fn shape(check: &Check, raw: &RawContact, key: &impl Fn(&str) -> String) -> Result<Shape, DesignError> {
    let shape = check.word(&key("shape"), &raw.shape)?;
    let (wanted, example) = match shape {
        ShapeKind::Hertz => ("semi_axes_mm", "both semi-axes of the ellipse, such as [7.0, 7.0]"),
        ShapeKind::Rectangle => ("sides_mm", "the lengths of both sides, such as [10.0, 6.0]"),
        ShapeKind::Disc | ShapeKind::Punch => ("radius_mm", "the radius, such as 10.0"),
    };
    let given = [
        ("semi_axes_mm", raw.semi_axes_mm.is_some()),
        ("sides_mm", raw.sides_mm.is_some()),
        ("radius_mm", raw.radius_mm.is_some()),
    ];
    if let Some((foreign, _)) = given.into_iter().find(|&(name, given)| given && name != wanted) {
        return Err(check.value(
            &key(foreign),
            format!("does not belong to a contact of shape \"{}\"", raw.shape),
            format!("remove it; the size of this shape is {wanted}"),
        ));
    }
    let missing = || check.value(&key(wanted), "is missing".to_owned(), format!("write {example}"));
    let metres = |name: &str, length: f64| check.real(&key(name), length, 0.01, 1000.0, "mm").map(|mm| mm * 1e-3);
    let pair = |values: &Option<Vec<f64>>| {
        let [x, y] = check.pair(&key(wanted), values.as_ref().ok_or_else(missing)?)?;
        Ok([metres(&format!("{wanted}[0]"), x)?, metres(&format!("{wanted}[1]"), y)?])
    };
    let radius = || metres(wanted, raw.radius_mm.ok_or_else(missing)?);
    Ok(match shape {
        ShapeKind::Hertz => Shape::Hertz { semi_axes_m: pair(&raw.semi_axes_mm)? },
        ShapeKind::Rectangle => Shape::Rectangle { sides_m: pair(&raw.sides_mm)? },
        ShapeKind::Disc => Shape::Disc { radius_m: radius()? },
        ShapeKind::Punch => Shape::Punch { radius_m: radius()? },
    })
}

/// A direction in degrees.
pub(super) fn angle_in_range(check: &Check, key: &str, angle: f64) -> Result<f64, DesignError> {
    check.real(key, angle, -3600.0, 3600.0, "degrees")
}

/// The traction of a contact.
fn traction(
    check: &Check,
    raw: &RawContact,
    shape: Shape,
    key: &impl Fn(&str) -> String,
) -> Result<Traction, DesignError> {
    let real = |name: &str, value: Option<f64>, low: f64, high: f64, unit: &str| {
        value.map(|value| check.real(&key(name), value, low, high, unit)).transpose()
    };
    let refuse =
        |name: &str, problem: &str, remedy: &str| Err(check.value(&key(name), problem.to_owned(), remedy.to_owned()));
    let tilt = match &raw.tilt {
        None => [0.0; 2],
        Some(values) => {
            let [along, across] = check.pair(&key("tilt"), values)?;
            if along.abs() + across.abs() > 1.0 {
                return refuse(
                    "tilt",
                    "makes the pressure a pull at one side",
                    "use two numbers whose magnitudes add up to at most 1",
                );
            }
            [along, across]
        }
    };
    let shear: ShearKind = raw.shear.as_ref().map_or(Ok(ShearKind::Sliding), |word| check.word(&key("shear"), word))?;
    if raw.spin.is_some() && shear != ShearKind::Sliding {
        return refuse("spin", "belongs to a contact that slides", "remove it or write shear = \"sliding\"");
    }
    if raw.held.is_some() != (shear == ShearKind::Held) {
        let (problem, remedy) = match raw.held {
            Some(_) => ("belongs to a contact that is held", "remove it or write shear = \"held\""),
            None => ("is missing", "write the tangential force as a share of the largest, such as 0.5"),
        };
        return refuse("held", problem, remedy);
    }
    let bent = raw.edge.is_some() || raw.tilt.is_some() || !matches!(shape, Shape::Hertz { .. });
    if shear == ShearKind::Held && bent {
        return refuse(
            "shear",
            "is \"held\", which is known for Hertz's pressure alone",
            "use shape = \"hertz\" without edge and tilt",
        );
    }
    Ok(Traction {
        turn_deg: real("turn_deg", raw.turn_deg, -3600.0, 3600.0, "degrees")?.unwrap_or(0.0),
        edge: real("edge", raw.edge, -0.5, 4.0, "")?,
        tilt,
        shear: match shear {
            ShearKind::Sliding => Shear::Sliding { spin: real("spin", raw.spin, -1000.0, 1000.0, "")?.unwrap_or(0.0) },
            ShearKind::Held => Shear::Held { share: real("held", raw.held, 0.0, 1.0, "")?.unwrap_or(1.0) },
            ShearKind::Even => Shear::Even,
        },
    })
}
