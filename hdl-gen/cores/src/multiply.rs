//! The registered multiplier of what does not accumulate: 18 by 27 bits in one piece.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, dff_setup};
use crate::sint::Sint;
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct Multiply {
    clock: Signal<In, Clock>,
    enable: Signal<In, Bit>,
    coefficient: Signal<In, Sint<18>>,
    data: Signal<In, Sint<27>>,
    low: Signal<Out, Sint<45>>,
    high: Signal<Out, Sint<45>>,
    product: Register<Sint<45>>,
}

impl Logic for Multiply {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, product);
        if self.enable.val() {
            self.product.d.next = (self.coefficient.val() * self.data.val()).into();
        }
        self.low.next = self.product.q.val();
        self.high.next = 0.into();
    }
}

/// The ports, whatever multiplies between them.
pub(crate) const PORTS: [(&str, &str); 6] = [
    ("clock", "rising edge"),
    ("enable", "the product follows the operands; else it holds"),
    ("coefficient", "left operand"),
    ("data", "right operand"),
    ("low", "one part of the product"),
    ("high", "the other"),
];

const DESCRIPTION: Description = Description {
    path: "common/sptfra_multiply.v",
    banner: "\
Multiplier of one DSP block of 27 by 18 bits: coefficient * data = low + high, high being zero.

Latency 1 enabled cycle, one product a cycle. Operands of 18 and 27 bits and products of 45 are two's complement
integers. The two parts let the adder behind be the same as on fabrics that multiply in two pieces.",
    ports: &PORTS,
    unused: &[],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(Multiply::default(), &DESCRIPTION)
}
