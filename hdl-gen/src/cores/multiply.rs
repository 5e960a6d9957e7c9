//! The registered multiplier of what does not accumulate: 18 by 27 bits.

/// Enabled cycles from the operands to the product.
pub const LATENCY: u32 = 1;

/// `coefficient * data`.
pub fn multiply(coefficient: i32, data: i32) -> i64 {
    i64::from(coefficient) * i64::from(data)
}
