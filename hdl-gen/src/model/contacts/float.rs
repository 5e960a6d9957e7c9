//! `sptfra_float_unit`: float32, rounded to nearest even, without denormals, infinities and NaN.
//!
//! Operands are exact in f64, and sums, products, quotients and roots of numbers of 24 bits that are rounded to 53 and then to
//! 24 are those that are rounded once. What is not float32's own is the range: see [`value`] and [`rounded`].

use crate::cores::cordic;

/// The largest finite number.
const LARGEST: u32 = f32::MAX.to_bits();

/// What bits stand for: a denormal for 0, all bits of the exponent for a number like any other.
pub fn value(bits: u32) -> f64 {
    let (exponent, fraction) = (bits >> 23 & 0xFF, bits & 0x7F_FFFF);
    if exponent == 0 {
        return 0.0;
    }
    let magnitude = f64::from(1 << 23 | fraction) * f64::from(exponent.cast_signed() - 150).exp2();
    if bits >> 31 == 1 { -magnitude } else { magnitude }
}

/// The nearest number of 24 bits: 0, without a sign, if it is below 2^-126, and the largest one if it is beyond that.
pub fn rounded(exact: f64) -> u32 {
    const DROPPED: u32 = 53 - 24;
    let sign = u32::from(exact < 0.0) << 31;
    let magnitude = exact.abs().to_bits();
    let up = (1 << (DROPPED - 1)) - 1 + (magnitude >> DROPPED & 1);
    let kept = (magnitude + up) >> DROPPED;
    // f64's exponent is 896 more.
    match (kept >> 23) as i64 - 896 {
        ..=0 => 0,
        1..=254 => sign | (kept - (896 << 23)) as u32,
        255.. => sign | LARGEST,
    }
}

/// `a + b`.
pub fn add(a: u32, b: u32) -> u32 {
    rounded(value(a) + value(b))
}

/// `a - b`.
pub fn subtract(a: u32, b: u32) -> u32 {
    rounded(value(a) - value(b))
}

/// `a b`.
pub fn multiply(a: u32, b: u32) -> u32 {
    rounded(value(a) * value(b))
}

/// `a / b`, 0 where `b` is 0.
pub fn divide(a: u32, b: u32) -> u32 {
    let (a, b) = (value(a), value(b));
    if b == 0.0 { 0 } else { rounded(a / b) }
}

/// The root of `a`, 0 of what is below 0.
pub fn root(a: u32) -> u32 {
    rounded(value(a).max(0.0).sqrt())
}

/// `|a| < |b|`.
pub fn is_below(a: u32, b: u32) -> bool {
    value(a).abs() < value(b).abs()
}

/// The angle of `(a, b)` in radians: of both as multiples of 2^-26 of the power of two below the larger one, the last of which
/// says whether anything was dropped.
pub fn angle(a: u32, b: u32) -> u32 {
    const FRACTION: i32 = 26;
    let larger = value(a).abs().max(value(b).abs());
    if larger == 0.0 {
        return 0;
    }
    let scale = f64::from(FRACTION - (larger.log2_floor())).exp2();
    let steps = |bits: u32| {
        let exact = value(bits).abs() * scale;
        let steps = exact.floor() as i32 | i32::from(exact.fract() != 0.0);
        (if value(bits) < 0.0 { -steps } else { steps }) << 3
    };
    let turned = cordic::vector(steps(a), steps(b)).angle;
    // Four bits of it are more than the sum has room for.
    let magnitude = turned.unsigned_abs();
    let magnitude = f64::from(magnitude >> 4 << 1 | u32::from(magnitude & 15 != 0)) * (-f64::from(FRACTION)).exp2();
    rounded(if turned < 0 { -magnitude } else { magnitude })
}

/// Exponents of numbers.
trait Exponent {
    /// That of the power of two from which the number is less than twice as much.
    fn log2_floor(self) -> i32;
}

impl Exponent for f64 {
    fn log2_floor(self) -> i32 {
        (self.to_bits() >> 52) as i32 - 1023
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers() -> Vec<u32> {
        let mut state = 11_u64;
        let mut numbers: Vec<u32> =
            [0.0, 1.0, 2.0, 3.0, f32::MAX, f32::MIN_POSITIVE, 1.0 + f32::EPSILON, 0.1, 1e-30, 7e30]
                .into_iter()
                .flat_map(|number: f32| [number.to_bits(), (-number).to_bits()])
                .collect();
        for _ in 0..300 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let exponent = 100 + (state >> 60) as u32 * 3;
            numbers.push((state >> 20) as u32 & 0x807F_FFFF | exponent << 23);
        }
        numbers
    }

    /// Within float32's own range it is float32.
    #[test]
    fn is_float32() {
        let same = |found: u32, expected: f32| {
            let expected = if expected.is_infinite() { f32::MAX.copysign(expected) } else { expected };
            // A zero has no sign.
            expected.is_subnormal() || found == (expected + 0.0).to_bits()
        };
        for a in numbers() {
            let x = f32::from_bits(a);
            assert!(x < 0.0 || same(root(a), x.sqrt()), "{x}");
            for b in numbers() {
                let y = f32::from_bits(b);
                assert!(same(add(a, b), x + y) && same(subtract(a, b), x - y), "{x} {y}");
                assert!(same(multiply(a, b), x * y), "{x} {y}");
                assert!(y == 0.0 || same(divide(a, b), x / y), "{x} {y}");
                assert_eq!(is_below(a, b), x.abs() < y.abs(), "{x} {y}");
                let turned = f64::from(f32::from_bits(angle(a, b)));
                let expected = if x == 0.0 && y == 0.0 { 0.0 } else { f64::from(y).atan2(f64::from(x)) };
                // A zero has no sign.
                let error = (turned - expected).abs();
                assert!(error < 2.2e-7 || (y == 0.0 && error < 1e-6 + 2.0 * std::f64::consts::PI), "{x} {y}: {turned}");
            }
        }
    }

    #[test]
    fn the_ends_of_the_range() {
        let float = |bits| f32::from_bits(bits);
        let [large, tiny] = [f32::MAX, f32::MIN_POSITIVE].map(f32::to_bits);
        assert_eq!((float(add(large, large)), float(subtract(0, multiply(large, large)))), (f32::MAX, f32::MIN));
        assert_eq!(
            [multiply(tiny, 0x3F00_0000), divide(tiny, large), add(1, 1), divide(1, 0), divide(large, 0)],
            [0; 5]
        );
        assert_eq!([subtract(large, large), root((-2.0_f32).to_bits()), angle(0, 0x8000_0000)], [0; 3]);
        // What would be infinite is 2^128 and more, half of it is a number.
        assert_eq!(multiply(f32::INFINITY.to_bits(), 0.5_f32.to_bits()), 2.0_f32.powi(127).to_bits());
    }
}
