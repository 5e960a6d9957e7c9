//! What people look at: waveforms with their views, a frame in the terminal, completions, manual pages.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

use fst_reader::{FstHierarchyEntry, FstReader};
use golden::forces::write_reference;
use golden::frames::write_frames;
use golden::scene::Scene;
use testbench::verilate::Trace;

use crate::support::{shipped, sptfra_in, workspace};

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

/// Path and range of every signal in an FST file.
fn signals_of_fst(file: &Path) -> BTreeMap<String, String> {
    let mut reader = FstReader::open(BufReader::new(File::open(file).expect("written"))).expect("an FST file");
    let mut scopes = Vec::new();
    let mut found = BTreeMap::new();
    reader
        .read_hierarchy(|entry| match entry {
            FstHierarchyEntry::Scope { name, .. } => scopes.push(name),
            FstHierarchyEntry::UpScope => drop(scopes.pop()),
            FstHierarchyEntry::Var { name, length, .. } => {
                let range = if length == 1 { String::new() } else { format!("[{}:0]", length - 1) };
                // The range stands behind the name too.
                let name = name.split(' ').next().unwrap_or_default();
                found.insert(format!("{}.{name}", scopes.join(".")), range);
            }
            _ => {}
        })
        .expect("a hierarchy");
    found
}

/// Two frames for the 4 by 3 designs.
fn two_frames(folder: &Path) {
    fs::write(folder.join("frames.csv"), [["-10.5"; 12].join(","), ["-20,0,7"; 4].join(",")].join("\n")).unwrap();
}

/// The signals that the `GTKWave` view names, each of which must be in the trace.
fn named_by_gtkwave<'a>(view: &'a str, there: &BTreeMap<String, String>) -> Vec<&'a str> {
    let named: Vec<&str> = view.lines().filter(|line| line.starts_with("top.")).collect();
    for signal in &named {
        let (path, range) = signal.find('[').map_or((*signal, ""), |at| signal.split_at(at));
        assert_eq!(there.get(path).map(String::as_str), Some(range), "{signal}");
    }
    named
}

#[test]
fn a_trace_is_fst_unless_its_name_says_otherwise_and_has_every_signal_of_the_views() {
    assert_eq!(Trace::best(), Trace::Fst, "FST needs the headers of zlib and LZ4: run `make tools`");
    let folder = tempfile::tempdir().expect("a folder");
    two_frames(folder.path());
    let design = workspace("designs/small-control.toml").display().to_string();
    let ran = sptfra_in(folder.path(), &["run", &design, "--frames", "frames.csv", "--trace"]);
    assert!(ran.status.success(), "{}{}", text(&ran.stdout), text(&ran.stderr));
    let there = signals_of_fst(&folder.path().join("small_control.fst"));
    let gtkwave = fs::read_to_string(folder.path().join("small_control.gtkw")).expect("written");
    assert!(gtkwave.starts_with("[dumpfile] \"small_control.fst\"\n"), "{gtkwave}");
    let named = named_by_gtkwave(&gtkwave, &there);
    assert!(named.len() >= 45, "{named:?}");
    let surfer = fs::read_to_string(folder.path().join("small_control.sucl")).expect("written");
    let added: Vec<&str> = surfer.lines().filter_map(|line| line.strip_prefix("variable_add ")).collect();
    assert!(added.len() == named.len() && added.iter().all(|path| there.contains_key(*path)), "{added:?}");
}

#[test]
fn every_signal_of_the_views_is_in_the_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    two_frames(folder.path());
    let reduced = fs::read_to_string(workspace("designs/small-control.toml")).expect("a design");
    let paper = reduced.replace("control = true\n", "").replace("plan = \"reduced\"", "plan = \"paper\"");
    for (name, design, least) in [("reduced", &reduced, 45), ("paper", &paper, 20)] {
        fs::write(folder.path().join("design.toml"), design).expect("written");
        let trace = format!("{name}.vcd");
        let ran = sptfra_in(folder.path(), &["run", "design.toml", "--frames", "frames.csv", "--trace", &trace]);
        let said = text(&ran.stdout);
        assert!(ran.status.success(), "{said}{}", text(&ran.stderr));
        assert!(said.contains(&format!("gtkwave {name}.gtkw, or surfer --command-file {name}.sucl")), "{said}");
        let read = |ending: &str| fs::read_to_string(folder.path().join(format!("{name}.{ending}"))).expect("written");
        let there = signals(&read("vcd"));
        let gtkwave = read("gtkw");
        assert!(gtkwave.starts_with(&format!("[dumpfile] \"{trace}\"\n")), "{gtkwave}");
        let named = named_by_gtkwave(&gtkwave, &there);
        assert!(named.len() >= least, "{named:?}");
        let surfer = read("sucl");
        assert!(surfer.starts_with(&format!("load_file {trace}\n")) && surfer.ends_with("zoom_fit\n"), "{surfer}");
        let added: Vec<&str> = surfer.lines().filter_map(|line| line.strip_prefix("variable_add ")).collect();
        assert!(added.iter().all(|path| there.contains_key(*path)), "{added:?}");
        assert_eq!(added.len(), named.len());
        for end in ["aclk", "s_axis_tvalid", "s_axis_tready", "m_axis_tvalid", "m_axis_tready", "frame_ready"] {
            assert!(added.iter().any(|path| path.ends_with(&format!(".{end}"))), "{end} in {added:?}");
        }
        for signal in ["start", "result_row", "taxel_u", "answer_valid", "friction_known", "we_write", "co_write"] {
            assert!(added.iter().any(|path| path.ends_with(&format!(".{signal}"))), "{signal} in {added:?}");
        }
    }
}

#[test]
fn a_frame_is_shown_plainly_where_there_is_no_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = workspace("golden/tests/designs/small.toml").display().to_string();
    let ran = sptfra_in(folder.path(), &["view", &design, "--frame", "9"]);
    let page = text(&ran.stdout);
    assert!(ran.status.success() && ran.stderr.is_empty(), "{}", text(&ran.stderr));
    assert!(page.starts_with("small_4x3, frame 9 of the simulated contact\n"), "{page}");
    assert!(!page.contains('\x1b') && page.lines().count() == 8, "{page}");
    // Three rows of four taxels, the last row first; the largest force has a nine.
    let rows: Vec<&str> = page.lines().skip(4).collect();
    assert!(rows[0].starts_with("  2 ") && rows[2].starts_with("  0 ") && rows[3].ends_with("3 "), "{page}");
    assert!(rows[..3].iter().any(|row| row.contains('9')), "{page}");
    assert!(rows[..3].iter().all(|row| row.split_whitespace().count() == 5), "{page}");
    // Another frame, pushed another way, looks different.
    assert_ne!(
        page.replace("frame 9", ""),
        text(&sptfra_in(folder.path(), &["view", &design]).stdout).replace("frame 0", "")
    );
    let machine = sptfra_in(folder.path(), &["view", &design, "--frame", "9", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&machine.stdout).expect("JSON");
    assert_eq!((&json["design"], &json["frame"], &json["meaning"]), (&"small_4x3".into(), &9.into(), &"good".into()));
    let field = json["field"]["f_z"].as_array().expect("a field");
    assert!(field.len() == 12 && field.iter().all(serde_json::Value::is_f64), "{json}");
    let shown = format!("{:.3}", json["F_z"].as_f64().expect("a force"));
    assert!(page.contains(&format!(", {shown}) N")), "{shown} in {page}");
    let refused = sptfra_in(folder.path(), &["view", &design, "--frame", "36"]);
    let message = text(&refused.stderr);
    assert!(!refused.status.success() && refused.stdout.is_empty());
    assert_eq!(message, "error: --frame 36: the simulated contact has 36 frames; choose 0 to 35\n");
}

/// What a command writes to a terminal of so many columns.
fn on_a_terminal(columns: u32, arguments: &[&str]) -> String {
    const TERMINAL: &str = "
import fcntl, os, pty, struct, sys, termios
columns, command = int(sys.argv[1]), sys.argv[2:]
child, terminal = pty.fork()
if child == 0:
    fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack('HHHH', 40, columns, 0, 0))
    os.execv(command[0], command)
try:
    while text := os.read(terminal, 4096):
        sys.stdout.buffer.write(text)
except OSError:
    pass
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
";
    let ran = Command::new("python3")
        .args(["-c", TERMINAL, &columns.to_string(), env!("CARGO_BIN_EXE_sptfra")])
        .args(arguments)
        .env("TERM", "xterm-256color")
        .env_remove("NO_COLOR")
        .output()
        .expect("python3");
    assert!(ran.status.success(), "{}", text(&ran.stderr));
    text(&ran.stdout)
}

#[test]
fn several_frames_play_in_one_place_of_a_terminal_and_are_pages_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = workspace("golden/tests/designs/small.toml").display().to_string();
    let view = |more: &[&str]| sptfra_in(folder.path(), &[&["view", &design], more].concat());
    let pages = text(&view(&["--frame", "3-5"]).stdout);
    assert_eq!(pages.matches("frame ").count(), 3, "{pages}");
    assert!(pages.contains("\n\nsmall_4x3, frame 4 of") && !pages.contains('\x1b'), "{pages}");
    // One scale for all of them: that of the largest force, which has the only nine of a normal force.
    let scale = |page: &str| page.split("9 is ").nth(1).and_then(|rest| rest.split(' ').next()).map(str::to_owned);
    let scales: Vec<_> = pages.split("\n\nsmall").map(scale).collect();
    assert!(scales[0].is_some() && scales.iter().all(|each| *each == scales[0]), "{scales:?}");
    let all: serde_json::Value = serde_json::from_slice(&view(&["--frame", "all", "--json"]).stdout).expect("JSON");
    let numbers: Vec<_> = all.as_array().expect("a list").iter().filter_map(|view| view["frame"].as_u64()).collect();
    assert_eq!(numbers, (0..36).collect::<Vec<_>>());
    for (wrong, why) in [("5-3", "write a frame as 4"), ("30-40", "--frame 36: the simulated contact has 36")] {
        let refused = view(&["--frame", wrong]);
        assert!(!refused.status.success() && text(&refused.stderr).contains(why), "{}", text(&refused.stderr));
    }
    let refused = view(&["--frame", "3-5", "--svg", "frame.svg"]);
    assert!(!refused.status.success() && !folder.path().join("frame.svg").exists());

    let played = on_a_terminal(80, &["view", &design, "--frame", "3-5", "--rate", "100"]);
    assert_eq!((played.matches("\x1b[H").count(), played.matches("\x1b[2J").count()), (3, 1), "{played:?}");
    assert!(played.contains("48;5;"), "in colour: {played:?}");
    // Four characters a taxel where there is room, one where there is none.
    let legends = [20, 19].map(|columns| {
        let shown = on_a_terminal(columns, &["view", &design]);
        assert!(!shown.contains("\x1b[H"), "one frame stays where it is: {shown:?}");
        shown.contains("second digit")
    });
    assert_eq!(legends, [true, false]);
}

/// The standing scene knows the force on each taxel.
#[test]
fn a_picture_of_the_standing_scene_shows_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = workspace("designs/sensor1-reduced.toml").display().to_string();
    assert!(sptfra_in(folder.path(), &["view", &design, "--frame", "4", "--svg", "frame.svg"]).status.success());
    let drawn = fs::read_to_string(folder.path().join("frame.svg")).expect("drawn");
    assert_eq!(drawn.matches("<rect").count(), 3 * (100 + 24), "a cell a taxel and a bar each");
    let share = drawn.split("largest: ").nth(1).and_then(|rest| rest.split(' ').next()).expect("an error");
    let share: f64 = share.parse().expect("a number");
    assert!((5.0..40.0).contains(&share), "{share} % of the largest f_z");
}

/// The picture of the README. `UPDATE_EXPECTED=1` draws it anew.
#[test]
fn the_readmes_picture_is_what_view_draws() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = shipped("sensor1-fast");
    let scene = Scene::load(&workspace("scenes/sensor1-hertz.toml")).expect("a scene");
    let [frames, forces] = ["frames.csv", "frames.forces.csv"].map(|name| folder.path().join(name));
    let made = scene.frames().expect("computed");
    let stress: Vec<Vec<f64>> = made.iter().map(|frame| frame.stress.clone()).collect();
    write_frames(&frames, &stress).expect("written");
    write_reference(&forces, &made).expect("written");
    let path = workspace("designs/sensor1-fast.toml").display().to_string();
    let view = |more: &[&str]| {
        let arguments = [&["view", &path, "--frames", "frames.csv", "--frame", "4", "--svg", "frame.svg"], more];
        sptfra_in(folder.path(), &arguments.concat())
    };
    let ran = view(&["--reference", "frames.forces.csv"]);
    assert!(ran.status.success(), "{}", text(&ran.stderr));
    let drawn = fs::read_to_string(folder.path().join("frame.svg")).expect("drawn");
    let known = workspace("docs/figures/frame.svg");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        fs::write(&known, &drawn).expect("written");
    }
    assert_eq!(drawn, fs::read_to_string(&known).expect("docs/figures/frame.svg"), "UPDATE_EXPECTED=1 draws it anew");
    assert_eq!(drawn.matches("<rect").count(), 2 * design.sensor.taxels() + 2 * 24, "a cell a taxel, and both bars");
    assert!(drawn.contains("F true"), "{drawn}");
    // Without the true forces, there is none to draw.
    assert!(view(&[]).status.success());
    assert!(!fs::read_to_string(folder.path().join("frame.svg")).expect("drawn").contains("F true"));
}

#[test]
fn completions_and_manual_know_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let completions = sptfra_in(folder.path(), &["completions", "bash"]);
    let script = text(&completions.stdout);
    assert!(completions.status.success() && script.contains("sptfra") && script.contains("--trace"), "{script}");
    fs::write(folder.path().join("sptfra.bash"), &script).expect("written");
    let shell = Command::new("bash").args(["-n", "sptfra.bash"]).current_dir(folder.path()).status().expect("bash");
    assert!(shell.success());
    assert!(sptfra_in(folder.path(), &["man", "--out", "pages"]).status.success());
    for page in ["sptfra", "sptfra-solve", "sptfra-generate", "sptfra-run", "sptfra-view", "sptfra-completions"] {
        let text = fs::read_to_string(folder.path().join("pages").join(format!("{page}.1"))).expect(page);
        assert!(text.contains(".TH ") && text.contains(".SH NAME"), "{page}");
    }
}

#[test]
fn frames_that_are_suspicious_are_shown_with_a_warning_and_those_of_another_sensor_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = workspace("golden/tests/designs/small.toml").display().to_string();
    let sensor = golden::design::Design::load(&workspace("golden/tests/designs/small.toml")).expect("a design").sensor;
    let frames = testbench::frame_set::FrameSet::standing(&sensor).expect("frames").stress;
    let pulled: Vec<Vec<f64>> = frames.iter().map(|frame| frame.iter().map(|stress| -stress).collect()).collect();
    let file = folder.path().join("pulled.csv");
    golden::frames::write_frames(&file, &pulled).expect("written");
    let view = ["view", &design, "--frames", "pulled.csv"];
    let shown = sptfra_in(folder.path(), &view);
    let said = text(&shown.stderr);
    assert!(shown.status.success() && said.starts_with("warning: ") && said.contains("F_z > 0"), "{said}");
    assert!(said.contains("sensor.pa_per_count = -1.0"), "what to change: {said}");

    let other = golden::design::Sensor { pitch_mm: [4.0, 3.0], ..sensor };
    fs::write(golden::geometry::beside(&file), golden::geometry::to_toml(&other)).expect("written");
    for command in ["view", "run"] {
        let refused = sptfra_in(folder.path(), &[command, view[1], view[2], view[3]]);
        let said = text(&refused.stderr);
        assert!(!refused.status.success() && said.starts_with("error: ") && said.contains("4 x 3 mm"), "{said}");
    }
}
