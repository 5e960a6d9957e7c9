//! Other implementations of the cores that multiply, for fabrics whose multipliers are smaller than 18 by 27 bits.
//!
//! They have the modules, the ports, the cycles and the references of their namesakes.

pub(super) mod mac;
pub(super) mod multiply;
