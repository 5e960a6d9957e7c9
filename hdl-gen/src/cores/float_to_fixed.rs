//! float32 to 27-bit fixed point, scaled by a power of two, rounded half away from zero and clipped.

use rust_hdl_core::prelude::*;

use super::emit::{Description, emit};
use super::register::{Register, comment, dff_setup};
use super::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use super::{CoreError, CoreFile};

/// Enabled cycles from `float_bits` to `fixed`; one conversion a cycle.
pub const LATENCY: u32 = 5;

/// Bits of `fixed`, sign included.
pub const FIXED_BITS: u32 = 27;

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

#[derive(LogicBlock, Default)]
struct FloatToFixed {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    float_bits: Signal<In, Bits<32>>,
    shift: Signal<In, Sint<10>>,
    limit: Signal<In, Bits<27>>,
    fixed: Signal<Out, Sint<27>>,
    saturated: Signal<Out, Bit>,
    not_finite: Signal<Out, Bit>,
    float_d: Register<Bits<32>>,
    distance: Register<Bits<12>>,
    negative_u: Register<Bit>,
    not_finite_u: Register<Bit>,
    overflow_u: Register<Bit>,
    significand: Register<Bits<24>>,
    right: Register<Bits<5>>,
    negative_s: Register<Bit>,
    not_finite_s: Register<Bit>,
    overflow_s: Register<Bit>,
    doubled: Register<Bits<28>>,
    negative_r: Register<Bit>,
    not_finite_r: Register<Bit>,
    over: Register<Bit>,
    rounded: Register<Bits<27>>,
    value: Register<Sint<27>>,
    clipped: Register<Bit>,
    not_finite_c: Register<Bit>,
    exponent: Signal<Local, Bits<8>>,
    is_special: Signal<Local, Bit>,
    is_zero: Signal<Local, Bit>,
    exponent_bits: Signal<Local, Bits<12>>,
    shift_wide: Signal<Local, Sint<12>>,
    too_large: Signal<Local, Bit>,
    too_small: Signal<Local, Bit>,
    threshold: Signal<Local, Bits<28>>,
    magnitude: Signal<Local, Bits<27>>,
    positive: Signal<Local, Sint<27>>,
}

impl Logic for FloatToFixed {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, float_d, distance);
        dff_setup!(self, clock, negative_u, not_finite_u, overflow_u, significand, right);
        dff_setup!(self, clock, negative_s, not_finite_s, overflow_s, doubled);
        dff_setup!(self, clock, negative_r, not_finite_r, over, rounded);
        dff_setup!(self, clock, value, clipped, not_finite_c);

        comment!("distance: how far right the significand goes in a 28-bit window with one fraction bit");
        self.exponent_bits.next = bit_cast::<12, 8>(self.float_bits.val().get_bits::<8>(23));
        self.shift_wide.next = signed_bit_cast(self.shift.val());
        if self.enable.val() {
            self.float_d.d.next = self.float_bits.val();
            self.distance.d.next = (153 - self.exponent_bits.val()) - unsigned_cast(self.shift_wide.val());
        }

        comment!("unpack");
        self.exponent.next = self.float_d.q.val().get_bits::<8>(23);
        self.is_special.next = self.exponent.val() == 255;
        self.is_zero.next = self.exponent.val() == 0;
        self.too_large.next = self.distance.q.val().get_bit(11);
        self.too_small.next = !self.too_large.val() & self.distance.q.val().get_bits::<6>(5).any();
        if self.enable.val() {
            self.negative_u.d.next = self.float_d.q.val().get_bit(31);
            self.not_finite_u.d.next = self.is_special.val();
            self.right.d.next = self.distance.q.val().get_bits::<5>(0);
            self.overflow_u.d.next = self.too_large.val() & !self.is_zero.val();
            self.significand.d.next = bit_cast::<24, 23>(self.float_d.q.val().get_bits::<23>(0)) | 0x80_0000;
            if self.is_zero.val() | self.too_small.val() {
                self.significand.d.next = 0.into();
            }
            if self.is_special.val() {
                self.significand.d.next = 0.into();
                self.overflow_u.d.next = !self.float_d.q.val().get_bits::<23>(0).any();
            }
        }

        comment!("shift");
        if self.enable.val() {
            self.negative_s.d.next = self.negative_u.q.val();
            self.not_finite_s.d.next = self.not_finite_u.q.val();
            self.overflow_s.d.next = self.overflow_u.q.val();
            self.doubled.d.next = (bit_cast::<28, 24>(self.significand.q.val()) << 4) >> self.right.q.val();
        }

        comment!("round half away from zero; the comparison with what is rounded to limit does not wait for that");
        self.threshold.next = (bit_cast::<28, 27>(self.limit.val()) << 1) - 1;
        if self.enable.val() {
            self.negative_r.d.next = self.negative_s.q.val();
            self.not_finite_r.d.next = self.not_finite_s.q.val();
            self.over.d.next = self.overflow_s.q.val() | (self.doubled.q.val() >= self.threshold.val());
            self.rounded.d.next =
                self.doubled.q.val().get_bits::<27>(1) + bit_cast::<27, 1>(self.doubled.q.val().get_bits::<1>(0));
        }

        comment!("clip, negate");
        if self.over.q.val() {
            self.magnitude.next = self.limit.val();
        } else {
            self.magnitude.next = self.rounded.q.val();
        }
        self.positive.next = signed_cast(self.magnitude.val());
        if self.enable.val() {
            self.clipped.d.next = self.over.q.val();
            self.not_finite_c.d.next = self.not_finite_r.q.val();
            if self.negative_r.q.val() {
                self.value.d.next = -self.positive.val();
            } else {
                self.value.d.next = self.positive.val();
            }
        }
        self.fixed.next = self.value.q.val();
        self.saturated.next = self.clipped.q.val();
        self.not_finite.next = self.not_finite_c.q.val();
    }
}

const DESCRIPTION: Description = Description {
    module: "sptfra_float_to_fixed",
    banner: "\
float32 to 27-bit fixed point: fixed = float_bits * 2^shift, rounded half away from zero, clipped to +-limit.

Latency 5 enabled cycles (distance, unpack, shift, round, clip), one value an enabled cycle. Denormals count as zero.
saturated: the rounded magnitude is limit or more. NaN gives 0 with not_finite; an infinity gives +-limit with
saturated and not_finite.",
    ports: &[
        ("clock", "rising edge"),
        ("enable", "every stage advances; else all hold"),
        ("float_bits", "IEEE 754 single precision"),
        ("shift", "the result's binary point; sampled with float_bits"),
        ("limit", "largest magnitude, below 2^26; constant while conversions are under way"),
        ("fixed", "the value"),
        ("saturated", "the rounded magnitude reached limit"),
        ("not_finite", "float_bits was NaN or an infinity"),
    ],
    unused: &[],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(FloatToFixed::default(), &DESCRIPTION)
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
