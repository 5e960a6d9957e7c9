//! The passes of a plan: from the paper's list of products to what the hardware runs.
//!
//! Fewer products, fold and mirror are passes over [`ProductList`]; the filter follows, then [`super::quantise`],
//! [`super::partition`] and [`bind`]. The paper's plan takes the list as it is, the reduced plan all passes, every one of
//! them exact but for rounding:
//!
//! | program | products | result |
//! |---|---|---|
//! | weights, coefficients | `C33inv b` | separated into `\|w\|` and `y+` |
//! | | `-K1 \|w\|`, `-K0 y+` with all sums `G_pq`, `-K2 \|w\|` | `u1, u0, u2` |
//! | residual | `C33 y+`, `-C31 \|w\|`, `-C32 \|w\|` | what of `r` each friction component brings |
//! | field | `r`, then `A1 r, A2 r, A3 r` | the forces, but for the weights' own share |
//!
//! Only the first program stands between a frame and its search; the residual is computed meanwhile. With
//! `outputs = "resultants"` there is nothing else.

use golden::design::{Design, Filter, Outputs, PlanKind};
use golden::parity::Orbits;
use golden::products::{Epilogue, ProductList, Step, Vector};

use super::product::{Block, Preload, Product};
use super::quantise::Quantised;

/// Orbits along a side up to which the diagonal mirror is worth a table.
const MOST_MIRRORED_SIDE: usize = 16;

/// The list of a design's plan.
pub fn products(design: &Design) -> ProductList {
    let paper = ProductList::paper();
    if design.algorithm.plan == PlanKind::Paper {
        return paper;
    }
    let folded = paper.fewer_products(design.algorithm.outputs == Outputs::Field).folded();
    match mirrored_side(design) {
        Some(side) => folded.mirrored(side),
        None => folded,
    }
}

/// On a square grid with a square pitch, what is wanted along y is what is there along x, mirrored at the diagonal.
fn mirrored_side(design: &Design) -> Option<usize> {
    let sensor = &design.sensor;
    let [x, y] = sensor.pitch_mm;
    let square = sensor.columns == sensor.rows && x.to_bits() == y.to_bits();
    let side = Orbits::new(sensor.columns, sensor.rows).columns();
    // F1 keeps another pattern on each side of the diagonal; and the mirror of many orbits is a large table unless it
    // is an exchange of bits.
    let kept = matches!(design.algorithm.filter, Filter::None);
    (square && kept && (side.is_power_of_two() || side <= MOST_MIRRORED_SIDE)).then_some(side)
}

/// The last pass: products of stored matrices, in the blocks that they belong to.
pub fn bind(list: &ProductList, quantised: &Quantised) -> Vec<Product> {
    let formats = &quantised.formats;
    let bound = |step: &Step| {
        let matrix = quantised.place[step.matrix];
        let operand = formats.of(step.operand());
        let result = match (step.epilogue, &formats.folded) {
            (Epilogue::Part, Some(folded)) => folded.y,
            _ => formats.of(step.result),
        };
        let shift = |matrix: usize, lsb: i32| (lsb - quantised.matrices[matrix].accumulator_lsb(operand)) as u32;
        let preload = quantised.sums.filter(|_| step.sums);
        let (block, program) = owner(step.result, formats.folded.is_some());
        Product {
            step: Step { matrix, ..step.clone() },
            preload: preload.map(|matrix| Preload { matrix, shift: shift(matrix, formats.g.lsb) }),
            block,
            program,
            shift: shift(matrix, result.lsb),
        }
    };
    list.steps.iter().map(bound).collect()
}

/// Block and program of the product with this result.
fn owner(result: Vector, reduced: bool) -> (Block, usize) {
    match result {
        Vector::U(_) if !reduced => (Block::Op, 0),
        Vector::Residual(_) => (Block::Co, 1),
        Vector::Explained | Vector::Force(_) => (Block::Op, 2),
        Vector::Stress | Vector::Weight | Vector::Pull => (Block::We, 0),
        Vector::U(_) | Vector::Partial(_) | Vector::G(..) => (Block::Co, 0),
    }
}
