//! Unsigned restoring divider: 64-bit numerator, 48-bit denominator, one quotient bit a cycle.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct Divider {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    start: Signal<In, Bit>,
    numerator: Signal<In, Bits<64>>,
    denominator: Signal<In, Bits<48>>,
    quotient: Signal<Out, Bits<64>>,
    done: Signal<Out, Bit>,
    busy: Register<Bit>,
    finished: Register<Bit>,
    left: Register<Bits<6>>,
    digits: Register<Bits<64>>,
    remainder: Register<Bits<48>>,
    divisor: Register<Bits<48>>,
    shifted: Signal<Local, Bits<50>>,
    trial: Signal<Local, Bits<50>>,
    fits: Signal<Local, Bit>,
}

impl Logic for Divider {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, busy, left, digits, remainder, divisor);
        clock!(self, clock, finished);
        self.finished.d.next = false;

        comment!("bring the next digit down, try to subtract: bit 49 of the difference is the borrow");
        self.shifted.next = (bit_cast::<50, 48>(self.remainder.q.val()) << 1)
            | bit_cast::<50, 1>(self.digits.q.val().get_bits::<1>(63));
        self.trial.next = self.shifted.val() - bit_cast::<50, 48>(self.divisor.q.val());
        self.fits.next = !self.trial.val().get_bit(49);

        comment!("the numerator leaves its register at the top while the quotient enters at the bottom");
        if self.busy.q.val() {
            self.digits.d.next = (self.digits.q.val() << 1) | bit_cast::<64, 1>(self.fits.val().into());
            if self.fits.val() {
                self.remainder.d.next = self.trial.val().get_bits::<48>(0);
            } else {
                self.remainder.d.next = self.shifted.val().get_bits::<48>(0);
            }
            self.left.d.next = self.left.q.val() - 1;
            if self.left.q.val() == 0 {
                self.busy.d.next = false;
                self.finished.d.next = true;
            }
        } else if self.start.val() {
            self.digits.d.next = self.numerator.val();
            self.divisor.d.next = self.denominator.val();
            self.remainder.d.next = 0.into();
            self.left.d.next = 63.into();
            self.busy.d.next = true;
        }

        comment!("reset ends what is under way");
        if self.reset.val() {
            self.busy.d.next = false;
            self.finished.d.next = false;
        }
        self.quotient.next = self.digits.q.val();
        self.done.next = self.finished.q.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "common/sptfra_divider.v",
    banner: "\
Unsigned restoring divider: quotient (64 bits) = numerator (64 bits) / denominator (48 bits), rounded down.

One quotient bit a cycle. A start in cycle 0 gives done for one cycle in cycle 65. A new start is taken from then
on. A denominator of zero gives all ones.",
    ports: &[
        ("clock", "rising edge"),
        ("reset", "synchronous, high: gives up the division under way"),
        ("start", "takes the operands; ignored while a division is under way"),
        ("numerator", "dividend"),
        ("denominator", "divisor"),
        ("quotient", "valid from done until the next start"),
        ("done", "high for one cycle, 65 cycles after start"),
    ],
    unused: &["trial"],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(Divider::default(), &DESCRIPTION)
}
