//! From a checked design to synthesizable Verilog: validate, plan, emit.
//!
//! [`golden::design::Design`] says what is wanted; [`plan::Plan`] decides what is computed, in which formats,
//! where and when; [`emit::emit`] prints it as files; [`write::write_folder`] puts them on disk, all or none.
//! [`model::Model`] executes the plan in integers, bit for bit as the emitted hardware does.

pub mod blocks;
mod build;
pub mod cores;
pub mod emit;
pub mod estimators;
pub mod format;
pub mod inspection;
pub mod model;
pub mod new_design;
pub mod parameters;
pub mod plan;
pub mod resources;
pub mod timing;
pub mod write;
