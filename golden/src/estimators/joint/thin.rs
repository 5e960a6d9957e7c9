//! The layer that the joint estimator needs.

use super::JointConstants;
use crate::estimators::Thin;

/// Depths over the coarser pitch: with the constants alone, and with a correction.
const CONSTANTS: f64 = 0.5;
const CORRECTED: f64 = 0.4;

impl JointConstants {
    /// Its gain makes up for the normal force, its correction for part of the rest.
    pub(crate) fn thin(&self) -> Thin {
        let (limit, remedy) = if self.correction.is_some() {
            (CORRECTED, "many frames have no direction, and tangential forces are off by half of F_z")
        } else {
            (CONSTANTS, "tangential forces are off by tenths of F_z; golden calibrate helps down to 0.4")
        };
        Thin { limit, remedy: remedy.to_owned() }
    }
}
