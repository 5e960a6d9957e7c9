//! The row sequencer of a sparse matrix-vector PE: counts the products of every row.

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
