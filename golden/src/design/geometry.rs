//! The geometry of a sensor as scenes and recordings state it, in the ranges of a design's.

use serde::Deserialize;

use super::checks::Check;
use super::keys::{LENGTH_MM, MIN_SIDE};
use super::{DesignError, Lengths, MAX_SIDE, Sensor};

/// The keys; counts are `i64` so that a negative one gets a message about its range, not about its type.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawSensor {
    pub(crate) columns: i64,
    pub(crate) rows: i64,
    pub(crate) pitch_mm: Lengths,
    pub(crate) depth_mm: f64,
}

impl RawSensor {
    pub(crate) fn check(self, origin: &str) -> Result<Sensor, DesignError> {
        let check = Check { origin };
        let side = |key, value| check.integer(key, value, MIN_SIDE as i64, MAX_SIDE as i64);
        let length = |key, value| check.real(key, value, LENGTH_MM[0], LENGTH_MM[1], "mm");
        let pitch_mm = self.pitch_mm.pair(&check, "sensor.pitch_mm")?;
        Ok(Sensor {
            columns: side("sensor.columns", self.columns)? as usize,
            rows: side("sensor.rows", self.rows)? as usize,
            pitch_mm: [length("sensor.pitch_mm[0]", pitch_mm[0])?, length("sensor.pitch_mm[1]", pitch_mm[1])?],
            depth_mm: length("sensor.depth_mm", self.depth_mm)?,
        })
    }
}
