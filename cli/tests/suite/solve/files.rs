//! Files that are not what a command takes, and files that are there already.

use std::fs;
use std::path::Path;

use golden::frames::{read_recording, write_frames};
use tempfile::TempDir;

use super::{folder_with, line_of, row};
use crate::support::{sptfra, text, workspace};

#[test]
fn bad_frames_get_one_message_and_no_output() {
    let good = row("-1.5");
    for (frames, parts) in [
        (format!("{good}\n-1,-2,-3\n"), vec!["line 2", "column 3", "12 values"]),
        (format!("{good},-7\n"), vec!["line 1", "column 13", "12 values"]),
        (format!("{good}\n{}\n", good.replacen("-1.5", "abc", 1)), vec!["line 2", "column 1", "abc"]),
        (format!("{good}\n\n{}\n", row("NaN")), vec!["line 3", "column 1", "NaN"]),
        (row("inf"), vec!["line 1", "column 1", "inf"]),
        (row("1e999"), vec!["line 1", "column 1", "1e999"]),
        (good.replacen("-1.5", "", 1), vec!["line 1", "column 1", "\"\""]),
        (String::new(), vec!["no frame"]),
    ] {
        let (folder, path) = folder_with(&frames);
        let out = folder.path().join("out.csv");
        let design = workspace("golden/tests/designs/small.toml");
        let output = sptfra(&["solve", text(&design), "--frames", text(&path), "--out", text(&out)]);
        assert!(!output.status.success(), "{frames}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("frames.csv"), "{said}");
        for part in parts {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(!out.exists());
    }
}

#[cfg(unix)]
#[test]
fn forces_go_to_a_pipe_or_a_device() {
    let (folder, frames) = folder_with(&row("-1000.5"));
    let design = workspace("golden/tests/designs/small.toml");
    let solve = |out: &str| sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", out]);
    let file = folder.path().join("forces.csv");
    assert!(solve(text(&file)).status.success());
    // Standard output is a pipe here.
    let output = solve("/dev/stdout");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains(&fs::read_to_string(&file).unwrap()), "{said}");
    assert!(solve("/dev/null").status.success());
    let output = solve(text(folder.path()));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && said.contains("folder"), "{said}");
}

#[test]
fn frames_that_are_no_text() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    fs::write(&path, [0xff, 0xfe, b',', b'1', b'\n']).unwrap();
    let error = read_recording(&path, &line_of(2), 0).unwrap_err().to_string();
    assert!(error.contains("line 1, column 1"), "{error}");
}

#[test]
fn frames_read_back_to_the_bit() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    let frames = vec![vec![-0.1, 1.0 / 3.0, 1e-300], vec![-0.0, 123_456_789.123, f64::from(f32::MAX)]];
    write_frames(&path, &frames).unwrap();
    let again = read_recording(&path, &line_of(3), 0).unwrap().frames;
    let array = path.with_extension("npy");
    write_frames(&array, &frames).unwrap();
    assert!(fs::read(&array).unwrap().starts_with(b"\x93NUMPY"));
    assert_eq!(read_recording(&array, &line_of(3), 0).unwrap().frames, again);
    let bits = |frames: &[Vec<f64>]| -> Vec<u64> { frames.iter().flatten().map(|value| value.to_bits()).collect() };
    assert_eq!(bits(&again), bits(&frames));

    // The sensor's stream is float32: what does not fit there is no stress.
    write_frames(&path, &[vec![0.0, 1e39, 0.0]]).unwrap();
    let error = read_recording(&path, &line_of(3), 0).unwrap_err().to_string();
    assert!(error.contains("line 1, column 2"), "{error}");
}

#[test]
fn other_bad_input() {
    let (folder, frames) = folder_with(&row("-900"));
    let design = workspace("golden/tests/designs/small.toml");
    let out = folder.path().join("out.csv");
    let nowhere = folder.path().join("no/such/out.csv");
    let reference = folder.path().join("reference.csv");
    fs::write(&reference, "0,1,2,-3,0.5,0,0.5,0\n0,1,2,-3,0.5,0,0.5,0\n").unwrap();
    let [design, frames, out, nowhere, reference] =
        [&design, &frames, &out, &nowhere, &reference].map(|path| text(path));
    let dir = text(folder.path());
    for (arguments, part) in [
        (vec!["solve", "absent.toml", "--frames", frames, "--out", out], "absent.toml"),
        (vec!["solve", design, "--frames", "absent.csv", "--out", out], "absent.csv"),
        (vec!["solve", design, "--frames", frames, "--out", nowhere], "out.csv"),
        (vec!["solve", design, "--frames", frames, "--out", dir], "it is a folder"),
        (vec!["solve", design, "--frames", frames, "--out", out, "--reference", reference], "2 frames"),
        (vec!["scene", design, "--out", out], "small.toml"),
    ] {
        let output = sptfra(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.starts_with("error: "), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(!Path::new(out).exists(), "{arguments:?}");
    }
    assert!(folder.path().is_dir());
}

#[test]
fn an_old_file_is_replaced_whole() {
    let (folder, frames) = folder_with(&row("-900"));
    let out = folder.path().join("out.csv");
    fs::write(&out, "old\n".repeat(1000)).unwrap();
    let design = workspace("golden/tests/designs/small.toml");
    let output = sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(output.status.success());
    assert_eq!(fs::read_to_string(&out).unwrap().lines().count(), 2);
}

#[test]
fn an_input_is_never_overwritten() {
    let (_folder, frames) = folder_with(&row("-900"));
    let before = fs::read(&frames).unwrap();
    let design = workspace("golden/tests/designs/small.toml");
    let output = sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", text(&frames)]);
    assert!(!output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("overwrite the input"), "{said}");
    assert_eq!(fs::read(&frames).unwrap(), before);
}

/// Frames are not taken for true forces, nor those of another sensor: the errors would be of thousands of percent.
#[test]
fn what_is_no_reference_is_refused() {
    let folder = TempDir::new().unwrap();
    let design = workspace("golden/tests/designs/small.toml");
    let [frames, out] = ["frames.csv", "out.csv"].map(|name| folder.path().join(name));
    let made = sptfra(&["scene", "--design", text(&design), "--out", text(&frames)]);
    assert!(made.status.success(), "{made:?}");
    let solve = |reference: &Path| {
        let given = ["--frames", text(&frames), "--reference", text(reference), "--out", text(&out)];
        let output = sptfra(&[&["solve", text(&design)], &given[..]].concat());
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    };
    assert!(solve(&folder.path().join("frames.forces.csv")).0);
    let long = folder.path().join("long.csv");
    let rows = 36;
    let file = |line: String| fs::write(&long, (line + "\n").repeat(rows)).unwrap();
    for (line, why) in [
        (vec!["-120.5"; 13].join(","), "is no status"),
        (["70000", "1", "1", "-3", "0.5", "0.1"].join(",") + ",0,0,0,0,0,0,1", "is no status"),
        (["0", "1", "1", "-3", "-0.5", "0.1"].join(",") + ",0,0,0,0,0,0,1", "is negative"),
        (["0", "1", "1", "-3", "0.5", "40"].join(",") + ",0,0,0,0,0,0,1", "is no angle"),
    ] {
        file(line);
        let (good, said) = solve(&long);
        assert!(!good && said.contains("long.csv, line 1") && said.contains(why), "{said}");
    }
    // Forces of a sensor that is not the design's.
    let other = folder.path().join("other.csv");
    let made = sptfra(&["scene", text(&workspace("scenes/sensor1-hertz.toml")), "--out", text(&other)]);
    assert!(made.status.success(), "{made:?}");
    let (good, said) = solve(&folder.path().join("other.forces.csv"));
    assert!(!good && said.contains("other.sensor.toml"), "{said}");
}

#[test]
fn files_of_other_programs_get_a_word_of_what_to_do() {
    let design = workspace("golden/tests/designs/small.toml");
    for (begin, part) in [
        (&b"PK\x03\x04"[..], "numpy.save(\"frames.npy\", numpy.load(\"frames.npz\")[\"NAME\"])"),
        (b"\x89HDF\r\n\x1a\n", "HDF5"),
        (b"MATLAB 5.0 MAT-file", "writematrix"),
        (b"\x1f\x8b\x08", "gunzip"),
    ] {
        let (_folder, file) = folder_with("");
        fs::write(&file, begin).unwrap();
        let output = sptfra(&["check", text(&design), "--frames", text(&file)]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.lines().count() == 1, "{said}");
        assert!(said.contains("frames.csv: the file is ") && said.contains(part), "{said}");
    }
}
