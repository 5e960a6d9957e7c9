//! Design files of older formats, and files with a base.

use golden::design::{Design, Scaling};

use super::{BARE, MINIMAL, message, refused};

/// A file of format 2 with every key that has another form now.
const OLD: &str = "name = \"pad\"\n[sensor]\ncolumns = 10\nrows = 8\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\ndead = [44]\n\
    [algorithm]\nestimator = \"joint\"\ncount_bodies = true\ngrid = 15\nfamily = \"wide\"\ndoubt = 0.06\n\
    fitted_to = \"10 x 8 taxels, wide\"\ntangential = [1.0, 0.0]\n\
    [hardware]\narithmetic = \"fixed\"\nrange = \"frame\"\noptimise = \"interval\"\nreplaceable = 4\ntarget_us = 15.0\n\
    debug = true\n";

#[test]
fn an_older_file_is_refused_with_each_key_to_change() {
    let steps = [
        "format is not 3",
        "write format = 3",
        "algorithm.count_bodies = true: write count_contacts = true",
        "algorithm.grid = 15: remove it and run `sptfra calibrate`",
        "algorithm.family = \"wide\": write training_set = \"general\"",
        "algorithm.doubt = 0.06: write max_standard_error = 0.06",
        "algorithm.fitted_to = \"10 x 8 taxels, wide\": remove it and run `sptfra calibrate`",
        "algorithm.tangential = [1.0, 0.0]: write friction_correction = [1.0, 0.0]",
        "hardware.arithmetic = \"fixed\": remove it",
        "hardware.range = \"frame\": write scaling = \"per_frame\"",
        "hardware.optimise = \"interval\": write optimise = \"throughput\"",
        "hardware.replaceable = 4: write dead = { taxels = [44], room = 4 } under [sensor]",
        "hardware.target_us = 15.0: give --target-us 15.0 to inspect and generate",
        "hardware.debug = true: give --debug to generate",
    ];
    refused(OLD, &steps);
    // A file whose first line alone was changed: the rest, and nothing of what is right.
    let half = format!("format = 3\n{OLD}");
    refused(&half, &steps[2..]);
    assert!(!message(&half).contains("write format"), "{}", message(&half));
    for (format, remedy) in [("2", "write format = 3"), ("4", "newer version"), ("\"3\"", "write format = 3")] {
        refused(&MINIMAL.replace("format = 3", &format!("format = {format}")), &["format", remedy]);
    }
    let plain = message(&MINIMAL.replace("format = 3\n", ""));
    assert!(plain.ends_with("format is not 3; write format = 3 above the tables"), "{plain}");
}

/// A base's keys hold where the file has none, table by table; its paths are from its own folder.
#[test]
fn a_base_gives_what_a_file_leaves_out() {
    let base = format!(
        "{BARE}pa_per_count = -2.0\ncalibration = \"gains.csv\"\n[algorithm]\nestimator = \"line\"\nplan = \"paper\"\n\
         filter = {{ kind = \"f1\", l = 7 }}\n[hardware]\nscaling = \"per_frame\"\nlanes = 4\n"
    );
    let gains = "1,0\n".repeat(80);
    let files = [("paper/base.toml", base.clone()), ("paper/gains.csv", gains.clone())];
    let load = |text: &str| Design::from_parts(text, "pad.toml", &files);
    let own = "format = 3\nbase = \"paper/base.toml\"\nname = \"own\"\n[algorithm]\nfilter = { kind = \"f2\", p = 30 }\n\
               [hardware]\nlanes = 8\n";
    let merged = load(own).unwrap();
    // As one file that says all of it.
    let whole = base
        .replace("\"pad\"", "\"own\"")
        .replace("kind = \"f1\", l = 7", "kind = \"f2\", p = 30")
        .replace("lanes = 4", "lanes = 8");
    let whole = Design::from_parts(&whole, "whole.toml", &[("gains.csv", gains)]).unwrap();
    assert_eq!(merged, whole);
    assert_eq!((merged.hardware.scaling, merged.to_toml()), (Scaling::PerFrame, whole.to_toml()));
    let refused = |text: &str, parts: &[&str]| {
        let message = load(text).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)) && !message.contains('\n'), "{message}");
    };
    refused(&own.replace("paper/base", "base"), &["pad.toml", "base", "base.toml", "cannot be read"]);
    refused(&own.replace("lanes = 8", "lanes = 6.5"), &["pad.toml, line 7", "a whole number"]);
    refused(&own.replace("lanes = 8", "lane = 8"), &["pad.toml, line 7", "did you mean `lanes`?"]);
    refused(&own.replace("lanes = 8", "lanes = 999"), &["hardware.lanes", "1 to 128"]);
    let wrong =
        |base: String| Design::from_parts(own, "pad.toml", &[("paper/base.toml", base)]).unwrap_err().to_string();
    assert!(
        wrong(base.replace("rows", "row")).contains("paper/base.toml, line 5"),
        "{}",
        wrong(base.replace("rows", "row"))
    );
    let chain = wrong(base.replace("format = 3\n", "format = 3\nbase = \"x.toml\"\n"));
    assert!(chain.contains("has a base itself"), "{chain}");
}

/// Errors were found for one sensor and algorithm; what counts mean, dead taxels and hardware change nothing about them.
#[test]
fn errors_of_a_base_are_those_of_its_own_sensor_and_algorithm() {
    let base = format!(
        "{BARE}[algorithm]\nestimator = \"line\"\nstandard_error = {{ model = 0.1, noise = 90.0, border = 1.0 }}\n\
         expected_error = {{ noise = [0.0], median = [5.0], p95 = [9.0] }}\n"
    );
    for (keys, same) in [
        ("[hardware]\nlanes = 8\n", true),
        ("[sensor]\npa_per_count = -2.0\ndead = [3]\n", true),
        ("[algorithm]\noutputs = \"resultants\"\n", true),
        ("[sensor]\npitch_mm = [3.0, 3.0]\n", false),
        ("[algorithm]\nfilter = { kind = \"f2\", p = 30 }\nplan = \"paper\"\n", false),
    ] {
        let own = format!("format = 3\nbase = \"base.toml\"\nname = \"own\"\n{keys}");
        let algorithm = Design::from_parts(&own, "pad.toml", &[("base.toml", base.clone())]).unwrap().algorithm;
        assert_eq!((algorithm.standard_error.is_some(), algorithm.expected_error.is_some()), (same, same), "{keys}");
    }
}
