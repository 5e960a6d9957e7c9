//! The row sequencer of a sparse matrix-vector PE: counts the products of every row.

use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::register::{Register, comment, dff_setup};
use crate::{CoreError, CoreFile};

#[derive(LogicBlock, Default)]
struct RowSequencer {
    clock: Signal<In, Clock>,
    restart: Signal<In, Bit>,
    start_address: Signal<In, Bits<16>>,
    issue: Signal<In, Bit>,
    row_word: Signal<In, Bits<16>>,
    row_address: Signal<Out, Bits<16>>,
    row_fetch: Signal<Out, Bit>,
    first: Signal<Out, Bit>,
    last: Signal<Out, Bit>,
    kind: Signal<Out, Bits<2>>,
    pointer: Register<Bits<16>>,
    primes: Register<Bit>,
    at_start: Register<Bit>,
    remaining: Register<Bits<14>>,
    row_kind: Register<Bits<2>>,
    at_end: Signal<Local, Bit>,
    count: Signal<Local, Bits<14>>,
    current_kind: Signal<Local, Bits<2>>,
    fetch: Signal<Local, Bit>,
}

impl Logic for RowSequencer {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, pointer, at_start, remaining, row_kind);
        clock!(self, clock, primes);

        comment!("products of this row from this one on");
        if self.at_start.q.val() {
            self.count.next = self.row_word.val().get_bits::<14>(0);
            self.current_kind.next = self.row_word.val().get_bits::<2>(14);
        } else {
            self.count.next = self.remaining.q.val();
            self.current_kind.next = self.row_kind.q.val();
        }
        self.at_end.next = self.count.val() == 1;

        comment!("the next row's word is fetched as soon as this row starts");
        self.fetch.next = self.primes.q.val() | (self.issue.val() & self.at_start.q.val());
        if self.fetch.val() {
            self.pointer.d.next = self.pointer.q.val() + 1;
        }
        if self.issue.val() {
            self.at_start.d.next = self.at_end.val();
            self.remaining.d.next = self.count.val() - 1;
            self.row_kind.d.next = self.current_kind.val();
        }

        comment!("on to another row");
        self.primes.d.next = self.restart.val();
        if self.restart.val() {
            self.pointer.d.next = self.start_address.val();
            self.at_start.d.next = true;
        }
        self.row_address.next = self.pointer.q.val();
        self.row_fetch.next = self.fetch.val();
        self.first.next = self.at_start.q.val();
        self.last.next = self.at_end.val();
        self.kind.next = self.current_kind.val();
    }
}

const DESCRIPTION: Description = Description {
    path: "spmv/sptfra_row_sequencer.v",
    banner: "\
Row sequencer of a sparse matrix-vector PE: marks the first and the last product of every row.

Reads a ROM with one word a row, {kind[1:0], macs[13:0]} with macs >= 1 products. The ROM is outside and
registered: row_word is the word at the row_address of the last cycle with row_fetch. One product a cycle, rows
of one product back to back included; first, last and kind belong to the same cycle as issue.",
    ports: &[
        ("clock", "rising edge"),
        ("restart", "at first, and at any time: issue may follow two cycles later"),
        ("start_address", "with restart: address of the word to go on from"),
        ("issue", "one product is issued in this cycle"),
        ("row_word", "the ROM's answer: {kind[1:0], macs[13:0]}"),
        ("row_address", "the ROM's address"),
        ("row_fetch", "the ROM reads"),
        ("first", "with issue: first product of its row"),
        ("last", "with issue: last product of its row"),
        ("kind", "with issue: the row's kind"),
    ],
    unused: &[],
};

pub(super) fn core() -> Result<CoreFile, CoreError> {
    emit(RowSequencer::default(), &DESCRIPTION)
}
