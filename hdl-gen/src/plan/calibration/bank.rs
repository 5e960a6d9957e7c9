//! What a bank holds, its words and their CRC.

use super::{CurveMap, DeadMap};
use crate::plan::gain::GAIN_BITS;

/// Bits of a gain in its word: mantissa, then the exponent of the counts.
const EXPONENT_MASK: u32 = (1 << crate::plan::counts::EXPONENT_BITS) - 1;
/// What a bank holds, in numbers of the hardware.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bank {
    /// Mantissa and exponent of each taxel's gain.
    pub gains: Vec<(i32, i32)>,
    /// Each taxel's offset, in steps of the stress.
    pub offsets: Vec<i32>,
    /// A frame with a smaller `sum |b|` has no contact, in steps.
    pub contact: u32,
    /// Stress of a taxel that is noise, in steps: what presses or pulls is above it, and in the frames of a tare a taxel's
    /// stress spreads by no more.
    pub noise: u32,
    /// Taxels that are replaced.
    pub dead: DeadMap,
    /// The curve of the counts, where the design has one.
    pub curve: Option<CurveMap>,
}

impl Bank {
    /// The words in their order: gains, offsets, contact threshold, noise floor, dead taxels, curve.
    pub fn words(&self) -> Vec<u32> {
        let offsets = self.offsets.iter().map(|&offset| offset.cast_unsigned());
        let dead = self.dead.words(self.gains.len());
        let curve = self.curve.iter().flat_map(CurveMap::words);
        self.gain_words().chain(offsets).chain([self.contact, self.noise]).chain(dead).chain(curve).collect()
    }

    /// The words of the gains.
    pub fn gain_words(&self) -> impl Iterator<Item = u32> {
        let mantissa_mask = (1 << GAIN_BITS) - 1;
        self.gains.iter().map(move |&(mantissa, exponent)| {
            (exponent.cast_unsigned() & EXPONENT_MASK) << GAIN_BITS | mantissa.cast_unsigned() & mantissa_mask
        })
    }

    /// CRC-32 of the words, as of Ethernet and zlib, the lowest byte of a word first.
    pub fn crc(&self) -> u32 {
        let bit = |crc: u32, _| crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
        let byte = |crc: u32, byte: u8| (0..8).fold(crc ^ u32::from(byte), bit);
        !self.words().into_iter().flat_map(u32::to_le_bytes).fold(u32::MAX, byte)
    }
}

#[cfg(test)]
mod tests {
    use super::{Bank, DeadMap};
    use crate::plan::dead::DeadPlan;

    #[test]
    fn a_crc_is_that_of_zlib() {
        let dead = DeadMap { room: 0, dead: DeadPlan { taxels: vec![], weights: vec![], shift: 0 } };
        let bank = Bank { gains: vec![], offsets: vec![], contact: 0x3433_3231, noise: 0x3837_3635, dead, curve: None };
        assert_eq!(bank.crc(), 0x9AE0_DAAF, "of 12345678");
    }
}
