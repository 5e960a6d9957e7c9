//! The registered multiplier of what does not accumulate: 18 by 27 bits, in one piece or in two.

use rust_hdl_core::prelude::*;

use super::emit::{Description, emit};
use super::register::{Register, comment, dff_setup};
use super::sint::{Sint, signed_bit_cast, signed_cast, unsigned_cast};
use super::{CoreError, CoreFile};

/// Enabled cycles from the operands to the product.
pub const LATENCY: u32 = 1;

/// What `low + high` must be: `coefficient * data`.
pub fn multiply(coefficient: i32, data: i32) -> i64 {
    i64::from(coefficient) * i64::from(data)
}

#[derive(LogicBlock, Default)]
struct Multiply {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    coefficient: Signal<In, Sint<18>>,
    data: Signal<In, Sint<27>>,
    low: Signal<Out, Sint<45>>,
    high: Signal<Out, Sint<45>>,
    product: Register<Sint<45>>,
    coefficient_wide: Signal<Local, Sint<45>>,
    data_wide: Signal<Local, Sint<45>>,
}

impl Logic for Multiply {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, product);
        self.coefficient_wide.next = signed_bit_cast(self.coefficient.val());
        self.data_wide.next = signed_bit_cast(self.data.val());
        if self.enable.val() {
            self.product.d.next = self.coefficient_wide.val() * self.data_wide.val();
        }
        self.low.next = self.product.q.val();
        self.high.next = 0.into();
    }
}

#[derive(LogicBlock, Default)]
struct MultiplySplit {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    coefficient: Signal<In, Sint<18>>,
    data: Signal<In, Sint<27>>,
    low: Signal<Out, Sint<45>>,
    high: Signal<Out, Sint<45>>,
    product_low: Register<Sint<36>>,
    product_high: Register<Sint<28>>,
    data_bits: Signal<Local, Bits<27>>,
    lower: Signal<Local, Bits<17>>,
    lower_wide: Signal<Local, Bits<36>>,
    upper: Signal<Local, Bits<10>>,
    upper_signed: Signal<Local, Sint<10>>,
    high_wide: Signal<Local, Sint<45>>,
    data_low: Signal<Local, Sint<36>>,
    data_high: Signal<Local, Sint<28>>,
    coefficient_low: Signal<Local, Sint<36>>,
    coefficient_high: Signal<Local, Sint<28>>,
}

impl Logic for MultiplySplit {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, product_low, product_high);
        comment!("products with the lower 17 bits of the data and with the upper 10");
        self.data_bits.next = unsigned_cast(self.data.val());
        self.lower.next = self.data_bits.val().get_bits::<17>(0);
        self.lower_wide.next = bit_cast::<36, 17>(self.lower.val());
        self.data_low.next = signed_cast(self.lower_wide.val());
        self.upper.next = self.data_bits.val().get_bits::<10>(17);
        self.upper_signed.next = signed_cast(self.upper.val());
        self.data_high.next = signed_bit_cast(self.upper_signed.val());
        self.coefficient_low.next = signed_bit_cast(self.coefficient.val());
        self.coefficient_high.next = signed_bit_cast(self.coefficient.val());
        if self.enable.val() {
            self.product_low.d.next = self.coefficient_low.val() * self.data_low.val();
            self.product_high.d.next = self.coefficient_high.val() * self.data_high.val();
        }
        self.low.next = signed_bit_cast(self.product_low.q.val());
        self.high_wide.next = signed_bit_cast(self.product_high.q.val());
        self.high.next = self.high_wide.val() << 17;
    }
}

const PORTS: [(&str, &str); 6] = [
    ("clock", "rising edge"),
    ("enable", "the product follows the operands; else it holds"),
    ("coefficient", "left operand"),
    ("data", "right operand"),
    ("low", "one part of the product"),
    ("high", "the other"),
];

const WHOLE: Description = Description {
    module: "sptfra_multiply",
    banner: "\
Multiplier of one DSP block of 27 by 18 bits: coefficient * data = low + high, high being zero.

Latency 1 enabled cycle, one product a cycle. The two parts let the adder behind be the same as with
sptfra_multiply_split. All numbers are two's complement integers.",
    ports: &PORTS,
    unused: &[],
};

const SPLIT: Description = Description {
    module: "sptfra_multiply_split",
    banner: "\
Multiplier made of two of 18 by 18 bits: coefficient * data = low + high modulo 2^45.

Latency 1 enabled cycle, one product a cycle. The parts are left for the adder behind to join with its own addend.
All numbers are two's complement integers.",
    ports: &PORTS,
    unused: &[],
};

pub(super) fn whole() -> Result<CoreFile, CoreError> {
    emit(Multiply::default(), &WHOLE)
}

pub(super) fn split() -> Result<CoreFile, CoreError> {
    emit(MultiplySplit::default(), &SPLIT)
}
