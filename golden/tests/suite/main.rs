//! Tests of the solver through its public interface, one module a topic.

mod bank;
mod check;
mod contact_kinds;
#[allow(dead_code, reason = "shared with the studies of xtask, which use all of it")]
mod contacts;
mod crosstalk;
mod curve;
mod dead_taxels;
mod design_file;
#[allow(dead_code, reason = "shared with the tests of the other crates")]
mod designs;
#[allow(dead_code, reason = "shared with the tests of the RTL, which use all of it")]
mod effort;
mod estimator;
mod fuzz;
mod half_space;
mod joint;
mod large;
mod matrices;
mod products;
mod readers;
mod recorded;
mod recording;
mod reduced;
mod regularisation;
mod samples;
mod scene_file;
mod separate;
mod smoothing;
mod stages;
mod tune_filter;
mod unloaded;
mod workspace;
