//! `base = "FILE"`: the keys of another design file under those of this one.

use std::path::Path;

use toml::{Table, Value};

/// Keys that name files, as paths from the design file.
const PATHS: [&[&str]; 4] = [
    &["sensor", "calibration"],
    &["sensor", "curve"],
    &["algorithm", "correction", "file"],
    &["algorithm", "filter", "scenes"],
];

/// What errors of a design depend on: with another value, those of its base are not its own.
const DECIDE_ERRORS: [(&str, &[&str]); 2] = [
    ("sensor", &["columns", "rows", "pitch_mm", "depth_mm", "tension"]),
    ("algorithm", &["kernel", "regularisation", "filter", "estimator", "gain", "friction_correction", "correction"]),
];

/// Removes errors that `base` states of itself, where `own` has another sensor or algorithm.
pub(super) fn drop_errors(own: &Table, base: &mut Table) {
    let has = |(table, keys): (&str, &[&str])| {
        let table = own.get(table).and_then(Value::as_table);
        table.is_some_and(|table| keys.iter().any(|key| table.contains_key(*key)))
    };
    if let Some(algorithm) = base.get_mut("algorithm").and_then(Value::as_table_mut)
        && DECIDE_ERRORS.into_iter().any(has)
    {
        for key in ["standard_error", "expected_error"] {
            algorithm.remove(key);
        }
    }
}

/// Adds to `own` what it lacks of `base`, tables key by key. A filter is one choice, and goes as a whole.
pub(super) fn under(own: &mut Table, base: Table) {
    for (key, below) in base {
        match (own.get_mut(&key), below) {
            (None, below) => {
                own.insert(key, below);
            }
            (Some(Value::Table(own)), Value::Table(below)) if key != "filter" => under(own, below),
            _ => (),
        }
    }
}

/// Makes paths from the folder of the base of this `name` into paths from the design's.
pub(super) fn relocate(table: &mut Table, name: &str) {
    if let Some(folder) = Path::new(name).parent().filter(|folder| !folder.as_os_str().is_empty()) {
        for path in PATHS {
            move_path(table, path, folder);
        }
    }
}

fn move_path(table: &mut Table, path: &[&str], folder: &Path) {
    let moved = |name: &str| Value::from(folder.join(name).to_string_lossy().into_owned());
    let [key, rest @ ..] = path else { return };
    match table.get_mut(*key) {
        Some(Value::Table(table)) => move_path(table, rest, folder),
        Some(Value::String(name)) if rest.is_empty() => table[*key] = moved(&name.clone()),
        Some(Value::Array(names)) if rest.is_empty() => {
            for name in names {
                if let Value::String(file) = name {
                    *name = moved(&file.clone());
                }
            }
        }
        _ => (),
    }
}
