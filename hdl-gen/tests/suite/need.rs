//! `--target-us`: the fewest lanes that meet the need, or what would.

use std::path::Path;

use golden::design::{Design, PlanKind};
use hdl_gen::plan::{Plan, PlanError};

use crate::command::{good, hdl_gen};

/// Sensor 1 by the reduced plan.
fn sensor(algorithm: &str, hardware: &str) -> Design {
    let text = format!(
        "format = 3\nname = \"need\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n{algorithm}\n[hardware]\n{hardware}\n"
    );
    Design::from_toml(&text, "need.toml").expect("a design")
}

fn refusal(algorithm: &str, target_us: f64) -> String {
    match Plan::meeting(&sensor(algorithm, ""), target_us) {
        Err(error @ PlanError::Target { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_fewest_lanes_that_meet_the_need() {
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
fn only_remedies_that_meet_the_need_are_offered() {
    let line = |target_us| refusal("", target_us);
    let joint = |target_us| refusal("estimator = \"joint\"", target_us);
    for (refusal, expected) in [
        // The smallest change, and if that is the streams' width one that leaves it.
        (line(8.0), "stream_bits = 64, outputs = \"resultants\", "),
        (line(7.0), "stream_bits = 128, outputs = \"resultants\", "),
        (line(6.5), "outputs = \"resultants\", "),
        (line(5.0), ""),
        (joint(20.0), "grid = 15, "),
        (joint(6.0), "grid = 15 with stream_bits = 64, grid = 15 with outputs = \"resultants\", "),
        (joint(4.0), ""),
        (refusal("estimator = \"joint\"\ngrid = 15", 6.0), "stream_bits = 64, outputs = \"resultants\", "),
    ] {
        assert_eq!(offered(&refusal), expected, "{refusal}");
    }
}

/// What is offered is the smallest change: it meets the need, and what comes before it does not.
#[test]
fn remedies_do_what_is_said_of_them() {
    let met = |algorithm: &str, hardware: &str, target_us: f64| {
        Plan::meeting(&sensor(algorithm, hardware), target_us).is_ok()
    };
    let [fine, coarse] = ["", "\ngrid = 15"].map(|grid| format!("estimator = \"joint\"{grid}"));
    assert!(!met(&fine, "stream_bits = 128", 6.0) && !met(&coarse, "", 6.0) && met(&coarse, "stream_bits = 64", 6.0));
    assert!(met(&format!("{coarse}\noutputs = \"resultants\""), "", 6.0));
    assert!(!met("", "stream_bits = 64", 7.0) && met("", "stream_bits = 128", 7.0));
    assert!(!met("", "stream_bits = 128", 6.5) && met("outputs = \"resultants\"", "", 6.5));
}

/// A coarser grid takes constants of its own, which `fitted_to` insists on; the walk made smaller is the fine grid's.
#[test]
fn a_grid_is_offered_with_what_it_takes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").join("designs");
    for (design, units) in [("sensor1-joint", 128), ("sensor2-wide", 128)] {
        let design = Design::load(&folder.join(design).with_extension("toml")).expect("right");
        let refusal = Plan::meeting(&design, 15.0).expect_err("too slow").to_string();
        let grid = format!("grid = 15 (which `golden calibrate --hidden {units}` fits the constants to), ");
        assert_eq!(offered(&refusal), grid, "{}", design.name);
    }
    let area = Plan::meeting(&sensor("estimator = \"joint\"", "optimise = \"area\""), 40.0);
    assert_eq!(offered(&area.expect_err("too slow").to_string()), "");
}

/// What is offered does what is said of it.
#[test]
fn the_clock_that_is_offered_meets_the_need() {
    let Err(PlanError::Target { needed_mhz, .. }) = Plan::meeting(&sensor("", ""), 8.0) else { panic!() };
    let faster = sensor("", &format!("clock_mhz = {needed_mhz:?}"));
    assert!(Plan::meeting(&faster, 8.0).is_ok(), "{needed_mhz}");
}

/// The paper's plan has lanes of its own choice, and times are above 0.
#[test]
fn a_need_that_nothing_can_be_found_for_is_refused() {
    let mut design = sensor("", "");
    design.algorithm.plan = PlanKind::Paper;
    let paper = Plan::meeting(&design, 5.0).expect_err("refused").to_string();
    assert!(paper.contains("5 us") && paper.contains("plan = \"reduced\""), "{paper}");
    let folder = tempfile::tempdir().expect("a folder");
    for wrong in ["0", "-1", "inf", "nan", "soon"] {
        let output = hdl_gen(folder.path(), &["inspect", "need.toml", &format!("--target-us={wrong}")]);
        let refused = String::from_utf8_lossy(&output.stderr);
        assert!(refused.contains("microseconds") && refused.contains("greater than 0"), "{refused}");
    }
}

#[test]
fn a_design_that_is_too_large_for_its_part_is_written_with_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "format = 3\nname = \"big_pad\"\n[sensor]\ncolumns = 20\nrows = 20\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
                [algorithm]\nplan = \"paper\"\n[hardware]\nlanes = 8\n";
    std::fs::write(folder.path().join("large.toml"), text).expect("a file");
    let warned = |arguments: &[&str]| good(folder.path(), arguments).contains("too much for xczu9eg");
    assert!(warned(&["inspect", "large.toml"]) && warned(&["generate", "large.toml", "--out", "large"]));
    assert!(folder.path().join("large/rtl").is_dir());
}

#[test]
fn each_board_s_part_has_its_shares_and_its_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = |name: &str, part: &str, hardware: &str| {
        let text = format!(
            "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
             [algorithm]\nplan = \"reduced\"\nestimator = \"line\"\n[hardware]\npart = \"{part}\"\n{hardware}\n"
        );
        std::fs::write(folder.path().join(format!("{name}.toml")), text).expect("a file");
        good(folder.path(), &["inspect", &format!("{name}.toml")])
    };
    let resources = |said: &str| said.lines().find(|line| line.contains(" bits of ROM")).expect("its line").to_owned();
    // Of 36 multipliers on each part and the memories of one board's design: DSP, RAMB36 that the device has.
    for (part, dsp) in
        [("xczu9eg-ffvb1156-2-e", 2520.0), ("xczu7ev-ffvc1156-2-e", 1728.0), ("xck26-sfvc784-2LV-c", 1248.0)]
    {
        let line = resources(&said("pad", part, "lanes = 16"));
        let share = format!(": {:.1} and ", 100.0 * 36.0 / dsp);
        assert!(line.contains("36 DSP48E2") && line.contains(&share) && line.ends_with(part), "{line}");
    }
    // The older multipliers: two for each but those of lanes and field, with 25 bits; two for all with 27.
    let narrow = said("pad", "xc7z020clg400-1", "lanes = 16\ndata_bits = 25");
    assert!(resources(&narrow).contains("55 DSP48E1") && !narrow.contains("data_bits = 25"), "{narrow}");
    let wide = said("pad", "xc7z020clg400-1", "lanes = 16");
    assert!(resources(&wide).contains("72 DSP48E1"), "{wide}");
    assert!(wide.contains("36 multipliers take 72 of them; with data_bits = 25"), "{wide}");
    let large = said("pad", "xc7z020clg400-1", "lanes = 112");
    assert!(
        large.contains("too much for xc7z020clg400-1, which has 220 DSP48E1 and 140 RAMB36; take fewer"),
        "{large}"
    );
    // Of a part without a board nothing is known.
    assert!(resources(&said("pad", "xc7k325tffg900-2", "lanes = 112")).ends_with(" bits of ROM"));
}
