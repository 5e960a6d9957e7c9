//! The registered multiplier of two products of 18 by 18 bits.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::multiply::PORTS;
use crate::register::{Register, comment, dff_setup};
use crate::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct Multiply {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    coefficient: Signal<In, Sint<18>>,
    data: Signal<In, Sint<27>>,
    low: Signal<Out, Sint<45>>,
    high: Signal<Out, Sint<45>>,
    product_low: Register<Sint<36>>,
    product_high: Register<Sint<28>>,
    data_bits: Signal<Local, Bits<27>>,
    lower: Signal<Local, Bits<18>>,
    upper: Signal<Local, Bits<10>>,
    data_low: Signal<Local, Sint<18>>,
    data_high: Signal<Local, Sint<10>>,
    high_wide: Signal<Local, Sint<45>>,
}

impl Logic for Multiply {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, product_low, product_high);
        comment!("products with the lower 17 bits of the data and with the upper 10");
        self.data_bits.next = unsigned_cast(self.data.val());
        self.lower.next = bit_cast::<18, 17>(self.data_bits.val().get_bits::<17>(0));
        self.upper.next = self.data_bits.val().get_bits::<10>(17);
        self.data_low.next = signed_cast(self.lower.val());
        self.data_high.next = signed_cast(self.upper.val());
        if self.enable.val() {
            self.product_low.d.next = (self.coefficient.val() * self.data_low.val()).into();
            self.product_high.d.next = (self.coefficient.val() * self.data_high.val()).into();
        }
        self.low.next = signed_bit_cast(self.product_low.q.val());
        self.high_wide.next = signed_bit_cast(self.product_high.q.val());
        self.high.next = self.high_wide.val() << 17;
    }
}

const DESCRIPTION: Description = Description {
    path: "ecp5/sptfra_multiply.v",
    banner: "\
Multiplier made of two of 18 by 18 bits, for Lattice ECP5: coefficient * data = low + high modulo 2^45.

Latency 1 enabled cycle, one product a cycle. Operands of 18 and 27 bits and the parts of 45 are two's complement
integers. The parts are left for the adder behind to join with its own addend.",
    ports: &PORTS,
    unused: &[],
};

pub(crate) fn core() -> Result<CoreFile, CoreError> {
    emit(Multiply::default(), &DESCRIPTION)
}
