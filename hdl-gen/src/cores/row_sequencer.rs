//! The row sequencer of a sparse matrix-vector lane: counts the products of every row.

use rust_hdl_core::prelude::*;

use super::emit::{Description, emit};
use super::register::{Register, comment, dff_setup};
use super::{CoreError, CoreFile};

/// Bits of the product count in a row word; the two bits above them are the row's kind.
pub const MACS_BITS: u32 = 14;

/// What the sequencer says of one product.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Product {
    /// It is the first of its row.
    pub first: bool,
    /// It is the last of its row.
    pub last: bool,
    /// Its row's kind.
    pub kind: u8,
}

/// One entry of the row ROM: a row of `kind` (two bits) with `macs` products, at least one and below 2^14; `None` if
/// either does not fit.
pub fn row_word(kind: u8, macs: u32) -> Option<u16> {
    (kind < 4 && (1..1 << MACS_BITS).contains(&macs)).then_some(u16::from(kind) << MACS_BITS | macs as u16)
}

/// What `sptfra_row_sequencer` answers to the successive cycles with `issue` after a restart, for the rows of a ROM.
pub fn products(rows: &[u16]) -> impl Iterator<Item = Product> {
    rows.iter().flat_map(|word| {
        let (kind, macs) = ((word >> MACS_BITS) as u8, word & ((1 << MACS_BITS) - 1));
        (0..macs).map(move |position| Product { first: position == 0, last: position + 1 == macs, kind })
    })
}

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
    module: "sptfra_row_sequencer",
    banner: "\
Row sequencer of a sparse matrix-vector lane: marks the first and the last product of every row.

Walks a ROM with one word a row, {kind[1:0], macs[13:0]} with macs >= 1 products. The ROM is outside and
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn row_words_hold_what_fits() {
        assert_eq!(row_word(3, 16383), Some(u16::MAX));
        assert_eq!(row_word(1, 1), Some(0x4001));
        assert_eq!((row_word(4, 1), row_word(0, 0), row_word(0, 16384)), (None, None, None));
    }

    #[test]
    fn products_follow_the_rows() {
        let rows: Vec<u16> = [(2, 1), (1, 3)].into_iter().filter_map(|(kind, macs)| row_word(kind, macs)).collect();
        let told: Vec<_> = products(&rows).map(|product| (product.first, product.last, product.kind)).collect();
        assert_eq!(told, [(true, true, 2), (true, false, 1), (false, false, 1), (false, true, 1)]);
    }
}
