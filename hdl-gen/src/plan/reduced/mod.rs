//! The reduced plan: the same forces from ten products in the parity basis, a quarter of the work each.
//!
//! Every step is exact but for rounding (the mirror symmetries of the grid, and `C33 C33^-1 = I`):
//!
//! | program | products | result |
//! |---|---|---|
//! | weights, coefficients | `C33inv b` | parted into `\|w\|` and `y+` |
//! | | `-K1 \|w\|`, `-K0 y+` with all sums `G_pq`, `-K2 \|w\|` | `u1, u0, u2` |
//! | residual | `C33 y+`, `-C31 \|w\|`, `-C32 \|w\|` | what of `r` each friction component brings |
//! | field | `r`, then `A1 r, A2 r, A3 r` | the forces, but for the weights' own share |
//!
//! Only the first program stands between a frame and its search; the residual is computed meanwhile. With
//! `outputs = "resultants"` there is nothing else.

mod bounds;
mod composed;
mod steps;

use golden::design::{Design, Outputs};
use golden::matrices::Matrices;
use golden::parity::Quads;
use golden::reduced::ReducedMatrices;

use super::format::{FRICTION_FRACTION, Format};
use super::product::{Product, Vector};
use super::quantise::QuantisedMatrix;
use super::{Formats, PlanError};
use bounds::Operand;
use steps::Steps;

/// Bits by which four taxels' sum is wider than a taxel's value.
pub const FOLD_BITS: u32 = 2;
/// Coefficient codes of the friction products: one, `mu_x`, `mu_y`.
pub const SELECT_ONE: i32 = 0;
/// See [`SELECT_ONE`].
pub const SELECT_MU_X: i32 = 1;
/// See [`SELECT_ONE`].
pub const SELECT_MU_Y: i32 = 2;
/// Rows of the sums in front of `K0 y+`: `G_p0`, `G_p1`, `G_p2`, `sum |w|`. The first three have a p in each of three
/// ways, see [`sum_way`].
pub const SUM_ROWS: usize = 4;
/// The way in which sum row `q` holds `G_pq`: the class of the operand on which the sum depends. `p` from 0.
pub fn sum_way(p: usize, q: usize) -> usize {
    let of_p = [1, 2, 0];
    let of_q = [0, 1, 2];
    of_p[p] ^ of_q[q]
}

/// Formats of the folded vectors; those of the taxels' values are in [`Formats`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
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

/// What the reduced plan computes.
pub struct ReducedPlan {
    /// Matrices as stored.
    pub matrices: Vec<QuantisedMatrix>,
    /// Products in order.
    pub products: Vec<Product>,
    /// Formats of the taxels' values; `g` is that of the sums.
    pub formats: Formats,
    /// Most that the roundings of a frame's vectors can add to a taxel's force, in newtons; 0 where it is little.
    pub rounding_n: f64,
}

/// Quantises the folded matrices and chooses, from worst-case row sums, formats that no input within the full scale
/// can overflow.
///
/// # Errors
/// [`PlanError`] when the widths of the design leave too few bits, or the filter leaves nothing of a row.
pub fn build(design: &Design, matrices: &Matrices, stress: Format) -> Result<ReducedPlan, PlanError> {
    let quads = Quads::new(design.sensor.columns, design.sensor.rows);
    let reduced = ReducedMatrices::new(matrices, &quads, &design.algorithm.filter)?;
    let widths = [design.hardware.coefficient_bits, design.hardware.data_bits];
    let field = design.algorithm.outputs == Outputs::Field;
    let mut steps = Steps::new(&reduced, widths, design.algorithm.joint.gain, design.hardware.skip_zeros);

    let base = Operand {
        folded: Format { bits: stress.bits, lsb: stress.lsb + FOLD_BITS as i32, bound: stress.bound },
        taxel: stress,
    };
    let weights = steps.weights(base)?;
    let u = steps.coefficients(base, weights, mirrored_side(design, &quads))?;
    let sums = steps.sums(weights)?;
    let ([residual, explained, force], rounding_n) =
        if field { steps.field(weights, mirrored_side(design, &quads), taxel_force_n(design))? } else { ([u; 3], 0.0) };
    let taxel = |folded: Format| Format { lsb: folded.lsb - FOLD_BITS as i32, ..folded };
    let folded = FoldedFormats {
        stress: base.folded,
        y: taxel_to_folded(weights.taxel),
        weight: weights.folded,
        u,
        residual,
        explained,
        force,
        taxel_force: taxel(force),
    };
    let formats = Formats { stress, weight: weights.taxel, g: sums, u: taxel(u), folded: Some(folded) };
    steps.finish(&formats);
    Ok(ReducedPlan { matrices: steps.matrices, products: steps.products, formats, rounding_n })
}

/// The force of a taxel whose cell is pressed with the full scale.
pub(super) fn taxel_force_n(design: &Design) -> f64 {
    let [x, y] = design.sensor.pitch_mm;
    design.hardware.full_scale_pa * x * y * 1e-6
}

/// On a square grid with a square pitch, what is wanted along y is what is there along x, mirrored at the diagonal.
fn mirrored_side(design: &Design, quads: &Quads) -> Option<usize> {
    let [x, y] = design.sensor.pitch_mm;
    let square = design.sensor.columns == design.sensor.rows && x.to_bits() == y.to_bits();
    let side = quads.columns();
    // F1 keeps another pattern on each side of the diagonal; and the mirror of many quads is a large table unless it
    // is an exchange of bits.
    let kept = matches!(design.algorithm.filter, golden::design::Filter::None);
    (square && kept && (side.is_power_of_two() || side <= MOST_MIRRORED_SIDE)).then_some(side)
}

/// Quads along a side up to which the diagonal mirror is worth a table.
const MOST_MIRRORED_SIDE: usize = 16;

fn taxel_to_folded(taxel: Format) -> Format {
    Format { lsb: taxel.lsb + FOLD_BITS as i32, ..taxel }
}
