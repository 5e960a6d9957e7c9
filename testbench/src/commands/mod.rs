//! Commands with many options, one file each.

pub mod sweep;
