//! The standard error that an estimator states: the logarithm of its share of the normal force.

/// Fraction bits of the logarithm.
pub const ERROR_FRACTION: u32 = 12;
/// Least and largest logarithm of base 2: a thousandth of the normal force, and four times as much.
pub const ERROR_RANGE: [i32; 2] = [-10, 2];

/// A logarithm within its range, as far as it goes there.
pub(crate) fn limited(log: f64) -> f64 {
    let [least, most] = ERROR_RANGE.map(f64::from);
    log.clamp(least, most - (-f64::from(ERROR_FRACTION)).exp2())
}

/// What a logarithm of base 2 stands for: `2^n (1 + f)` for n + f, which differs from `2^(n + f)` by 6 % at most and is a
/// floating-point number as it is.
pub(crate) fn ratio(log: f64) -> f64 {
    (1.0 + log - log.floor()) * log.floor().exp2()
}

/// The logarithm that stands for a ratio above 0.
pub(crate) fn log(ratio: f64) -> f64 {
    let whole = ratio.log2().floor();
    whole + ratio / whole.exp2() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_comes_back_from_its_logarithm() {
        for value in [1e-3, 0.05, 0.1, 0.125, 0.3, 1.0, 1.7, 3.99] {
            assert!((ratio(log(value)) / value - 1.0).abs() < 1e-12, "{value}");
            assert!((ratio(value.log2()) / value - 1.0).abs() < 0.062, "{value}");
        }
        assert!((limited(-99.0) + 10.0).abs() < 1e-12 && limited(99.0) < 2.0);
    }
}
