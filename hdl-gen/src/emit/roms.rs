//! ROM initialisation files: hexadecimal words, one a line, for `$readmemh` and Vivado's `read_mem`.

use crate::blocks::array::{column_bits, pe_numbers};
use crate::blocks::{bz, row_width};
use crate::cores::LONG_BITS;
use crate::estimators::WEIGHT_BITS;
use crate::format::address_bits;
use crate::plan::Plan;
use crate::plan::counts::EXPONENT_BITS;
use crate::plan::curve::{SEGMENT_BITS, SHIFT_BITS};
use crate::plan::gain::GAIN_BITS;
use crate::plan::product::{SUMS_DESTINATION, destination, destination_bits};
use crate::plan::schedule::MACS_BITS;
use crate::plan::vector_formats::ARM_BITS;

use crate::resources::memory::{BANK, banks};

use super::FileMap;

/// Adds every ROM file of the plan. All PEs' files have the same number of words; shorter ones end in zeros.
pub fn insert(plan: &Plan, files: &mut FileMap) {
    let name = &plan.design.name;
    let coefficient_bits = plan.design.hardware.coefficient_bits;
    let column_bits = column_bits(plan);
    let schedule = &plan.schedule;
    for (program, pe) in schedule.pes.iter().zip(pe_numbers(plan)) {
        let file = |contents: &str| format!("rom/{name}_{contents}_pe{pe}.mem");
        let depth = schedule.word_depth();
        let word = |channels: &[i32]| joined(&channels[..plan.channels()], coefficient_bits);
        let values = program.words.iter().map(|(_, channels)| word(channels));
        let bits = coefficient_bits * plan.channels() as u32;
        insert_rom(files, file("values"), hex(values, depth, bits));
        let columns = program.words.iter().map(|&(column, _)| u128::from(column));
        insert_rom(files, file("columns"), hex(columns, depth, column_bits));
        let segments =
            program.segments.iter().map(|segment| u128::from((segment.kind as u32) << MACS_BITS | segment.macs));
        insert_rom(files, file("macs"), hex(segments, schedule.segment_depth(), 16));
    }
    let slots = (0..schedule.slots.len()).map(|index| slot(plan, index));
    insert_rom(files, format!("rom/{name}_slots.mem"), hex(slots, schedule.slots.len(), slot_bits(plan)));
    if let Some(counts) = plan.counts.as_ref().filter(|counts| counts.per_taxel()) {
        for (first, kind) in bz::taxel_files(plan.streams()).iter().enumerate() {
            let step = plan.streams().conversions();
            let depth = plan.taxels().div_ceil(step);
            let exponents = counts.exponents.iter().skip(first).step_by(step);
            let exponents = exponents.map(|&exponent| u128::from(exponent as u32));
            files.insert(format!("rom/{name}{kind}_exponents.mem"), hex(exponents, depth, EXPONENT_BITS));
            let gains = counts.gains.iter().skip(first).step_by(step).map(|&gain| u128::from(gain as u32));
            files.insert(format!("rom/{name}{kind}_gains.mem"), hex(gains, depth, GAIN_BITS));
            let offsets = counts.offsets.iter().skip(first).step_by(step).map(|&offset| u128::from(offset as u64));
            files.insert(format!("rom/{name}{kind}_offsets.mem"), hex(offsets, depth, counts.offset_bits()));
        }
    }
    if let Some(calibration) = &plan.calibration {
        // Both banks, each from a power of two on.
        let depth = 1 << address_bits(plan.taxels());
        let bank = &calibration.power_up;
        let both = |words: Vec<u128>| {
            let padded = words.into_iter().chain(std::iter::repeat(0)).take(depth);
            padded.clone().chain(padded)
        };
        let exponents = both(bank.gains.iter().map(|&(_, exponent)| u128::from(exponent.cast_unsigned())).collect());
        files.insert(format!("rom/{name}_bank_exponents.mem"), hex(exponents, 2 * depth, EXPONENT_BITS));
        let gains = both(bank.gains.iter().map(|&(mantissa, _)| u128::from(mantissa.cast_unsigned())).collect());
        files.insert(format!("rom/{name}_bank_gains.mem"), hex(gains, 2 * depth, GAIN_BITS));
        let offsets = both(bank.offsets.iter().map(|&offset| u128::from(offset.cast_unsigned())).collect());
        files.insert(format!("rom/{name}_bank_offsets.mem"), hex(offsets, 2 * depth, calibration.offset_bits()));
    }
    if let Some(bank) = plan.calibration.as_ref().map(|calibration| &calibration.power_up) {
        let depth = 1 << address_bits(plan.taxels());
        for place in 0..bank.dead.room {
            let one = (0..depth).map(|taxel| if taxel < plan.taxels() { bank.dead.weight(place, taxel) } else { 0 });
            let both = one.clone().chain(one).map(|weight| u128::from(weight as u32));
            files.insert(format!("rom/{name}_bank_weights{place}.mem"), hex(both, 2 * depth, WEIGHT_BITS));
        }
    }
    if let Some(curve) = plan.calibration.as_ref().and_then(|calibration| calibration.power_up.curve.as_ref()) {
        let room = curve.format.room;
        let kinds = [("firsts", LONG_BITS), ("values", LONG_BITS), ("slopes", GAIN_BITS), ("shifts", SHIFT_BITS)];
        for (kind, (called, bits)) in kinds.into_iter().enumerate() {
            let both = (0..2 * room).map(|place| u128::from(curve.segment(place % room)[kind] & ((1 << bits) - 1)));
            files.insert(format!("rom/{name}_bank_curve_{called}.mem"), hex(both, 2 * room, bits));
        }
    }
    if !plan.arms.is_empty() {
        let arms = plan.arms.iter().map(|arms| joined(arms, ARM_BITS));
        files.insert(format!("rom/{name}_arms.mem"), hex(arms, plan.arms.len(), 2 * ARM_BITS));
    }
    if let Some(curve) = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref()) {
        let words = curve.words();
        files.insert(format!("rom/{name}_curve.mem"), hex(words.iter().copied(), words.len(), SEGMENT_BITS));
    }
    if let Some(dead) = &plan.dead {
        files.insert(format!("rom/{name}_neighbours.mem"), weights(&dead.words()));
    }
    for (contents, words) in plan.estimator.block().roms() {
        insert_rom(files, format!("rom/{name}_{contents}.mem"), weights(&words));
    }
}

/// Adds the file of a ROM, or of a deep one those of its banks, as `sptfra_rom` reads them.
fn insert_rom(files: &mut FileMap, path: String, text: Vec<u8>) {
    let line = text.iter().position(|&byte| byte == b'\n').map_or(1, |end| end + 1);
    let bank_count = banks(text.len() / line);
    if bank_count == 1 {
        files.insert(path, text);
        return;
    }
    for (bank, words) in text.chunks(BANK * line).enumerate() {
        files.insert(path.replacen("rom/", &format!("rom/bank{bank:02}_"), 1), words.to_vec());
    }
}

/// Bits of a write-back slot: last of its program, PE, destination, row.
fn slot_bits(plan: &Plan) -> u32 {
    1 + address_bits(plan.pes()) + destination_bits(plan.has_field()) + row_width(plan)
}

fn slot(plan: &Plan, index: usize) -> u128 {
    let schedule = &plan.schedule;
    let slot = schedule.slots[index];
    let last = index + 1 == schedule.slots.len() || schedule.programs.iter().any(|program| program.slot == index + 1);
    let elements = plan.elements() as u32;
    // Rows in front of a product's own are sums.
    let (destination, row) = match slot.row.checked_sub(elements) {
        Some(sum) => (SUMS_DESTINATION, sum),
        None => (destination(plan.products[slot.product as usize].result), slot.row),
    };
    let pe = u128::from(last) << address_bits(plan.pes()) | u128::from(slot.pe);
    (pe << destination_bits(plan.has_field()) | destination as u128) << row_width(plan) | u128::from(row)
}

/// The coefficients of all channels in one word, that of channel 0 lowest.
fn joined(channels: &[i32], bits: u32) -> u128 {
    let mask = (1_u32 << bits) - 1;
    channels.iter().rev().fold(0, |word, &value| word << bits | u128::from(value as u32 & mask))
}

/// Words of several weights each.
fn weights(words: &[Vec<i32>]) -> Vec<u8> {
    words.iter().flat_map(|weights| (wide_hex(weights, WEIGHT_BITS) + "\n").into_bytes()).collect()
}

/// One word of several values of `bits` bits each in two's complement, the first lowest.
fn wide_hex(values: &[i32], bits: u32) -> String {
    let total = values.len() as u32 * bits;
    let bit = |index: u32| index < total && values[(index / bits) as usize] >> (index % bits) & 1 == 1;
    let digit = |digit: u32| (0..4).fold(0, |nibble, place| nibble | u32::from(bit(4 * digit + place)) << place);
    (0..total.div_ceil(4)).rev().filter_map(|index| char::from_digit(digit(index), 16)).collect()
}

/// `depth` words of `bits` bits in two's complement.
fn hex(words: impl Iterator<Item = u128>, depth: usize, bits: u32) -> Vec<u8> {
    // Digit by digit rather than by the formatter: the largest designs have 30 million words.
    let digits = bits.div_ceil(4);
    let mask = (1_u128 << bits) - 1;
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
    use super::{FileMap, hex, insert_rom, joined, wide_hex};

    #[test]
    fn a_wide_word_has_its_first_value_lowest() {
        assert_eq!(wide_hex(&[1], 18), "00001");
        assert_eq!(wide_hex(&[-1, 5, 0], 18), "0000000017ffff");
        assert_eq!(wide_hex(&[3; 8], 18).len(), 36);
    }

    #[test]
    fn a_deep_rom_has_a_file_for_each_bank() {
        let mut files = FileMap::new();
        for (name, words) in [("rom/shallow.mem", 4096), ("rom/deep.mem", 2 * 4096 + 5)] {
            insert_rom(&mut files, name.to_owned(), hex((0..words).map(|word| word as u128), words, 16));
        }
        let names: Vec<&str> = files.keys().map(String::as_str).collect();
        assert_eq!(names, ["rom/bank00_deep.mem", "rom/bank01_deep.mem", "rom/bank02_deep.mem", "rom/shallow.mem"]);
        assert!(files["rom/bank01_deep.mem"].starts_with(b"1000\n1001\n"));
        assert_eq!(files["rom/bank02_deep.mem"], b"2000\n2001\n2002\n2003\n2004\n");
    }

    #[test]
    fn words_are_masked_and_padded() {
        let text = hex([joined(&[-1], 18), 5].into_iter(), 3, 18);
        assert_eq!(String::from_utf8(text).unwrap(), "3ffff\n00005\n00000\n");
        let text = hex([0xdead_beef_u128, 0x0123].into_iter(), 2, 16);
        assert_eq!(String::from_utf8(text).unwrap(), "beef\n0123\n");
    }
}
