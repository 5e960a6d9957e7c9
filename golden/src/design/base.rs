//! `base = "FILE"`: the keys of another design file under those of this one.

use std::path::Path;

use toml::{Table, Value};

use super::DesignError;
use super::checks::Check;
use super::files::Beside;
use super::read::table;

/// Keys that name files, as paths from the design file.
const PATHS: [&[&str]; 4] = [
    &["sensor", "calibration"],
    &["sensor", "curve"],
    &["algorithm", "correction", "file"],
    &["algorithm", "filter", "scenes"],
];

/// A base, as it was read.
pub(super) struct Base {
    pub(super) text: String,
    /// Its place, for messages.
    pub(super) origin: String,
}

/// Puts the base's keys under those of `own`; `None` if it names no base.
pub(super) fn merge(check: &Check, own: &mut Table, beside: Beside<'_>) -> Result<Option<Base>, DesignError> {
    let Some(name) = own.get("base").and_then(Value::as_str).map(str::to_owned) else { return Ok(None) };
    let path = beside.path(&name);
    let text = beside.read(&name).map_err(|source| {
        let problem = format!("names {}, which cannot be read: {source}", path.display());
        check.value("base", problem, "give the path of a design file from this one")
    })?;
    let origin = path.display().to_string();
    let mut keys = table(&text, &origin)?;
    if keys.contains_key("base") {
        let problem = format!("names {origin}, which has a base itself");
        return Err(check.value("base", problem, "name that one, and write here what is changed"));
    }
    if let Some(folder) = Path::new(&name).parent().filter(|folder| !folder.as_os_str().is_empty()) {
        for path in PATHS {
            relocate(&mut keys, path, folder);
        }
    }
    own.remove("base");
    under(own, keys);
    Ok(Some(Base { text, origin }))
}

/// Adds to `own` what it lacks of `base`, tables key by key. A filter is one choice, and goes as a whole.
fn under(own: &mut Table, base: Table) {
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

/// Makes paths from the base's folder into paths from the design's.
fn relocate(table: &mut Table, path: &[&str], folder: &Path) {
    let moved = |name: &str| Value::from(folder.join(name).to_string_lossy().into_owned());
    let [key, rest @ ..] = path else { return };
    match table.get_mut(*key) {
        Some(Value::Table(table)) => relocate(table, rest, folder),
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
