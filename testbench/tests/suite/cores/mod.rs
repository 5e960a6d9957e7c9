//! Every leaf core as emitted, in Verilator, against its Rust reference, cycle by cycle.
//!
//! Each core has a run: stimulus for every cycle, and what its reference says the outputs must then be. One Verilator
//! model holds all cores and plays all runs at once; every test judges one run.

use std::sync::OnceLock;

mod bench;
mod converters;
mod iterative;
mod lint;
mod streaming;

use self::bench::{Played, Run};

/// The run of the given core, simulated. The first caller simulates all of them.
fn played(module: &str) -> &'static Played {
    static ALL: OnceLock<Result<Vec<Played>, String>> = OnceLock::new();
    let all = ALL.get_or_init(|| {
        let runs: Vec<Run> = vec![
            streaming::mac("sptfra_mac"),
            streaming::mac("sptfra_mac_ecp5"),
            streaming::mac_wide("sptfra_mac_wide"),
            streaming::multiply("sptfra_multiply"),
            streaming::multiply("sptfra_multiply_ecp5"),
            streaming::multiply_wide("sptfra_multiply_wide"),
            streaming::axis_skid(),
            streaming::row_sequencer(),
            iterative::ratio(),
            iterative::cordic(),
            converters::float_to_fixed(),
            converters::fixed_to_float(),
        ];
        bench::play(runs).map_err(|error| error.to_string())
    });
    let all = all.as_ref().expect("the simulation runs");
    all.iter().find(|played| played.run.module == module).expect("the core has a run")
}

#[test]
fn every_core_has_a_run() {
    for (module, _) in bench::cores() {
        assert!(!played(&module).outputs.is_empty());
    }
}

#[test]
fn mac_accumulates_as_its_reference() {
    played("sptfra_mac").check(15_000);
    played("sptfra_mac_ecp5").check(15_000);
}

#[test]
fn a_wide_mac_rounds_each_product() {
    played("sptfra_mac_wide").check(15_000);
}

#[test]
fn multipliers_multiply_in_one_piece_and_in_two() {
    played("sptfra_multiply").check(15_000);
    played("sptfra_multiply_ecp5").check(15_000);
    played("sptfra_multiply_wide").check(15_000);
}

#[test]
fn skid_buffer_follows_its_cycle_model() {
    played("sptfra_axis_skid").check(25_000);
}

#[test]
fn skid_buffer_keeps_the_rules_of_the_stream() {
    streaming::check_stream(played("sptfra_axis_skid"));
}

#[test]
fn row_sequencer_marks_the_products_of_the_reference() {
    played("sptfra_row_sequencer").check(20_000);
}

#[test]
fn ratio_divides_as_its_reference() {
    played("sptfra_ratio").check(10_000);
}

#[test]
fn cordic_turns_as_its_reference() {
    played("sptfra_cordic").check(10_000);
}

#[test]
fn float_to_fixed_converts_as_its_reference() {
    played("sptfra_float_to_fixed").check(15_000);
}

#[test]
fn fixed_to_float_converts_as_its_reference() {
    played("sptfra_fixed_to_float").check(15_000);
}
