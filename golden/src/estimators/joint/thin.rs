//! The layer that the grid search needs.

use super::JointConstants;
use crate::estimators::Thin;
use crate::kernel::Kernel;
use crate::sensor::Sensor;

/// Depth over the coarser pitch below which no kernel and no correction serve.
const LEAST: f64 = 0.3;
const BELOW: &str = "take a thicker layer or a finer pitch";

impl JointConstants {
    /// Its gain makes up for the normal force, its correction for part of the rest: for more where forces are spread over
    /// their cells, since a point force beside a taxel hardly reaches it through a thin layer.
    pub(crate) fn thin(&self, sensor: &Sensor, kernel: Kernel) -> Thin {
        let (limit, wrong, remedy) = match (self.correction.is_some(), kernel) {
            (false, Kernel::Point) => (
                0.5,
                "tangential forces are off by tenths of F_z",
                "kernel = \"cell\" and sptfra calibrate serve to 0.3",
            ),
            (false, Kernel::Cell) => {
                (0.4, "tangential forces are off by tenths of F_z", "sptfra calibrate serves down to 0.3")
            }
            (true, Kernel::Point) => {
                (0.4, "many frames have no direction", "kernel = \"cell\", calibrated anew, serves down to 0.3")
            }
            (true, Kernel::Cell) => (LEAST, "one contact in twenty is off by a tenth of F_z", BELOW),
        };
        let remedy = if sensor.is_thinner_than(LEAST) { BELOW } else { remedy };
        Thin { limit, remedy: format!("{wrong}; {remedy}") }
    }
}
