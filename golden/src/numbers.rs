//! Largest magnitudes, middles, correlations and roundings of values, numbers of things in words, and rows of values as text.

use std::borrow::Borrow;
use std::fmt::Write;

/// The largest magnitude; 0 of no values.
pub(crate) fn magnitude(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    values.into_iter().fold(0.0, |peak: f64, value| peak.max(value.borrow().abs()))
}

/// The values from the least to the largest.
pub(crate) fn sorted(values: impl IntoIterator<Item: Borrow<f64>>) -> Vec<f64> {
    let mut values: Vec<f64> = values.into_iter().map(|value| *value.borrow()).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The middle value, of an even number the upper one; 0 of no values.
pub(crate) fn middle(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    let sorted = sorted(values);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// The mean; 0 of none.
pub(crate) fn mean(values: impl IntoIterator<Item: Borrow<f64>>) -> f64 {
    let mut count = 0_usize;
    let sum: f64 = values.into_iter().inspect(|_| count += 1).map(|value| *value.borrow()).sum();
    sum / count.max(1) as f64
}

/// The mean place of weights, none of them below 0; `None` where all are 0.
pub(crate) fn centre(places: impl Iterator<Item = (f64, [f64; 2])>) -> Option<[f64; 2]> {
    let [x, y, sum] = places
        .fold([0.0; 3], |[x, y, sum], (weight, [at_x, at_y])| [x + weight * at_x, y + weight * at_y, sum + weight]);
    (sum > 0.0).then(|| [x / sum, y / sum])
}

/// So many of a thing: "1 frame", "2 frames".
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Correlation of the values in pairs; 0 where either are all the same.
pub(crate) fn correlation(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let [count, a, b] = pairs.clone().fold([0.0; 3], |[count, a, b], (x, y)| [count + 1.0, a + x, b + y]);
    let [product, xx, yy] = pairs.fold([0.0; 3], |[product, xx, yy], (x, y)| {
        let [x, y] = [x - a / count, y - b / count];
        [product + x * y, xx + x * x, yy + y * y]
    });
    if xx * yy > 0.0 { product / (xx * yy).sqrt() } else { 0.0 }
}

/// To so many significant digits.
pub(crate) fn rounded(value: f64, digits: i32) -> f64 {
    if value == 0.0 {
        return value;
    }
    let digits = digits - 1 - value.abs().log10().floor() as i32;
    let scale = 10_f64.powi(digits.abs());
    if digits >= 0 { (value * scale).round() / scale } else { (value / scale).round() * scale }
}

/// Appends one CSV row; each number is the shortest that reads back as the same float.
pub(crate) fn push_row(text: &mut String, values: impl Iterator<Item = f64>) {
    for (index, value) in values.enumerate() {
        let separator = if index == 0 { "" } else { "," };
        // Writing to a String cannot fail.
        let _ = write!(text, "{separator}{value:?}");
    }
    text.push('\n');
}
