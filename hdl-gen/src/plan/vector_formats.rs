//! Formats of a plan's vectors.

use golden::products::Vector;
use golden::sensor::Sensor;

use crate::format::{FRICTION_FRACTION, Format, pow2};

/// Bits by which four taxels' sum is wider than a taxel's value.
pub const FOLD_BITS: u32 = 2;

/// Formats of the taxels' values in the four kinds of vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// `b_z` in Pa; its bound is the full scale, to which larger inputs are clamped.
    pub stress: Format,
    /// `|w_z|` in N; in the reduced plan `y+` too.
    pub weight: Format,
    /// All nine `g_pq`, and `A_p b_z`, in N; in the reduced plan their sums `G_pq`.
    pub g: Format,
    /// Exponent of a step of the torques' sums, in N m. They are as many bits wide as those of the forces: an arm is
    /// counted in a power of two that none exceeds.
    pub torque_lsb: i32,
    /// `u_q` in Pa.
    pub u: Format,
    /// Reduced plan: formats of the folded vectors.
    pub folded: Option<FoldedFormats>,
}

impl Formats {
    /// The format in which the lanes read or leave `vector`.
    pub fn of(&self, vector: Vector) -> Format {
        match (&self.folded, vector) {
            (Some(folded), _) => folded.of(vector),
            (None, Vector::Stress) => self.stress,
            (None, Vector::Weight | Vector::Pull) => self.weight,
            (None, Vector::U(_) | Vector::Residual(_) | Vector::Explained) => self.u,
            (None, Vector::Partial(_) | Vector::G(..) | Vector::Force(_)) => self.g,
        }
    }
}

/// Fraction bits of an arm, in units of [`arm_exponent`].
pub const ARM_FRACTION: u32 = 16;

/// Bits of an arm.
pub const ARM_BITS: u32 = ARM_FRACTION + 2;

/// The smallest power of two, in metres, that no arm of a sensor's torques exceeds; its exponent.
pub fn arm_exponent(sensor: &Sensor) -> i32 {
    let [x, y] = sensor.arm_m(0);
    x.abs().max(y.abs()).log2().ceil() as i32
}

/// The arms of all taxels along x and y with [`ARM_FRACTION`] fraction bits.
pub fn arms(sensor: &Sensor) -> Vec<[i32; 2]> {
    let scale = pow2(ARM_FRACTION as i32 - arm_exponent(sensor));
    (0..sensor.taxels()).map(|taxel| sensor.arm_m(taxel).map(|arm| (arm * scale).round() as i32)).collect()
}

/// Formats of the folded vectors; those of the taxels' values are in [`Formats`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FoldedFormats {
    /// Folded stress, in Pa.
    pub stress: Format,
    /// Folded `y = C33inv b`, in N.
    pub y: Format,
    /// Folded `|w|` and `y+`, in N.
    pub weight: Format,
    /// Folded `u_q`, in Pa.
    pub u: Format,
    /// The three parts of the residual, in Pa.
    pub residual: Format,
    /// `r`, in Pa.
    pub explained: Format,
    /// Folded `A_p r`, in N.
    pub force: Format,
    /// `A_p r` of a taxel, in N.
    pub taxel_force: Format,
}

impl FoldedFormats {
    /// The format in which the lanes leave `vector`, if they do.
    pub fn of(&self, vector: Vector) -> Format {
        match vector {
            Vector::Stress => self.stress,
            Vector::Weight | Vector::Pull => self.weight,
            Vector::Residual(_) => self.residual,
            Vector::Explained => self.explained,
            Vector::Force(_) => self.force,
            Vector::U(_) | Vector::Partial(_) | Vector::G(..) => self.u,
        }
    }
}

/// How a taxel's force is put together from `A_p r` and the weight's share: left shifts of the former and of the
/// latter's product with a friction component, and the exponent of the sum's step.
pub fn field_shifts(formats: &Formats, folded: &FoldedFormats) -> (u32, u32, i32) {
    let share = formats.weight.lsb - FRICTION_FRACTION as i32;
    let exponent = folded.taxel_force.lsb.min(share);
    ((folded.taxel_force.lsb - exponent) as u32, (share - exponent) as u32, exponent)
}
