//! The layer that the line search needs.

use crate::estimators::Thin;
use crate::kernel::{self, Kernel};
use crate::sensor::Sensor;

/// Below three quarters of a pitch the edge falls between the taxels, and the normal force with it.
pub(crate) fn thin(sensor: &Sensor, kernel: Kernel) -> Thin {
    let short = 100.0 * (1.0 - 1.0 / kernel::gain(sensor, kernel));
    let wrong = match short {
        1.0.. => format!("F_z comes out {short:.0} % too small"),
        // With the "cell" kernel.
        _ => "tangential forces are off by tenths of F_z".to_owned(),
    };
    Thin { limit: 0.75, remedy: format!("by the line search {wrong}; write estimator = \"joint\"") }
}
