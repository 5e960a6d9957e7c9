//! Vectoring CORDIC: magnitude and angle of a vector, one iteration a cycle.

use std::array;
use std::sync::LazyLock;

/// Micro-rotations of one conversion.
pub const ITERATIONS: u32 = 30;

/// Cycles from `start` to `done`: a start in cycle 0 gives `done` in cycle 62.
pub const LATENCY: u32 = 62;

/// The factor left in the magnitude: the product of `sqrt(1 + 2^-2i)` over the iterations.
pub const CORDIC_GAIN: f64 = 1.646_760_258_121_065_4;

/// Fraction bits of the angle, in radians.
pub const ANGLE_FRACTION_BITS: u32 = 29;

/// Bits below the result's last place, against the truncation of every iteration.
pub const GUARD_BITS: u32 = 5;

/// `atan(2^-i)` with [`ANGLE_FRACTION_BITS`] + [`GUARD_BITS`] fraction bits, to nearest.
///
/// None is nearer to a tie than 2 % of a step, and an f64 has 19 bits below a step: every platform rounds them alike.
pub static ARC_TANGENTS: LazyLock<[i64; ITERATIONS as usize]> = LazyLock::new(|| {
    let scale = f64::from(ANGLE_FRACTION_BITS + GUARD_BITS).exp2();
    array::from_fn(|i| ((-(i as f64)).exp2().atan() * scale).round() as i64)
});

/// A quarter turn in the format of [`ARC_TANGENTS`].
pub const QUARTER_TURN: i64 = 26_986_075_409;

/// What `sptfra_cordic` answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vector {
    /// [`CORDIC_GAIN`] times the length, in the unit of the components: 34 bits.
    pub magnitude: u64,
    /// `atan2(y, x)` in radians with [`ANGLE_FRACTION_BITS`] fraction bits.
    pub angle: i32,
}

/// Magnitude and angle of `(x, y)`, components within ±2^30; `(0, 0)` gives zeros.
///
/// For a larger component of at least 2^29 the angle is within 2^-26 rad and the magnitude within 2^-26 of itself.
pub fn vector(x: i32, y: i32) -> Vector {
    if x == 0 && y == 0 {
        return Vector { magnitude: 0, angle: 0 };
    }
    let (x0, y0) = (i64::from(x) << GUARD_BITS, i64::from(y) << GUARD_BITS);
    // The micro-rotations reach 1.74 rad: a vector in the left half plane first turns by a quarter.
    let (mut x, mut y, mut z) = match (x < 0, y < 0) {
        (false, _) => (x0, y0, 0),
        (true, false) => (y0, -x0, QUARTER_TURN),
        (true, true) => (-y0, x0, -QUARTER_TURN),
    };
    for (i, arc_tangent) in ARC_TANGENTS.iter().enumerate() {
        (x, y, z) = if y < 0 {
            (x - (y >> i), y + (x >> i), z - arc_tangent)
        } else {
            (x + (y >> i), y - (x >> i), z + arc_tangent)
        };
    }
    let half = 1 << (GUARD_BITS - 1);
    Vector { magnitude: ((x + half) >> GUARD_BITS).cast_unsigned(), angle: ((z + half) >> GUARD_BITS) as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1.0 / 67_108_864.0;

    fn check(x: i32, y: i32) {
        let answer = vector(x, y);
        let angle = f64::from(answer.angle) / f64::from(ANGLE_FRACTION_BITS).exp2();
        let length = CORDIC_GAIN * f64::from(x).hypot(f64::from(y));
        assert!((angle - f64::from(y).atan2(f64::from(x))).abs() <= TOLERANCE, "{x} {y}: {angle}");
        assert!((answer.magnitude as f64 - length).abs() <= TOLERANCE * length, "{x} {y}: {answer:?}");
    }

    /// All thirty stand in `sptfra_cordic.v`, which a test holds against what is printed of them.
    #[test]
    fn constants_are_those_of_the_micro_rotations() {
        // The first, and those nearest to a tie.
        assert_eq!([0, 2, 7].map(|i| ARC_TANGENTS[i]), [13_493_037_705, 4_208_701_385, 134_214_997]);
        assert_eq!(ARC_TANGENTS[29], 32);
        let gain: f64 = (0..ITERATIONS).map(|i| (-f64::from(i)).exp2().hypot(1.0)).product();
        assert!((gain - CORDIC_GAIN).abs() < 1e-15);
        let scale = f64::from(ANGLE_FRACTION_BITS + GUARD_BITS).exp2();
        assert_eq!(QUARTER_TURN, (std::f64::consts::FRAC_PI_2 * scale).round() as i64);
    }

    #[test]
    fn is_accurate_for_normalised_vectors() {
        let mut state = 5_u64;
        for _ in 0..100_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let large = (1 << 29) + (state >> 35) as i32;
            let large = if state & (1 << 20) == 0 { large } else { -large };
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let small = (state.cast_signed() >> (34 + (state >> 5) % 30)) as i32;
            check(large, small);
            check(small, large);
        }
    }

    #[test]
    fn axes_and_origin() {
        for length in [1 << 29, (1 << 29) + 1, 1 << 30] {
            for (x, y) in [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)] {
                check(x * length, y * length);
            }
        }
        assert_eq!(vector(0, 0), Vector { magnitude: 0, angle: 0 });
    }
}
