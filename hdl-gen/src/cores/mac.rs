//! The multiply-accumulate lane: 18 by 27 bits into 48, the shape of one DSP block.

use super::ACCUMULATOR_BITS;

/// Cycles from the operands to the accumulator that holds their product.
pub const LATENCY: u32 = 3;

/// The accumulator after one valid product: `coefficient * data`, added to what was there unless this is the first
/// product of a sum. Wraps at 48 bits.
pub fn accumulate(accumulator: i64, first: bool, coefficient: i32, data: i32) -> i64 {
    let product = i64::from(coefficient) * i64::from(data);
    let sum = if first { product } else { accumulator.wrapping_add(product) };
    let unused = 64 - ACCUMULATOR_BITS;
    (sum << unused) >> unused
}

#[cfg(test)]
mod tests {
    use super::accumulate;

    #[test]
    fn starts_adds_and_wraps() {
        assert_eq!(accumulate(99, true, -3, 5), -15);
        assert_eq!(accumulate(99, false, -3, 5), 84);
        let product = 1 << 43;
        assert_eq!(accumulate((1 << 47) - product, false, -(1 << 17), -(1 << 26)), -(1 << 47));
    }
}
