//! Two quotients of one denominator, side by side, a bit a cycle.

/// Cycles from `start` to `done`, for quotients of `bits` bits.
pub const fn latency(bits: u32) -> u64 {
    bits as u64 + 1
}

/// One quotient of `sptfra_ratio`, rounded down. The numerator is already shifted left by the fraction bits. All ones for a
/// denominator of zero, of which the port shows the low bits.
pub fn divide(numerator: u64, denominator: u64) -> u64 {
    numerator.checked_div(denominator).unwrap_or(u64::MAX)
}
