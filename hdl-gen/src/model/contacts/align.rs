//! What `sptfra_align` answers.

/// A float32 as a whole number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aligned {
    /// Steps, with the sign.
    pub steps: i64,
    /// Whether it is larger than that.
    pub clipped: bool,
}

/// A float32 as a whole number of steps of `2^unit`, rounded towards zero and clipped to `bits` bits with the sign's;
/// denormals are zero.
pub fn align(word: u32, unit: i32, bits: u32) -> Aligned {
    let most = (1_i64 << (bits - 1)) - 1;
    let exponent = (word >> 23 & 0xff) as i32;
    if exponent == 0 {
        return Aligned { steps: 0, clipped: false };
    }
    let significand = i64::from(0x80_0000 | word & 0x7f_ffff);
    let left = exponent - 150 - unit;
    let clipped = left > bits as i32 - 25;
    let magnitude = match left {
        ..-23 => 0,
        -23..0 => significand >> -left,
        _ if clipped => most,
        _ => significand << left,
    };
    Aligned { steps: if word >> 31 == 1 { -magnitude } else { magnitude }, clipped }
}

#[cfg(test)]
mod tests {
    use super::align;

    #[test]
    fn rounds_towards_zero_and_clips() {
        let of = |value: f32, unit| align(value.to_bits(), unit, 27).steps;
        assert_eq!([of(1.0, 0), of(-1.75, 0), of(1.75, -1), of(-0.99, 0), of(3e-39, -140)], [1, -1, 3, 0, 0]);
        let most = (1 << 26) - 1;
        assert_eq!([of(67_108_860.0, 0), of(67_108_864.0, 0), of(-1e30, 0)], [67_108_860, most, -most]);
        assert_eq!(of(8_388_609.0, 23), 1);
        assert_eq!(of(8_388_609.0, 24), 0);
        let clips = |value: f32| align(value.to_bits(), 0, 27).clipped;
        assert_eq!([67_108_860.0, 67_108_864.0, -1e30, 0.0, 3e-39].map(clips), [false, true, true, false, false]);
    }
}
