//! Design files that say what is not so.

#![allow(clippy::float_cmp)] // the same bits are meant

use std::path::Path;

use golden::design::Design;

use super::{MINIMAL, refused, with, with_choices};

#[test]
fn keys_that_contradict_the_plan() {
    let paper = "[algorithm]\nplan = \"paper\"\n";
    let reduced = "[algorithm]\nplan = \"reduced\"\n";
    for (more, parts) in [
        (format!("{paper}outputs = \"resultants\""), ["algorithm.outputs", "resultants", "plan = \"reduced\""]),
        (format!("{paper}[hardware]\noptimise = \"latency\""), ["hardware.optimise", "latency", "plan = \"reduced\""]),
        (format!("{paper}[hardware]\noptimise = \"area\""), ["hardware.optimise", "area", "plan = \"reduced\""]),
        (format!("{reduced}[hardware]\noptimise = \"area\""), ["hardware.optimise", "area", "\"joint\""]),
        (format!("{reduced}[hardware]\nlanes = 6"), ["hardware.lanes", "is 6", "multiple of 4"]),
        (
            format!("{reduced}filter = {{ kind = \"f3\", scenes = [\"a\"] }}"),
            ["algorithm.filter", "f3", "plan = \"paper\""],
        ),
    ] {
        refused(&format!("{MINIMAL}{more}\n"), &parts);
    }
    for key in ["columns", "rows"] {
        let large = format!(
            "{}{paper}",
            MINIMAL.replace("rows = 8", "rows = 10").replace(&format!("{key} = 10"), &format!("{key} = 33"))
        );
        refused(&large, &[&format!("sensor.{key}"), "is 33", "at most 32", "plan = \"reduced\""]);
    }
}

#[test]
fn choices_that_are_none() {
    for (line, parts) in [
        ("", ["algorithm.filter.choices.A2", "missing", "sptfra tune-filter"]),
        ("A2 = \"f3\"", ["algorithm.filter.choices.A2", "f3", "f1 l=40"]),
        ("A2 = \"f1 p=3\"", ["algorithm.filter.choices.A2", "f1 p=3", "f2 p=30"]),
        ("A2 = \"f1 l=-3\"", ["algorithm.filter.choices.A2", "f1 l=-3", "f2 p=30"]),
        ("A2 = \"f1 l=79\"", ["algorithm.filter.choices.A2", "is 79", "1 to 78"]),
        ("A2 = \"f2 p=0\"", ["algorithm.filter.choices.A2", "is 0", "greater than 0"]),
        ("A2 = \"f2 p=NaN\"", ["algorithm.filter.choices.A2", "NaN", "greater than 0"]),
        ("A2 = \"none\"\nA4 = \"none\"", ["algorithm.filter.choices.A4", "A4", "names are C33inv"]),
        ("A2 = 30", ["A2", "line", "string"]),
    ] {
        refused(&with_choices(line), &parts);
    }
}

#[test]
fn crosstalk_and_smoothing_in_their_ranges() {
    let sensor = |keys: &str| with("depth_mm = 3.0", &format!("depth_mm = 3.0\n{keys}"));
    refused(&sensor("crosstalk = 0.2"), &["sensor.crosstalk", "is 0.2", "0.0001 to 0.1"]);
    refused(&sensor("smoothing = 9"), &["sensor.smoothing", "is 9", "1 to 8"]);
    refused(&sensor("noise = 0.2"), &["sensor.noise"]);
    refused(&sensor("noise = { deviation = 500.0, largest = 4000.0 }"), &["sensor.noise", "12.5 %", "press harder"]);
    refused(&sensor("noise = { deviation = 12.0, largest = 0.0 }"), &["sensor.noise.largest"]);
    refused(&sensor("noise = { deviation = 12.0 }"), &["sensor.noise", "largest"]);
    let noise = |keys: &str| Design::from_toml(&sensor(keys), "pad.toml").unwrap().input.noise.to_bits();
    assert_eq!(noise("noise = { deviation = 12.0, largest = 4000.0 }"), noise("noise = 0.003"));
    let measured = "noise = { deviation = 12.0, largest = 4000.0 }";
    refused(
        &sensor(&format!("{measured}\ncurve = {{ power = 1.2, scale = -0.01 }}")),
        &["sensor.noise", "noise = 0.01"],
    );
    refused(
        &sensor(&format!("{measured}\npa_per_count = -100")),
        &["sensor.noise.largest", "400000 Pa", "full_scale_pa"],
    );
    let design = Design::from_toml(&sensor(&format!("{measured}\npa_per_count = -2")), "pad.toml").unwrap();
    assert_eq!(design.input.typical_pa(), Some(8000.0));
    assert_eq!(Design::from_toml(&design.to_toml(), "resolved").unwrap(), design);
    refused(&sensor("smoothing = 4\nnoise = 0"), &["sensor.smoothing", "sensor.noise is 0", "check --unloaded"]);
    let creep = |strength: &str, seconds: &str| {
        sensor(&format!("creep = {{ strength = {strength}, seconds = {seconds}, frames_per_second = 100.0 }}"))
    };
    refused(&creep("1.5", "10.0"), &["sensor.creep.strength", "is 1.5", "0.001 to 1"]);
    refused(&creep("0.4", "0.01"), &["sensor.creep", "a time constant of 1 frames", "2 to 131072"]);
    refused(&creep("0.4", "1400.0"), &["sensor.creep", "140000 frames", "every nth frame"]);
    refused(&sensor("creep = { strength = 0.4, seconds = 10.0 }"), &["frames_per_second"]);
    let design = Design::from_toml(&sensor("crosstalk = 0.02\nsmoothing = 4"), "pad.toml").unwrap();
    assert_eq!(Design::from_toml(&design.to_toml(), "resolved").unwrap(), design);
}

#[test]
fn unknown_and_missing_keys() {
    refused(&with("depth_mm = 3.0", "depth_mm = 3.0\nwidth = 2"), &["width", "line 9", "depth_mm"]);
    refused(&format!("{MINIMAL}[hardwear]\nlanes = 3\n"), &["hardwear", "did you mean `hardware`?"]);
    refused(&format!("{MINIMAL}[hardware]\nlane = 3\n"), &["lane", "did you mean `lanes`?", "line 10"]);
    refused(&with("rows = 8\n", ""), &["rows", "missing"]);
    refused(&with("name = \"pad\"\n", ""), &["name", "missing"]);
    refused("format = 3\nname = \"pad\"\n", &["sensor", "missing"]);
    refused(&format!("{MINIMAL}[algorithm]\nfilter = {{ kind = \"f1\", l = 4, q = 1 }}\n"), &["q", "line 10"]);
}

#[test]
fn wrong_types_and_broken_toml() {
    refused(&with("columns = 10", "columns = \"ten\""), &["line 5", "columns"]);
    for one in ["3.4", "3"] {
        let remedy = format!("[{one}, {one}]");
        let parts = ["sensor.pitch_mm", "one number", &remedy];
        refused(&with("pitch_mm = [4.0, 2.0]", &format!("pitch_mm = {one}")), &parts);
    }
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = \"3.4\""), &["pitch_mm", "two numbers"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0]"), &["sensor.pitch_mm", "1 values", "two"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0, 2.0, 1.0]"), &["sensor.pitch_mm", "3 values", "two"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0, \"2\"]"), &["line 7", "pitch_mm"]);
    refused(&with("columns = 10", "columns = = 10"), &["line 5"]);
    refused(&with("columns = 10", "columns = 10.5"), &["line 5", "columns", "a whole number"]);
}

#[test]
fn sizes_out_of_range() {
    for value in ["0", "-3", "1", "65", "9000000000000000000"] {
        refused(&with("columns = 10", &format!("columns = {value}")), &["sensor.columns", value, "2 to 64"]);
        refused(&with("rows = 8", &format!("rows = {value}")), &["sensor.rows", "2 to 64"]);
    }
    for value in ["0.0", "-3.0", "nan", "inf", "0.009", "1000.1"] {
        refused(&with("depth_mm = 3.0", &format!("depth_mm = {value}")), &["sensor.depth_mm", "0.01 to 1000"]);
        refused(
            &with("pitch_mm = [4.0, 2.0]", &format!("pitch_mm = [4.0, {value}]")),
            &["sensor.pitch_mm[1]", "0.01 to 1000"],
        );
    }
}

#[test]
fn names_that_are_no_identifiers() {
    for name in ["", "1st", "a b", "a-b", "a$b", "ä", "../x", "a\\n"] {
        refused(&with("\"pad\"", &format!("\"{name}\"")), &["name", "Verilog identifier"]);
    }
    refused(&with("\"pad\"", "\"sptfra_mac\""), &["name", "all designs share"]);
    for keyword in ["module", "reg", "logic", "small"] {
        refused(&with("\"pad\"", &format!("\"{keyword}\"")), &["name", "keyword"]);
    }
    refused(&with("\"pad\"", &format!("\"{}\"", "x".repeat(65))), &["name", "65"]);
    assert!(Design::from_toml(&with("\"pad\"", &format!("\"_{}\"", "x".repeat(63))), "pad.toml").is_ok());
}

#[test]
fn options_are_refused_with_the_list_of_allowed_ones() {
    for (line, parts) in [
        ("kernel = \"line\"", ["kernel", "line 10", "`point` or `cell`"]),
        ("calibrated_for = \"x\"", ["algorithm.calibrated_for", "grid search", "remove what belongs"]),
        ("training_set = \"general\"\ngain = 1.1", ["algorithm.training_set", "and so do gain", "remove what belongs"]),
        ("estimator = \"joint\"\ncalibrated_for = \"x\"", ["algorithm.calibrated_for", "\"x\"", "sptfra calibrate"]),
        ("estimator = \"point\"", ["estimator", "line 10", "`line` or `joint`"]),
        ("outputs = \"forces\"", ["outputs", "line 10", "`field` or `resultants`"]),
        ("plan = \"fast\"", ["plan", "line 10", "`paper` or `reduced`"]),
        ("filter = { kind = \"f4\" }", ["kind", "line 10", "one of `none`, `f1`, `f2`, `f3`"]),
        ("filter = { kind = \"f3\" }", ["algorithm.filter.scenes", "missing", "scenes = ["]),
        ("filter = { kind = \"f3\", scenes = [] }", ["algorithm.filter.scenes", "missing", "scenes = ["]),
        ("filter = { kind = \"f3\", l = 4 }", ["algorithm.filter.l", "f3", "remove"]),
        ("filter = { kind = \"f2\", p = 4, scenes = [\"a\"] }", ["algorithm.filter.scenes", "f2", "remove"]),
        ("filter = { kind = \"f1\" }", ["algorithm.filter.l", "missing", "l ="]),
        ("filter = { kind = \"f2\" }", ["algorithm.filter.p", "missing", "p ="]),
        ("filter = { kind = \"f1\", l = 4, p = 2.0 }", ["algorithm.filter.p", "f1", "remove"]),
        ("filter = { kind = \"none\", l = 4 }", ["algorithm.filter.l", "none", "remove"]),
        // 80 taxels: 78 is the narrowest band.
        ("filter = { kind = \"f1\", l = 0 }", ["algorithm.filter.l", "is 0", "1 to 78"]),
        ("filter = { kind = \"f1\", l = 79 }", ["algorithm.filter.l", "is 79", "1 to 78"]),
        ("filter = { kind = \"f2\", p = 0.0 }", ["algorithm.filter.p", "is 0", "greater than 0"]),
        ("filter = { kind = \"f2\", p = inf }", ["algorithm.filter.p", "inf", "finite"]),
        ("filter = { kind = \"f2\", p = nan }", ["algorithm.filter.p", "NaN", "finite"]),
        ("noise_floor_pa = 0.0", ["algorithm.noise_floor_pa", "is 0", "greater than 0"]),
        ("noise_floor_pa = 1e6", ["algorithm.noise_floor_pa", "1000000", "100000"]),
    ] {
        refused(&format!("{MINIMAL}[algorithm]\n{line}\n"), &parts);
    }
    for (line, parts) in [
        ("coefficient_bits = 28", ["hardware.coefficient_bits", "28", "8 to 27"]),
        ("data_bits = 15", ["hardware.data_bits", "15", "16 to 35"]),
        ("lanes = 0", ["hardware.lanes", "is 0", "1 to 128"]),
        ("stream_bits = 48", ["hardware.stream_bits", "is 48", "one of 32, 64, 128"]),
        ("lanes = 129", ["hardware.lanes", "129", "1 to 128"]),
        ("optimise = \"speed\"", ["optimise", "line 10", "one of `throughput`, `latency`, `area`"]),
        ("scaling = \"taxel\"", ["scaling", "line 10", "`fixed` or `per_frame`"]),
        ("control = 1", ["control", "line 10", "boolean"]),
        ("full_scale_pa = -1.0", ["hardware.full_scale_pa", "-1", "0"]),
        ("full_scale_pa = 1e10", ["hardware.full_scale_pa", "10000000000", "1000000000"]),
        ("clock_mhz = 0.5", ["hardware.clock_mhz", "0.5", "1 to 1000"]),
        ("part = \"a; rm\"", ["hardware.part", "a; rm", "letters"]),
        ("part = \"\"", ["hardware.part", "\"\"", "letters"]),
    ] {
        refused(&format!("{MINIMAL}[hardware]\n{line}\n"), &parts);
    }
}

/// Constants of the grid search stay with the sensor, the kernel and the regularisation that they were fitted to.
#[test]
fn constants_of_another_sensor_are_refused() {
    let text = include_str!("../../../../designs/sensor2-fast.toml");
    let weights = ("sensor2-fast.weights.csv", include_str!("../../../../designs/sensor2-fast.weights.csv").to_owned());
    let reads = |text: &str| Design::from_parts(text, "joint.toml", std::slice::from_ref(&weights)).is_ok();
    assert!(reads(text));
    for (key, value) in [
        ("pitch_mm = [4.0, 4.0]", "pitch_mm = [4.0, 2.0]"),
        ("depth_mm = 3.0", "depth_mm = 3.5"),
        ("kernel = \"point\"", "kernel = \"cell\""),
        ("kernel = \"point\"", "kernel = \"point\"\nregularisation = 0.01"),
    ] {
        let changed = text.replace(key, value);
        assert_ne!(changed, text, "{key}");
        refused(
            &changed,
            &["algorithm.calibrated_for", "10 x 10 taxels of 4 x 4 mm, 3 mm deep, point, 0", "sptfra calibrate"],
        );
    }
    // What the constants do not depend on may change.
    assert!(reads(&text.replace("lanes = 16", "lanes = 32")));
}

#[test]
fn a_file_that_is_not_there() {
    let error = Design::load(Path::new("no/such/file.toml")).unwrap_err();
    assert!(error.to_string().contains("no/such/file.toml"));
}
