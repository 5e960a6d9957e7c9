//! Op's summary in integers: friction components, resultants, friction coefficient, angle.

use crate::cores::{cordic, ratio};
use crate::format::FRICTION_FRACTION;
use golden::estimators::ERROR_FRACTION;
use golden::products::ByPq;

/// Fraction bits of the CORDIC's inverse gain.
pub const GAIN_FRACTION: u32 = 26;

/// `1 / gain` of the CORDIC with [`GAIN_FRACTION`] fraction bits.
pub fn inverse_gain() -> i64 {
    (f64::from(1_u32 << GAIN_FRACTION) / cordic::CORDIC_GAIN).round() as i64
}

/// The scalar results of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// `mu_x`, `mu_y` with [`FRICTION_FRACTION`] fraction bits.
    pub friction: [i64; 2],
    /// Resultants, [`FRICTION_FRACTION`] bits finer than g.
    pub forces: [i64; 3],
    /// Torques, as many bits finer than their sums.
    pub torques: [i64; 3],
    /// `mu = quotient * 2^exponent`.
    pub friction_quotient: u64,
    /// See `friction_quotient`.
    pub friction_exponent: i32,
    /// `phi` in radians with 29 fraction bits.
    pub angle: i32,
}

impl Summary {
    pub fn new(sums: &ByPq<i64>, friction: [i64; 2]) -> Self {
        let [fx, fy, fz, tx, ty, tz] =
            sums.map(|[g0, g1, g2]| (g0 << FRICTION_FRACTION) + friction[0] * g1 + friction[1] * g2);
        let (forces, torques) = ([fx, fy, fz], [tx, ty, tz]);
        let tangential = Tangential::new(forces[0], forces[1]);
        let normal = forces[2].unsigned_abs();
        let normal_bits = bits(normal);
        let quotient = if tangential.bits == 0 || normal_bits == 0 {
            0
        } else {
            let unit = ((u128::from(normal) << (64 - normal_bits)) >> 32) as u64;
            ratio::divide((tangential.magnitude & ((1 << 38) - 1)) << 26, unit)
        };
        Self {
            friction,
            forces,
            torques,
            friction_quotient: quotient,
            friction_exponent: tangential.bits as i32 - normal_bits as i32 - 30,
            angle: tangential.angle,
        }
    }
}

impl Summary {
    /// The standard error of `(F_x, F_y)` as a number of steps of the forces times `2^exponent`, from its logarithm of base 2
    /// over `|F_z|`; `2^(n + f)` is taken as `2^n (1 + f)`.
    pub fn standard_error(&self, log: i64) -> (i64, i32) {
        let normal = self.forces[2].unsigned_abs();
        let normal_bits = bits(normal);
        let unit = if normal == 0 { 0 } else { (u128::from(normal) << (64 - normal_bits)) >> 32 } as i64;
        let factor = (1 << ERROR_FRACTION) + (log & ((1 << ERROR_FRACTION) - 1));
        let error = (unit >> 6) * (factor << (FRICTION_FRACTION - ERROR_FRACTION));
        (error, normal_bits as i32 - 42 + (log >> ERROR_FRACTION) as i32)
    }

    /// The friction coefficient with [`FRICTION_FRACTION`] fraction bits, rounded down; one far too large is all ones.
    pub fn friction_coefficient(&self) -> i64 {
        let down = -(self.friction_exponent + FRICTION_FRACTION as i32);
        let quotient = self.friction_quotient as i64;
        match down {
            ..1 if quotient != 0 => (1 << 35) - 1,
            ..1 => 0,
            // The quotient has fewer bits than that.
            _ => quotient >> down.min(62),
        }
    }
}

/// `(F_x, F_y)` in polar form.
struct Tangential {
    /// Significant bits of the larger component.
    bits: u32,
    /// `sqrt(x^2 + y^2)` of the components scaled to 30 bits, times 64.
    magnitude: u64,
    angle: i32,
}

impl Tangential {
    fn new(x: i64, y: i64) -> Self {
        let bits = bits(((x ^ (x >> 63)) | (y ^ (y >> 63))) as u64);
        let unit = |value: i64| ((value << (63 - bits)) >> 33) as i32;
        let vector = cordic::vector(unit(x), unit(y));
        let gain = inverse_gain() as u64;
        let high = (vector.magnitude >> 17) * gain;
        let low = (vector.magnitude & ((1 << 17) - 1)) * gain;
        Self { bits, magnitude: ((high << 17) + low) >> 20, angle: vector.angle }
    }
}

fn bits(value: u64) -> u32 {
    64 - value.leading_zeros()
}
