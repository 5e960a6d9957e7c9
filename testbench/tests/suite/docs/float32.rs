//! What docs/choosing.md says of words of 27 × 35 bits beside float32, against the figures of docs/hard-cases.md.

use std::cmp::Ordering;
use std::fs;

use crate::support::workspace;

/// `A f = b` by float32 and by wide words, of each case that states both.
fn figures() -> Vec<[f64; 2]> {
    let page = fs::read_to_string(workspace("docs/hard-cases.md")).expect("readable");
    let (mut columns, mut figures) = (None, Vec::new());
    for line in page.lines() {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if !line.starts_with("| ") {
            columns = columns.filter(|_| line.starts_with("|---"));
        } else if cells[0] == "case" {
            // A table of the line estimator: float32 and wide words behind the backward error.
            let place = cells.iter().position(|name| *name == "backward f64");
            columns = place.filter(|&at| cells[at + 1..=at + 3] == ["f32", "fixed", "wide"]).map(|at| [at + 1, at + 3]);
        } else if let Some(columns) = columns {
            let [float32, wide] = columns.map(|column: usize| cells[column].parse().ok());
            figures.extend(float32.zip(wide).map(|(float32, wide)| [float32, wide]));
        }
    }
    figures
}

#[test]
fn wide_words_are_beside_float32_as_stated() {
    let figures = figures();
    let count = |wanted| figures.iter().filter(|[float32, wide]| wide.partial_cmp(float32) == Some(wanted)).count();
    let stated = format!(
        "the smaller in {} of {}, the same in {}",
        count(Ordering::Less),
        figures.len(),
        count(Ordering::Equal)
    );
    let page = fs::read_to_string(workspace("docs/choosing.md")).expect("readable");
    let text: Vec<&str> = page.split_whitespace().collect();
    assert!(text.join(" ").contains(&stated), "docs/choosing.md does not say: {stated}");
}
