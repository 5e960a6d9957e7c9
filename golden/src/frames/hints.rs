//! What to do about a line of frames that cannot be read.

use super::layout::{Layout, Target};
use crate::separator::{self, is_unknown};

/// About a field that is no number.
pub(super) fn value(target: Option<&Target>, layout: &Layout, text: &str) -> String {
    if is_unknown(text) && target.is_some() {
        let skip = if layout.skip_bad { "" } else { ", or leave such frames out with --skip-bad" };
        return format!("name a taxel that is dead in sensor.dead{skip}");
    }
    let behind = text.rsplit_once(':').filter(|_| text.starts_with(char::is_alphabetic));
    if behind.is_some_and(|(_, value)| separator::number(value.trim().as_bytes()).is_some()) {
        return "cut the names before the values: sed 's/[^,]*://g'".to_owned();
    }
    let counts = target.is_some_and(|target| target.counts);
    let what = if counts { "the sensor's count, such as 1012" } else { "the stress in pascals, such as -1250.5" };
    format!(
        "give {what}, separated by commas, semicolons, tabs or spaces; columns before the values need --labels, columns \
         behind them --columns FIRST-LAST, lines above them --skip-lines"
    )
}

/// About a line of `found` fields in place of `expected`, `labels` of them before the values.
pub(super) fn length(target: Option<&Target>, labels: usize, found: usize, expected: usize) -> String {
    let Some(target) = target else { return "give a line of forces for each frame".to_owned() };
    let taxels = target.sensor.taxels();
    let hint = match found.saturating_sub(expected) {
        0 => String::new(),
        more if more == taxels => format!(
            "; are these decimal commas? Separate the values by semicolons. Or two arrays in a line? Say which with \
             --columns {}-{} or --columns {}-{}",
            labels + 1,
            labels + taxels,
            labels + taxels + 1,
            labels + 2 * taxels
        ),
        more => format!(
            "; {more} columns more than taxels, a time or a total: in front of the values? Say so with --labels {}. Behind \
             them? With --columns {}-{}",
            labels + more,
            labels + 1,
            labels + taxels
        ),
    };
    let what = if target.counts { "count" } else { "stress" };
    format!("give one {what} for each taxel of the sensor{hint}")
}
