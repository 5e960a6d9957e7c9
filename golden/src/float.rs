//! The kinds of floating-point numbers.

use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

/// f64 or f32.
pub trait Float:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Into<f64>
{
    /// The nearest number.
    fn of(value: f64) -> Self;
}

// Always inline: these stand in the innermost loop, and development builds inline little by themselves.
#[expect(clippy::inline_always, reason = "the innermost loop of every product")]
impl Float for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
}

#[expect(clippy::inline_always, reason = "the innermost loop of every product")]
impl Float for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }
}
