//! The `hdl-gen` command on bad input: one clear message, nothing half-written, nothing of the user's touched.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::generate::{contents, folder_with_design, good};
use crate::support::{design_text, sptfra_in, without_progress};

/// The one message of a command that fails, after a look that every file is as before.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let before = contents(folder);
    let output = sptfra_in(folder, arguments);
    let message = without_progress(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(message.starts_with("error: ") && message.ends_with('\n') && message.lines().count() == 1, "{message}");
    assert_eq!(contents(folder), before, "{arguments:?}");
    message
}

/// `inspect` and `generate` refuse the design with one message that has all `parts`.
fn check_design(text: &str, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.toml"), text).unwrap();
    let message = refused(folder.path(), &["generate", "bad.toml"]);
    assert_eq!(refused(folder.path(), &["inspect", "bad.toml", "--json"]), message);
    for part in parts.iter().chain(&["bad.toml"]) {
        assert!(message.contains(part), "no {part:?} in: {message}");
    }
}

/// A good design with one replacement.
fn changed(from: &str, to: &str) -> String {
    let good = design_text("pad", [4, 3], [4.0, 2.0], 3.0, "");
    assert!(good.contains(from));
    good.replacen(from, to, 1)
}

#[test]
fn keys_are_known_and_complete() {
    check_design(&changed("rows = 3", "rows = 3\ncolour = 3"), &["line 7", "colour", "rows"]);
    check_design(&changed("rows = 3\n", ""), &["rows", "missing"]);
    check_design(&changed("name = \"pad\"\n", ""), &["name", "missing"]);
    check_design(&changed("depth_mm = 3.0", "depth_mm = 3.0\n[hardware]\nspeed = 3"), &["speed", "lanes"]);
    check_design(&changed("rows = 3", "rows = 3\nrows = 3"), &["line 7", "duplicate"]);
    check_design("", &["format = 3"]);
    check_design("name = ", &["line 1"]);
}

#[test]
fn sizes_make_sense() {
    for columns in ["0", "1", "-4", "65", "4000"] {
        check_design(&changed("columns = 4", &format!("columns = {columns}")), &["sensor.columns", columns, "2 to 64"]);
    }
    let paper = |rows: &str| {
        changed("depth_mm = 3.0", "depth_mm = 3.0\n[algorithm]\nplan = \"paper\"").replace("rows = 3", rows)
    };
    check_design(&paper("rows = 33"), &["sensor.rows", "33", "at most 32", "reduced"]);
    for columns in ["4.5", "\"4\"", "99999999999999999999", "nan"] {
        check_design(&changed("columns = 4", &format!("columns = {columns}")), &["line 5", "columns"]);
    }
    for depth in ["0.0", "-3.0", "nan", "inf", "-inf", "1e300"] {
        check_design(&changed("depth_mm = 3.0", &format!("depth_mm = {depth}")), &["sensor.depth_mm", "1000 mm"]);
    }
    for pitch in ["[0.0, 2.0]", "[4.0, -2.0]", "[4.0, nan]", "[4.0]", "[4.0, 2.0, 1.0]", "[]"] {
        check_design(&changed("[4.0, 2.0]", pitch), &["sensor.pitch_mm"]);
    }
    for (key, value) in [
        ("lanes", "0"),
        ("lanes", "129"),
        ("coefficient_bits", "7"),
        ("coefficient_bits", "28"),
        ("data_bits", "12"),
        ("data_bits", "36"),
        ("clock_mhz", "0.0"),
        ("clock_mhz", "nan"),
        ("full_scale_pa", "0.0"),
        ("full_scale_pa", "-1.0"),
        ("full_scale_pa", "inf"),
        ("full_scale_pa", "1e-300"),
        ("part", "\"x; exec rm\""),
    ] {
        let text = changed("depth_mm = 3.0", &format!("depth_mm = 3.0\n[hardware]\n{key} = {value}"));
        check_design(&text, &[&format!("hardware.{key}")]);
    }
}

#[test]
fn keys_fit_the_plan() {
    let with = |algorithm: &str, hardware: &str| {
        let more = format!("depth_mm = 3.0\n[algorithm]\n{algorithm}\n[hardware]\n{hardware}");
        changed("depth_mm = 3.0", &more)
    };
    let reduced = "plan = \"reduced\"";
    for lanes in ["1", "6", "63"] {
        check_design(
            &with(reduced, &format!("lanes = {lanes}")),
            &["hardware.lanes", lanes, "multiple of 4 from 4 to 128"],
        );
    }
    check_design(&with("plan = \"quick\"", ""), &["plan", "quick", "`paper` or `reduced`"]);
    let paper = "plan = \"paper\"";
    check_design(&with(&format!("{paper}\noutputs = \"resultants\""), ""), &["algorithm.outputs", "reduced"]);
    check_design(&with(paper, "optimise = \"latency\""), &["hardware.optimise", "reduced"]);
    check_design(&with(reduced, "optimise = \"speed\""), &["optimise", "speed", "latency"]);
}

#[test]
fn names_are_verilog_identifiers() {
    for name in ["module", "../x", "a b", "", "4x3", "a-b", "a\\\"b", "p\\u00e4d", "a\\nb", "endmodule"] {
        check_design(&changed("\"pad\"", &format!("\"{name}\"")), &["name", "Verilog"]);
    }
    check_design(&changed("\"pad\"", &format!("\"{}\"", "x".repeat(65))), &["name", "64"]);
}

#[test]
fn filters_leave_something() {
    let with = |filter: &str| {
        changed("depth_mm = 3.0", &format!("depth_mm = 3.0\n[algorithm]\nplan = \"paper\"\nfilter = {filter}"))
    };
    check_design(&with("{ kind = \"f2\", p = 1e-9 }"), &["C33inv", "weaker"]);
    check_design(&with("{ kind = \"f1\", l = 11 }"), &["algorithm.filter.l", "1 to 10"]);
    check_design(&with("{ kind = \"f1\" }"), &["algorithm.filter.l", "missing"]);
    check_design(&with("{ kind = \"f1\", p = 3.0 }"), &["algorithm.filter.p"]);
    check_design(&with("{ kind = \"f9\" }"), &["kind", "f9", "line"]);
    check_design(&with("{ kind = \"f2\", p = -1.0 }"), &["algorithm.filter.p"]);
}

#[test]
fn a_sensor_that_cannot_be_inverted_is_refused() {
    for depth in ["100.0", "900.0"] {
        check_design(&changed("depth_mm = 3.0", &format!("depth_mm = {depth}")), &["singular", "smaller depth"]);
    }
}

#[test]
fn the_papers_plan_has_no_joint_estimator() {
    let keys = "depth_mm = 3.0\n[algorithm]\nplan = \"paper\"\nestimator = \"joint\"\ngain = 1.1\nfriction_correction = [1, 0]";
    check_design(&changed("depth_mm = 3.0", keys), &["paper's plan has the line search only", "plan = \"reduced\""]);
}

#[test]
fn widths_resolve_the_noise_floor() {
    let text = "depth_mm = 3.0\n[algorithm]\nnoise_floor_pa = 0.5\n[hardware]\ndata_bits = 16\nfull_scale_pa = 1e6";
    check_design(&changed("depth_mm = 3.0", text), &["data_bits = 16", "noise floor of 0.5 Pa", "full_scale_pa"]);
}

#[test]
fn words_of_two_multipliers_have_their_plan_and_their_part() {
    let with = |keys: &str| changed("depth_mm = 3.0", &format!("depth_mm = 3.0\n{keys}"));
    let paper = with("[algorithm]\nplan = \"paper\"\n[hardware]\ndata_bits = 35");
    check_design(&paper, &["[hardware] data_bits = 35", "paper's plan", "data_bits = 27", "plan = \"reduced\""]);
    check_design(&with("[hardware]\ndata_bits = 28"), &["[hardware] data_bits = 28", "29 to 35, or 27"]);
    for key in ["coefficient_bits = 27", "data_bits = 35"] {
        let text = with(&format!("[hardware]\npart = \"LFE5U-85F-8BG756I\"\n{key}"));
        check_design(&text, &[&format!("[hardware] {key}"), "18 x 18", "coefficient_bits = 18 and data_bits = 27"]);
    }
}

#[test]
fn the_core_has_a_vendor_a_library_and_a_version() {
    for vlnv in ["acme:1.0", "acme:pads:1", "acme:pads:1.0.0", "a b:pads:1.0", ":pads:1.0"] {
        let text = changed("depth_mm = 3.0", &format!("depth_mm = 3.0\n[hardware]\nvlnv = \"{vlnv}\""));
        check_design(&text, &["hardware.vlnv", vlnv, "vendor:library:version", "example.org:sensors:1.2"]);
    }
    let folder = folder_with_design("vlnv = \"acme.com:pads:2.7\"");
    good(folder.path(), &["generate", "pad.toml", "--out", "out"]);
    let read = |file: &str| fs::read_to_string(folder.path().join("out").join(file)).unwrap();
    assert!(read("pad.core").contains("\nname: acme.com:pads:pad:2.7\n"));
    assert!(read("README.md").contains("acme.com:pads:pad"));
    let package = read("vivado/package_ip.tcl");
    assert!(package.contains("-vendor acme.com -library pads ") && package.contains("set_property version 2.7 $core"));
    assert!(read("vivado/block_design.tcl").contains("-vlnv acme.com:pads:$design:2.7 core"));
}

#[test]
fn a_geometry_that_amplifies_beyond_the_widths_is_refused() {
    let text = design_text("deep", [10, 10], [4.0, 4.0], 12.0, "");
    check_design(&text, &["data_bits = 27", "rounding alone", "condition number", "depth_mm", "regularisation"]);
    let text = design_text("deeper", [10, 10], [4.0, 4.0], 16.0, "");
    check_design(&text, &["condition number", "16 mm", "regularisation = { noise = 0.002 }"]);
}

#[test]
fn design_files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    for name in ["binary.toml", "missing.toml", "."] {
        for command in ["inspect", "generate"] {
            let message = refused(folder.path(), &[command, name]);
            assert!(message.contains(&format!("{name}: cannot read")), "{message}");
        }
    }
}

#[test]
fn new_refuses_bad_names_and_existing_files() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in ["module", "../x", "a\"b", "a b", "", "päd", "a\nb", "-"] {
        let message = refused(here, &["new", "--paper-sensor", "1", "--", name]);
        assert!(message.contains("name") && message.contains("Verilog"), "{message}");
    }
    fs::write(here.join("pad.toml"), "mine").unwrap();
    assert!(refused(here, &["new", "pad"]).contains("pad.toml: is there already"));
    assert!(refused(here, &["new", "pad", "--dir", "nowhere"]).contains("nowhere"));
    assert!(refused(here, &["new", "pad", "--dir", "pad.toml"]).contains("pad.toml"));
}

#[test]
fn folders_that_are_not_the_generators_are_left_alone() {
    let folder = folder_with_design("");
    let here = folder.path();
    fs::create_dir_all(here.join("mine/deeper")).unwrap();
    fs::write(here.join("mine/deeper/thesis.tex"), "years of work").unwrap();
    let message = refused(here, &["generate", "pad.toml", "--out", "mine"]);
    assert!(message.contains("mine: holds deeper/thesis.tex") && message.contains("--out"), "{message}");

    fs::write(here.join("file"), "mine").unwrap();
    assert!(refused(here, &["generate", "pad.toml", "--out", "file"]).contains("no folder"));
    assert!(refused(here, &["generate", "pad.toml", "--out", "file/below"]).contains("file"));
    assert!(refused(here, &["generate", "pad.toml", "--out", "."]).contains(".: holds file"));
    assert!(refused(&here.join("mine"), &["generate", "../pad.toml", "--out", ".."]).contains("..: holds file"));

    good(here, &["generate", "pad.toml", "--out", "out"]);
    fs::write(here.join("out/rtl/notes.txt"), "mine").unwrap();
    assert!(refused(here, &["generate", "pad.toml", "--out", "out"]).contains("rtl/notes.txt"));
    fs::remove_file(here.join("out/rtl/notes.txt")).unwrap();
    fs::write(here.join("out/rtl/pad.v"), "my better version").unwrap();
    assert!(refused(here, &["generate", "pad.toml", "--out", "out"]).contains("rtl/pad.v, which was changed"));
}

/// A folder in which nobody can create anything, on Linux not even root.
#[cfg(target_os = "linux")]
#[test]
fn folders_that_cannot_be_written() {
    let folder = folder_with_design("");
    let message = refused(folder.path(), &["generate", "pad.toml", "--out", "/proc/hdl-gen/out"]);
    assert!(message.contains("/proc/hdl-gen") && message.contains("choose another folder"), "{message}");
    assert!(
        refused(
            folder.path(),
            &["new", "other", "--paper-sensor", "1", "--columns", "4", "--rows", "4", "--dir", "/proc"]
        )
        .contains("/proc/other.toml")
    );
}

/// A disk that fills up is played by a limit on the size of files.
#[cfg(unix)]
#[test]
fn a_generation_that_fails_or_is_killed_midway_leaves_the_old_folder() {
    let folder = folder_with_design("lanes = 2\n[algorithm]\nplan = \"paper\"");
    let here = folder.path();
    good(here, &["generate", "pad.toml", "--out", "out"]);
    let before = contents(&here.join("out"));
    let larger = design_text("pad", [8, 8], [4.0, 2.0], 3.0, "");
    fs::write(here.join("pad.toml"), larger).unwrap();
    let generate = |preparation: &str| {
        let script = format!("{preparation}; exec \"$0\" generate pad.toml --out out");
        let program = env!("CARGO_BIN_EXE_sptfra");
        Command::new("sh").current_dir(here).args(["-c", &script, program]).output().unwrap()
    };
    let failed = generate("trap '' XFSZ; ulimit -f 8");
    let message = String::from_utf8(failed.stderr).unwrap();
    assert_eq!(failed.status.code(), Some(1), "{message}");
    assert!(message.starts_with("error: ") && message.contains("cannot write the file"), "{message}");
    assert_eq!(contents(&here.join("out")), before);
    let beside = fs::read_dir(here).unwrap().count();
    assert_eq!(beside, 2, "a failure leaves nothing beside the folder");

    let killed = generate("ulimit -f 8");
    assert!(killed.status.code().is_none_or(|code| code > 1), "killed by a signal");
    assert_eq!(contents(&here.join("out")), before);
    let done = generate("true");
    assert!(done.status.success());
    assert_ne!(contents(&here.join("out")), before);
}

#[test]
fn a_board_is_one() {
    let folder = folder_with_design("");
    let text = include_str!("../../../hdl-gen/boards/zcu102.toml");
    let check = |name: &str, from: &str, to: &str, parts: &[&str]| {
        assert!(text.contains(from), "{from}");
        fs::write(folder.path().join(name), text.replacen(from, to, 1)).unwrap();
        let message = refused(folder.path(), &["generate", "pad.toml", "--board", name]);
        for part in parts.iter().chain(&[name]) {
            assert!(message.contains(part), "no {part:?} in: {message}");
        }
    };
    check("Mine.toml", "dsp", "dsp", &["file name", "small letters"]);
    check("zcu104.toml", "dsp", "dsp", &["file name", "already", "another name"]);
    check("queue.toml", "dsp", "dsp", &["file name", "already"]);
    check("mine.toml", "dsp = ", "colour = 3\ndsp = ", &["line", "colour", "dsp"]);
    check("mine.toml", "dsp = 2520", "", &["missing key `dsp`", "zcu102.toml"]);
    check("mine.toml", "dsp = 2520", "dsp = 0", &["dsp", "data sheet"]);
    check("mine.toml", "dsp = 2520", "dsp = ", &["line"]);
    check("mine.toml", "title = \"", "title = \"$[exit]", &["title", "plain letters"]);
    check("mine.toml", "dsp = ", "connection = \"[x]\"\ndsp = ", &["connection", "plain letters"]);
    check("mine.toml", "part = \"", "part = \"x y", &["part", "plain letters"]);
    check("mine.toml", "zynq_ultra_ps_e", "zynq", &["zynq_ultra_ps_e", "processing_system7"]);
    check("mine.toml", "0xA0000000", "0xA0000100", &["registers", "0x10000"]);
    check("mine.toml", "0xA0000000", "0xFFFF0000", &["registers", "0x10000"]);
    let missing = refused(folder.path(), &["generate", "pad.toml", "--board", "none.toml"]);
    assert!(missing.contains("none.toml: ") && missing.contains("give the path"), "{missing}");
    fs::write(folder.path().join("mine.toml"), text).unwrap();
    fs::create_dir(folder.path().join("there")).unwrap();
    fs::write(folder.path().join("there/mine.toml"), text).unwrap();
    let twice = ["generate", "pad.toml", "--board", "mine.toml", "--board", "there/mine.toml"];
    assert!(refused(folder.path(), &twice).contains("two files are named mine"));
}
