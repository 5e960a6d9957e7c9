//! The registered multiplier of what does not accumulate: 18 by 27 bits, in one piece or in two.

/// Enabled cycles from the operands to the product.
pub const LATENCY: u32 = 1;

/// What `low + high` must be: `coefficient * data`.
pub fn multiply(coefficient: i32, data: i32) -> i64 {
    i64::from(coefficient) * i64::from(data)
}
