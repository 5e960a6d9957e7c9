//! Numbers as people read them.

/// `1234567` as `1,234,567`.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Rounded, the whole part grouped. For values that are not negative.
pub fn decimals(value: f64, places: usize) -> String {
    if !value.is_finite() {
        return "∞".to_owned();
    }
    let text = format!("{value:.places$}");
    match text.split_once('.') {
        Some((whole, fraction)) => format!("{}.{fraction}", whole.parse().map_or_else(|_| whole.to_owned(), grouped)),
        None => text,
    }
}

/// One digit behind the point; from a thousand on as `2e3`.
pub fn percent(value: f64) -> String {
    if value < 1000.0 { format!("{value:.1}") } else { format!("{value:.0e}") }
}

/// The figure, or a dash where there is none.
pub fn or_dash(value: Option<f64>, show: impl FnOnce(f64) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), show)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 7_335_000].map(grouped), ["0", "999", "1,000", "7,335,000"]);
        assert_eq!(decimals(58680.0, 2), "58,680.00");
        assert_eq!(decimals(0.045, 1), "0.0");
        assert_eq!(decimals(f64::INFINITY, 1), "∞");
    }

    #[test]
    fn what_is_far_from_one_is_short() {
        assert_eq!([2.345, 1234.0].map(percent), ["2.3", "1e3"]);
        assert_eq!(or_dash(None, percent), "–");
    }
}
