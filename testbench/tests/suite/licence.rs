//! Who takes a single file of this project elsewhere finds its licence in it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::workspace;

const FOLDERS: [&str; 6] = ["docs/ci", "drivers", "hdl-gen/rtl", "python", "testbench", "tools"];
const ENDINGS: [&str; 11] = ["c", "cpp", "h", "py", "sh", "smk", "sv", "svh", "tcl", "v", "yml"];
const LINE: &str = "SPDX-License-Identifier: MIT OR Apache-2.0";

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the project") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().and_then(|ending| ending.to_str()).is_some_and(|ending| ENDINGS.contains(&ending)) {
            found.push(path);
        }
    }
}

#[test]
fn every_source_that_is_not_rust_names_its_licence() {
    let mut found = ["Makefile", ".ci/run"].map(workspace).to_vec();
    for folder in FOLDERS {
        sources(&workspace(folder), &mut found);
    }
    assert!(found.len() > 150, "only {} files found", found.len());
    let without = found.iter().filter(|path| {
        let text = fs::read_to_string(path).expect("UTF-8");
        // PeakRDL prints the driver's header, and says so in its first lines.
        !text.lines().take(3).any(|line| line.contains(LINE)) && !path.ends_with("sptfra_registers.h")
    });
    let without: Vec<&PathBuf> = without.collect();
    assert!(without.is_empty(), "without the line `{LINE}`: {without:?}");
}
