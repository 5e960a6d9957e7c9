//! Tests of the generator through its public interface, one module a topic.

mod columns;
mod constants;
mod counts;
mod emission;
mod energy;
mod expected;
mod folded_formats;
mod formats;
mod joint;
mod model;
mod pes;
mod reduced;
mod roms;
mod rooms;
mod savings;
mod scale;
mod schedule;
#[allow(dead_code, reason = "shared with the tests of golden, which use all of it")]
#[path = "../../../golden/tests/suite/stages.rs"]
mod stages;
mod support;
mod target_search;
