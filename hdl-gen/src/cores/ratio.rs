//! Two quotients of one denominator, side by side, a bit a cycle.

/// Cycles from `start` to `done`, for quotients of `bits` bits.
pub const fn latency(bits: u32) -> u64 {
    bits as u64 + 1
}

/// What `sptfra_ratio` answers: `numerator / denominator` rounded down, all ones for a denominator of zero.
pub fn divide(numerator: u64, denominator: u64) -> u64 {
    numerator.checked_div(denominator).unwrap_or(u64::MAX)
}
