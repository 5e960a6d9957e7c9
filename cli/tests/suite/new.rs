//! What `sptfra new` takes of a sensor, and what it says of it.

use std::fs;

use golden::design::{Design, Scaling};
use hdl_gen::plan::Plan;

use crate::generate::good;
use crate::support::sptfra_in;

/// What is said of a new design, and the design.
fn new(options: &[&str]) -> (String, Design) {
    let folder = tempfile::tempdir().unwrap();
    let paper = if options.contains(&"--paper-sensor") { &[][..] } else { &["--paper-sensor", "1"] };
    let said = good(folder.path(), &[&["new", "pad"], paper, options].concat());
    (said, Design::load(&folder.path().join("pad.toml")).unwrap())
}

#[test]
fn a_pitch_is_one_number_or_two() {
    for pitch in [&["3.4"][..], &["3.4", "3.4"], &["3.4,3.4"]] {
        let (said, design) = new(&[&["--estimator", "line", "--pitch-mm"], pitch].concat());
        assert_eq!(design.sensor.pitch_mm.map(f64::to_bits), [3.4_f64.to_bits(); 2]);
        assert!(said.contains("taxels of 3.4 x 3.4 mm"), "{said}");
    }
    let folder = tempfile::tempdir().unwrap();
    for (pitch, part) in
        [(&["4,4,4"][..], "3 lengths; give one or two"), (&["wide"], "as 4 2 or 4,2"), (&["nan"], "nan")]
    {
        let output = sptfra_in(folder.path(), &[&["new", "pad", "--paper-sensor", "1", "--pitch-mm"], pitch].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(part), "{said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
}

#[test]
fn geometry_and_tension_have_to_be_given() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |options: &[&str]| {
        let output = sptfra_in(folder.path(), &[&["new", "pad"], options].concat());
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let said = refused(&[]);
    assert!(said.contains("--columns, --rows, --pitch-mm, --depth-mm, --tension missing"), "{said}");
    assert!(said.contains("Drag a finger") && said.contains("--paper-sensor 1"), "{said}");
    let said = refused(&["--columns", "6", "--rows", "6", "--pitch-mm", "4", "--tension", "read"]);
    assert!(said.contains("--depth-mm missing") && !said.contains("Drag a finger"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    assert!(new(&["--paper-sensor", "2"]).0.contains("10 x 10 taxels of 4 x 4 mm, 3 mm deep"));
    // What a count is worth, and which way it goes.
    let counts = ["--estimator", "line", "--counts", "12"];
    let (said, _) = new(&counts);
    assert!(said.contains("taken for 100000 Pa") && said.contains("Larger counts are taken to press"), "{said}");
    let (said, _) = new(&[&counts[..], &["--full-scale-pa", "60000"]].concat());
    assert!(!said.contains("taken for 100000 Pa") && said.contains("Larger counts are taken to press"), "{said}");
}

#[test]
fn noise_is_a_share_or_percent() {
    let line = ["--estimator", "line"];
    for (noise, expected) in [("1%", 0.01), ("0.01", 0.01), ("2.5 %", 0.025), ("0", 0.0)] {
        let (_, design) = new(&[&line[..], &["--noise", noise]].concat());
        assert_eq!(design.input.noise.to_bits(), f64::to_bits(expected), "{noise}");
    }
    assert_eq!(new(&line).1.input.noise.to_bits(), golden::design::DEFAULT_NOISE.to_bits());
    let folder = tempfile::tempdir().unwrap();
    for wrong in ["1", "20%", "-1%", "nan", "%"] {
        let noise = format!("--noise={wrong}");
        let output = sptfra_in(folder.path(), &["new", "pad", "--paper-sensor", "1", &noise]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains("such as 1% or 0.01"), "{wrong}: {said}");
    }
}

/// What docs/explanation/estimators.md says of a new design beside `sensor1-fast`, which has neither.
#[test]
fn a_range_for_each_frame_and_counted_contacts_cost_some_latency() {
    let (_, design) = new(&[]);
    let mut plain = design.clone();
    plain.hardware.scaling = Scaling::Fixed;
    plain.algorithm.count_contacts = false;
    let [new, plain] = [design, plain].map(|design| Plan::new(&design).unwrap().timeline);
    assert_eq!([new.latency_cycles - plain.latency_cycles, new.interval_cycles], [30, plain.interval_cycles]);
}

/// The errors that are told are those of the sensor at hand.
#[test]
fn a_new_design_tells_how_far_to_trust_it() {
    let of_depth = |depth: &str| {
        let (said, design) = new(&["--columns", "8", "--rows", "8", "--pitch-mm", "4", "--depth-mm", depth]);
        let text = said.split("expect the shear within ").nth(1).and_then(|rest| rest.split(" % of F_z").next());
        let told: f64 = text.expect("errors").parse().unwrap();
        let [found, _] = design.algorithm.expected_error.expect("errors").at(design.input.noise);
        assert!((told - found).abs() < 0.51, "{told} {found}");
        (said, told)
    };
    let (said, usual) = of_depth("3");
    assert!((1.0..10.0).contains(&usual) && !said.contains("warning"), "{said}");
    // By the kernel "point" it would be over 20.
    let (said, thin) = of_depth("1");
    assert!(thin > usual && thin < 20.0 && said.contains("\nwarning: the layer is 0.25 of a pitch thin"), "{said}");
    for (depth, kernel) in [("2", "point"), ("1.9", "cell")] {
        let (said, design) = new(&["--pitch-mm", "4", "--depth-mm", depth]);
        assert_eq!(design.algorithm.kernel.to_string(), kernel, "{depth}");
        assert_eq!(said.contains("kernel = \"cell\""), kernel == "cell", "{said}");
    }
    let (said, deep) = of_depth("12");
    assert!(deep > usual && said.contains("`regularisation`"), "{said}");
}
