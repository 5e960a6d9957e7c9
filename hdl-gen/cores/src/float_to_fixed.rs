//! float32 to 27-bit fixed point, scaled by a power of two, rounded half away from zero and clipped.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment};
use crate::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct FloatToFixed {
    clock: Signal<In, Clock>,
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
        clock!(self, clock, float_d, distance);
        clock!(self, clock, negative_u, not_finite_u, overflow_u, significand, right);
        clock!(self, clock, negative_s, not_finite_s, overflow_s, doubled);
        clock!(self, clock, negative_r, not_finite_r, over, rounded);
        clock!(self, clock, value, clipped, not_finite_c);

        comment!("distance: how far right the significand goes in a 28-bit window with one fraction bit");
        self.exponent_bits.next = bit_cast::<12, 8>(self.float_bits.val().get_bits::<8>(23));
        self.shift_wide.next = signed_bit_cast(self.shift.val());
        self.float_d.d.next = self.float_bits.val();
        self.distance.d.next = (153 - self.exponent_bits.val()) - unsigned_cast(self.shift_wide.val());

        comment!("unpack");
        self.exponent.next = self.float_d.q.val().get_bits::<8>(23);
        self.is_special.next = self.exponent.val() == 255;
        self.is_zero.next = self.exponent.val() == 0;
        self.too_large.next = self.distance.q.val().get_bit(11);
        self.too_small.next = !self.too_large.val() & self.distance.q.val().get_bits::<6>(5).any();
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

        comment!("shift");
        self.negative_s.d.next = self.negative_u.q.val();
        self.not_finite_s.d.next = self.not_finite_u.q.val();
        self.overflow_s.d.next = self.overflow_u.q.val();
        self.doubled.d.next = (bit_cast::<28, 24>(self.significand.q.val()) << 4) >> self.right.q.val();

        comment!("round half away from zero; the comparison with what is rounded to limit does not wait for that");
        self.threshold.next = (bit_cast::<28, 27>(self.limit.val()) << 1) - 1;
        self.negative_r.d.next = self.negative_s.q.val();
        self.not_finite_r.d.next = self.not_finite_s.q.val();
        self.over.d.next = self.overflow_s.q.val() | (self.doubled.q.val() >= self.threshold.val());
        self.rounded.d.next =
            self.doubled.q.val().get_bits::<27>(1) + bit_cast::<27, 1>(self.doubled.q.val().get_bits::<1>(0));

        comment!("clip, negate");
        if self.over.q.val() {
            self.magnitude.next = self.limit.val();
        } else {
            self.magnitude.next = self.rounded.q.val();
        }
        self.positive.next = signed_cast(self.magnitude.val());
        self.clipped.d.next = self.over.q.val();
        self.not_finite_c.d.next = self.not_finite_r.q.val();
        if self.negative_r.q.val() {
            self.value.d.next = -self.positive.val();
        } else {
            self.value.d.next = self.positive.val();
        }
        self.fixed.next = self.value.q.val();
        self.saturated.next = self.clipped.q.val();
        self.not_finite.next = self.not_finite_c.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "common/sptfra_float_to_fixed.v",
    banner: "\
float32 to 27-bit fixed point: fixed = float_bits * 2^shift, rounded half away from zero, clipped to +-limit.

Latency 5 cycles (distance, unpack, shift, round, clip), one value a cycle. Denormals count as zero.
saturated: the rounded magnitude is limit or more. NaN gives 0 with not_finite; an infinity gives +-limit with
saturated and not_finite.",
    ports: &[
        ("clock", "rising edge"),
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
