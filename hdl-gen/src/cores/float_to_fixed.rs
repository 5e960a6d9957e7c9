//! float32 to 27-bit fixed point, scaled by a power of two, rounded half away from zero and clipped.

/// Cycles from `float_bits` to `fixed`; one conversion a cycle.
pub const LATENCY: u32 = 5;

/// Bits of `fixed`, sign included.
pub const FIXED_BITS: u32 = super::LONG_BITS;

/// With this much left to shift, a normalised 24-bit significand already exceeds every 27-bit limit.
const OVERFLOW_SHIFT: i32 = 4;

/// What `sptfra_float_to_fixed` answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Converted {
    /// The rounded and clipped value.
    pub fixed: i32,
    /// The rounded magnitude exceeded the limit, or the input was an infinity.
    pub saturated: bool,
    /// The input was an infinity or not a number.
    pub not_finite: bool,
}

/// `x * 2^shift` rounded half away from zero and clipped to `±limit`, with `x` the float32 of the given bits.
///
/// What is rounded to `±limit`, too, is `saturated`: where the limit is the end of a sensor's range, nobody can tell it
/// from a clipped value. Denormals count as zero. NaN gives 0 and `not_finite`; an infinity gives `±limit`, `saturated`
/// and `not_finite`.
/// The port takes `shift` in -512 ..= 511 and 27 bits of `limit`, from 1 to 2^26 - 1, so that `±limit` fits the result
/// (others wrap, here as in the hardware).
pub fn convert(bits: u32, shift: i32, limit: u32) -> Converted {
    let negative = bits >> 31 == 1;
    let exponent = ((bits >> 23) & 0xff) as i32;
    let fraction = bits & 0x7f_ffff;
    let limit = limit & ((1 << FIXED_BITS) - 1);
    if exponent == 0xff && fraction != 0 {
        return Converted { fixed: 0, saturated: false, not_finite: true };
    }
    let not_finite = exponent == 0xff;
    // |x| = significand * 2^(exponent - 150)
    let left = exponent - 150 + shift;
    let overflows = not_finite || (exponent != 0 && left >= OVERFLOW_SHIFT);
    // One fraction bit stays for the rounding.
    let right = OVERFLOW_SHIFT - 1 - left;
    let doubled =
        if exponent == 0 || overflows || right > 27 { 0 } else { ((0x80_0000 | fraction) << OVERFLOW_SHIFT) >> right };
    let saturated = overflows || doubled >= threshold(limit);
    let magnitude = if saturated { limit } else { doubled.div_ceil(2) };
    let signed = if negative { magnitude.wrapping_neg() } else { magnitude };
    let unused = 32 - FIXED_BITS;
    Converted { fixed: (signed << unused).cast_signed() >> unused, saturated, not_finite }
}

/// The least magnitude, in half steps, that is rounded to the limit: 28 bits.
fn threshold(limit: u32) -> u32 {
    (limit << 1).wrapping_sub(1) & ((1 << (FIXED_BITS + 1)) - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixed(x: f32, shift: i32, limit: u32) -> (i32, bool, bool) {
        let converted = convert(x.to_bits(), shift, limit);
        (converted.fixed, converted.saturated, converted.not_finite)
    }

    #[test]
    fn rounds_half_away_from_zero() {
        for (x, expected) in [(0.5, 1), (-0.5, -1), (1.5, 2), (2.5, 3), (0.499_999_97, 0), (-2.5, -3), (-0.0, 0)] {
            assert_eq!(fixed(x, 0, 1000), (expected, false, false), "{x}");
        }
    }

    #[test]
    fn agrees_with_f64_over_many_scales() {
        let mut state = 1_u64;
        for _ in 0..200_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let shift = ((state >> 20) % 80) as i32 - 40;
            let exponent = (127 - shift + ((state >> 30) % 40) as i32 - 8) as u32;
            let bits = (((state >> 63) as u32) << 31) | (exponent << 23) | ((state >> 40) as u32 & 0x7f_ffff);
            let x = f64::from(f32::from_bits(bits));
            let rounded = (x * f64::from(shift).exp2()).round();
            let limit = (1 << 26) - 1;
            let clipped = rounded.clamp(-f64::from(limit), f64::from(limit));
            let expected = (clipped as i32, rounded.abs() >= f64::from(limit), false);
            assert_eq!(fixed(f32::from_bits(bits), shift, limit as u32), expected, "{x} {shift}");
        }
    }

    #[test]
    fn flags_what_has_no_value() {
        assert_eq!(fixed(f32::NAN, 0, 99), (0, false, true));
        assert_eq!(fixed(f32::INFINITY, -500, 99), (99, true, true));
        assert_eq!(fixed(f32::NEG_INFINITY, 0, 99), (-99, true, true));
        assert_eq!(fixed(f32::MAX, 511, 99), (99, true, false));
        assert_eq!(fixed(f32::from_bits(1), 511, 99), (0, false, false));
        assert_eq!(fixed(-99.5, 0, 99), (-99, true, false));
        assert_eq!(fixed(-99.0, 0, 99), (-99, true, false));
        assert_eq!(fixed(98.5, 0, 99), (99, true, false));
        assert_eq!(fixed(-98.49, 0, 99), (-98, false, false));
    }
}
