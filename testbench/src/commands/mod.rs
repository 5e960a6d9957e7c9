//! Commands with many options, one file each.

pub mod hard;
pub mod sweep;
