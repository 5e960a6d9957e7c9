//! What a real system does to the generator: kills it, runs it twice at once, gives it names that mean something else.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use golden::design::Design;
use proptest::prelude::*;

use crate::generate::{contents, folder_with_design, good};
use crate::support::{design_text, program};

type Files = BTreeMap<String, Vec<u8>>;

fn generator(here: &Path, design: &str, out: &str) -> Command {
    let mut command = program();
    command.current_dir(here).args(["generate", design, "--out", out]).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Two designs of one name, in `one.toml` and `two.toml`, and what is generated from each.
fn two_designs(here: &Path) -> [Files; 2] {
    [("one", 4), ("two", 8)].map(|(file, lanes)| {
        let text = design_text("pad", [4, 3], [4.0, 2.0], 3.0, &format!("[hardware]\nlanes = {lanes}"));
        fs::write(here.join(format!("{file}.toml")), text).unwrap();
        good(here, &["generate", &format!("{file}.toml"), "--out", file]);
        contents(&here.join(file))
    })
}

#[test]
fn killed_at_any_moment_it_leaves_the_old_folder_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let designs = two_designs(here);
    good(here, &["generate", "one.toml", "--out", "out"]);
    let start = Instant::now();
    good(here, &["generate", "two.toml", "--out", "out"]);
    let duration = start.elapsed();
    // Moments from the start to a little after the end; the last tenth, where it writes, more often.
    let mut finished = 0;
    for round in 0..40_u32 {
        let share = if round % 2 == 0 { f64::from(round) / 40.0 } else { 0.85 + 0.3 * f64::from(round) / 40.0 };
        let mut running = generator(here, if round % 2 == 0 { "one.toml" } else { "two.toml" }, "out").spawn().unwrap();
        thread::sleep(Duration::from_secs_f64(duration.as_secs_f64() * share));
        // It may have ended by itself.
        let _ = running.kill();
        finished += u32::from(running.wait().unwrap().success());
        let found = contents(&here.join("out"));
        assert!(designs.contains(&found), "round {round}: {:?}", found.keys());
    }
    assert!(finished < 40, "some were killed");
    // What the killed ones left beside it is in nobody's way.
    good(here, &["generate", "one.toml", "--out", "out"]);
    assert_eq!(contents(&here.join("out")), designs[0]);
}

#[test]
fn two_at_once_into_one_folder_do_not_mix() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let designs = two_designs(here);
    for round in 0..10 {
        // In the first round the folder is not there.
        let running = ["one.toml", "two.toml"].map(|design| generator(here, design, "out").spawn().unwrap());
        for mut process in running {
            assert!(process.wait().unwrap().success(), "round {round}");
        }
        assert!(designs.contains(&contents(&here.join("out"))), "round {round}");
    }
    let beside: Vec<_> = fs::read_dir(here).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(beside.len(), 5, "{beside:?}");
}

#[test]
fn the_same_bytes_in_two_folders_on_one_and_two_threads() {
    let folder = folder_with_design("lanes = 4");
    let here = folder.path();
    let filter = "[algorithm]\nplan = \"paper\"\nfilter = { kind = \"f2\", p = 20 }";
    fs::write(here.join("wide.toml"), design_text("wide", [8, 6], [4.0, 2.0], 3.0, filter)).unwrap();
    fs::create_dir(here.join("elsewhere")).unwrap();
    for design in ["pad", "wide"] {
        let runs = [(here.to_owned(), "1"), (here.join("elsewhere"), "2"), (here.to_owned(), "8")];
        let found = runs.map(|(place, threads)| {
            let out = place.join(format!("{design}-{threads}"));
            let path = here.join(format!("{design}.toml"));
            let mut command = generator(&place, path.to_str().unwrap(), out.to_str().unwrap());
            assert!(command.env("RAYON_NUM_THREADS", threads).status().unwrap().success());
            contents(&out)
        });
        assert!(found[0] == found[1] && found[1] == found[2], "{design}");
        // And no file knows where it lies.
        let place = here.to_str().unwrap();
        let tells = |bytes: &Vec<u8>| String::from_utf8_lossy(bytes).contains(place);
        assert!(!found[0].values().any(tells), "{design}");
    }
}

/// Characters that mean something in Verilog, Tcl, C, a shell, a path or a TOML string.
const MEANINGFUL: &str = "[a-z0-9_./\\\\;$`'\"{}\\[\\]()*#% \n\t:&|<>~-]{0,12}";

fn quoted(text: &str) -> String {
    let escaped: String = text.chars().map(|letter| format!("\\u{:04X}", letter as u32)).collect();
    format!("\"{escaped}\"")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// What the design file says in words is refused, or stands for nothing but itself wherever it is printed.
    #[test]
    fn no_word_of_a_design_smuggles_anything(name in MEANINGFUL, part in MEANINGFUL) {
        let of = |word: &str, more: &str| {
            !word.is_empty() && word.chars().all(|letter| letter.is_ascii_alphanumeric() || more.contains(letter))
        };
        let design = |name: &str, part: &str| {
            let text = design_text("pad", [4, 3], [4.0, 2.0], 3.0, &format!("[hardware]\npart = {}", quoted(part)));
            Design::from_toml(&text.replace("\"pad\"", &quoted(name)), "pad.toml")
        };
        if let Ok(design) = design(&name, "xc7a35t") {
            prop_assert!(of(&design.name, "_"), "{:?}", design.name);
        }
        if let Ok(design) = design("pad", &part) {
            prop_assert!(of(&design.hardware.part, "._-"), "{:?}", design.hardware.part);
        }
    }
}

#[test]
fn a_path_in_a_design_is_read_and_never_printed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let hostile = "../cal [exec rm] $x; `include \"y\" endmodule.csv";
    fs::create_dir(here.join("designs")).unwrap();
    fs::write(here.join("designs").join(hostile), "1.0,0.0\n".repeat(12)).unwrap();
    let text = design_text("pad", [4, 3], [4.0, 2.0], 3.0, "")
        .replace("depth_mm = 3.0", &format!("depth_mm = 3.0\npa_per_count = -12.5\ncalibration = {}", quoted(hostile)));
    fs::write(here.join("designs/pad.toml"), text).unwrap();
    good(here, &["generate", "designs/pad.toml", "--out", "out"]);
    let files = contents(&here.join("out"));
    for (path, bytes) in &files {
        assert!(!String::from_utf8_lossy(bytes).contains("[exec rm]"), "{path}");
        let parts: Vec<Component> = Path::new(path).components().collect();
        assert!(parts.iter().all(|part| matches!(part, Component::Normal(_))), "{path}");
        let plain = |letter: char| letter.is_ascii_alphanumeric() || "_-./".contains(letter);
        assert!(path.chars().all(plain), "{path}");
    }
    assert!(files.contains_key("calibration.csv"));
    // Nothing was written outside the folder.
    let mut beside: Vec<_> = fs::read_dir(here).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    beside.sort();
    assert_eq!(beside.len(), 3, "{beside:?}");
}
