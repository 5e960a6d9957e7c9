//! `sptfra solve` as a filter: a line in, a line out, at once.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Stdio;

use super::{HEADER, folder_with, row};
use crate::support::{program, sptfra, text, workspace};

#[test]
fn a_line_in_is_a_line_out_before_the_next_one() {
    let design = workspace("golden/tests/designs/small.toml");
    let mut filter = program()
        .args(["solve", text(&design), "--frames", "-", "--out", "-", "--labels", "1"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = filter.stdin.take().unwrap();
    let mut lines = BufReader::new(filter.stdout.take().unwrap()).lines();
    let mut line = || lines.next().unwrap().unwrap();
    // The header comes before any frame does.
    assert_eq!(line(), HEADER);
    let (folder, frames) = folder_with("");
    let forces = folder.path().join("forces.csv");
    for value in ["-1000.0", "-2000.0", "0"] {
        writeln!(input, "# a remark\n\nlabel,{}", row(value)).unwrap();
        input.flush().unwrap();
        let said = line();
        std::fs::write(&frames, row(value)).unwrap();
        let output = sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", text(&forces)]);
        assert!(output.status.success(), "{output:?}");
        let expected = std::fs::read_to_string(&forces).unwrap();
        assert_eq!(Some(said.as_str()), expected.lines().nth(1));
    }
    // What is wrong with a line says where, and ends the filter after what was good.
    writeln!(input, "label,1,2").unwrap();
    drop(input);
    let output = filter.wait_with_output().unwrap();
    assert!(!output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("error: standard input, line 10: the line ends at column 3 where 13"), "{said}");
}

/// In kilopascals: after the first frames of a stream, and of a file before them.
#[test]
fn frames_that_look_wrong_are_told_of_on_the_way() {
    let design = workspace("golden/tests/designs/small.toml");
    let frames: String = (0..40).map(|_| row("-1.0") + "\n").collect();
    let (_folder, file) = folder_with(&frames);
    for (from, piped) in [("-", Stdio::from(std::fs::File::open(&file).unwrap())), (text(&file), Stdio::null())] {
        let output =
            program().args(["solve", text(&design), "--frames", from, "--out", "-"]).stdin(piped).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.matches("warning: the largest reading").count() == 1, "{said}");
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 41);
    }
    let refused = sptfra(&["check", text(&design), "--frames", "-"]);
    assert!(!refused.status.success());
    assert!(String::from_utf8(refused.stderr).unwrap().contains("write them into a file first"));
}

/// The numbers of columns above the frames are no frame; a note says so, once.
#[test]
fn numbers_of_columns_are_told_of() {
    let design = workspace("golden/tests/designs/small.toml");
    let numbers: Vec<String> = (0..12).map(|number| number.to_string()).collect();
    let (_folder, file) = folder_with(&format!("{}\n{1}\n{1}\n", numbers.join(","), row("-1000.5")));
    for (from, piped) in [("-", Stdio::from(std::fs::File::open(&file).unwrap())), (text(&file), Stdio::null())] {
        let output =
            program().args(["solve", text(&design), "--frames", from, "--out", "-"]).stdin(piped).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.matches("line 1: numbers up to 11").count() == 1 && said.contains("note: "), "{said}");
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 3);
    }
}

/// Who opens a port while a frame goes through it gets the end of one.
#[test]
fn a_first_line_that_is_cut_off_is_passed_over() {
    let design = workspace("golden/tests/designs/small.toml");
    for (lines, good) in [
        (format!("3,-4.5\n{0}\n{0}\n", row("-1000.5")), true),
        (format!("0.5e,{0}\n{0}\n{0}\n", row("-1000.5")), true),
        (format!("{0}\n3,-4.5\n{0}\n", row("-1000.5")), false),
        (format!("{0},7\n{0}\n", row("-1000.5")), false),
        ("3,-4.5\n".to_owned(), false),
        (format!("3,-4.5\n3,-4.5\n{}\n", row("-1000.5")), false),
    ] {
        let (_folder, file) = folder_with(&lines);
        let output = program()
            .args(["solve", text(&design), "--frames", "-", "--out", "-"])
            .stdin(Stdio::from(std::fs::File::open(&file).unwrap()))
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.success(), good, "{lines}{said}");
        let forces = String::from_utf8(output.stdout).unwrap().lines().count() - 1;
        let first_is_good = lines.starts_with(&(row("-1000.5") + "\n"));
        assert_eq!(forces, if good { 2 } else { usize::from(first_is_good) }, "{lines}");
        assert_eq!(said.contains("line 1") && said.contains("passed over"), good || lines.starts_with('3'), "{said}");
    }
}

#[test]
fn a_file_goes_to_standard_output_as_to_a_file() {
    let design = workspace("golden/tests/designs/small.toml");
    let (folder, frames) = folder_with(&format!("{}\n{}\n", row("-1000.0"), row("-10.5")));
    let forces = folder.path().join("forces.csv");
    let solve = |out: &str, more: &[&str]| {
        sptfra(&[&["solve", text(&design), "--frames", text(&frames), "--out", out, "--field"], more].concat())
    };
    assert!(solve(text(&forces), &[]).status.success());
    let output = solve("-", &[]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), std::fs::read_to_string(&forces).unwrap());
    let said = String::from_utf8(solve("-", &["--json"]).stderr).unwrap();
    assert!(said.contains("standard output has the forces alone"), "{said}");
    let output = sptfra(&["solve", text(&design), "--frames", "-", "--out", text(&forces)]);
    assert!(!output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("write --out - too"));
}

/// Frames that say above them which sensor they are of go through its design and no other, from a pipe and from a file.
#[test]
fn piped_frames_of_another_sensor_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let design = workspace("golden/tests/designs/small.toml");
    let wider = folder.path().join("wider.toml");
    let text_of = std::fs::read_to_string(&design).unwrap();
    let mut table = toml::from_str::<toml::Table>(&text_of).unwrap();
    table["sensor"]["pitch_mm"] = toml::Value::from(vec![7.0, 5.0]);
    std::fs::write(&wider, toml::to_string(&table).unwrap()).unwrap();
    let frames = sptfra(&["scene", "--design", text(&design), "--out", "-"]).stdout;
    let file = folder.path().join("redirected.csv");
    std::fs::write(&file, &frames).unwrap();
    let solve = |design: &Path, from: &str| {
        let mut child = program()
            .args(["solve", text(design), "--frames", from, "--out", "-"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // The other end may be closed before all is written: it has seen enough.
        let _ = child.stdin.take().unwrap().write_all(&frames);
        child.wait_with_output().unwrap()
    };
    for (from, place) in [("-", "standard input, line 1"), (text(&file), "redirected.csv, line 1")] {
        let output = solve(&design, from);
        assert!(output.status.success(), "{output:?}");
        let output = solve(&wider, from);
        let said = String::from_utf8(output.stderr).unwrap();
        // The header at most, and no forces.
        assert!(!output.status.success() && String::from_utf8_lossy(&output.stdout).lines().count() <= 1, "{said}");
        for part in [place, "7 x 5 mm", "sptfra scene --design"] {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
    }
}

/// Frames of a scene, made and solved without a file.
#[test]
fn frames_of_a_scene_go_through_a_pipe() {
    let design = workspace("golden/tests/designs/small.toml");
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("made.csv");
    assert!(sptfra(&["scene", "--design", text(&design), "--out", text(&made)]).status.success());
    let piped =
        program().args(["scene", "--design", text(&design), "--out", "-"]).current_dir(folder.path()).output().unwrap();
    assert!(piped.status.success() && piped.stderr.is_empty(), "{piped:?}");
    // A remark above the frames in place of the file beside them.
    let (remark, frames) = piped.stdout.split_at(piped.stdout.iter().position(|&byte| byte == b'\n').unwrap() + 1);
    assert!(remark.starts_with(b"# sensor = {"), "{}", String::from_utf8_lossy(remark));
    assert_eq!(frames, std::fs::read(&made).unwrap());
    // The frames' own file and the two beside it, and none of the pipe.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    for (options, part) in [(["-", "--json"], "--json and --out -"), (["x.npz", "--json"], "the ending .npy")] {
        let output = sptfra(&[&["scene", "--design", text(&design), "--out"][..], &options].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(part), "{said}");
    }
}
