//! Keys that a design file no longer has, and what stands in their place.

use super::DesignError;
use super::checks::Check;

/// Table, key, and what to do.
const RENAMED: [(&str, &str, &str); 5] = [
    ("algorithm", "family", "write training_set = \"sliding\" for \"narrow\", training_set = \"general\" for \"wide\""),
    ("algorithm", "doubt", "write max_standard_error in its place"),
    ("algorithm", "fitted_to", "remove it and run `sptfra calibrate`, which writes calibrated_for"),
    ("algorithm", "tangential", "write friction_correction in its place, or run `sptfra calibrate`"),
    ("algorithm", "grid", "remove it and run `sptfra calibrate`: the search has one grid, of 13 x 13 points"),
];

/// Refuses the first of these keys. Text that is no TOML passes: its error is another one.
pub(super) fn refuse(text: &str, origin: &str) -> Result<(), DesignError> {
    let Ok(design) = text.parse::<toml::Table>() else { return Ok(()) };
    let has = |table: &str, key: &str| design.get(table).is_some_and(|table| table.get(key).is_some());
    match RENAMED.into_iter().find(|(table, key, _)| has(table, key)) {
        Some((table, key, remedy)) => {
            let problem = "is a key of an earlier version".to_owned();
            Err(Check { origin }.value(&format!("{table}.{key}"), problem, remedy.to_owned()))
        }
        None => Ok(()),
    }
}
