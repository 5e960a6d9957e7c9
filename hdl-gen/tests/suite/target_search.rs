//! `--target-us`: the fewest lanes that meet the target, or what would.

use golden::design::{Design, PlanKind};
use hdl_gen::plan::{Plan, PlanError};

const JOINT: &str = "estimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]";

/// Sensor 1 by the reduced plan.
fn sensor(algorithm: &str, hardware: &str) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"target\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n{algorithm}\n[hardware]\n{hardware}\n"
    );
    Design::from_toml(&text, "target.toml").expect("a design")
}

fn refusal(algorithm: &str, target_us: f64) -> String {
    match Plan::meeting(&sensor(algorithm, ""), target_us) {
        Err(error @ PlanError::Target { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_fewest_lanes_that_meet_the_target() {
    for target_us in [13.0, 20.0, 40.0] {
        let found = Plan::meeting(&sensor("", ""), target_us).expect("a plan");
        let lanes = found.design.hardware.lanes;
        assert!(found.timeline.latency_cycles as f64 <= target_us * found.design.hardware.clock_mhz);
        // The plan that names as many lanes is the same, and one with a group of four less is too slow.
        let named = |lanes: usize| Plan::new(&sensor("", &format!("lanes = {lanes}"))).expect("a plan");
        assert_eq!(named(lanes).timeline, found.timeline, "{target_us}");
        let fewer = named(lanes - 4).timeline.latency_cycles as f64 / found.design.hardware.clock_mhz;
        assert!(fewer > target_us, "{lanes} lanes for {target_us} us, but {} take {fewer} us", lanes - 4);
    }
}

/// What is offered: from the clock that it would take to what always helps.
fn offered(refusal: &str) -> &str {
    let (_, rest) = refusal.split_once(" MHz; it would take a clock of ").expect("a clock");
    let (_, rest) = rest.split_once(" MHz, ").expect("a clock");
    rest.split_once("fewer taxels, or a target of").expect("the rest").0
}

#[test]
fn only_remedies_that_meet_the_target_are_offered() {
    let line = |target_us| refusal("", target_us);
    let joint = |target_us| refusal(JOINT, target_us);
    for (refusal, expected) in [
        // The smallest change, and if that is the streams' width one that leaves it.
        (line(8.0), "stream_bits = 64, outputs = \"resultants\", "),
        (line(7.0), "stream_bits = 128, outputs = \"resultants\", "),
        (line(6.5), "outputs = \"resultants\", "),
        (line(5.0), ""),
        (joint(6.0), "stream_bits = 64, outputs = \"resultants\", "),
        (joint(4.0), ""),
    ] {
        assert_eq!(offered(&refusal), expected, "{refusal}");
    }
}

/// What is offered is the smallest change: it meets the target, and what comes before it does not.
#[test]
fn remedies_do_what_is_said_of_them() {
    let met = |algorithm: &str, hardware: &str, target_us: f64| {
        Plan::meeting(&sensor(algorithm, hardware), target_us).is_ok()
    };
    assert!(!met(JOINT, "", 6.0) && met(JOINT, "stream_bits = 64", 6.0));
    assert!(met(&format!("{JOINT}\noutputs = \"resultants\""), "", 6.0));
    assert!(!met("", "stream_bits = 64", 7.0) && met("", "stream_bits = 128", 7.0));
    assert!(!met("", "stream_bits = 128", 6.5) && met("outputs = \"resultants\"", "", 6.5));
}

/// A design that keeps its area small is offered no other estimator.
#[test]
fn a_small_area_keeps_its_estimator() {
    let area = Plan::meeting(&sensor(JOINT, "optimise = \"area\""), 5.0);
    let refusal = area.expect_err("too slow").to_string();
    assert!(!offered(&refusal).contains("estimator"), "{refusal}");
}

/// What is offered does what is said of it.
#[test]
fn the_clock_that_is_offered_meets_the_target() {
    let Err(PlanError::Target { needed_mhz, .. }) = Plan::meeting(&sensor("", ""), 8.0) else { panic!() };
    let faster = sensor("", &format!("clock_mhz = {needed_mhz:?}"));
    assert!(Plan::meeting(&faster, 8.0).is_ok(), "{needed_mhz}");
}

/// The paper's plan has lanes of its own choice.
#[test]
fn a_target_that_nothing_can_be_found_for_is_refused() {
    let mut design = sensor("", "");
    design.algorithm.plan = PlanKind::Paper;
    let paper = Plan::meeting(&design, 5.0).expect_err("refused").to_string();
    assert!(paper.contains("5 us") && paper.contains("plan = \"reduced\""), "{paper}");
}
