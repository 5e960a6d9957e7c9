//! The keys of a contact that say how its load is spread.

use serde::Deserialize;

use super::parse::RawContact;
use super::{Shape, Shear, Traction};
use crate::design::DesignError;
use crate::design::checks::Check;

#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Sliding,
    Held,
    Even,
}

/// The traction of a contact; `key` makes the name of a key for messages.
pub(super) fn traction(
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
    let shear: Kind = raw.shear.as_ref().map_or(Ok(Kind::Sliding), |word| check.word(&key("shear"), word))?;
    if raw.spin.is_some() && shear != Kind::Sliding {
        return refuse("spin", "belongs to a contact that slides", "remove it or write shear = \"sliding\"");
    }
    if raw.held.is_some() != (shear == Kind::Held) {
        let (problem, remedy) = match raw.held {
            Some(_) => ("belongs to a contact that is held", "remove it or write shear = \"held\""),
            None => ("is missing", "write the tangential force as a share of the largest, such as 0.5"),
        };
        return refuse("held", problem, remedy);
    }
    let bent = raw.edge.is_some() || raw.tilt.is_some() || !matches!(shape, Shape::Hertz { .. });
    if shear == Kind::Held && bent {
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
            Kind::Sliding => Shear::Sliding { spin: real("spin", raw.spin, -1000.0, 1000.0, "")?.unwrap_or(0.0) },
            Kind::Held => Shear::Held { share: real("held", raw.held, 0.0, 1.0, "")?.unwrap_or(1.0) },
            Kind::Even => Shear::Even,
        },
    })
}
