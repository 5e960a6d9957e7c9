//! Tests of the command, one module a subcommand.

mod calibrate;
mod contacts;
mod export_calibration;
mod generate;
mod hostile;
mod inspect;
mod new;
mod refused;
mod run;
mod scene;
mod solve;
mod support;
mod sweep;
mod unloaded;
mod view;
