//! Unsigned restoring divider: 64-bit numerator, 48-bit denominator, one quotient bit a cycle.

/// Cycles from `start` to `done`: a start in cycle 0 gives `done` in cycle 65.
pub const LATENCY: u32 = 65;

const DENOMINATOR_MASK: u64 = (1 << 48) - 1;

/// What `sptfra_divider` answers: `numerator / denominator` rounded down, all ones for a denominator of zero.
///
/// Only the low 48 bits of `denominator` count, as on the port.
pub fn divide(numerator: u64, denominator: u64) -> u64 {
    numerator.checked_div(denominator & DENOMINATOR_MASK).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::divide;

    #[test]
    fn rounds_down_and_saturates_without_a_denominator() {
        assert_eq!(divide(100, 7), 14);
        assert_eq!(divide(u64::MAX, 1), u64::MAX);
        assert_eq!(divide(6, 7), 0);
        assert_eq!(divide(5, 0), u64::MAX);
        assert_eq!(divide(0, 0), u64::MAX);
    }

    #[test]
    fn sees_48_bits_of_the_denominator() {
        assert_eq!(divide(100, (1 << 48) + 10), 10);
        assert_eq!(divide(u64::MAX, (1 << 48) - 1), 1 << 16);
    }
}
