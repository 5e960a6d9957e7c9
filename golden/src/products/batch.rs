//! Products of several frames at a time: of matrices with matrices in place of vectors.
//!
//! On a large sensor a frame alone has to fetch every coefficient from memory to use it once. Frames together use it
//! once each.

use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixView, DMatrixViewMut};

use super::interpreter::{Arithmetic, ByPq};
use super::list::{ProductList, Source};
use super::step::Step;
use crate::parity::{CLASSES, Quads, butterfly};
use crate::reduced::{ReducedMatrices, SumRows};

/// Frames in a batch: so many that fetching a coefficient costs less than using it.
pub(crate) const FRAMES: usize = 128;

/// What all batches of a folded list share.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    /// The matrices, dense, by class of the operand, with their signs. Entries that the filter has dropped are zeros.
    matrices: Vec<[DMatrix<f64>; CLASSES]>,
    sums: SumRows,
    /// The taxels of every quad by member.
    members: Vec<[usize; CLASSES]>,
    taxels: usize,
}

impl Blocks {
    /// For a folded list and its matrices.
    pub(crate) fn new(list: &ProductList, stored: &ReducedMatrices, quads: &Quads) -> Self {
        let blocks = list.matrices.iter().map(|form| {
            let Source::Ten(name) = form.source else { return [0; CLASSES].map(|_| DMatrix::zeros(0, 0)) };
            let rows = &stored.get(name).rows;
            let mut blocks = [rows.len(); CLASSES].map(|n| DMatrix::zeros(n, n));
            for (row, entries) in rows.iter().enumerate() {
                for &(column, values) in entries {
                    for (block, value) in blocks.iter_mut().zip(values) {
                        block[(row, column as usize)] = form.sign * value;
                    }
                }
            }
            blocks
        });
        let sums = stored.sum_rows().clone();
        Self { matrices: blocks.collect(), sums, members: quads.all(), taxels: quads.taxels() }
    }
}

impl Blocks {
    /// Number of taxels.
    pub(crate) fn taxels(&self) -> usize {
        self.taxels
    }
}

/// Up to [`FRAMES`] frames of a folded list.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    blocks: Arc<Blocks>,
    /// Friction components of each, once they are known; as many as there are frames.
    pub(crate) friction: Vec<[f64; 2]>,
}

/// By class: the values of one frame after the other.
type Columns = [Vec<f64>; CLASSES];

impl Batch {
    /// Of no frames yet.
    pub(crate) fn new(blocks: Arc<Blocks>) -> Self {
        Self { blocks, friction: Vec::with_capacity(FRAMES) }
    }

    fn quads(&self) -> usize {
        self.blocks.members.len()
    }

    fn frames(&self) -> usize {
        self.friction.len()
    }

    /// One frame's values of a vector, by class.
    fn column<'v>(&self, vector: &'v Columns, frame: usize) -> [&'v [f64]; CLASSES] {
        let n = self.quads();
        vector.each_ref().map(|class| &class[frame * n..][..n])
    }

    /// The same, to be changed.
    fn column_mut<'v>(&self, vector: &'v mut Columns, frame: usize) -> [&'v mut [f64]; CLASSES] {
        let n = self.quads();
        vector.each_mut().map(|class| &mut class[frame * n..][..n])
    }

    /// Calls `each` for every frame and quad with the number of the value in each class.
    fn for_each(&self, mut each: impl FnMut(usize, usize, &[usize; CLASSES])) {
        for frame in 0..self.frames() {
            for (quad, taxels) in self.blocks.members.iter().enumerate() {
                each(frame * self.quads() + quad, frame * self.blocks.taxels, taxels);
            }
        }
    }
}

impl Arithmetic for Batch {
    type Vector = Columns;
    /// One frame's after the other.
    type Taxels = Vec<f64>;
    type Sums = Vec<ByPq<f64>>;
    /// The batch has it.
    type Friction = ();
    type Scratch = ();

    fn vector(&self) -> Columns {
        std::array::from_fn(|_| vec![0.0; self.quads() * FRAMES])
    }

    fn taxels(&self) -> Vec<f64> {
        vec![0.0; self.blocks.taxels * FRAMES]
    }

    fn no_sums(&self) -> Vec<ByPq<f64>> {
        vec![ByPq::default(); FRAMES]
    }

    fn scratch(&self) {}

    fn load(&self, stress: &Vec<f64>, operand: &mut Columns) {
        self.for_each(|at, first, taxels| {
            let sums = butterfly(taxels.map(|taxel| stress[first + taxel]));
            operand.iter_mut().zip(sums).for_each(|(class, sum)| class[at] = sum);
        });
    }

    fn multiply(&self, _: usize, step: &Step, operand: &Columns, result: &mut Columns, (): &mut ()) {
        let n = self.quads();
        for (class, block) in self.blocks.matrices[step.matrix].iter().enumerate() {
            let operand = DMatrixView::from_slice(&operand[class], n, self.frames());
            let mut result = DMatrixViewMut::from_slice(&mut result[class ^ step.parity], n, self.frames());
            result.gemm(1.0, block, &operand, 0.0);
        }
    }

    fn combine(&self, _: usize, [a, b, c]: [&Columns; 3], (): (), result: &mut Columns) {
        for (frame, [mu_x, mu_y]) in self.friction.iter().enumerate() {
            let parts = [a, b, c].map(|part| self.column(part, frame));
            for (class, result) in self.column_mut(result, frame).into_iter().enumerate() {
                let [a, b, c] = parts.map(|part| part[class]);
                for (result, ((a, b), c)) in result.iter_mut().zip(a.iter().zip(b).zip(c)) {
                    *result = a + mu_x * b + mu_y * c;
                }
            }
        }
    }

    fn part(&self, y: &mut Columns, pull: &mut Columns, weight: &mut Vec<f64>) {
        self.for_each(|at, first, taxels| {
            let values = butterfly(y.each_ref().map(|class| class[at])).map(|sum| 0.25 * sum);
            let magnitudes = values.map(|value| (-value).max(0.0));
            for (taxel, magnitude) in taxels.iter().zip(magnitudes) {
                weight[first + taxel] = magnitude;
            }
            y.iter_mut().zip(butterfly(magnitudes)).for_each(|(class, sum)| class[at] = sum);
            let pulls = butterfly(values.map(|value| value.max(0.0)));
            pull.iter_mut().zip(pulls).for_each(|(class, sum)| class[at] = sum);
        });
    }

    fn clip_negate(&self, y: &mut Columns) {
        y.iter_mut().flatten().for_each(|value| *value = (-*value).max(0.0));
    }

    fn add(&self, result: &mut Columns, other: &Columns) {
        result.iter_mut().flatten().zip(other.iter().flatten()).for_each(|(value, other)| *value += other);
    }

    fn add_stress(&self, _: usize, result: &mut Columns, stress: &Columns) {
        self.add(result, stress);
    }

    fn unfold(&self, vector: &Columns, values: &mut Vec<f64>) {
        self.for_each(|at, first, taxels| {
            for (taxel, sum) in taxels.iter().zip(butterfly(vector.each_ref().map(|class| class[at]))) {
                values[first + taxel] = 0.25 * sum;
            }
        });
    }

    fn sums(&self, _: usize, pull: &Columns, weight: &Columns, sums: &mut Vec<ByPq<f64>>) {
        for (frame, sums) in sums[..self.frames()].iter_mut().enumerate() {
            let [pull, weight] = [pull, weight].map(|vector| self.column(vector, frame));
            *sums = self.blocks.sums.of(|quad, class| pull[class][quad], |quad, class| weight[class][quad]);
        }
    }

    fn sum(&self, _: &Columns, _: usize, _: usize, _: &mut Vec<ByPq<f64>>) {}
}
