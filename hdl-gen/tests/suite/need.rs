//! `target_us`: the fewest lanes that meet the need, or what would.

use golden::design::Design;
use hdl_gen::plan::{Plan, PlanError};

use crate::command::good;

/// Sensor 1 by the reduced plan.
fn sensor(algorithm: &str, hardware: &str) -> Design {
    let text = format!(
        "name = \"need\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n{algorithm}\n[hardware]\n{hardware}\n"
    );
    Design::from_toml(&text, "need.toml").expect("a design")
}

fn refusal(algorithm: &str, target_us: f64) -> String {
    match Plan::new(&sensor(algorithm, &format!("target_us = {target_us:?}"))) {
        Err(error @ PlanError::Target { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_fewest_lanes_that_meet_the_need() {
    for target_us in [13.0, 20.0, 40.0] {
        let found = Plan::new(&sensor("", &format!("target_us = {target_us:?}"))).expect("a plan");
        let lanes = found.design.hardware.lanes;
        assert!(found.timeline.latency_cycles as f64 <= target_us * found.design.hardware.clock_mhz);
        // The plan that names as many lanes is the same, and one with a group of four less is too slow.
        let named = |lanes: usize| Plan::new(&sensor("", &format!("lanes = {lanes}"))).expect("a plan");
        assert_eq!(named(lanes).timeline, found.timeline, "{target_us}");
        let fewer = named(lanes - 4).timeline.latency_cycles as f64 / found.design.hardware.clock_mhz;
        assert!(fewer > target_us, "{lanes} lanes for {target_us} us, but {} take {fewer} us", lanes - 4);
    }
}

#[test]
fn only_remedies_that_meet_the_need_are_offered() {
    let resultants = refusal("", 8.0);
    assert!(resultants.contains("outputs = \"resultants\", fewer taxels"), "{resultants}");
    let none = refusal("", 5.0);
    assert!(none.contains("MHz, fewer taxels") && !none.contains("resultants"), "{none}");
    let line = refusal("estimator = \"joint\"", 20.0);
    assert!(line.contains("MHz, estimator = \"line\", fewer taxels"), "{line}");
    let both = refusal("estimator = \"joint\"", 8.0);
    assert!(both.contains("estimator = \"line\" with outputs = \"resultants\", fewer taxels"), "{both}");
}

/// What is offered does what is said of it.
#[test]
fn the_clock_that_is_offered_meets_the_need() {
    let Err(PlanError::Target { needed_mhz, .. }) = Plan::new(&sensor("", "target_us = 8.0")) else { panic!() };
    let faster = format!("target_us = 8.0\nclock_mhz = {needed_mhz:?}");
    assert!(Plan::new(&sensor("", &faster)).is_ok(), "{needed_mhz}");
}

#[test]
fn a_design_that_is_too_large_for_its_part_is_written_with_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "name = \"big_pad\"\n[sensor]\ncolumns = 20\nrows = 20\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
                [algorithm]\nplan = \"paper\"\n[hardware]\nlanes = 8\n";
    std::fs::write(folder.path().join("large.toml"), text).expect("a file");
    let warned = |arguments: &[&str]| good(folder.path(), arguments).contains("too much for xczu9eg");
    assert!(warned(&["inspect", "large.toml"]) && warned(&["generate", "large.toml", "--out", "large"]));
    assert!(folder.path().join("large/rtl").is_dir());
}
