//! What of the sources is hardware in a design: modules are the same in all of them, and leave out by `generate` what
//! a design has not.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::compile::output;
use super::{BuildError, RtlSources, write_sources};
use crate::tools;

/// Each node of Verilator's tree has its place in the sources, as `FILE,LINE:COLUMN,LINE:COLUMN`.
const PLACE: &str = "\"loc\":\"";

/// The names of the tree's files.
#[derive(Deserialize)]
struct Names {
    files: BTreeMap<String, Name>,
}

#[derive(Deserialize)]
struct Name {
    filename: String,
}

/// The lines, from 1, with something that Verilator's tree still has after elaboration, file by file.
///
/// # Errors
/// [`BuildError`] if Verilator does not take the sources, or there is no room for them.
pub fn elaborated_lines(sources: &RtlSources) -> Result<BTreeMap<String, BTreeSet<usize>>, BuildError> {
    let folder = tempfile::tempdir().map_err(BuildError::io("make a folder in", &std::env::temp_dir()))?;
    write_sources(sources, folder.path())?;
    let mut command = tools::verilator()?;
    command.args(["--json-only", "--json-only-output", "tree.json", "--json-only-meta-output", "names.json"]);
    command.args(["-Wno-fatal", "--top-module", &sources.top]).args(sources.verilog()).current_dir(folder.path());
    output(command, "Verilator", &sources.top)?;
    let read = |name: &str| {
        let file = folder.path().join(name);
        fs::read_to_string(&file).map_err(BuildError::io("read", Path::new(name)))
    };
    let names: Names = serde_json::from_str(&read("names.json")?)
        .map_err(|error| BuildError::io("read", Path::new("names.json"))(error.into()))?;
    let tree = read("tree.json")?;
    let mut lines: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
    for (at, mark) in tree.match_indices(PLACE) {
        let mut parts = tree[at + mark.len()..].splitn(3, [',', ':']);
        let name = parts.next().and_then(|file| names.files.get(file));
        if let (Some(name), Some(Ok(line))) = (name, parts.next().map(str::parse)) {
            lines.entry(name.filename.clone()).or_default().insert(line);
        }
    }
    Ok(lines)
}
