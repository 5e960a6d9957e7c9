//! What to do about a line of frames that cannot be read.

use super::layout::{Layout, Target};
use crate::numbers::counted;
use crate::separator::{self, is_unknown};

/// Columns beside a row of the grid, such as its number, a time and a sum.
const BESIDE: usize = 3;

/// About a field that is no number.
pub(super) fn value(target: &Target, layout: &Layout, text: &str) -> String {
    if is_unknown(text) {
        let skip = if layout.skip_bad { "" } else { ", or leave such frames out with --skip-bad" };
        return format!("name a taxel that is dead in sensor.dead{skip}");
    }
    let behind = text.rsplit_once(':').filter(|_| text.starts_with(char::is_alphabetic));
    if behind.is_some_and(|(_, value)| separator::number(value.trim().as_bytes()).is_some()) {
        return "cut the names before the values: sed 's/[^,]*://g'".to_owned();
    }
    let what =
        if target.counts { "the sensor's count, such as 1012" } else { "the stress in pascals, such as -1250.5" };
    format!(
        "give {what}, separated by commas, semicolons, tabs or spaces; columns before the values need --labels, columns \
         behind them --columns FIRST-LAST, lines above them --skip-lines"
    )
}

/// About a line of `found` fields in place of `expected`, `labels` of them before the values.
pub(super) fn length(target: &Target, labels: usize, found: usize, expected: usize) -> String {
    let (taxels, columns) = (target.sensor.taxels(), target.sensor.columns);
    let [first, last] = [labels + 2, labels + 1 + taxels];
    let either_side = format!(". Some on either side? With --columns {first}-{last} or the like");
    let either_side = if found > expected + 1 { &either_side } else { "" };
    let beside = found.checked_sub(labels + columns).filter(|beside| (1..=BESIDE).contains(beside));
    let hint = match (found.saturating_sub(expected), beside) {
        (0, Some(beside)) => format!(
            "; are these rows of the grid, with {} more? Say where their {columns} values stand with --columns {}-{} or \
             --columns {}-{found}",
            counted(beside, "column"),
            labels + 1,
            labels + columns,
            labels + beside + 1
        ),
        (0, _) => String::new(),
        (more, _) if more == taxels => format!(
            "; are these decimal commas? Separate the values by semicolons. Or two arrays in a line? Say which with \
             --columns {}-{} or --columns {}-{}",
            labels + 1,
            labels + taxels,
            labels + taxels + 1,
            labels + 2 * taxels
        ),
        (more, _) => format!(
            "; {} more than taxels, a time or a total: in front of the values? Say so with --labels {}. Behind them? With \
             --columns {}-{}{}",
            counted(more, "column"),
            labels + more,
            labels + 1,
            labels + taxels,
            either_side
        ),
    };
    let what = if target.counts { "count" } else { "stress" };
    format!("give one {what} for each taxel of the sensor{hint}")
}
