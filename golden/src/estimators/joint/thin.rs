//! The layer that the joint estimator needs.

use super::JointConstants;
use crate::estimators::Thin;
use crate::kernel::Kernel;

impl JointConstants {
    /// Its gain makes up for the normal force, its correction for part of the rest: for more where forces are spread over
    /// their cells, since a point force beside a taxel hardly reaches it through a thin layer.
    pub(crate) fn thin(&self, kernel: Kernel) -> Thin {
        let (limit, remedy) = match (self.correction.is_some(), kernel) {
            (false, Kernel::Point) => (
                0.5,
                "tangential forces are off by tenths of F_z; kernel = \"cell\" and golden calibrate carry down to 0.3",
            ),
            (false, Kernel::Cell) => {
                (0.4, "tangential forces are off by tenths of F_z; golden calibrate carries down to 0.3")
            }
            (true, Kernel::Point) => (
                0.4,
                "many frames have no direction, and tangential forces are off by half of F_z; kernel = \"cell\", \
                 calibrated anew, carries down to 0.3",
            ),
            (true, Kernel::Cell) => (0.3, "both tangential and normal forces are off by a tenth of F_z and more"),
        };
        Thin { limit, remedy: remedy.to_owned() }
    }
}
