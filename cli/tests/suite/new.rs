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
    let clipped = ["--paper-sensor", "1", "--tension", "clipped", "--estimator", "line"];
    let said = refused(&clipped);
    assert!(said.contains("reads no tension needs the grid search: leave --estimator line away"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    let small = ["--columns", "4", "--rows", "3", "--estimator", "line"];
    assert!(new(&[&small[..], &["--paper-sensor", "2"]].concat()).0.contains("4 x 3 taxels of 4 x 4 mm, 3 mm deep"));
    // What a count is worth, and which way it goes.
    let counts = [&small[..], &["--counts", "12"]].concat();
    let (said, _) = new(&counts);
    assert!(said.contains("stands for 100000 Pa") && said.contains("Larger counts mean more pressure"), "{said}");
    let (said, _) = new(&[&counts[..], &["--full-scale-pa", "60000"]].concat());
    assert!(!said.contains("stands for 100000 Pa") && said.contains("Larger counts mean more pressure"), "{said}");
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
        let (said, design) = new(&["--columns", "6", "--rows", "6", "--pitch-mm", "4", "--depth-mm", depth]);
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
        let (said, design) = new(&["--columns", "5", "--rows", "5", "--pitch-mm", "4", "--depth-mm", depth]);
        assert_eq!(design.algorithm.kernel.to_string(), kernel, "{depth}");
        assert_eq!(said.contains("kernel = \"cell\""), kernel == "cell", "{said}");
    }
    let (said, deep) = of_depth("12");
    assert!(deep > usual && said.contains("`regularisation`"), "{said}");
}
