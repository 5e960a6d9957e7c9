//! The commands, one file each.

pub mod build;
pub mod calibrate;
mod calibrate_recorded;
pub mod check;
pub mod export_calibration;
pub mod frames;
pub mod generate;
pub mod inspect;
pub mod new;
pub mod recording;
pub mod run;
pub mod scene;
pub mod solve;
mod solve_lines;
pub mod sweep;
pub mod tune_filter;
mod unloaded;
pub mod view;
