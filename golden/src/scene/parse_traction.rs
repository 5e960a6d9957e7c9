//! The keys of a contact that say how its load is spread.

use serde::Deserialize;

use super::{Shape, Shear, Traction};
use crate::design::DesignError;
use crate::design::checks::Check;

/// The keys as they stand in the file.
pub(super) struct RawTraction<'a> {
    pub(super) turn_deg: Option<f64>,
    pub(super) edge: Option<f64>,
    pub(super) tilt: Option<&'a [f64]>,
    pub(super) shear: Option<&'a str>,
    pub(super) held: Option<f64>,
    pub(super) spin: Option<f64>,
}

#[derive(Deserialize, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Sliding,
    Held,
    Even,
}

impl RawTraction<'_> {
    /// The traction; `key` makes the name of a key for messages.
    pub(super) fn check(
        &self,
        check: &Check,
        shape: Shape,
        key: &impl Fn(&str) -> String,
    ) -> Result<Traction, DesignError> {
        let real = |name: &str, value: Option<f64>, low: f64, high: f64, unit: &str| {
            value.map(|value| check.real(&key(name), value, low, high, unit)).transpose()
        };
        let refuse = |name: &str, problem: &str, remedy: &str| {
            Err(check.value(&key(name), problem.to_owned(), remedy.to_owned()))
        };
        let tilt = match self.tilt {
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
        let shear: Kind = self.shear.map_or(Ok(Kind::Sliding), |word| check.word(&key("shear"), word))?;
        if self.spin.is_some() && shear != Kind::Sliding {
            return refuse("spin", "belongs to a contact that slides", "remove it or write shear = \"sliding\"");
        }
        if self.held.is_some() != (shear == Kind::Held) {
            let (problem, remedy) = match self.held {
                Some(_) => ("belongs to a contact that is held", "remove it or write shear = \"held\""),
                None => ("is missing", "write the tangential force as a share of the largest, such as 0.5"),
            };
            return refuse("held", problem, remedy);
        }
        let bent = self.edge.is_some() || self.tilt.is_some() || !matches!(shape, Shape::Hertz { .. });
        if shear == Kind::Held && bent {
            return refuse(
                "shear",
                "is \"held\", which is known for Hertz's pressure alone",
                "use shape = \"hertz\" without edge and tilt",
            );
        }
        Ok(Traction {
            turn_deg: real("turn_deg", self.turn_deg, -3600.0, 3600.0, "degrees")?.unwrap_or(0.0),
            edge: real("edge", self.edge, -0.5, 4.0, "")?,
            tilt,
            shear: match shear {
                Kind::Sliding => Shear::Sliding { spin: real("spin", self.spin, -1000.0, 1000.0, "")?.unwrap_or(0.0) },
                Kind::Held => Shear::Held { share: real("held", self.held, 0.0, 1.0, "")?.unwrap_or(1.0) },
                Kind::Even => Shear::Even,
            },
        })
    }
}
