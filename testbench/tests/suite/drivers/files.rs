//! The C driver loads calibrations from files, good, wrong and damaged.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::calibration::{banks, subject, write_files};
use super::{CALIBRATION, DRIVER, FILES, MACHINE, SANITIZED, all_of, compile, run};
use crate::support::faults::some_faults_of;
use crate::support::workspace;

/// Damaged files.
const DAMAGED: usize = 200;

/// A calibration whose every taxel is alive, line by line, and what comes behind it.
fn lines(header: &str, line: &str, count: usize, behind: &str) -> String {
    format!("{header}{}{behind}", format!("{line}\n").repeat(count))
}

/// A calibration, a file of a curve, a noise floor, and the code and a part of the message.
type Bad = (String, Option<&'static str>, f64, &'static str);

fn bad() -> Vec<Bad> {
    let other = "0,0\n5,-10\n60,-1000\n";
    let curve = "count,pascals\n0,0\n9000,-112500\n";
    let header = "gain,offset,taxel 3,taxel 4\n";
    let steep = "count,pascals\n0,0\n1e-3,-9000\n9,-20000\n";
    let points: String = (0..66).map(|count| format!("{count},{count}\n")).collect();
    let ascending = format!("count,pascals\n{points}");
    vec![
        // What is wrong with the file: BAD_FILE.
        ("1.0,0.0\n1.0\n".to_owned(), None, 0.0, "-22 line 2: \"1.0\" is no gain,offset such as"),
        ("1.0;0.0\n1.0,0\n".to_owned(), None, 0.0, "-22 line 2: \"1.0,0\" is no gain,offset"),
        ("nan,0\n".to_owned(), None, 0.0, "-22 line 1: \"nan,0\" is no gain,offset"),
        ("0x1,0\n".to_owned(), None, 0.0, "-22 line 1: \"0x1,0\" is no gain,offset"),
        ("1,1e39\n".to_owned(), None, 0.0, "-22 line 1: \"1,1e39\" is no gain,offset"),
        (lines("", "1,0", 3, ""), None, 0.0, "-22 line 3: 3 taxels, and the core has 12"),
        (lines("", "1,0", 13, ""), None, 0.0, "-22 line 13: a taxel more than the 12"),
        (String::new(), None, 0.0, "-22 : 0 taxels, and the core has 12"),
        (lines("", "1,0", 11, curve), None, 0.0, "-22 line 12: 11 taxels, and the core has 12"),
        ("1,0,".repeat(20) + "\n", None, 0.0, "-22 line 1: more than 17 values"),
        ("1".repeat(3000) + "\n", None, 0.0, "-22 line 1: a line of more than 2046 characters"),
        (lines("offset,gain\n", "0,1", 12, ""), None, 0.0, "-22 line 1: \"offset,gain\" is no header"),
        (lines("gain,offset,3\n", "1,0,0", 12, ""), None, 0.0, "-22 line 1: \"gain,offset,3\" is no gain,offset"),
        (
            lines("gain,offset,taxel 12\n", "1,0,0", 12, ""),
            None,
            0.0,
            "-22 line 1: \"gain,offset,taxel 12\" has no number",
        ),
        (lines(header, "1,0,0", 12, ""), None, 0.0, "-22 line 2: \"1,0,0\" is no gain,offset and a weight"),
        (lines("", "1,0", 12, "count,pascals\n0\n"), None, 0.0, "-22 line 14: \"0\" is no count,pascals"),
        (lines("", "1,0", 12, ""), Some("0,0\n5,x\n"), 0.0, "-22 curve.csv, line 2: \"5,x\" is no count,pascals"),
        (
            lines("", "1,0", 12, ""),
            Some("gain,offset\n1,0\n"),
            0.0,
            "-22 curve.csv, line 2: gains and offsets, and no curve",
        ),
        (
            lines("", "1,0", 12, ""),
            Some("pascals,count\n0,0\n"),
            0.0,
            "-22 curve.csv, line 1: \"pascals,count\" has the pascals",
        ),
        (lines("", "1,0", 12, curve), Some(other), 0.0, "-22 curve.csv, line 2: the curve is another"),
        (lines("", "1,0", 12, curve), Some("0,0\n"), 0.0, "-22 curve.csv: the curve is another"),
        (lines("", "1,0", 12, &ascending), None, 0.0, "-22 line 79: more than 65 points"),
        // What no bank takes: OUT_OF_RANGE.
        (lines("# 17\n17,0\n", "1,0", 11, ""), None, 0.0, "-14 line 2: no bank takes a gain of 17 with an offset of 0"),
        (
            lines("", "1,0", 11, "1,1000000\n"),
            None,
            0.0,
            "-14 line 12: no bank takes a gain of 1 with an offset of 1e+06",
        ),
        (lines("gain,offset\n", "1,0", 11, "0,0\n"), None, 0.0, "-14 line 13: nothing replaces taxel 11 of gain 0"),
        (
            lines("gain,offset,taxel 4,taxel 3\n", "1,0,0,0", 12, ""),
            None,
            0.0,
            "-14 line 1: dead taxels ascend, and taxel 3",
        ),
        (lines(header, "1,0,0.5,0", 12, ""), None, 0.0, "-14 line 5: a dead taxel has a weight of 0"),
        (
            lines("gain,offset,taxel 1,taxel 3,taxel 4\n", "1,0,0,0,0", 12, ""),
            None,
            0.0,
            "-14 line 1: 3 dead taxels, and the core has room for 2",
        ),
        (
            lines("", "1,0", 12, "count,pascals\n0,0\n5,-10\n5,-20\n"),
            None,
            0.0,
            "-14 line 16: 5,-20 after 5,-10: counts ascend",
        ),
        (lines("", "1,0", 12, steep), None, 0.0, "-14 line 15: 0.001,-9000 after 0,0"),
        (lines("", "1,0", 12, "count,pascals\n"), None, 0.0, "-14 a curve of 0 points: use 2 to 17"),
        (lines("", "1,0", 12, ""), Some("0,0\n"), 0.0, "-14 curve.csv: a curve of 1 points: use 2 to 17"),
        (lines("", "1,0", 12, ""), None, 1e12, "-14 a noise floor of 1e+12 Pa"),
    ]
}

/// Whatever a byte of one of so many files turns into.
fn damage(place: &Path, files: usize, list: &mut String) {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for index in 0..DAMAGED {
        let mut bytes = fs::read(place.join(format!("{}.csv", index % files))).expect("there");
        for _ in 0..random.random_range(1..4) {
            let at = random.random_range(0..bytes.len());
            match random.random_range(0..3) {
                0 => drop(bytes.remove(at)),
                1 => bytes[at] = b"0123456789,;\t-+eE.\"#\n\r \0"[random.random_range(0..24)],
                _ => bytes.insert(at, random.random()),
            }
        }
        fs::write(place.join(format!("any{index}.csv")), bytes).expect("written");
        writeln!(list, "any any{index}.csv - 0.0").expect("to a string");
    }
}

#[test]
fn the_c_driver_loads_files() {
    let (plan, built) = subject();
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path();
    let mut list = String::new();
    let all = banks(&plan);
    for (index, inputs) in all.iter().enumerate() {
        write_files(&plan, inputs, index, place);
        let words = inputs.bank.words().into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>();
        fs::write(place.join(format!("{index}.words")), words).expect("written");
        let curve = if index == 1 || index == 4 { format!("{index}.curve.csv") } else { "-".to_owned() };
        writeln!(list, "good {index}.csv {curve} {:?} {index}.words", inputs.noise).expect("to a string");
    }
    let bad = bad();
    for (index, (text, curve, noise, said)) in bad.iter().enumerate() {
        fs::write(place.join(format!("bad{index}.csv")), text).expect("written");
        let named = curve.map_or("-".to_owned(), |_| format!("bad{index}curve.csv"));
        if let Some(curve) = curve {
            fs::write(place.join(&named), curve).expect("written");
        }
        writeln!(list, "bad bad{index}.csv {named} {noise:?} {said}").expect("to a string");
    }
    writeln!(list, "bad none.csv - 0.0 -8 cannot open the file: No such file").expect("to a string");
    writeln!(list, "bad . - 0.0 -8 cannot read the file: Is a directory").expect("to a string");
    damage(place, all.len(), &mut list);
    fs::write(place.join("list"), list).expect("written");
    let run_with = |files: &[PathBuf]| {
        let own = ["testbench/tests/suite/drivers/file.c"];
        let others = DRIVER.into_iter().chain(CALIBRATION).chain(MACHINE).chain(own).map(workspace);
        let sources: Vec<_> = others.chain(files.iter().cloned()).collect();
        let host = place.join("host");
        compile(&sources.iter().map(PathBuf::as_path).collect::<Vec<_>>(), &SANITIZED, &host);
        let mut command = Command::new(host);
        command.arg(&built.library).arg("list").current_dir(place);
        command
    };
    let driver = FILES.map(workspace);
    assert!(run(run_with(&driver)).contains(&format!("PASS: 6 good, {} bad, 200 any", bad.len() + 2)));
    // A driver that is wrong is noticed.
    let text = all_of(&driver);
    let faults = [
        ("\";\\t,\"", "\",;\\t\""),
        ("of->weights[place * of->taxels + of->taken]", "of->weights[of->taken * of->dead_count + place]"),
        ("from->count > SPTFRA_MOST_FIELDS) {\n            return 0;", "0) {\n            return 0;"),
        ("of->point_lines[of->points++] = from->number;", "of->points++;"),
        ("of->points == MOST_POINTS", "0"),
        ("sptfra_begins(name, \"taxel \")", "strncmp(name, \"taxel \", 6) == 0"),
    ];
    for (right, wrong) in some_faults_of(&text, faults) {
        let copies = driver.each_ref().map(|file| {
            let text = fs::read_to_string(file).expect("there");
            let copy = place.join(file.file_name().expect("a file"));
            fs::write(&copy, text.replace(right, wrong)).expect("written");
            copy
        });
        let output = run_with(&copies).output().expect("starts");
        assert!(!output.status.success(), "{right}: {}", String::from_utf8_lossy(&output.stdout));
    }
}
