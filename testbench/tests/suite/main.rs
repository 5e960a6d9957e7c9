//! Tests of the emitted RTL and of what runs it, one module a topic.

mod bad_frames;
mod bench;
mod bodies;
mod browser;
mod build_cache;
mod calibration;
mod cells;
mod checks;
mod command;
#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/contacts.rs"]
mod contacts;
mod copies;
mod cores;
mod counts;
mod dead_taxels;
mod deep_rom;
mod dist;
mod docs;
mod drivers;
mod figures;
mod flows;
mod formal;
mod hard;
mod icarus;
mod joint;
mod layered;
mod lint;
mod looking;
mod netlist;
mod overrun;
mod parameters;
mod properties;
mod python;
mod range;
mod registers;
mod simulate;
mod skip_zeros;
mod standin;
mod stream_faults;
mod stream_modes;
mod streams;
mod stress;
mod support;
mod sweep;
mod unreal_matrices;
