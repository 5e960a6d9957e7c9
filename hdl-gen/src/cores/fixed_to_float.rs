//! 64-bit fixed point, scaled by a power of two, to float32.

/// Enabled cycles from `fixed` to `float_bits`; one conversion a cycle.
pub const LATENCY: u32 = 7;

/// The float32 bits of `fixed * 2^exponent`, rounded to nearest even.
///
/// Zero gives +0. What rounds to less than the smallest normal number (2^-126) becomes a zero of the same sign, what
/// exceeds the largest finite number an infinity. The port takes `exponent` in -512 ..= 511.
pub fn convert(fixed: i64, exponent: i32) -> u32 {
    let magnitude = fixed.unsigned_abs();
    if magnitude == 0 {
        return 0;
    }
    let sign = u32::from(fixed < 0) << 31;
    let zeros = magnitude.leading_zeros();
    let normalised = magnitude << zeros;
    // The leading one stands for 2^(63 - zeros + exponent); 127 is the bias of float32.
    let biased = 127 + 63 - i64::from(zeros) + i64::from(exponent);
    let fraction = (normalised >> 40) as i64 & 0x7f_ffff;
    let (half, sticky) = (normalised >> 39 & 1 == 1, normalised & ((1 << 39) - 1) != 0);
    let up = i64::from(half && (sticky || fraction & 1 == 1));
    // A carry out of the fraction raises the exponent.
    let rounded = (biased << 23) + fraction + up;
    match rounded >> 23 {
        ..=0 => sign,
        1..=254 => sign | rounded as u32,
        255.. => sign | f32::INFINITY.to_bits(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(state: &mut u64) -> u64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *state ^ (*state >> 29)
    }

    #[test]
    fn agrees_with_the_native_conversion() {
        let mut state = 7;
        for _ in 0..200_000 {
            let width = next(&mut state) >> 58;
            let fixed = next(&mut state).cast_signed() >> width;
            assert_eq!(convert(fixed, 0), (fixed as f32).to_bits(), "{fixed}");
        }
        for fixed in [0, 1, -1, i64::MIN, i64::MAX, (1 << 24) + 1, (1 << 24) + 3, (1 << 25) - 1, -((1 << 40) - 1)] {
            assert_eq!(convert(fixed, 0), (fixed as f32).to_bits(), "{fixed}");
        }
    }

    #[test]
    fn scales_by_the_exponent() {
        let mut state = 3;
        for _ in 0..200_000 {
            let fixed = next(&mut state).cast_signed() >> 12;
            let exponent = (next(&mut state) >> 32) as i32 % 200;
            // 52 bits are exact in an f64, and so is the power of two.
            let expected = (fixed as f64 * f64::from(exponent).exp2()) as f32;
            let expected = if expected.is_subnormal() { 0.0_f32.copysign(expected) } else { expected };
            assert_eq!(convert(fixed, exponent), expected.to_bits(), "{fixed} {exponent}");
        }
    }

    #[test]
    fn flushes_and_overflows_with_the_sign() {
        assert_eq!(convert(1, -127), 0);
        assert_eq!(convert(-1, -127), 0x8000_0000);
        assert_eq!(convert(1, -126), f32::MIN_POSITIVE.to_bits());
        assert_eq!(convert((1 << 25) - 1, -151), f32::MIN_POSITIVE.to_bits(), "rounds up into the normal range");
        assert_eq!(convert((1 << 24) - 1, 104), f32::MAX.to_bits());
        assert_eq!(convert(-1, 128), f32::NEG_INFINITY.to_bits());
        assert_eq!(convert((1 << 25) - 1, 103), f32::INFINITY.to_bits());
        assert_eq!(convert(0, 511), 0);
    }
}
