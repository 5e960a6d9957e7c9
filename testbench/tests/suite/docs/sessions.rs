//! The commands of README and docs, run as they are written, in a folder with what their pages speak of.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;
use golden::scene::{Scene, SceneFrame};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tempfile::TempDir;

use super::{Line, commands, lines, lines_of};
use crate::support::designs::design_file;
use crate::support::workspace;

/// What is not run here, by how the line begins, and why.
const ELSEWHERE: [(&str, &str); 30] = [
    ("make ", "installs tools, builds all, or takes minutes; the targets are looked up"),
    ("cargo ", "builds all, or runs tests of minutes; topics are looked up"),
    ("export ", "of the shell that the next lines are typed into"),
    ("pip ", "topic python"),
    ("sptfra calibrate pressure_mat.toml", "minutes"),
    ("sptfra run designs/small-control.toml --trace", "topic looking"),
    ("modprobe", "on a board, as root"),
    ("insmod", "likewise"),
    ("xmutil", "likewise"),
    ("cp NAME", "likewise"),
    ("fpgautil", "likewise"),
    ("./forces_linux", "likewise"),
    ("gtkwave", "a window"),
    ("surfer", "a window"),
    ("vivado", "is not there; topic flows has a stub"),
    ("bootgen", "is not there"),
    ("dtc", "topic drivers"),
    ("echo", "for bootgen, which is not there"),
    ("fusesoc", "topic flows"),
    ("verilator", "topic lint"),
    ("yosys", "topic lint"),
    ("cd rtl-out/NAME", "topic lint"),
    ("python3 rtl-out/NAME", "topic flows"),
    ("sptfra generate designs/small-control.toml", "docs/how-to/board.md: topic drivers"),
    ("sptfra scene --design designs/small-control.toml", "likewise"),
    ("ln -sf", "likewise"),
    ("drivers/c/examples/", "likewise"),
    ("python3 drivers/python/forces.py", "likewise"),
    ("python3 forces.py", "on a board"),
    ("python3 -m venv", "installs tools"),
];
/// Likewise, with a name that a user puts in.
const PLACEHOLDERS: [&str; 1] = ["DESIGN.toml"];

fn is_elsewhere(line: &str) -> bool {
    ELSEWHERE.iter().any(|(begin, _)| line.starts_with(begin)) || PLACEHOLDERS.iter().any(|word| line.contains(word))
}

/// What a command warns of as it should, by how it begins.
const WARNS: [(&str, &str); 2] = [
    ("sptfra solve designs/bed-mat.toml", "of a pitch thin"),
    ("sptfra solve designs/bed-mat.toml", "the end of the converter?"),
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

    /// Another folder with the same files.
    fn copy(&self) -> Self {
        let session = Self::new();
        for entry in fs::read_dir(self.folder.path()).expect("a folder").map(|entry| entry.expect("an entry")) {
            if entry.file_type().expect("a type").is_file() {
                fs::copy(entry.path(), session.folder.path().join(entry.file_name())).expect("copied");
            }
        }
        session
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

/// Counts of an unloaded scanner: offsets, and Gaussian noise of ten counts.
fn unloaded(taxels: usize) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    // Twelve even numbers from 0 to 1 have a variance of 1 together.
    let mut noise = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let mut reads = |taxel: usize| (40.0 * ((5 * taxel) % 7) as f64 + 10.0 * noise()).round();
    (0..60).map(|_| (0..taxels).map(&mut reads).collect()).collect()
}

/// A design file with the keys that a command printed, in place of its own or of the comments that stand for them.
fn with_keys(design: &str, printed: &str) -> String {
    let mut text = design.to_owned();
    for line in printed.lines().skip_while(|line| *line != "[sensor]") {
        let Some((key, _)) = line.split_once(" = ") else { continue };
        let is_own = |own: &&str| own.trim_start_matches("# ").starts_with(&format!("{key} = "));
        let own = design.lines().find(is_own).unwrap_or_else(|| panic!("no {key} in {design}"));
        text = text.replacen(own, line, 1);
    }
    text
}

#[test]
fn the_session_of_the_readme_does_what_it_says() {
    let session = Session::new();
    golden::frames::write_frames(&session.file("unloaded.csv"), &unloaded(100)).expect("written");
    let (mut said, mut count) = (String::new(), 0);
    for line in lines_of(&workspace("README.md")).iter().filter(|line| !is_elsewhere(&line.text)) {
        let printed = session.run(&quick(&line.text), &line.place());
        said += &printed;
        match count {
            // A recording, as the README makes one for who has none.
            0 => said += &session.run("sptfra scene --design my_sensor --out frames.csv", "frames.csv"),
            1 => {
                let design = fs::read_to_string(session.file("my_sensor.toml")).expect("written");
                fs::write(session.file("my_sensor.toml"), with_keys(&design, &printed)).expect("written");
            }
            // With the offsets that are set now.
            2 => said += &session.run("sptfra scene --design trained --out frames.csv", "frames.csv"),
            _ => {}
        }
        count += 1;
    }
    assert_eq!(count, 6, "lines were run");
    // As docs/how-to/tare-and-noise.md says of the keys.
    let found = session.run("sptfra check trained --frames unloaded.csv", "unloaded.csv");
    assert!(found.contains("nothing suspicious") && found.contains("Nothing presses"), "{found}");
    for name in ["my_sensor.toml", "my_sensor.tare.csv", "forces.csv", "my_core/rtl/trained.v"] {
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
    let page = workspace("docs/how-to/look-at-frames.md");
    let line = lines_of(&page).remove(0);
    says(&page, &session.run(&line.text, &line.place()));
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

/// Counts of a scanner at rest, then under a weight that stays for a minute. They rise by 0.4 of it, with a time constant
/// of 10 s.
fn constant_load(taxels: usize) -> String {
    let mut text = "t (s)".to_owned() + &(0..taxels).map(|taxel| format!(",p{taxel}")).collect::<String>() + "\n";
    for (frame, counts) in unloaded(taxels).iter().cycle().take(640).enumerate() {
        let second = frame as f64 / 10.0;
        let crept = 1.0 + 0.4 * (1.0 - f64::exp((4.0 - second) / 10.0));
        let load = if second < 4.0 { 0.0 } else { (1000.0 * crept).round() };
        text += &second.to_string();
        text += &counts.iter().map(|count| format!(",{}", count + load)).collect::<String>();
        text.push('\n');
    }
    text
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

/// What the pages speak of: a small pad with its recordings, a sensor with frames, a scanner, and a board.
fn prepare(session: &Session) {
    session.run("sptfra new pad --columns 6 --rows 6 --pitch-mm 4 4 --depth-mm 3 --tension read", "pad");
    // Another name of the same sensor: to fit its constants anew takes seconds.
    let pad = fs::read_to_string(session.file("pad.toml")).expect("written");
    let named = |name: &str| pad.replacen("name = \"pad\"", &format!("name = \"{name}\""), 1);
    fs::write(session.file("my_sensor.toml"), named("my_sensor")).expect("written");
    let design = named("two_fingers");
    let several = design.replacen("\ncontacts = 1\n", "\ncontacts = 4\n", 1);
    assert!(design != several, "{design}");
    fs::write(session.file("two-fingers.toml"), several).expect("written");
    session.run("sptfra scene --design pad --out frames.csv", "frames.csv");
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
    fs::copy(design_file("small-scanner"), session.file("scanner.toml")).expect("copied");
    golden::frames::write_frames(&session.file("unloaded.csv"), &unloaded(12)).expect("written");
    fs::write(session.file("load.csv"), constant_load(12)).expect("written");
    // A board of one's own.
    fs::copy(workspace("hdl-gen/boards/zcu102.toml"), session.file("my-carrier.toml")).expect("copied");
}

/// What the pages' commands make.
const MADE: [&str; 11] = [
    "scanner-creep.toml",
    "pad-june.toml",
    "pad-july.toml",
    "june.html",
    "scanner.calibration.csv",
    "forces.csv",
    "frame.svg",
    "board-folder/metadata.json",
    "report.json",
    "target/sweep/report.html",
    "second/rtl/v2_sptfra_rom.v",
];

/// What takes a minute as it is written, and seconds so.
fn quick(line: &str) -> String {
    match line {
        "sptfra calibrate my_sensor --out trained.toml" | "sptfra calibrate pad-june.toml --out pad-july.toml" => {
            format!("{line} --quick")
        }
        "sptfra solve my_sensor --frames - --out -" => format!("{line} < frames.csv"),
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
    let prepared = Session::new();
    prepare(&prepared);
    let pages = typed.chunk_by(|a, b| a.file == b.file).map(|page| {
        let session = prepared.copy();
        for line in page {
            session.run(&quick(&line.text), &line.place());
        }
        let made = |name: &&&str| session.file(name).exists();
        (name(page[0]), MADE.iter().filter(made).copied().collect::<Vec<_>>())
    });
    let found: Vec<(String, Vec<&str>)> = pages.collect();
    let expected = [
        ("README.md", vec!["forces.csv"]),
        ("calibrate-with-weights.md", vec!["pad-june.toml", "pad-july.toml", "june.html"]),
        ("choose-a-design.md", vec!["target/sweep/report.html"]),
        ("ci.md", vec!["report.json"]),
        ("large-arrays.md", vec!["forces.csv"]),
        ("look-at-frames.md", vec!["frame.svg"]),
        ("sensor-without-tension.md", vec![]),
        ("several-contacts.md", vec!["forces.csv"]),
        ("tare-and-noise.md", vec!["scanner-creep.toml", "scanner.calibration.csv"]),
        ("vivado.md", vec![]),
        ("generated-folder.md", vec!["second/rtl/v2_sptfra_rom.v"]),
        ("first-forces.md", vec!["forces.csv", "board-folder/metadata.json"]),
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
