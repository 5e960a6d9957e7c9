//! ROM initialisation files: hexadecimal words, one a line, for `$readmemh` and Vivado's `read_mem`.

use crate::plan::Plan;
use crate::plan::format::address_bits;

use super::{FileMap, lane_file};

/// Adds every ROM file of the plan. All lanes' files have the same number of words; shorter ones end in zeros.
pub fn insert(plan: &Plan, files: &mut FileMap) {
    let name = &plan.design.name;
    let coefficient_bits = plan.design.hardware.coefficient_bits;
    let column_bits = address_bits(plan.taxels());
    let schedule = &plan.schedule;
    for (lane, program) in schedule.lanes.iter().enumerate() {
        let words = schedule.word_depth();
        let values = program.words.iter().map(|&(_, value)| value as u32);
        files.insert(lane_file(name, "values", lane), hex(values, words, coefficient_bits));
        let columns = program.words.iter().map(|&(column, _)| column);
        files.insert(lane_file(name, "columns", lane), hex(columns, words, column_bits));
        let segments = program.segments.iter().map(|segment| (segment.kind as u32) << 14 | segment.macs);
        files.insert(lane_file(name, "macs", lane), hex(segments, schedule.segment_depth(), 16));
    }
    let product_bits = address_bits(plan.products.len());
    let visits =
        schedule.visits.iter().map(|visit| (visit.lane << product_bits | visit.product) << column_bits | visit.row);
    let width = address_bits(schedule.lanes.len()) + product_bits + column_bits;
    files.insert(format!("rom/{name}_visits.mem"), hex(visits, schedule.visits.len(), width));
}

/// `depth` words of `bits` bits in two's complement.
fn hex(words: impl Iterator<Item = u32>, depth: usize, bits: u32) -> Vec<u8> {
    // Digit by digit rather than by the formatter: the largest designs have 30 million words.
    let digits = bits.div_ceil(4);
    let mask = (1_u32 << bits) - 1;
    let mut text = Vec::with_capacity(depth * (digits as usize + 1));
    for word in words.chain(std::iter::repeat(0)).take(depth) {
        let word = word & mask;
        text.extend((0..digits).rev().map(|digit| b"0123456789abcdef"[(word >> (4 * digit)) as usize & 15]));
        text.push(b'\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::hex;

    #[test]
    fn words_are_masked_and_padded() {
        let text = hex([-1_i32 as u32, 5].into_iter(), 3, 18);
        assert_eq!(String::from_utf8(text).unwrap(), "3ffff\n00005\n00000\n");
        let text = hex([0xdead_beef_u32, 0x0123].into_iter(), 2, 16);
        assert_eq!(String::from_utf8(text).unwrap(), "beef\n0123\n");
    }
}
