//! The multiply-accumulate lane of two products of 18 by 18 bits.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct MacSplit {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    valid: Signal<In, Bit>,
    first: Signal<In, Bit>,
    coefficient: Signal<In, Sint<18>>,
    data: Signal<In, Sint<27>>,
    accumulator: Signal<Out, Sint<48>>,
    valid_a: Register<Bit>,
    first_a: Register<Bit>,
    coefficient_a: Register<Sint<18>>,
    data_a: Register<Sint<27>>,
    valid_m: Register<Bit>,
    first_m: Register<Bit>,
    low: Register<Sint<36>>,
    high: Register<Sint<28>>,
    sum: Register<Sint<48>>,
    data_bits: Signal<Local, Bits<27>>,
    lower: Signal<Local, Bits<18>>,
    upper: Signal<Local, Bits<10>>,
    data_low: Signal<Local, Sint<18>>,
    data_high: Signal<Local, Sint<10>>,
    high_wide: Signal<Local, Sint<48>>,
    addend_low: Signal<Local, Sint<48>>,
    addend_high: Signal<Local, Sint<48>>,
    base: Signal<Local, Sint<48>>,
}

impl Logic for MacSplit {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, valid_a, first_a, coefficient_a, data_a, valid_m, first_m, low, high);
        dff_setup!(self, clock, sum);
        comment!("operands");
        self.valid_a.d.next = self.valid.val() & !self.reset.val();
        self.first_a.d.next = self.first.val();
        self.coefficient_a.d.next = self.coefficient.val();
        self.data_a.d.next = self.data.val();

        comment!("products with the lower 17 bits of the data and with the upper 10");
        self.valid_m.d.next = self.valid_a.q.val() & !self.reset.val();
        self.first_m.d.next = self.first_a.q.val();
        self.data_bits.next = unsigned_cast(self.data_a.q.val());
        self.lower.next = bit_cast::<18, 17>(self.data_bits.val().get_bits::<17>(0));
        self.upper.next = self.data_bits.val().get_bits::<10>(17);
        self.data_low.next = signed_cast(self.lower.val());
        self.data_high.next = signed_cast(self.upper.val());
        self.low.d.next = (self.coefficient_a.q.val() * self.data_low.val()).into();
        self.high.d.next = (self.coefficient_a.q.val() * self.data_high.val()).into();

        comment!("sum of three: no adder stands between the products and the accumulator's");
        self.addend_low.next = signed_bit_cast(self.low.q.val());
        self.high_wide.next = signed_bit_cast(self.high.q.val());
        self.addend_high.next = self.high_wide.val() << 17;
        self.base.next = self.sum.q.val();
        if self.first_m.q.val() {
            self.base.next = 0.into();
        }
        if self.valid_m.q.val() {
            self.sum.d.next = (self.base.val() + self.addend_low.val()) + self.addend_high.val();
        }
        self.accumulator.next = self.sum.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "ecp5/sptfra_mac.v",
    banner: "\
Multiply-accumulate lane: sums coefficient * data with two multipliers of 18 by 18 bits, for Lattice ECP5. Other
fabrics have an sptfra_mac with one of 27 by 18, with the same sums in the same cycles.

Latency 3 cycles (operands, two products, accumulator), one product a cycle. Operands of 18 and 27 bits and the
accumulator of 48 are two's complement integers; the binary point is the user's. The accumulator wraps; a sum of up
to 15 products, and any sum whose coefficients add up to less than 2^21 in magnitude, never does.",
    ports: &[
        ("clock", "rising edge"),
        ("reset", "synchronous, high: discards products under way, keeps the accumulator"),
        ("valid", "the operands count"),
        ("first", "with valid: start a new sum with this product"),
        ("coefficient", "left operand"),
        ("data", "right operand"),
        ("accumulator", "the sum, three cycles after the operands; holds without valid ones"),
    ],
    unused: &[],
};

pub(crate) fn core() -> Result<CoreFile, CoreError> {
    emit(MacSplit::default(), &DESCRIPTION)
}
