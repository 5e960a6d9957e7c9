//! Design files: defaults, round trip, and a clear refusal of everything else.

#![allow(clippy::float_cmp)] // the same bits are meant

mod older;
mod refused;
mod schema;
mod weights;

use std::path::Path;

use golden::design::{Design, Estimator, Filter, Kernel, Optimise, Outputs, PlanKind, Regularisation, Scaling};

/// Nothing but what every design must say.
const BARE: &str =
    "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 10\nrows = 8\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n";
/// The same by the line search, which needs no constants.
const MINIMAL: &str = "format = 3\nbase = \"tests/plain.toml\"\nname = \"pad\"\n[sensor]\ncolumns = 10\nrows = 8\n\
    pitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n";

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
    let text = format!("{BARE}[algorithm]\ngain = 1.1\nfriction_correction = [0.9, -0.1]\n");
    let design = Design::from_toml(&text, "pad.toml").unwrap();
    assert_eq!(design.algorithm.filter, Filter::None);
    assert_eq!((design.algorithm.estimator, design.algorithm.kernel), (Estimator::Joint, Kernel::Point));
    assert!(design.algorithm.count_contacts && design.hardware.scaling == Scaling::PerFrame);
    assert_eq!(design.algorithm.noise_floor_pa, 100_000.0 / 65536.0);
    assert_eq!((design.hardware.coefficient_bits, design.hardware.data_bits, design.hardware.lanes), (18, 27, 16));
    assert_eq!(design.hardware.part, "xczu9eg-ffvb1156-2-e");
    assert_eq!((design.algorithm.plan, design.algorithm.outputs), (PlanKind::Reduced, Outputs::Field));
    assert_eq!(design.hardware.optimise, Optimise::Throughput);
    assert_eq!(design.hardware.stream_bits, 32);
}

/// Fitted constants have no default: the refusal names the command that fits them.
#[test]
fn a_design_without_its_constants_is_refused() {
    for (given, missing) in [("friction_correction = [1, 0]", "gain"), ("gain = 1.1", "friction_correction")] {
        refused(
            &format!("{BARE}[algorithm]\n{given}\n"),
            &[&format!("algorithm.{missing} is missing"), "`sptfra calibrate pad.toml --out pad-calibrated.toml`"],
        );
    }
}

/// Kernel and regularisation follow depth and noise, and the resolved design says which they are.
#[test]
fn kernel_and_regularisation_follow_the_depth() {
    for (depth, kernel, regularisation) in [
        ("1.9", Kernel::Cell, Regularisation::None),
        ("3.0", Kernel::Point, Regularisation::None),
        ("3.1", Kernel::Point, Regularisation::Noise { noise: 0.005 }),
    ] {
        let text = |keys: &str| {
            let depth = BARE.replace("depth_mm = 3.0", &format!("depth_mm = {depth}"));
            format!("{depth}[algorithm]\nestimator = \"line\"\n{keys}\n")
        };
        let usual = Design::from_toml(&text(""), "pad.toml").unwrap();
        assert_eq!((usual.algorithm.kernel, usual.algorithm.regularisation), (kernel, regularisation), "{depth}");
        let other = Design::from_toml(&text("kernel = \"point\"\nregularisation = 0"), "pad.toml").unwrap();
        assert_eq!((other.algorithm.kernel, other.algorithm.regularisation), (Kernel::Point, Regularisation::None));
        let is_deep = regularisation != Regularisation::None;
        assert_eq!(usual.to_toml().contains("regularisation"), is_deep, "{depth}");
        let edited = usual.to_commented_toml().replace("\nnoise = 0.005\n", "\nnoise = 0.01\n");
        let edited = Design::from_toml(&edited, "edited").unwrap().algorithm.regularisation;
        assert_eq!(edited, if is_deep { Regularisation::Noise { noise: 0.01 } } else { Regularisation::None });
        for design in [usual, other] {
            assert_eq!(Design::from_toml(&design.to_toml(), "resolved").unwrap(), design);
        }
    }
}

#[test]
fn a_register_bank_is_asked_for() {
    let of = |text: &str| Design::from_toml(&format!("{MINIMAL}[hardware]\n{text}\n"), "pad.toml").unwrap();
    let (without, with) = (of("control = false"), of("control = true"));
    assert_eq!(without.to_toml(), Design::from_toml(MINIMAL, "pad.toml").unwrap().to_toml());
    assert!(!without.hardware.control && without.to_toml().contains("\ncontrol = false\n"));
    assert!(with.hardware.control && with.to_toml().contains("\ncontrol = true\n"));
    assert_eq!(Design::from_toml(&with.to_toml(), "pad.toml").unwrap(), with);
}

#[test]
fn several_contacts_are_asked_for() {
    let of = |text: &str| Design::from_toml(&format!("{MINIMAL}[algorithm]\n{text}\n"), "pad.toml").unwrap();
    let alone = Design::from_toml(MINIMAL, "pad.toml").unwrap().to_toml();
    assert_eq!(of("contacts = 1").to_toml(), alone);
    let counting = of("count_contacts = true");
    assert!(counting.algorithm.count_contacts && counting.to_toml().contains("\ncount_contacts = true\n"));
    assert_eq!(Design::from_toml(&counting.to_toml(), "pad.toml").unwrap(), counting);
    assert_eq!(of("count_contacts = false").to_toml(), alone);
    let several = of("contacts = 8");
    assert!(several.algorithm.contacts == 8 && several.to_toml().contains("\ncontacts = 8\n"));
    assert_eq!(Design::from_toml(&several.to_toml(), "pad.toml").unwrap(), several);
    for wrong in ["0", "9", "-1"] {
        refused(
            &format!("{MINIMAL}[algorithm]\ncontacts = {wrong}\n"),
            &["algorithm.contacts", &format!("is {wrong}"), "1 to 8"],
        );
    }
}

/// Whatever else a design says, a key that is left out has its documented default.
#[test]
fn the_plan_is_the_reduced_one_unless_the_paper_s_is_asked_for() {
    for (more, expected) in [
        ("[hardware]\nlanes = 4", PlanKind::Reduced),
        ("[algorithm]\nfilter = { kind = \"f1\", l = 7 }", PlanKind::Reduced),
        ("[algorithm]\nplan = \"paper\"\n[hardware]\nlanes = 6", PlanKind::Paper),
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
        ("[hardware]\noptimise = \"latency\"", ["optimise = \"latency\"", "plan = \"reduced\""]),
        ("[algorithm]\nplan = \"paper\"", ["plan = \"paper\"", "optimise = \"throughput\""]),
        (
            "[algorithm]\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\n[hardware]\noptimise = \"area\"",
            ["optimise = \"area\"", "plan = \"reduced\""],
        ),
        ("[hardware]\nstream_bits = 64", ["stream_bits = 64\n", "plan = \"reduced\""]),
        ("[hardware]\nscaling = \"per_frame\"", ["scaling = \"per_frame\"\n", "plan = \"reduced\""]),
    ] {
        let design = Design::from_toml(&format!("{MINIMAL}{more}\n"), "pad.toml").unwrap();
        let resolved = design.to_toml();
        assert_eq!(Design::from_toml(&resolved, "resolved").unwrap(), design);
        assert!(parts.iter().all(|part| resolved.contains(part)), "{resolved}");
        assert_eq!(design.hardware.lanes, 16);
    }
    let whole = with("columns = 10\nrows = 8", "columns = 64\nrows = 64");
    assert_eq!(Design::from_toml(&whole, "pad.toml").unwrap().sensor.taxels(), 4096);
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
            "{MINIMAL}[algorithm]\nplan = \"paper\"\nkernel = \"cell\"\nfilter = {filter}\n\
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
    format!(
        "{MINIMAL}[algorithm]\nplan = \"paper\"\n[algorithm.filter]\nkind = \"f3\"\n[algorithm.filter.choices]\n{lines}"
    )
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
    let design = Design::from_toml(&format!("{MINIMAL}[algorithm]\nplan = \"paper\"\n{scenes}\n"), "pad.toml").unwrap();
    let again = Design::from_toml(&design.to_toml(), "resolved").unwrap();
    assert_eq!(again, design);
    let expected = vec!["../a \"b\".toml".to_owned(), "c\\d.toml".to_owned()];
    assert_eq!(again.algorithm.filter, Filter::F3 { scenes: expected, choices: None });
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
