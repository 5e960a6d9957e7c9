//! What people look at: waveforms with their views, a frame in the terminal, completions, manual pages.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").join(path)
}

fn testbench(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_testbench")).args(arguments).current_dir(folder).output().expect("starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// Path and range of every signal in a VCD file.
fn signals(vcd: &str) -> BTreeMap<String, String> {
    let mut scopes = Vec::new();
    let mut found = BTreeMap::new();
    for line in vcd.lines().take_while(|line| !line.contains("$enddefinitions")) {
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["$scope", _, name, "$end"] => scopes.push(name.to_owned()),
            ["$upscope", ..] => drop(scopes.pop()),
            ["$var", _, _, _, name, ref range @ .., "$end"] => {
                found.insert(format!("{}.{name}", scopes.join(".")), range.concat());
            }
            _ => {}
        }
    }
    found
}

#[test]
fn every_signal_of_the_views_is_in_the_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("frames.csv"), [["-10.5"; 12].join(","), ["-20,0,7"; 4].join(",")].join("\n"))
        .unwrap();
    let reduced = fs::read_to_string(workspace("designs/small-control.toml")).expect("a design");
    let paper =
        reduced.replace("control = true\n", "").replace("kernel = \"point\"", "kernel = \"point\"\nplan = \"paper\"");
    for (name, design, least) in [("reduced", &reduced, 45), ("paper", &paper, 20)] {
        fs::write(folder.path().join("design.toml"), design).expect("written");
        let trace = format!("{name}.vcd");
        let ran = testbench(folder.path(), &["run", "design.toml", "--frames", "frames.csv", "--trace", &trace]);
        let said = text(&ran.stdout);
        assert!(ran.status.success(), "{said}{}", text(&ran.stderr));
        assert!(said.contains(&format!("gtkwave {name}.gtkw, or surfer --command-file {name}.sucl")), "{said}");
        let read = |ending: &str| fs::read_to_string(folder.path().join(format!("{name}.{ending}"))).expect("written");
        let there = signals(&read("vcd"));
        let gtkwave = read("gtkw");
        assert!(gtkwave.starts_with(&format!("[dumpfile] \"{trace}\"\n")), "{gtkwave}");
        let named: Vec<&str> = gtkwave.lines().filter(|line| line.starts_with("top.")).collect();
        for signal in &named {
            let (path, range) = signal.find('[').map_or((*signal, ""), |at| signal.split_at(at));
            assert_eq!(there.get(path).map(String::as_str), Some(range), "{signal}");
        }
        assert!(named.len() >= least, "{named:?}");
        let surfer = read("sucl");
        assert!(surfer.starts_with(&format!("load_file {trace}\n")) && surfer.ends_with("zoom_fit\n"), "{surfer}");
        let added: Vec<&str> = surfer.lines().filter_map(|line| line.strip_prefix("variable_add ")).collect();
        assert!(added.iter().all(|path| there.contains_key(*path)), "{added:?}");
        assert_eq!(added.len(), named.len());
        for end in ["aclk", "s_axis_tvalid", "s_axis_tready", "m_axis_tvalid", "m_axis_tready", "frame_ready"] {
            assert!(added.iter().any(|path| path.ends_with(&format!(".{end}"))), "{end} in {added:?}");
        }
        let starts: &[&str] = if name == "paper" { &["frame_start", "co_start", "op_start"] } else { &["core.start"] };
        assert!(starts.iter().all(|start| added.iter().any(|path| path.ends_with(&format!(".{start}")))), "{added:?}");
    }
}

#[test]
fn a_frame_is_shown_plainly_where_there_is_no_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = workspace("designs/small.toml").display().to_string();
    let ran = testbench(folder.path(), &["view", &design, "--frame", "9"]);
    let page = text(&ran.stdout);
    assert!(ran.status.success() && ran.stderr.is_empty(), "{}", text(&ran.stderr));
    assert!(page.starts_with("small_4x3, frame 9 of the sensor's standing scene\n"), "{page}");
    assert!(!page.contains('\x1b') && page.lines().count() == 8, "{page}");
    // Three rows of four taxels, the last row first; the largest force has a nine.
    let rows: Vec<&str> = page.lines().skip(4).collect();
    assert!(rows[0].starts_with("  2 ") && rows[2].starts_with("  0 ") && rows[3].ends_with("3 "), "{page}");
    assert!(rows[..3].iter().any(|row| row.contains('9')), "{page}");
    assert!(rows[..3].iter().all(|row| row.split_whitespace().count() == 5), "{page}");
    // Another frame, pushed another way, looks different.
    assert_ne!(
        page.replace("frame 9", ""),
        text(&testbench(folder.path(), &["view", &design]).stdout).replace("frame 0", "")
    );
    let refused = testbench(folder.path(), &["view", &design, "--frame", "36"]);
    let message = text(&refused.stderr);
    assert!(!refused.status.success() && refused.stdout.is_empty());
    assert_eq!(message, "error: --frame 36: the sensor's standing scene has 36 frames; choose 0 to 35\n");
}

#[test]
fn completions_and_manual_know_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let completions = testbench(folder.path(), &["completions", "bash"]);
    let script = text(&completions.stdout);
    assert!(completions.status.success() && script.contains("testbench") && script.contains("--trace"), "{script}");
    fs::write(folder.path().join("testbench.bash"), &script).expect("written");
    let shell = Command::new("bash").args(["-n", "testbench.bash"]).current_dir(folder.path()).status().expect("bash");
    assert!(shell.success());
    assert!(testbench(folder.path(), &["man", "--out", "pages"]).status.success());
    for page in ["testbench", "testbench-run", "testbench-view", "testbench-bench", "testbench-completions"] {
        let text = fs::read_to_string(folder.path().join("pages").join(format!("{page}.1"))).expect(page);
        assert!(text.contains(".TH ") && text.contains(".SH NAME"), "{page}");
    }
}
