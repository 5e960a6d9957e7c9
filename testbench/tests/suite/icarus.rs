//! A second opinion: the emitted testbench in Icarus Verilog, whose registers and memories start unknown and which
//! carries unknown bits wherever they go.

use std::collections::BTreeMap;
use std::fs;

use crate::support::effort::some_of;
use crate::support::{by_plan, icarus, icarus_runtime, in_parallel, planned, shipped, with_joint, with_lanes};
use golden::design::{Design, Outputs, PlanKind};
use hdl_gen::emit::emit;

type Files = BTreeMap<String, Vec<u8>>;

fn emitted(design: &Design) -> Files {
    emit(&planned(design)).expect("emitted")
}

/// Compiles the design with its testbench and runs it; what it printed.
fn simulate(name: &str, files: &Files) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let mut compiler = icarus();
    compiler.args(["-Wall", "-g2005", "-DSIMULATION", "-o", "simulation", "-s", &format!("{name}_tb")]);
    // Strings go in with their quotes.
    let data =
        [("ROM_DIR", "rom/".to_owned()), ("STIMULUS", file(name, "stimulus")), ("EXPECTED", file(name, "expected"))];
    for (parameter, value) in data {
        compiler.arg(format!("-P{name}_tb.{parameter}=\"{value}\""));
    }
    for (path, contents) in files {
        let place = folder.path().join(path);
        fs::create_dir_all(place.parent().expect("a file has a folder")).expect("writable");
        fs::write(&place, contents).expect("writable");
        let verilog = place.extension().is_some_and(|ending| ending == "v");
        if verilog && (path.starts_with("rtl/") || path.starts_with("sim/")) {
            compiler.arg(path);
        }
    }
    let compiled = compiler.current_dir(&folder).output().expect("starts");
    assert!(compiled.status.success() && compiled.stderr.is_empty(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let mut runtime = icarus_runtime();
    let ran = runtime.args(["-n", "simulation"]).current_dir(&folder).output().expect("starts");
    [ran.stdout, ran.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat()
}

fn file(name: &str, contents: &str) -> String {
    format!("sim/{name}_{contents}.mem")
}

/// The words of the expected answers, a line each.
fn expected(name: &str, files: &Files) -> Vec<String> {
    let text = String::from_utf8(files[&file(name, "expected")].clone()).expect("UTF-8");
    text.lines().map(str::to_owned).collect()
}

#[test]
fn icarus_gives_every_word_of_the_model() {
    let mut narrow = with_lanes(shipped("small"), 3);
    narrow.name = "narrow".to_owned();
    narrow.hardware.coefficient_bits = 8;
    narrow.hardware.data_bits = 16;
    let mut tiny = with_lanes(shipped("small"), 64);
    (tiny.sensor.columns, tiny.sensor.rows) = (2, 2);
    let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
    // Odd sides, a pitch that is not square; and a square one, where one matrix serves both directions.
    let odd = with_lanes(shipped("odd"), 8);
    let mut square = shipped("small");
    (square.sensor.columns, square.sensor.rows) = (5, 5);
    let designs = [
        by_plan(shipped("small"), paper, Outputs::Field),
        by_plan(narrow, paper, Outputs::Field),
        by_plan(tiny.clone(), paper, Outputs::Field),
        shipped("odd"),
        by_plan(odd, reduced, Outputs::Resultants),
        with_joint(Design { name: "joint".to_owned(), ..square.clone() }),
        by_plan(square, reduced, Outputs::Field),
        by_plan(tiny, reduced, Outputs::Field),
        by_plan(shipped("small"), reduced, Outputs::Field),
    ];
    in_parallel(&some_of(&designs), |design| {
        let files = emitted(design);
        let said = simulate(&design.name, &files);
        // Four directions, and one frame each that is empty, has a NaN, and is short.
        let frames = 7;
        let words = frames * planned(design).words_out();
        assert_eq!(expected(&design.name, &files).len(), words);
        assert!(said.starts_with(&format!("PASS: {frames} frames, {words} words, ")), "{}: {said}", design.name);
    });
}

#[test]
fn the_frames_of_the_testbench_are_of_every_kind() {
    let design = shipped("small");
    let words = expected(&design.name, &emitted(&design));
    let frames: Vec<&[String]> = words.chunks(planned(&design).words_out()).collect();
    let statuses: Vec<&str> = frames.iter().map(|frame| frame[0].as_str()).collect();
    assert_eq!(
        statuses,
        ["000000000", "000010001", "000020000", "000030010", "000040000", "000050020", "000060000"],
        "frame counter and status"
    );
    for frame in frames {
        let (last, others) = frame.split_last().expect("a word");
        assert!(last.starts_with('1') && others.iter().all(|word| word.starts_with('0')), "TLAST ends the frame");
    }
}

/// The testbench fails for one wrong bit, for a word too many and for a word too few, and counts.
#[test]
fn a_difference_fails() {
    let design = shipped("small");
    let name = design.name.as_str();
    let files = emitted(&design);
    let right = expected(name, &files);
    let with = |words: &[String]| {
        let mut changed = files.clone();
        changed.insert(file(name, "expected"), words.iter().flat_map(|word| [word, "\n"]).collect::<String>().into());
        simulate(name, &changed)
    };
    let mut flipped = right.clone();
    let bit = u64::from_str_radix(&flipped[100], 16).expect("hexadecimal") ^ 1;
    flipped[100] = format!("{bit:09x}");
    let said = with(&flipped);
    assert!(said.contains("word 48 of frame 1: expected") && said.contains("FAIL: 1 words wrong"), "{said}");
    assert!(!said.contains("PASS"), "{said}");

    let mut swapped = right;
    swapped.swap(0, 51);
    let said = with(&swapped);
    assert!(said.contains("FAIL: 2 words wrong"), "{said}");

    // The input is never taken.
    let mut deaf = files.clone();
    let top = format!("rtl/{name}.v");
    let text = String::from_utf8(deaf[&top].clone()).expect("UTF-8");
    deaf.insert(top.clone(), text.replace(".m_tready (in_tready)", ".m_tready (1'b0)").into());
    let said = simulate(name, &deaf);
    assert!(said.contains("FAIL: 0 words wrong, 0 received"), "{said}");

    // A packet that does not end, and one that ends early.
    let ends = |last: &str| {
        let mut other = files.clone();
        let text = String::from_utf8(files[&top].clone()).expect("UTF-8").replace("(m_axis_tlast)", "()");
        other.insert(
            top.clone(),
            text.replace("endmodule", &format!("assign m_axis_tlast = {last};\nendmodule")).into(),
        );
        simulate(name, &other)
    };
    let said = ends("1'b0");
    assert!(said.contains("; frame 0 has 364 words, 312 too many"), "{said}");
    let said = ends("1'b1");
    assert!(said.contains("; frame 0 has 1 words, 51 too few"), "{said}");
}
