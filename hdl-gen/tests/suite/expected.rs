//! The output of one small design lies in git, so that the review of a change sees what it does to the Verilog. Modules of
//! the library, which are emitted as they stand in `hdl-gen/rtl` with the generator's version, are listed by name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs};

use hdl_gen::cores::Multiplier;
use hdl_gen::emit::rtl::library;
use hdl_gen::emit::{FileMap, VERSION, emit};
use hdl_gen::plan::Plan;

use crate::support::designs::design;

/// What writes the folder anew.
const RENEW: &str = "UPDATE_EXPECTED=1 cargo test -p sptfra-hdl-gen --test suite expected::";

/// More would hide a change in the review that is to show it.
const MOST_BYTES: usize = 450_000;

/// The list of the library's modules in the output.
const LIBRARY: &str = "rtl/library.txt";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/expected/small")
}

fn generated() -> FileMap {
    let mut files = emit(&Plan::new(&design("small")).expect("a plan")).expect("emitted");
    let copies: BTreeMap<String, String> = library(Multiplier::Whole)
        .into_iter()
        .map(|(module, text)| {
            (format!("rtl/{module}.v"), text.replacen(" generator.", &format!(" generator. Version {VERSION}."), 1))
        })
        .collect();
    let listed: String = files
        .extract_if(.., |path, text| copies.get(path).is_some_and(|copy| copy.as_bytes() == text))
        .map(|(path, _)| path + "\n")
        .collect();
    files.insert(LIBRARY.to_owned(), listed.into_bytes());
    files
}

/// The files of a folder and of those in it, by their paths within.
fn read(folder: &Path, within: &str, files: &mut FileMap) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("there").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        let within = if within.is_empty() { name.into_owned() } else { format!("{within}/{name}") };
        if path.is_dir() {
            read(&path, &within, files);
        } else {
            files.insert(within, fs::read(&path).expect("readable"));
        }
    }
}

/// Where two texts differ first: line number, line expected, line found.
fn difference(expected: &[u8], found: &[u8]) -> String {
    let [expected, found] = [expected, found].map(String::from_utf8_lossy);
    let lines = expected.lines().zip(found.lines()).enumerate();
    match lines.filter(|(_, (expected, found))| expected != found).map(|(at, lines)| (at + 1, lines)).next() {
        Some((line, (expected, found))) => format!("line {line} is `{found}`, expected `{expected}`"),
        None => format!("{} lines, expected {}", found.lines().count(), expected.lines().count()),
    }
}

#[test]
fn the_small_design_is_as_it_lies_in_git() {
    let files = generated();
    if env::var_os("UPDATE_EXPECTED").is_some() {
        if folder().is_dir() {
            fs::remove_dir_all(folder()).expect("removable");
        }
        for (path, contents) in &files {
            let file = folder().join(path);
            fs::create_dir_all(file.parent().expect("a folder")).expect("writable");
            fs::write(file, contents).expect("writable");
        }
    }
    let mut expected = FileMap::new();
    read(&folder(), "", &mut expected);
    let mut differences = BTreeMap::new();
    for (path, contents) in &files {
        match expected.get(path) {
            None => drop(differences.insert(path, "is not expected".to_owned())),
            Some(text) if text != contents => drop(differences.insert(path, difference(text, contents))),
            Some(_) => {}
        }
    }
    for path in expected.keys().filter(|path| !files.contains_key(*path)) {
        differences.insert(path, "is expected and not generated".to_owned());
    }
    let list: String = differences.iter().map(|(path, what)| format!("\n{path}: {what}")).collect();
    assert!(list.is_empty(), "{list}\nIf this is meant: {RENEW}");
    let bytes: usize = files.values().map(Vec::len).sum();
    assert!(bytes <= MOST_BYTES, "{bytes} bytes: choose a smaller design");
}
