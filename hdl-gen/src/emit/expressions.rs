//! Verilog expressions whose form depends on widths: slices, extensions, literals, addresses.

use crate::plan::Plan;
use crate::plan::format::address_bits;
use crate::plan::layout::Place;
use crate::plan::product::Vector;

/// Verilog slice of a 48-bit `value` that drops `shift` bits and keeps `data`.
pub(super) fn result_slice(shift: u32, data: u32) -> String {
    // Few bits to drop: what remains is shorter than the result and takes copies of the sign.
    match (shift + data - 1).checked_sub(47) {
        Some(missing) if missing > 0 => format!("{{ {{{missing}{{value[47]}}}}, value[47:{shift}]}}"),
        _ => format!("value[{}:{shift}]", shift + data - 1),
    }
}

/// Verilog expression of a vector's first word in the operand memories; `bank` is that of the frame's stress.
pub(super) fn operand_base(plan: &Plan, vector: Vector) -> String {
    let width = address_bits(plan.operands.words());
    match plan.operands.place(vector) {
        Some(Place::Fixed(word)) => format!("{width}'d{word}"),
        Some(Place::StressBank) => format!("(bank ? {width}'d{} : {width}'d0)", plan.elements()),
        // No product reads it, so nothing writes it either.
        None => format!("{width}'d0"),
    }
}

pub(super) fn half(shift: u32) -> u64 {
    1 << (shift - 1)
}

pub(super) fn zero_extend(signal: &str, from: u32, to: u32) -> String {
    if to > from { format!("{{{}'d0, {signal}}}", to - from) } else { signal.to_owned() }
}

pub(super) fn sign_extend(signal: &str, from: u32, to: u32) -> String {
    if to > from { format!("{{ {{{}{{{signal}[{}]}}}}, {signal}}}", to - from, from - 1) } else { signal.to_owned() }
}

pub(super) fn slice(signal: &str, from: u32, to: u32) -> String {
    if from > to { format!("{signal}[{}:0]", to - 1) } else { signal.to_owned() }
}

/// `value * index` as a sum of shifted copies, one for each bit of the index.
pub(super) fn shift_and_add(value: &str, index: &str, bits: u32) -> String {
    let shifted = |bit| if bit == 0 { value.to_owned() } else { format!("({value} << {bit})") };
    let term = |bit| format!("({} & {{48{{{index}[{bit}]}}}})", shifted(bit));
    (0..bits).map(term).collect::<Vec<_>>().join("\n        + ")
}

/// The bits of `signal`, whose highest is `top`, that are not from `high` to `low`: `, signal[..], signal[..]`.
pub(super) fn bits_outside(signal: &str, top: u32, high: u32, low: u32) -> String {
    let above = if high < top { format!(", {signal}[{top}:{}]", high + 1) } else { String::new() };
    let below = if low > 0 { format!(", {signal}[{}:0]", low - 1) } else { String::new() };
    above + &below
}

pub(super) fn signed_literal(bits: u32, value: i32) -> String {
    if value < 0 { format!("-{bits}'sd{}", -value) } else { format!("{bits}'sd{value}") }
}
