//! Tests of the emitted RTL and of what runs it, one module a topic.

mod bad_frames;
mod browser;
mod build_cache;
mod calibration;
mod checks;
#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/contacts.rs"]
mod contacts;
mod copies;
mod cores;
mod count_contacts;
mod counts;
mod dead_taxels;
mod deep_rom;
mod dist;
mod docs;
mod drivers;
mod figures;
mod flows;
mod formal;
mod icarus;
mod joint;
mod layered;
mod licence;
mod lint;
mod older_parts;
mod overrun;
mod pack_registers;
mod parameters;
mod properties;
mod python;
mod ram;
mod range;
mod registers;
mod simulate;
mod smoothing;
mod stream_faults;
mod stream_modes;
mod streams;
mod stub;
mod support;
mod unreal_matrices;
