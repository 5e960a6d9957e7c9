//! Several frames at once by the reduced plan: products of matrices in place of products with vectors.
//!
//! On a large sensor a frame alone has to fetch every coefficient from memory to use it once. Frames together use it
//! once each, and the blocks that share an operand are stacked, so that a few large products do all the work.

use nalgebra::{DMatrix, DVector};

use super::cean::Contact;
use super::reading::{Reader, Reading};
use super::reduced::{FrameScratch, Reduced, optimum, split};
use super::{Solution, SolverError};
use crate::design::Outputs;
use crate::estimators::{Friction, FrictionScratch, Seen};
use crate::parity::CLASSES;
use crate::reduced::{ReducedMatrices, ReducedName as Name};

/// Frames in a batch: so many that fetching a coefficient costs less than using it.
pub(super) const FRAMES: usize = 128;

/// Matrices of each class that share an operand, one above the other, dense.
#[derive(Clone, Debug)]
pub(super) struct Stacks {
    stress: Stack,
    positive: Stack,
    magnitude: Stack,
    residual: Stack,
}

#[derive(Clone, Debug)]
struct Stack {
    parities: Vec<usize>,
    /// By class of the operand.
    blocks: [DMatrix<f64>; CLASSES],
}

impl Stacks {
    pub(super) fn new(matrices: &ReducedMatrices) -> Self {
        let stack = |names: &[Name]| Stack::new(matrices, names);
        Self {
            stress: stack(&[Name::C33inv]),
            positive: stack(&[Name::K0, Name::C33]),
            magnitude: stack(&[Name::K1, Name::K2, Name::C31, Name::C32]),
            residual: stack(&[Name::A1, Name::A2, Name::A3]),
        }
    }
}

impl Stack {
    /// Entries that the filter has dropped are zeros.
    fn new(matrices: &ReducedMatrices, names: &[Name]) -> Self {
        let n = matrices.get(names[0]).rows.len();
        let mut blocks = [0, 1, 2, 3].map(|_| DMatrix::zeros(names.len() * n, n));
        for (part, &name) in names.iter().enumerate() {
            for (row, entries) in matrices.get(name).rows.iter().enumerate() {
                for &(column, values) in entries {
                    for (block, value) in blocks.iter_mut().zip(values) {
                        block[(part * n + row, column as usize)] = value;
                    }
                }
            }
        }
        Self { parities: names.iter().map(|name| name.parity()).collect(), blocks }
    }

    /// Multiplies the first `frames` columns of the operands.
    fn times(&self, operands: &[DMatrix<f64>; CLASSES], frames: usize, results: &mut [DMatrix<f64>; CLASSES]) {
        for ((block, operand), result) in self.blocks.iter().zip(operands).zip(results) {
            let mut result = result.view_mut((0, 0), (block.nrows(), frames));
            result.gemm(1.0, block, &operand.columns(0, frames), 0.0);
        }
    }

    /// One quad of the folded result of matrix `part` for one frame.
    fn value(&self, results: &[DMatrix<f64>; CLASSES], part: usize, q: usize, frame: usize) -> [f64; CLASSES] {
        let row = part * self.blocks[0].ncols() + q;
        let parity = self.parities[part];
        [0, 1, 2, 3].map(|class| results[class ^ parity][(row, frame)])
    }
}

/// Memory of a batch.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    contacts: Vec<(usize, Contact)>,
    /// One column a frame.
    b: DMatrix<f64>,
    /// Operands by class, n rows.
    positive: [DMatrix<f64>; CLASSES],
    magnitude: [DMatrix<f64>; CLASSES],
    operand: [DMatrix<f64>; CLASSES],
    /// Products, up to 4 n rows.
    of_positive: [DMatrix<f64>; CLASSES],
    of_magnitude: [DMatrix<f64>; CLASSES],
    result: [DMatrix<f64>; CLASSES],
    frames: Vec<FrameScratch>,
    friction: FrictionScratch,
}

impl Scratch {
    pub(super) fn new(n: usize, taxels: usize) -> Self {
        let four = |rows: usize| [0, 1, 2, 3].map(|_| DMatrix::zeros(rows, FRAMES));
        Self {
            contacts: Vec::with_capacity(FRAMES),
            b: DMatrix::zeros(taxels, FRAMES),
            positive: four(n),
            magnitude: four(n),
            operand: four(n),
            of_positive: four(2 * n),
            of_magnitude: four(4 * n),
            result: four(3 * n),
            frames: vec![FrameScratch::new(n, taxels); FRAMES],
            friction: FrictionScratch::default(),
        }
    }
}

impl Reduced {
    /// Whether frames together are faster than one by one: the stacks hold zeros for what a filter has dropped, so at
    /// least a quarter of the entries must be left.
    pub(super) fn batch_pays(&self) -> bool {
        let kept: usize = Name::ALL.into_iter().map(|name| self.matrices.nnz(name)).sum();
        4 * kept >= Name::ALL.len() * CLASSES * self.quads() * self.quads()
    }

    /// Solves up to [`FRAMES`] frames, each into its solution.
    pub(super) fn solve_batch<F: AsRef<[f64]>>(
        &self,
        reader: &Reader,
        friction: &Friction,
        frames: &[F],
        solutions: &mut [Solution],
        b: &mut DVector<f64>,
        scratch: &mut Scratch,
    ) -> Result<(), SolverError> {
        let stacks = self.stacks();
        let field = if self.outputs == Outputs::Field { b.len() } else { 0 };
        // Only frames with a contact take a column.
        scratch.contacts.clear();
        for (index, (frame, solution)) in frames.iter().zip(&mut *solutions).enumerate() {
            match reader.read(frame.as_ref(), b)? {
                Reading::Nothing(status) => solution.reset(status, field),
                Reading::Contact { contact, status } => {
                    solution.reset(status, field);
                    let column = scratch.contacts.len();
                    scratch.b.set_column(column, b);
                    for q in 0..self.quads() {
                        put(&mut scratch.operand, q, column, self.members.fold(b.as_slice(), q));
                    }
                    scratch.contacts.push((index, contact));
                }
            }
        }
        let Scratch { contacts, b, positive, magnitude, operand, of_positive, of_magnitude, result, frames, .. } =
            scratch;
        let count = contacts.len();
        stacks.stress.times(operand, count, result);
        for (column, frame) in frames[..count].iter_mut().enumerate() {
            for q in 0..self.quads() {
                let (y, w) = split(stacks.stress.value(result, 0, q, column), &mut frame.press[q]);
                put(positive, q, column, y);
                put(magnitude, q, column, w);
            }
        }
        stacks.positive.times(positive, count, of_positive);
        stacks.magnitude.times(magnitude, count, of_magnitude);
        let (of_positive, of_magnitude) = (&*of_positive, &*of_magnitude);
        for (column, ((index, contact), frame)) in contacts.iter().zip(&mut *frames).enumerate() {
            let of_positive = |part| move |q| stacks.positive.value(of_positive, part, q, column);
            let of_magnitude = |part| move |q| stacks.magnitude.value(of_magnitude, part, q, column);
            let stress = &b.as_slice()[column * b.nrows()..];
            self.put_u(0, stress, of_positive(0), frame);
            self.put_u(1, stress, of_magnitude(0), frame);
            self.put_u(2, stress, of_magnitude(1), frame);
            let class = |operands: &[DMatrix<f64>; CLASSES], q| [0, 1, 2, 3].map(|class| operands[class][(q, column)]);
            let sums = self.sums(|q| class(positive, q), |q| class(magnitude, q));
            let seen = Seen { b: &stress[..b.nrows()], contact: *contact, sums: &sums, u: frame.stresses() };
            let [mu_x, mu_y] = optimum(friction, &seen, &mut scratch.friction, &mut solutions[*index]);
            for q in 0..self.quads() {
                let (normal, x, y) = (of_positive(1)(q), of_magnitude(2)(q), of_magnitude(3)(q));
                put(operand, q, column, [0, 1, 2, 3].map(|c| normal[c] - mu_x * x[c] - mu_y * y[c]));
            }
        }
        if self.outputs == Outputs::Resultants {
            return Ok(());
        }
        stacks.residual.times(operand, count, result);
        for (column, ((index, _), frame)) in contacts.iter().zip(&*frames).enumerate() {
            for p in 0..3 {
                let product = |q| stacks.residual.value(result, p, q, column);
                self.put_force(p, product, frame, &mut solutions[*index]);
            }
        }
        Ok(())
    }
}

/// Puts one quad of a folded vector into a column.
fn put(operands: &mut [DMatrix<f64>; CLASSES], q: usize, column: usize, values: [f64; CLASSES]) {
    for (operand, value) in operands.iter_mut().zip(values) {
        operand[(q, column)] = value;
    }
}
