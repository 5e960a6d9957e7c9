//! Design files: defaults, round trip, and a clear refusal of everything else.

#![allow(clippy::float_cmp)] // the same bits are meant

use std::path::Path;

use golden::design::{Design, Estimator, Filter, Optimise, Outputs, PlanKind, WEIGHTS_FILE};
use sha2::{Digest, Sha256};

const MINIMAL: &str = "name = \"pad\"\n[sensor]\ncolumns = 10\nrows = 8\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n";

fn message(text: &str) -> String {
    Design::from_toml(text, "pad.toml").expect_err("the file is wrong").to_string()
}

/// Replaces a line of the minimal file, or adds one at the end.
fn with(line: &str, replacement: &str) -> String {
    assert!(MINIMAL.contains(line), "no such line: {line}");
    MINIMAL.replace(line, replacement)
}

#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    let message = message(text);
    assert!(message.contains("pad.toml"), "no file name in: {message}");
    for part in parts {
        assert!(message.contains(part), "no {part:?} in: {message}");
    }
    assert!(!message.contains('\n'), "more than one line: {message}");
}

#[test]
fn everything_but_name_and_sensor_has_a_default() {
    let design = Design::from_toml(MINIMAL, "pad.toml").unwrap();
    assert_eq!(design.algorithm.filter, Filter::None);
    assert_eq!(design.algorithm.noise_floor_pa, 100_000.0 / 65536.0);
    assert_eq!((design.hardware.coefficient_bits, design.hardware.data_bits, design.hardware.lanes), (18, 27, 16));
    assert_eq!(design.hardware.part, "xczu9eg-ffvb1156-2-e");
    assert_eq!((design.algorithm.plan, design.algorithm.outputs), (PlanKind::Reduced, Outputs::Field));
    assert_eq!((design.hardware.target_us, design.hardware.optimise), (None, Optimise::Interval));
    assert!(!design.hardware.skip_zeros);
    assert_eq!(design.hardware.stream_bits, 32);
}

#[test]
fn a_register_bank_is_asked_for_and_leaves_no_word_where_it_is_not() {
    let of = |text: &str| Design::from_toml(&format!("{MINIMAL}[hardware]\n{text}\n"), "pad.toml").unwrap();
    let (without, with) = (of("control = false"), of("control = true"));
    assert_eq!(without.to_toml(), Design::from_toml(MINIMAL, "pad.toml").unwrap().to_toml());
    assert!(!without.to_toml().contains("control"));
    assert!(with.hardware.control && with.to_toml().contains("\ncontrol = true\n"));
    assert_eq!(Design::from_toml(&with.to_toml(), "pad.toml").unwrap(), with);
}

#[test]
fn the_plan_is_the_reduced_one_where_that_changes_nothing_and_fits() {
    for (more, expected) in [
        ("[hardware]\nlanes = 4", PlanKind::Reduced),
        ("[hardware]\nlanes = 6", PlanKind::Paper),
        ("[algorithm]\nfilter = { kind = \"f1\", l = 7 }", PlanKind::Paper),
        ("[algorithm]\nfilter = { kind = \"f3\", scenes = [\"a.toml\"] }", PlanKind::Paper),
        ("[algorithm]\nplan = \"paper\"", PlanKind::Paper),
        ("[algorithm]\nplan = \"reduced\"\nfilter = { kind = \"f2\", p = 7 }", PlanKind::Reduced),
    ] {
        let design = Design::from_toml(&format!("{MINIMAL}{more}\n"), "pad.toml").unwrap();
        assert_eq!(design.algorithm.plan, expected, "{more}");
    }
}

#[test]
fn keys_of_the_reduced_plan_read_back_the_same() {
    for (more, parts) in [
        ("[algorithm]\noutputs = \"resultants\"", ["outputs = \"resultants\"", "plan = \"reduced\""]),
        ("[hardware]\ntarget_us = 20", ["target_us = 20.0", "plan = \"reduced\""]),
        ("[hardware]\noptimise = \"latency\"\nskip_zeros = true", ["optimise = \"latency\"", "skip_zeros = true"]),
        ("[algorithm]\nplan = \"paper\"", ["plan = \"paper\"", "skip_zeros = false"]),
        ("[hardware]\nstream_bits = 64", ["stream_bits = 64\n", "plan = \"reduced\""]),
    ] {
        let design = Design::from_toml(&format!("{MINIMAL}{more}\n"), "pad.toml").unwrap();
        let resolved = design.to_toml();
        assert_eq!(Design::from_toml(&resolved, "resolved").unwrap(), design);
        assert!(parts.iter().all(|part| resolved.contains(part)), "{resolved}");
        assert_eq!(design.hardware.lanes, 16);
        assert_ne!(resolved.contains("lanes = "), resolved.contains("target_us = "), "{resolved}");
    }
    let whole = with("columns = 10\nrows = 8", "columns = 64\nrows = 64");
    assert_eq!(Design::from_toml(&whole, "pad.toml").unwrap().sensor.taxels(), 4096);
}

#[test]
fn keys_that_contradict_the_plan() {
    let paper = "[algorithm]\nplan = \"paper\"\n";
    let reduced = "[algorithm]\nplan = \"reduced\"\n";
    for (more, parts) in [
        (format!("{paper}outputs = \"resultants\""), ["algorithm.outputs", "resultants", "plan = \"reduced\""]),
        (format!("{paper}[hardware]\noptimise = \"latency\""), ["hardware.optimise", "latency", "plan = \"reduced\""]),
        (format!("{paper}[hardware]\ntarget_us = 5"), ["hardware.target_us", "is 5", "plan = \"reduced\""]),
        (format!("{paper}[hardware]\nskip_zeros = true"), ["hardware.skip_zeros", "paper", "plan = \"reduced\""]),
        (format!("{reduced}[hardware]\nlanes = 6"), ["hardware.lanes", "is 6", "multiple of 4"]),
        (
            format!("{reduced}filter = {{ kind = \"f3\", scenes = [\"a\"] }}"),
            ["algorithm.filter", "f3", "plan = \"paper\""],
        ),
        (
            format!("{reduced}filter = {{ kind = \"f2\", p = 3 }}\n[hardware]\nskip_zeros = true"),
            ["hardware.skip_zeros", "with a filter", "none"],
        ),
        (
            "[hardware]\nlanes = 8\ntarget_us = 5".to_owned(),
            ["hardware.target_us", "lanes = 8", "the need or the lanes"],
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
fn whole_numbers_do_where_reals_are_asked_for() {
    let design = Design::from_toml(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4, 2]"), "").unwrap();
    assert_eq!(design.sensor.pitch_mm, [4.0, 2.0]);
}

#[test]
fn the_resolved_design_reads_back_the_same() {
    for filter in ["{ kind = \"none\" }", "{ kind = \"f1\", l = 7 }", "{ kind = \"f2\", p = 0.3 }"] {
        let text = format!(
            "{MINIMAL}[algorithm]\nkernel = \"cell\"\nfilter = {filter}\n\
             [hardware]\nfull_scale_pa = 12345.678\nlanes = 3\n"
        );
        let design = Design::from_toml(&text, "pad.toml").unwrap();
        let resolved = design.to_toml();
        let again = Design::from_toml(&resolved, "resolved").unwrap();
        assert_eq!(design, again);
        assert_eq!(again.to_toml(), resolved);
    }
}

/// The minimal file with F3 and a filter for each matrix, in which `line` replaces that of A2.
fn with_choices(line: &str) -> String {
    let names = "C33inv A1 A2 A3 D10 D11 D12 D20 D21 D22 D30 D31 D32";
    let lines: String = names.split(' ').map(|name| format!("{name} = \"f2 p=2.5\"\n")).collect();
    let lines = lines.replace("A2 = \"f2 p=2.5\"", line);
    format!("{MINIMAL}[algorithm.filter]\nkind = \"f3\"\n[algorithm.filter.choices]\n{lines}")
}

#[test]
fn a_filter_for_each_matrix_reads_back_the_same() {
    for line in ["A2 = \"f1 l=40\"", "A2 = \"none\"", "A2 = \" f2  p=0.25 \""] {
        let design = Design::from_toml(&with_choices(line), "pad.toml").unwrap();
        let resolved = design.to_toml();
        assert_eq!(Design::from_toml(&resolved, "resolved").unwrap(), design, "{resolved}");
        let text = line.trim_start_matches("A2 = ").replace("\" f2  p=0.25 \"", "\"f2 p=0.25\"");
        assert!(resolved.contains(&format!("A2 = {text}\n")), "{resolved}");
    }
    let scenes = "filter = { kind = \"f3\", scenes = [\"../a \\\"b\\\".toml\", 'c\\d.toml'] }";
    let design = Design::from_toml(&format!("{MINIMAL}[algorithm]\n{scenes}\n"), "pad.toml").unwrap();
    let again = Design::from_toml(&design.to_toml(), "resolved").unwrap();
    assert_eq!(again, design);
    let expected = vec!["../a \"b\".toml".to_owned(), "c\\d.toml".to_owned()];
    assert_eq!(again.algorithm.filter, Filter::F3 { scenes: expected, choices: None });
}

#[test]
fn choices_that_are_none() {
    for (line, parts) in [
        ("", ["algorithm.filter.choices.A2", "missing", "golden choose"]),
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
fn every_design_of_the_repository_loads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        // Weights stand beside the designs that name them.
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let design = Design::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let name = stem.replace('-', "_");
        assert!(design.name.starts_with(&name), "{} in {stem}", design.name);
        names.push(stem);
    }
    assert!(names.len() >= 14, "{names:?}");
}

#[test]
fn unknown_and_missing_keys() {
    refused(&with("depth_mm = 3.0", "depth_mm = 3.0\nwidth = 2"), &["width", "line 7", "depth_mm"]);
    refused(&format!("{MINIMAL}[hardwear]\nlanes = 3\n"), &["hardwear", "hardware"]);
    refused(&format!("{MINIMAL}[hardware]\nlane = 3\n"), &["lane"]);
    refused(&with("rows = 8\n", ""), &["rows", "missing"]);
    refused(&with("name = \"pad\"\n", ""), &["name", "missing"]);
    refused("name = \"pad\"\n", &["sensor", "missing"]);
    refused(&format!("{MINIMAL}[algorithm]\nfilter = {{ kind = \"f1\", l = 4, q = 1 }}\n"), &["q", "line 8"]);
}

#[test]
fn wrong_types_and_broken_toml() {
    refused(&with("columns = 10", "columns = \"ten\""), &["line 3", "columns"]);
    for one in ["3.4", "3"] {
        let remedy = format!("[{0:?}, {0:?}]", one.parse::<f64>().unwrap());
        let parts = ["sensor.pitch_mm", "one number", &remedy];
        refused(&with("pitch_mm = [4.0, 2.0]", &format!("pitch_mm = {one}")), &parts);
    }
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = \"3.4\""), &["pitch_mm", "two numbers"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0]"), &["sensor.pitch_mm", "1 values", "two"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0, 2.0, 1.0]"), &["sensor.pitch_mm", "3 values", "two"]);
    refused(&with("pitch_mm = [4.0, 2.0]", "pitch_mm = [4.0, \"2\"]"), &["line 5", "pitch_mm"]);
    refused(&with("columns = 10", "columns = = 10"), &["line 3"]);
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
        ("kernel = \"line\"", ["algorithm.kernel", "line", "point, cell"]),
        ("fitted_to = \"x\"", ["algorithm.fitted_to", "joint estimator", "remove it"]),
        ("estimator = \"joint\"\nfitted_to = \"x\"", ["algorithm.fitted_to", "\"x\"", "golden calibrate"]),
        ("estimator = \"point\"", ["algorithm.estimator", "point", "line, joint"]),
        ("outputs = \"forces\"", ["algorithm.outputs", "forces", "field, resultants"]),
        ("plan = \"fast\"", ["algorithm.plan", "fast", "paper, reduced"]),
        ("filter = { kind = \"f4\" }", ["algorithm.filter.kind", "f4", "none, f1, f2, f3"]),
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
        ("arithmetic = \"float\"", ["hardware.arithmetic", "float", "fixed"]),
        ("coefficient_bits = 19", ["hardware.coefficient_bits", "19", "8 to 18"]),
        ("data_bits = 15", ["hardware.data_bits", "15", "16 to 27"]),
        ("lanes = 0", ["hardware.lanes", "is 0", "1 to 64"]),
        ("stream_bits = 48", ["hardware.stream_bits", "is 48", "32, 64 or 128"]),
        ("lanes = 65", ["hardware.lanes", "65", "1 to 64"]),
        ("target_us = 0.0", ["hardware.target_us", "is 0", "greater than 0"]),
        ("target_us = inf", ["hardware.target_us", "inf", "finite"]),
        ("optimise = \"area\"", ["hardware.optimise", "area", "interval, latency"]),
        ("skip_zeros = 1", ["skip_zeros", "line 8", "boolean"]),
        ("full_scale_pa = -1.0", ["hardware.full_scale_pa", "-1", "0"]),
        ("full_scale_pa = 1e10", ["hardware.full_scale_pa", "10000000000", "1000000000"]),
        ("clock_mhz = 0.5", ["hardware.clock_mhz", "0.5", "1 to 1000"]),
        ("part = \"a; rm\"", ["hardware.part", "a; rm", "letters"]),
        ("part = \"\"", ["hardware.part", "\"\"", "letters"]),
    ] {
        refused(&format!("{MINIMAL}[hardware]\n{line}\n"), &parts);
    }
}

/// Constants of the joint estimator stay with the sensor, the kernel and the regularisation that they were fitted to.
#[test]
fn constants_of_another_sensor_are_refused() {
    let text = include_str!("../../../designs/sensor2-joint.toml");
    let weights = ("sensor2-joint.weights.csv", include_str!("../../../designs/sensor2-joint.weights.csv").to_owned());
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
            &["algorithm.fitted_to", "10 x 10 taxels of 4 x 4 mm, 3 mm deep, point, 0", "golden calibrate"],
        );
    }
    // What the constants do not depend on may change.
    assert!(reads(&text.replace("lanes = 16", "lanes = 32")));
}

/// A correction whose two hidden units see one taxel.
const INLINE: &str = "half_window = [0, 0]\nhidden = [[1, 2, 3, 4, 5, 6], [-7, 8, -9, 10, -11, 12]]\n\
                      output = [[13, 14], [-15, 131071]]\n";

fn corrected(keys: &str) -> String {
    format!("{MINIMAL}[algorithm]\nestimator = \"joint\"\n[algorithm.correction]\n{keys}")
}

#[test]
fn weights_stand_in_a_file_of_their_own() {
    let inline = Design::from_toml(&corrected(INLINE), "pad.toml").unwrap();
    let (resolved, files) = (inline.to_toml(), inline.files());
    let [(name, weights)] = &files[..] else { panic!("one file, not {files:?}") };
    assert_eq!(
        (*name, weights.as_str()),
        (
            WEIGHTS_FILE,
            "x+0y+0,mu_x,mu_y,centre_x,centre_y,one,to_x,to_y\n1,2,3,4,5,6,13,-15\n-7,8,-9,10,-11,12,14,131071\n"
        )
    );
    assert!(resolved.contains("half_window = [0, 0]\nfile = \"weights.csv\"\nsha256 = \""), "{resolved}");
    assert!(!resolved.contains("hidden"), "{resolved}");
    assert_eq!(Design::from_parts(&resolved, "resolved", &files).unwrap(), inline);
    let renamed = inline.to_toml_naming("a \"b\".csv");
    assert_eq!(Design::from_parts(&renamed, "resolved", &[("a \"b\".csv", weights.clone())]).unwrap(), inline);
    // The line estimator has no weights to write.
    let mut line = inline.clone();
    line.algorithm.estimator = Estimator::Line;
    assert!(line.files().is_empty() && !line.to_toml().contains("correction"));
}

#[test]
fn weights_that_are_not_those_of_the_design() {
    let inline = Design::from_toml(&corrected(INLINE), "pad.toml").unwrap();
    let resolved = inline.to_toml();
    let weights = &inline.files()[0].1;
    let said = |content: Option<String>| {
        let files: Vec<_> = content.into_iter().map(|content| (WEIGHTS_FILE, content)).collect();
        Design::from_parts(&resolved, "pad.toml", &files).unwrap_err().to_string()
    };
    for (message, parts) in [
        (said(None), ["pad.toml", "algorithm.correction.file", "weights.csv", "cannot be read", "golden calibrate"]),
        (
            said(Some(weights.replace("131071", "131070"))),
            ["pad.toml", "algorithm.correction.sha256", "weights.csv", "other weights", "golden calibrate"],
        ),
    ] {
        assert!(parts.iter().all(|part| message.contains(part)) && !message.contains('\n'), "{message}");
    }
    // With the right hash of a wrong table, as somebody who edits both could have it.
    let wrong = weights.replace("131071", "131072");
    let hash: String = Sha256::digest(&wrong).iter().map(|byte| format!("{byte:02x}")).collect();
    let keys = format!("half_window = [0, 0]\nfile = \"w.csv\"\nsha256 = \"{hash}\"\n");
    let error = Design::from_parts(&corrected(&keys), "pad.toml", &[("w.csv", wrong)]).unwrap_err().to_string();
    assert!(["w.csv", "line 3", "131072", "131071"].iter().all(|part| error.contains(part)), "{error}");
}

#[test]
fn corrections_that_contradict_themselves() {
    let file = "file = \"w.csv\"\n";
    for (keys, parts) in [
        (
            "half_window = [0, 0]\n".to_owned(),
            ["algorithm.correction.file", "missing", "remove [algorithm.correction]"],
        ),
        (format!("{INLINE}{file}"), ["algorithm.correction.file", "beside weights", "remove"]),
        (format!("half_window = [0, 0]\n{file}"), ["algorithm.correction.sha256", "missing", "sha256sum w.csv"]),
        (format!("{INLINE}sha256 = \"0\"\n"), ["algorithm.correction.sha256", "without a file", "file"]),
        (format!("half_window = [0, 9]\n{file}sha256 = \"0\"\n"), ["half_window[1]", "is 9", "0 to 7"]),
        (format!("half_window = [0, 0]\n{file}sha256 = \"0\"\nhash = 1\n"), ["hash", "unknown field", "sha256"]),
    ] {
        refused(&corrected(&keys), &parts);
    }
}

#[test]
fn a_file_that_is_not_there() {
    let error = Design::load(Path::new("no/such/file.toml")).unwrap_err();
    assert!(error.to_string().contains("no/such/file.toml"));
}
