//! Design files of older formats: what has to be changed, all at once.

use toml::{Table, Value};

use super::DesignError;
use super::checks::Check;
use super::keys::FORMAT;

/// Refuses a file of another format, or with keys of another, with the new form of each.
pub(super) fn refuse(check: &Check, file: &Table) -> Result<(), DesignError> {
    let changes = changes(file);
    let format = file.get("format");
    let problem = match format {
        Some(Value::Integer(format)) if *format == FORMAT && changes.is_empty() => return Ok(()),
        Some(Value::Integer(format)) if *format == FORMAT => format!("is {FORMAT}, and there are keys of format 2"),
        Some(other) => format!("is {other}, and this version reads format {FORMAT}"),
        None => "is missing".to_owned(),
    };
    let first = match format {
        Some(Value::Integer(format)) if *format == FORMAT => Vec::new(),
        Some(Value::Integer(format)) if *format > FORMAT => vec!["use a newer version".to_owned()],
        _ => vec![format!("write format = {FORMAT} above the tables")],
    };
    let steps: Vec<String> = first.into_iter().chain(changes).collect();
    Err(check.value("format", problem, steps.join("; ")))
}

/// What to do about each key that format 3 does not know, in the file's order of tables and keys.
fn changes(file: &Table) -> Vec<String> {
    let mut changes = Vec::new();
    for table in ["sensor", "algorithm", "hardware"] {
        let keys = file.get(table).and_then(Value::as_table);
        for (key, value) in keys.into_iter().flatten() {
            changes.extend(change(table, key, value, file).map(|new| format!("{table}.{key} = {value}: {new}")));
        }
    }
    changes
}

/// What to do about a key of `table`; `None` of one that format 3 has.
fn change(table: &str, key: &str, value: &Value, file: &Table) -> Option<String> {
    let word = value.as_str().unwrap_or_default();
    let become_ = |key: &str, word: &str| Some(format!("write {key} = \"{word}\""));
    let renamed = |key: &str| Some(format!("write {key} = {value}"));
    match (table, key) {
        ("algorithm", "count_bodies") => renamed("count_contacts"),
        ("algorithm", "family") => become_("training_set", if word == "wide" { "general" } else { "sliding" }),
        ("algorithm", "doubt") => renamed("max_standard_error"),
        ("algorithm", "fitted_to") => {
            let conditions = word.strip_suffix(", wide").map_or_else(|| word.to_owned(), |of| format!("{of}, general"));
            become_("calibrated_for", &conditions)
        }
        ("algorithm", "tangential") => renamed("friction_correction"),
        ("hardware", "range") => become_("scaling", if word == "frame" { "per_frame" } else { "fixed" }),
        ("hardware", "optimise") if word == "interval" => become_("optimise", "throughput"),
        ("hardware", "arithmetic" | "skip_zeros") => Some("remove it".to_owned()),
        ("hardware", "replaceable") => {
            let dead = file.get("sensor").and_then(|sensor| sensor.get("dead"));
            let dead = dead.map_or_else(|| "[]".to_owned(), Value::to_string);
            Some(format!("write dead = {{ taxels = {dead}, room = {value} }} under [sensor]"))
        }
        ("hardware", "target_us") => Some(format!("give --target-us {value} to inspect and generate")),
        ("hardware", "debug") => Some("give --debug to generate".to_owned()),
        _ => None,
    }
}
