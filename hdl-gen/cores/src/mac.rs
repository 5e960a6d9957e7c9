//! The multiply-accumulate lane: 18 by 27 bits into 48, the shape of one DSP block.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::sint::{Sint, signed_bit_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct Mac {
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
    product: Register<Sint<45>>,
    sum: Register<Sint<48>>,
    addend: Signal<Local, Sint<48>>,
    base: Signal<Local, Sint<48>>,
}

impl Logic for Mac {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, valid_a, first_a, coefficient_a, data_a, valid_m, first_m, product);
        dff_setup!(self, clock, sum);
        comment!("operands");
        self.valid_a.d.next = self.valid.val() & !self.reset.val();
        self.first_a.d.next = self.first.val();
        self.coefficient_a.d.next = self.coefficient.val();
        self.data_a.d.next = self.data.val();

        comment!("product");
        self.valid_m.d.next = self.valid_a.q.val() & !self.reset.val();
        self.first_m.d.next = self.first_a.q.val();
        self.product.d.next = (self.coefficient_a.q.val() * self.data_a.q.val()).into();

        comment!(
            "sum: adding to a selected zero, rather than selecting the sum, is what fits the adder of a DSP block"
        );
        self.addend.next = signed_bit_cast(self.product.q.val());
        self.base.next = self.sum.q.val();
        if self.first_m.q.val() {
            self.base.next = 0.into();
        }
        if self.valid_m.q.val() {
            self.sum.d.next = self.base.val() + self.addend.val();
        }
        self.accumulator.next = self.sum.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "common/sptfra_mac.v",
    banner: "\
Multiply-accumulate lane: sums coefficient * data in one DSP block of 27 by 18 bits.

Latency 3 cycles (operands, product, accumulator), one product a cycle. Operands of 18 and 27 bits and the
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

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(Mac::default(), &DESCRIPTION)
}
