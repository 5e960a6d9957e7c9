//! The commands of README and docs, run as they are written, in a folder with what their pages speak of.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;
use golden::scene::{Scene, SceneFrame};
use tempfile::TempDir;

use super::{Line, commands, lines, lines_of};
use crate::support::workspace;

/// What is not run here, by how the line begins, and why.
const ELSEWHERE: [(&str, &str); 29] = [
    ("make ", "installs tools, builds all, or takes minutes; the targets are looked up"),
    ("cargo ", "builds all, or runs tests of minutes; topics are looked up"),
    ("export ", "of the shell that the next lines are typed into"),
    ("golden bench", "minutes, and its figures are those of a machine"),
    ("testbench bench", "likewise"),
    ("testbench run designs/sensor1-joint.toml", "topic joint"),
    ("testbench run jobs/", "topic sweep"),
    ("testbench sweep my_sensor.toml --full", "thousands of points"),
    ("tools/synth.sh", "minutes of Yosys"),
    ("apt-get", "as root"),
    (".venv/bin/python tools/fe", "hours of CalculiX"),
    ("modprobe", "on a board, as root"),
    ("insmod", "likewise"),
    ("xmutil", "likewise"),
    ("./forces_linux", "likewise"),
    ("gtkwave", "a window"),
    ("surfer", "a window"),
    ("vivado", "is not there; topic flows has a stand-in"),
    ("fusesoc", "topic flows"),
    ("verilator", "topic lint"),
    ("obj/", "topic flows"),
    ("cd rtl-out/NAME", "topic lint"),
    ("hdl-gen generate designs/small-control.toml", "docs/board.md: topic drivers"),
    ("golden scene --design designs/small-control.toml", "likewise"),
    ("ln -sf", "likewise"),
    ("drivers/c/examples/", "likewise"),
    ("python3 drivers/python/forces.py", "likewise"),
    ("testbench view DESIGN", "a synopsis"),
    ("testbench view …", "a synopsis"),
];
/// Likewise, with a name that a user puts in.
const PLACEHOLDERS: [&str; 2] = ["DESIGN.toml", "NAME"];

fn is_elsewhere(line: &str) -> bool {
    ELSEWHERE.iter().any(|(begin, _)| line.starts_with(begin)) || PLACEHOLDERS.iter().any(|word| line.contains(word))
}

/// What a command warns of as it should, by how it begins.
const WARNS: [(&str, &str); 2] = [
    ("golden solve designs/bed-mat.toml", "of a pitch thin"),
    ("golden solve designs/bed-mat.toml", "the end of the converter?"),
];

/// A folder in which commands are typed.
struct Session {
    folder: TempDir,
    path: String,
}

impl Session {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["designs", "scenes", "data"] {
            std::os::unix::fs::symlink(workspace(name), folder.path().join(name)).expect("a link");
        }
        let path = format!("{}:{}", commands().display(), std::env::var("PATH").unwrap_or_default());
        Self { folder, path }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs a command; it succeeds and says nothing is wrong. What it says is the answer.
    fn run(&self, command: &str, place: &str) -> String {
        let mut bash = Command::new("bash");
        bash.args(["-c", command]).current_dir(self.folder.path()).env("PATH", &self.path);
        let Output { status, stdout, stderr } = bash.output().expect("bash starts");
        let wrong = String::from_utf8_lossy(&stderr);
        // A machine that is busy makes long work speak: how far it is, and for how many seconds.
        let expected =
            |line: &str| WARNS.iter().any(|(begin, warning)| command.starts_with(begin) && line.contains(warning));
        let silent = wrong.lines().all(|line| line.ends_with(" s") || expected(line));
        assert!(status.success() && silent, "{place}\n{wrong}");
        String::from_utf8(stdout).expect("UTF-8")
    }
}

#[test]
fn the_session_of_the_readme_does_what_it_says() {
    let session = Session::new();
    let readme = workspace("README.md");
    let (mut said, mut count) = (String::new(), 0);
    for line in lines_of(&readme).iter().filter(|line| !is_elsewhere(&line.text)) {
        said += &session.run(&line.text, &line.place());
        count += 1;
    }
    assert!(count >= 11, "only {count} lines were run");
    says(&readme, &said);
    for name in ["my_sensor.toml", "frames.csv", "forces.csv", "rtl-out/my_sensor/rtl/my_sensor.v", "frame.svg"] {
        assert!(session.file(name).exists(), "no {name}");
    }
    assert!(said.contains("Bit-exact in all 4 stream modes"), "the simulation's verdict:\n{said}");
}

/// What a page states in its first block of text is what its commands print; lines of a "…" stand for others.
fn says(page: &Path, said: &str) {
    let stated = fs::read_to_string(page).expect("readable");
    let results = stated.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("stated results");
    for result in results.lines().filter(|line| line.trim() != "…") {
        let printed = said.lines().any(|line| line.trim_end() == result);
        assert!(printed, "{} says {result:?}, the commands:\n{said}", page.display());
    }
}

#[test]
fn the_frame_of_the_page_is_what_the_terminal_shows() {
    let session = Session::new();
    says(
        &workspace("docs/looking.md"),
        &session.run("testbench view designs/sensor1-reduced.toml --frame 4", "looking.md"),
    );
}

/// A recording: a contact at four places, each under three loads, with rests between; and the weights.
fn recording(frames: &[SceneFrame]) -> (Vec<Vec<f64>>, String) {
    const HOLD: usize = 8;
    let (mut stress, mut weights) = (Vec::new(), "F_z (N)\n".to_owned());
    for frame in frames {
        for load in [0.0, 0.5, 0.0, 1.0, 0.0, 2.0, 0.0] {
            for _ in 0..HOLD {
                stress.push(frame.stress.iter().map(|stress| load * stress).collect());
                // Writing to a String cannot fail.
                let _ = writeln!(weights, "{}", load * frame.force[2]);
            }
        }
    }
    (stress, weights)
}

/// An array of `NumPy`'s format, version 1.0.
fn npy(frames: &[Vec<f64>]) -> Vec<u8> {
    let shape = format!("({}, {})", frames.len(), frames[0].len());
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(frames.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// What the pages speak of: a small pad with its recordings, and a sensor with frames and two scenes.
fn prepare(session: &Session) {
    session.run("hdl-gen new pad --columns 6 --rows 6 --pitch-mm 4 4 --depth-mm 3", "pad.toml");
    session.run("hdl-gen new my_sensor --columns 6 --rows 6 --pitch-mm 4 4 --depth-mm 3", "my_sensor.toml");
    session.run("golden scene --design pad --out frames.csv", "frames.csv");
    let pad = Design::load(&session.file("pad.toml")).expect("a design");
    let mut scene = Scene::standing(&pad.sensor);
    scene.sweep_deg.clear();
    let made = [[8e-3, 8e-3], [12e-3, 8e-3], [8e-3, 12e-3], [12e-3, 12e-3]].map(|centre_m| {
        scene.contacts[0].centre_m = centre_m;
        scene.frames().expect("a frame").remove(0)
    });
    let (stress, weights) = recording(&made);
    golden::frames::write_frames(&session.file("press.csv"), &stress).expect("written");
    fs::write(session.file("weights.csv"), weights).expect("written");
    let pressures: Vec<f64> = [0.0, 5e3, 0.0, 1e4, 0.0, 2e4, 0.0, 4e4, 0.0].iter().flat_map(|p| [*p; 8]).collect();
    let uniform: Vec<Vec<f64>> = pressures.iter().map(|pressure| vec![-pressure; 36]).collect();
    fs::write(session.file("bladder.npy"), npy(&uniform)).expect("written");
    let column: String = pressures.iter().map(|pressure| format!("{pressure}\n")).collect();
    fs::write(session.file("p.csv"), format!("pressure (Pa)\n{column}")).expect("written");
    // A scanner at rest: offsets, and noise of a count or two.
    let reads =
        |frame: usize, taxel: usize| (40 * ((5 * taxel) % 7) + (frame * 7919 + taxel * 104_729) % 101 % 5) as f64;
    let rest: Vec<Vec<f64>> = (0..60).map(|frame| (0..12).map(|taxel| reads(frame, taxel)).collect()).collect();
    golden::frames::write_frames(&session.file("rest.csv"), &rest).expect("written");
    let own = "[sensor]\ncolumns = 6\nrows = 6\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n[medium]\nkind = \"half_space\"\n\
               [[contact]]\nshape = \"disc\"\nradius_mm = 5.0\nnormal_force_n = 2.0\nfriction = 0.4\ndirection_deg = 20.0\n";
    for (name, x) in [("a.toml", 9.0), ("b.toml", 11.0)] {
        fs::write(session.file(name), format!("{own}centre_mm = [{x:?}, 10.0]\n")).expect("written");
    }
    // A board of one's own.
    fs::copy(workspace("hdl-gen/boards/zcu102.toml"), session.file("my-carrier.toml")).expect("copied");
}

/// What the pages' commands make.
const MADE: [&str; 8] = [
    "pad-june.toml",
    "june.html",
    "scanner.calibration.csv",
    "pad-joint.toml",
    "forces.csv",
    "frame.svg",
    "scanner.bank.csv",
    "target/sweep/report.html",
];

/// What takes a minute as it is written, and seconds so.
fn quick(line: &str) -> String {
    match line {
        "golden calibrate pad.toml --out pad-joint.toml" => format!("{line} --quick"),
        "golden solve my_sensor --frames - --out -" => format!("{line} < frames.csv"),
        _ => line.to_owned(),
    }
}

#[test]
fn the_commands_of_the_docs_run() {
    let lines = lines();
    // That of the root has a test of its own.
    let readme = workspace("README.md");
    let typed = |line: &&Line| line.file != readme && !is_elsewhere(&line.text);
    let typed: Vec<&Line> = lines.iter().filter(typed).collect();
    let pages = typed.chunk_by(|a, b| a.file == b.file).map(|page| {
        let session = Session::new();
        prepare(&session);
        for line in page {
            session.run(&quick(&line.text), &line.place());
        }
        let made = |name: &&&str| session.file(name).exists();
        (name(page[0]), MADE.iter().filter(made).copied().collect::<Vec<_>>())
    });
    let found: Vec<(String, Vec<&str>)> = pages.collect();
    let expected = [
        ("README.md", vec!["forces.csv"]),
        ("calibrating.md", vec!["pad-june.toml", "june.html", "scanner.calibration.csv"]),
        ("contacts.md", vec!["forces.csv"]),
        ("estimators.md", vec!["pad-joint.toml", "forces.csv"]),
        ("looking.md", vec!["frame.svg"]),
        ("python.md", vec![]),
        ("sensor.md", vec!["scanner.bank.csv"]),
        ("sweep.md", vec!["target/sweep/report.html"]),
        ("vivado.md", vec![]),
    ];
    assert_eq!(found, expected.map(|(page, made)| (page.to_owned(), made)));
}

fn name(line: &Line) -> String {
    line.file.file_name().and_then(|name| Path::new(name).to_str()).expect("a name").to_owned()
}

/// A line that nobody writes any more needs no reason.
#[test]
fn every_reason_is_of_a_line() {
    let lines = lines();
    for (begin, why) in ELSEWHERE {
        assert!(lines.iter().any(|line| line.text.starts_with(begin)), "{begin}: {why}");
    }
}
