//! Tests of developers' tasks, one module a task.

mod bench;
mod cells;
mod corner_cases;
mod luts;
mod netlist;
mod solver;
mod stress;
#[allow(dead_code, reason = "shared with the tests of the RTL, which use all of it")]
#[path = "../../../testbench/tests/suite/support/mod.rs"]
mod support;
