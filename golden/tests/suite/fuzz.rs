//! Readers on damaged files: each gives a value or one line of message, and never panics.
//!
//! The files are good ones with a few bytes or lines changed, and any bytes at all, a fixed number in every run.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::designs::folders;
use golden::calibrate::recorded::{read_forces, read_pressures};
use golden::design::Design;
use golden::forces::read_outcomes;
use golden::frames::{FrameLines, Frames, read_recording, write_frames};
use golden::scene::Scene;

use proptest::prelude::*;

const CASES: u32 = 600;
/// Words that a number, a key or a separator may turn into.
const WORDS: [&str; 24] = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-0",
    "0",
    "-1",
    "99999999999999999999",
    "9223372036854775807",
    "0x7f",
    "1e-320",
    "\"",
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    "\n",
    "\r",
    "\0",
    "true",
    "\u{feff}",
];

/// Headers of four taxels.
const HEADERS: [&str; 6] = [
    "",
    "p0,p1,p3,p2\n",
    "r1c1 (kPa),r2c1 (kPa),r1c2 (kPa),r2c2 (kPa)\n",
    "# t;0;1;2\n",
    "A1,B1,A2,B2\n",
    "s11,s12,s21,s22\n",
];

/// The files of a folder with this ending.
fn texts(folder: &Path, ending: &str) -> Vec<String> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("there").path()).collect();
    paths.sort();
    let right = |path: &PathBuf| path.extension().is_some_and(|found| found == ending);
    paths.into_iter().filter(right).map(|path| fs::read_to_string(path).expect("text")).collect()
}

fn designs() -> &'static [String] {
    static TEXTS: OnceLock<Vec<String>> = OnceLock::new();
    TEXTS.get_or_init(|| folders().iter().flat_map(|folder| texts(folder, "toml")).collect())
}

/// Weights and bases that designs name.
fn named() -> &'static [(&'static str, String)] {
    static TEXTS: OnceLock<Vec<(&str, String)>> = OnceLock::new();
    TEXTS.get_or_init(|| {
        let of = |(folder, name): (usize, &'static str)| {
            (name, fs::read_to_string(folders()[folder].join(name)).expect("readable"))
        };
        [
            (0, "sensor1-fast.weights.csv"),
            (0, "sensor2-fast.weights.csv"),
            (0, "sensor1-fast.toml"),
            (0, "sensor1-reduced.toml"),
            (1, "../../../designs/paper.toml"),
            (1, "../../../designs/sensor1-reduced.toml"),
        ]
        .map(of)
        .to_vec()
    })
}

fn scenes() -> &'static [String] {
    static TEXTS: OnceLock<Vec<String>> = OnceLock::new();
    TEXTS.get_or_init(|| texts(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes"), "toml"))
}

/// A change at a place, given as a share of the text's length.
#[derive(Clone, Debug)]
enum Change {
    Cut(f64, usize),
    Insert(f64, String),
    Replace(f64, usize, String),
    RepeatLine(f64),
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let words =
        || prop_oneof![prop::sample::select(&WORDS[..]).prop_map(str::to_owned), any::<char>().prop_map(String::from)];
    let change = prop_oneof![
        (0.0..1.0, 1..12_usize).prop_map(|(place, length)| Change::Cut(place, length)),
        (0.0..1.0, words()).prop_map(|(place, word)| Change::Insert(place, word)),
        (0.0..1.0, 1..6_usize, words()).prop_map(|(place, length, word)| Change::Replace(place, length, word)),
        (0.0..1.0).prop_map(Change::RepeatLine),
    ];
    prop::collection::vec(change, 1..4)
}

fn changed(text: &str, changes: &[Change]) -> String {
    changes.iter().fold(text.to_owned(), |text, change| {
        let letters: Vec<char> = text.chars().collect();
        let at = |share: &f64| (share * letters.len() as f64) as usize;
        let (from, to, word) = match change {
            Change::Cut(place, length) => (at(place), at(place) + length, String::new()),
            Change::Insert(place, word) => (at(place), at(place), word.clone()),
            Change::Replace(place, length, word) => (at(place), at(place) + length, word.clone()),
            Change::RepeatLine(place) => {
                let lines: Vec<&str> = text.lines().collect();
                let line = lines.get((place * lines.len() as f64) as usize).copied().unwrap_or_default();
                return format!("{text}\n{line}\n");
            }
        };
        let head: String = letters[..from].iter().collect();
        let tail: String = letters[to.min(letters.len())..].iter().collect();
        head + &word + &tail
    })
}

/// One line that names the file.
fn is_a_message(message: &str) -> bool {
    message.contains("fuzzed") && !message.is_empty() && message.lines().count() == 1
}

/// A sensor of four taxels.
fn four() -> Design {
    let text = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 2\nrows = 2\n\
                pitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    Design::from_toml(text, "pad.toml").expect("a design")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_design_is_read_or_refused(which in any::<prop::sample::Index>(), changes in changes()) {
        let text = changed(&designs()[which.index(designs().len())], &changes);
        match Design::from_parts(&text, "fuzzed.toml", named()) {
            // What is accepted can be written down and read again.
            Ok(design) => {
                let again = Design::from_parts(&design.to_toml(), "fuzzed.toml", &design.files());
                prop_assert_eq!(again.map(|again| again.to_toml()).ok(), Some(design.to_toml()));
            }
            Err(error) => prop_assert!(is_a_message(&error.to_string()), "{}", error),
        }
    }

    #[test]
    fn a_damaged_scene_is_read_or_refused(which in any::<prop::sample::Index>(), changes in changes()) {
        let text = changed(&scenes()[which.index(scenes().len())], &changes);
        if let Err(error) = Scene::from_toml(&text, "fuzzed.toml") {
            prop_assert!(is_a_message(&error.to_string()), "{}", error);
        }
    }

    #[test]
    fn a_damaged_array_is_read_or_refused(
        rows in prop::collection::vec(prop::collection::vec(-1e6..1e6_f64, 4), 1..5),
        place in any::<prop::sample::Index>(),
        byte in any::<u8>(),
        cut in 0..3_usize,
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fuzzed.npy");
        write_frames(&path, &rows).expect("writable");
        let mut bytes = fs::read(&path).expect("there");
        let place = place.index(bytes.len());
        bytes[place] = byte;
        bytes.truncate(bytes.len() - cut);
        fs::write(&path, bytes).expect("writable");
        match read_recording(&path, &four(), 0) {
            Ok(found) => prop_assert!(found.frames.iter().flatten().all(|value| value.is_finite())),
            Err(error) => prop_assert!(is_a_message(&error.to_string()), "{}", error),
        }
    }

    /// A line each, or a line for each row; as a file, in UTF-16, and line by line.
    #[test]
    fn damaged_frames_are_read_or_refused(
        rows in prop::collection::vec(prop::collection::vec(-1e6..1e6_f64, 4), 1..5),
        changes in changes(),
        labels in 0..3_usize,
        header in prop::sample::select(&HEADERS[..]),
        between in prop::sample::select(&[",", "\n", "\n1,0.5,", " "][..]),
        is_wide in any::<bool>(),
    ) {
        let [inner, end] = if between.contains('\n') { [",", "\n\n"] } else { [between, "\n"] };
        let row = |row: &Vec<f64>| format!("{}{inner}{}{between}{}{inner}{}", row[0], row[1], row[2], row[3]);
        let text = changed(&(header.to_owned() + &rows.iter().map(row).collect::<Vec<_>>().join(end)), &changes);
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fuzzed.csv");
        let wide = || format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect();
        fs::write(&path, if is_wide { wide() } else { text.clone().into_bytes() }).expect("writable");
        match read_recording(&path, &four(), labels) {
            Ok(Frames { frames, .. }) => {
                prop_assert!(frames.iter().all(|frame| frame.len() == 4));
                prop_assert!(frames.iter().flatten().all(|value| value.is_finite()));
            }
            Err(error) => prop_assert!(is_a_message(&error.to_string()), "{}", error),
        }
        let mut lines = FrameLines::new(&path, &four(), labels);
        for line in text.split_inclusive('\n') {
            match lines.frame(line.as_bytes()) {
                Ok(frame) => prop_assert!(frame.is_none_or(|frame| frame.len() == 4 && frame.iter().all(|value| value.is_finite()))),
                Err(error) => prop_assert!(is_a_message(&error.to_string()), "{}", error),
            }
        }
    }

    #[test]
    fn a_damaged_calibration_is_read_or_refused(
        rows in prop::collection::vec((0.5..2.0_f64, -100.0..100.0_f64), 12),
        changes in changes(),
    ) {
        let lines: Vec<String> = rows.iter().map(|(gain, offset)| format!("{gain},{offset}")).collect();
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("fuzzed.csv"), changed(&lines.join("\n"), &changes)).expect("writable");
        let design = folder.path().join("pad.toml");
        let text = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
                    pa_per_count = 10.0\ncalibration = \"fuzzed.csv\"\n";
        fs::write(&design, text).expect("writable");
        match Design::load(&design) {
            Ok(design) => {
                let calibration = design.input.calibration.expect("as the file says");
                prop_assert!(calibration.gain.iter().all(|gain| gain.is_finite() && *gain >= 0.0));
                prop_assert_eq!((calibration.gain.len(), calibration.offset.len()), (12, 12));
            }
            Err(error) => {
                prop_assert!(is_a_message(&error.to_string()), "{}", error);
                prop_assert!(!error.to_string().contains(char::is_control), "{:?}", error.to_string());
            }
        }
    }

    #[test]
    fn damaged_forces_are_read_or_refused(changes in changes(), frames in 1..3_usize) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fuzzed.csv");
        fs::write(&path, changed("0,1.5,-2.0,-6.0,0.4,1.0,0.2,0.3\n0,1.5,-2.0,-6.0,0.4,1.0,0.2,0.3\n", &changes))
            .expect("writable");
        if let Err(error) = read_outcomes(&path, frames) {
            prop_assert!(is_a_message(&error.to_string()), "{}", error);
        }
    }

    #[test]
    fn damaged_tables_are_read_or_refused(changes in changes(), is_timed in any::<bool>()) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fuzzed.csv");
        let forces = if is_timed { "t (s),F_x (N),F_z (N)\n0,0.5,-1\n0.1,,-2\n0.2,1,-3\n" } else { "F_z\n-1\n-2\n-3\n" };
        let pressures = if is_timed { "t (ms);p (kPa)\n0;1,5\n10;2\n20;3,25\n" } else { "-1000\n-2000\n\n-3000\n" };
        for (text, read) in [(forces, read_forces as fn(&Path) -> _), (pressures, read_pressures)] {
            fs::write(&path, changed(text, &changes)).expect("writable");
            if let Err(error) = read(&path) {
                prop_assert!(is_a_message(&error.to_string()), "{}", error);
            }
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fuzzed");
        fs::write(&path, &bytes).expect("writable");
        let errors = [
            Design::load(&path).err().map(|error| error.to_string()),
            Scene::load(&path).err().map(|error| error.to_string()),
            read_recording(&path, &four(), 0).err().map(|error| error.to_string()),
            read_outcomes(&path, 1).err().map(|error| error.to_string()),
            read_forces(&path).err().map(|error| error.to_string()),
            read_pressures(&path).err().map(|error| error.to_string()),
            FrameLines::new(&path, &four(), 0).frame(&bytes).err().map(|error| error.to_string()),
        ];
        for error in errors.into_iter().flatten() {
            prop_assert!(is_a_message(&error), "{error}");
        }
    }
}
