//! Design files of older formats: what has to be changed, all at once.

use toml::{Table, Value};

use super::DesignError;
use super::checks::Check;
use super::keys::FORMAT;

/// Refuses a file of another format, or with keys of another, with the new form of each.
pub(super) fn refuse(origin: &str, file: &Table) -> Result<(), DesignError> {
    let format = file.get("format").map(|format| format.as_integer().unwrap_or(0));
    let mut steps = changes(file);
    let problem = match format {
        Some(FORMAT) if steps.is_empty() => return Ok(()),
        Some(FORMAT) => format!("is {FORMAT}, and there are keys of format 2"),
        Some(format) if format > FORMAT => {
            steps = vec!["use a newer version of sptfra".to_owned()];
            format!("is {format}, and this version reads format {FORMAT}")
        }
        _ => {
            steps.insert(0, format!("write format = {FORMAT} above the tables"));
            format!("is not {FORMAT}")
        }
    };
    Err(Check { origin }.value("format", problem, steps.join("; ")))
}

/// What to do about each key that this format does not know, in the file's order of tables and keys.
fn changes(file: &Table) -> Vec<String> {
    let mut changes = Vec::new();
    for table in ["sensor", "algorithm", "hardware"] {
        for (key, value) in file.get(table).and_then(Value::as_table).into_iter().flatten() {
            changes.extend(change(table, key, value, file).map(|new| format!("{table}.{key} = {value}: {new}")));
        }
    }
    changes
}

/// What to do about a key of `table`; `None` of one that this format has.
fn change(table: &str, key: &str, value: &Value, file: &Table) -> Option<String> {
    let word = value.as_str().unwrap_or_default();
    Some(match (table, key) {
        ("algorithm", "count_bodies") => format!("write count_contacts = {value}"),
        ("algorithm", "family") if word == "wide" => "write training_set = \"general\"".to_owned(),
        ("algorithm", "family") => "write training_set = \"sliding\"".to_owned(),
        ("algorithm", "doubt") => format!("write max_standard_error = {value}"),
        ("algorithm", "correction") if value.get("error_base").is_some() => {
            "remove correction and run `sptfra calibrate`".to_owned()
        }
        ("algorithm", "tangential") => format!("write friction_correction = {value}"),
        ("algorithm", "grid" | "fitted_to") => "remove it and run `sptfra calibrate`".to_owned(),
        ("hardware", "range") if word == "frame" => "write scaling = \"per_frame\"".to_owned(),
        ("hardware", "range") => "write scaling = \"fixed\"".to_owned(),
        ("hardware", "optimise") if word == "interval" => "write optimise = \"throughput\"".to_owned(),
        ("hardware", "arithmetic" | "skip_zeros") => "remove it".to_owned(),
        ("hardware", "replaceable") => {
            let dead = file.get("sensor").and_then(|sensor| sensor.get("dead"));
            let dead = dead.map_or_else(|| "[]".to_owned(), Value::to_string);
            format!("write dead = {{ taxels = {dead}, room = {value} }} under [sensor]")
        }
        ("hardware", "target_us") => format!("give --target-us {value} to inspect and generate"),
        ("hardware", "debug") => "give --debug to generate".to_owned(),
        _ => return None,
    })
}
