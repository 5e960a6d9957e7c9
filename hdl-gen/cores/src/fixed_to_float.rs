//! 64-bit fixed point, scaled by a power of two, to float32.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::sint::{Sint, signed_bit_cast, unsigned_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct FixedToFloat {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    fixed: Signal<In, Sint<64>>,
    exponent: Signal<In, Sint<10>>,
    float_bits: Signal<Out, Bits<32>>,
    negative_m: Register<Bit>,
    magnitude: Register<Bits<64>>,
    scale_m: Register<Sint<11>>,
    negative_g: Register<Bit>,
    whole: Register<Bits<64>>,
    first_group: Register<Bit>,
    second_group: Register<Bit>,
    third_group: Register<Bit>,
    scale_g: Register<Sint<11>>,
    negative_c: Register<Bit>,
    coarse: Register<Bits<64>>,
    coarse_zeros: Register<Bits<2>>,
    scale_c: Register<Sint<11>>,
    negative_f: Register<Bit>,
    by_four: Register<Bits<64>>,
    fine_zeros: Register<Bits<4>>,
    scale_f: Register<Sint<11>>,
    negative_n: Register<Bit>,
    normal: Register<Bits<40>>,
    sticky_n: Register<Bit>,
    biased: Register<Bits<11>>,
    negative_r: Register<Bit>,
    is_zero_r: Register<Bit>,
    rounded: Register<Bits<34>>,
    result: Register<Bits<32>>,
    pattern: Signal<Local, Bits<64>>,
    by_one: Signal<Local, Bits<64>>,
    found_zeros: Signal<Local, Bits<4>>,
    zeros_one: Signal<Local, Bits<2>>,
    zeros: Signal<Local, Bits<11>>,
    scale_bits: Signal<Local, Bits<11>>,
    sticky: Signal<Local, Bit>,
    up: Signal<Local, Bit>,
    exponent_out: Signal<Local, Bits<11>>,
    vanishes: Signal<Local, Bit>,
    overflows: Signal<Local, Bit>,
    sign: Signal<Local, Bits<32>>,
}

#[allow(clippy::too_many_lines, reason = "rust-hdl wants a core's logic in one function")]
impl Logic for FixedToFloat {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, negative_m, magnitude, scale_m);
        dff_setup!(self, clock, negative_g, whole, first_group, second_group, third_group, scale_g);
        dff_setup!(self, clock, negative_c, coarse, coarse_zeros, scale_c);
        dff_setup!(self, clock, negative_f, by_four, fine_zeros, scale_f);
        dff_setup!(self, clock, negative_n, normal, sticky_n, biased);
        dff_setup!(self, clock, negative_r, is_zero_r, rounded, result);

        comment!("sign and magnitude; the biased exponent if the leading one were bit 63");
        self.pattern.next = unsigned_cast(self.fixed.val());
        if self.enable.val() {
            self.negative_m.d.next = self.pattern.val().get_bit(63);
            self.magnitude.d.next = self.pattern.val();
            if self.pattern.val().get_bit(63) {
                self.magnitude.d.next = !self.pattern.val() + 1;
            }
            self.scale_m.d.next = signed_bit_cast::<11, 10>(self.exponent.val()) + 190.into();
        }

        comment!("groups of 16 bits with a one among them");
        if self.enable.val() {
            self.negative_g.d.next = self.negative_m.q.val();
            self.scale_g.d.next = self.scale_m.q.val();
            self.whole.d.next = self.magnitude.q.val();
            self.first_group.d.next = self.magnitude.q.val().get_bits::<16>(48).any();
            self.second_group.d.next = self.magnitude.q.val().get_bits::<16>(32).any();
            self.third_group.d.next = self.magnitude.q.val().get_bits::<16>(16).any();
        }

        comment!("leading zeros in steps of 16");
        if self.enable.val() {
            self.negative_c.d.next = self.negative_g.q.val();
            self.scale_c.d.next = self.scale_g.q.val();
            if self.first_group.q.val() {
                self.coarse.d.next = self.whole.q.val();
                self.coarse_zeros.d.next = 0.into();
            } else if self.second_group.q.val() {
                self.coarse.d.next = self.whole.q.val() << 16;
                self.coarse_zeros.d.next = 1.into();
            } else if self.third_group.q.val() {
                self.coarse.d.next = self.whole.q.val() << 32;
                self.coarse_zeros.d.next = 2.into();
            } else {
                self.coarse.d.next = self.whole.q.val() << 48;
                self.coarse_zeros.d.next = 3.into();
            }
        }

        comment!("leading zeros in steps of 4");
        self.found_zeros.next = bit_cast::<4, 2>(self.coarse_zeros.q.val()) << 2;
        if self.enable.val() {
            self.negative_f.d.next = self.negative_c.q.val();
            self.scale_f.d.next = self.scale_c.q.val();
            if self.coarse.q.val().get_bits::<4>(60).any() {
                self.by_four.d.next = self.coarse.q.val();
                self.fine_zeros.d.next = self.found_zeros.val();
            } else if self.coarse.q.val().get_bits::<4>(56).any() {
                self.by_four.d.next = self.coarse.q.val() << 4;
                self.fine_zeros.d.next = self.found_zeros.val() | 1;
            } else if self.coarse.q.val().get_bits::<4>(52).any() {
                self.by_four.d.next = self.coarse.q.val() << 8;
                self.fine_zeros.d.next = self.found_zeros.val() | 2;
            } else {
                self.by_four.d.next = self.coarse.q.val() << 12;
                self.fine_zeros.d.next = self.found_zeros.val() | 3;
            }
        }

        comment!("leading zeros in steps of 1");
        if self.by_four.q.val().get_bit(63) {
            self.by_one.next = self.by_four.q.val();
            self.zeros_one.next = 0.into();
        } else if self.by_four.q.val().get_bit(62) {
            self.by_one.next = self.by_four.q.val() << 1;
            self.zeros_one.next = 1.into();
        } else if self.by_four.q.val().get_bit(61) {
            self.by_one.next = self.by_four.q.val() << 2;
            self.zeros_one.next = 2.into();
        } else {
            self.by_one.next = self.by_four.q.val() << 3;
            self.zeros_one.next = 3.into();
        }
        self.zeros.next = (bit_cast::<11, 4>(self.fine_zeros.q.val()) << 2) | bit_cast::<11, 2>(self.zeros_one.val());
        self.scale_bits.next = unsigned_cast(self.scale_f.q.val());
        if self.enable.val() {
            self.negative_n.d.next = self.negative_f.q.val();
            self.normal.d.next = self.by_one.val().get_bits::<40>(24);
            self.sticky_n.d.next = self.by_four.q.val().get_bits::<24>(0).any();
            self.biased.d.next = self.scale_bits.val() - self.zeros.val();
        }

        comment!("round to nearest even: a carry out of the fraction raises the exponent above it");
        self.sticky.next = self.sticky_n.q.val() | self.normal.q.val().get_bits::<15>(0).any();
        self.up.next = self.normal.q.val().get_bit(15) & (self.sticky.val() | self.normal.q.val().get_bit(16));
        if self.enable.val() {
            self.negative_r.d.next = self.negative_n.q.val();
            self.is_zero_r.d.next = !self.normal.q.val().get_bit(39);
            self.rounded.d.next = ((bit_cast::<34, 11>(self.biased.q.val()) << 23)
                | bit_cast::<34, 23>(self.normal.q.val().get_bits::<23>(16)))
                + bit_cast::<34, 1>(self.up.val().into());
        }

        comment!("zeros and infinities");
        self.exponent_out.next = self.rounded.q.val().get_bits::<11>(23);
        self.vanishes.next = self.exponent_out.val().get_bit(10) | (self.exponent_out.val() == 0);
        self.overflows.next = self.exponent_out.val() >= 255;
        self.sign.next = bit_cast::<32, 1>(self.negative_r.q.val().into()) << 31;
        if self.enable.val() {
            if self.vanishes.val() | self.is_zero_r.q.val() {
                self.result.d.next = self.sign.val();
            } else if self.overflows.val() {
                self.result.d.next = self.sign.val() | 0x7f80_0000;
            } else {
                self.result.d.next = self.sign.val() | bit_cast::<32, 31>(self.rounded.q.val().get_bits::<31>(0));
            }
        }
        self.float_bits.next = self.result.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "common/sptfra_fixed_to_float.v",
    banner: "\
64-bit fixed point to float32: float_bits = fixed * 2^exponent, rounded to nearest even.

Latency 7 enabled cycles (magnitude, four of normalisation, rounding, zeros and infinities), one value an enabled
cycle. Zero gives +0; what rounds to less than 2^-126 becomes a zero of its sign, what exceeds the largest finite
number an infinity.",
    ports: &[
        ("clock", "rising edge"),
        ("enable", "every stage advances; else all hold"),
        ("fixed", "two's complement integer"),
        ("exponent", "power of two it is multiplied by; sampled with fixed"),
        ("float_bits", "IEEE 754 single precision"),
    ],
    unused: &["by_one"],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(FixedToFloat::default(), &DESCRIPTION)
}
