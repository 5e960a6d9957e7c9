//! Frames of several bodies in integers: the shell around the core.

pub mod float;
pub mod records;
pub mod regions;
