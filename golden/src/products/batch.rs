//! Products of several frames at a time: of matrices with matrices in place of vectors.
//!
//! On a large sensor a frame alone has to fetch every coefficient from memory to use it once. Frames together use it
//! once each.

use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixView, DMatrixViewMut};

use super::interpreter::Arithmetic;
use super::list::{ProductList, Source};
use super::scalar::put_moments;
use super::step::Step;
use crate::filter::FilteredMatrices;
use crate::matrices::Matrices;
use crate::parity::{COMPONENTS, Orbits, butterfly};
use crate::reduced::{ReducedMatrices, SumRows};
use crate::sums::ByPq;

/// Frames in a batch: so many that fetching a coefficient costs less than using it.
pub(crate) const FRAMES: usize = 128;

/// What all batches of a list share. Vectors have `W` values an element, as those of [`super::scalar::Number`].
#[derive(Clone, Debug)]
pub(crate) struct Blocks<const W: usize> {
    /// The matrices, dense, by component of the operand, as the list multiplies with them. Entries that the filter has
    /// dropped are zeros.
    matrices: Vec<[DMatrix<f64>; W]>,
    sums: Sums,
    /// The taxels of every element.
    images: Vec<[usize; W]>,
    taxels: usize,
}

/// How the sums `G_pq` of a frame are found.
#[derive(Clone, Debug)]
enum Sums {
    /// From y+ and the weights, at once.
    Rows(Box<SumRows>),
    /// From the vectors `g_pq`, and with the arms of the taxels in metres those of the torques.
    Arms(Vec<[f64; 2]>),
}

impl Blocks<COMPONENTS> {
    /// For a folded list and its matrices.
    pub(crate) fn folded(list: &ProductList, stored: &ReducedMatrices, orbits: &Orbits) -> Self {
        let blocks = list.matrices.iter().map(|form| {
            let Source::Ten(name) = form.source else { return [0; COMPONENTS].map(|_| DMatrix::zeros(0, 0)) };
            let rows = &stored.get(name).rows;
            let mut blocks = [rows.len(); COMPONENTS].map(|n| DMatrix::zeros(n, n));
            for (row, entries) in rows.iter().enumerate() {
                for &(column, values) in entries {
                    for (block, value) in blocks.iter_mut().zip(values) {
                        block[(row, column as usize)] = form.sign * value;
                    }
                }
            }
            blocks
        });
        let sums = Sums::Rows(Box::new(stored.sum_rows().clone()));
        Self { matrices: blocks.collect(), sums, images: orbits.all(), taxels: orbits.taxels() }
    }
}

impl Blocks<1> {
    /// For the paper's list and its matrices.
    pub(crate) fn whole(list: &ProductList, filtered: &FilteredMatrices, matrices: &Matrices) -> Self {
        let blocks = list.matrices.iter().map(|form| {
            let mut whole = match form.source {
                Source::Thirteen(name) => DMatrix::from(filtered.get(name)),
                Source::Ten(_) => matrices.c33.dense(),
                Source::Friction => DMatrix::zeros(0, 0),
            };
            if form.with_identity {
                for place in 0..whole.nrows() {
                    whole[(place, place)] += 1.0;
                }
            }
            [whole * form.sign]
        });
        let sensor = matrices.sensor();
        let arms = (0..sensor.taxels()).map(|taxel| sensor.arm_m(taxel)).collect();
        let images = (0..sensor.taxels()).map(|taxel| [taxel]).collect();
        Self { matrices: blocks.collect(), sums: Sums::Arms(arms), images, taxels: sensor.taxels() }
    }
}

impl<const W: usize> Blocks<W> {
    /// Number of taxels.
    pub(crate) fn taxels(&self) -> usize {
        self.taxels
    }
}

/// Up to [`FRAMES`] frames of a list.
#[derive(Clone, Debug)]
pub(crate) struct Batch<const W: usize> {
    blocks: Arc<Blocks<W>>,
    /// Friction components of each, once they are known; as many as there are frames.
    pub(crate) friction: Vec<[f64; 2]>,
}

/// By component: the values of one frame after the other.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const W: usize>(pub(crate) [Vec<f64>; W]);

impl<const W: usize> Default for Columns<W> {
    fn default() -> Self {
        Self(std::array::from_fn(|_| Vec::new()))
    }
}

impl<const W: usize> Batch<W> {
    /// What each component of a folded vector has of a taxel.
    const SHARE: f64 = 1.0 / W as f64;

    /// Of no frames yet.
    pub(crate) fn new(blocks: Arc<Blocks<W>>) -> Self {
        Self { blocks, friction: Vec::with_capacity(FRAMES) }
    }

    /// Which blocks they are computed with.
    pub(crate) fn is_of(&self, blocks: &Arc<Blocks<W>>) -> bool {
        Arc::ptr_eq(&self.blocks, blocks)
    }

    fn elements(&self) -> usize {
        self.blocks.images.len()
    }

    fn frames(&self) -> usize {
        self.friction.len()
    }

    /// One frame's values of a vector, by component.
    fn column<'v>(&self, vector: &'v Columns<W>, frame: usize) -> [&'v [f64]; W] {
        let n = self.elements();
        vector.0.each_ref().map(|component| &component[frame * n..][..n])
    }

    /// The same, to be changed.
    fn column_mut<'v>(&self, vector: &'v mut Columns<W>, frame: usize) -> [&'v mut [f64]; W] {
        let n = self.elements();
        vector.0.each_mut().map(|component| &mut component[frame * n..][..n])
    }

    /// Calls `each` for every frame and orbit with the number of the value in each component.
    fn for_each(&self, mut each: impl FnMut(usize, usize, &[usize; W])) {
        for frame in 0..self.frames() {
            for (orbit, taxels) in self.blocks.images.iter().enumerate() {
                each(frame * self.elements() + orbit, frame * self.blocks.taxels, taxels);
            }
        }
    }
}

impl<const W: usize> Arithmetic for Batch<W> {
    type Vector = Columns<W>;
    /// One frame's after the other.
    type Taxels = Vec<f64>;
    type Sums = Vec<ByPq<f64>>;
    /// The batch has it.
    type Friction = ();
    type Scratch = ();

    fn vector(&self) -> Columns<W> {
        Columns(std::array::from_fn(|_| vec![0.0; self.elements() * FRAMES]))
    }

    fn taxels(&self) -> Vec<f64> {
        vec![0.0; self.blocks.taxels * FRAMES]
    }

    fn no_sums(&self) -> Vec<ByPq<f64>> {
        vec![ByPq::default(); FRAMES]
    }

    fn scratch(&self) {}

    fn load(&self, stress: &Vec<f64>, operand: &mut Columns<W>) {
        self.for_each(|at, first, taxels| {
            let sums = butterfly(taxels.map(|taxel| stress[first + taxel]));
            operand.0.iter_mut().zip(sums).for_each(|(component, sum)| component[at] = sum);
        });
    }

    fn multiply(&self, _: usize, step: &Step, operand: &Columns<W>, result: &mut Columns<W>, (): &mut ()) {
        let n = self.elements();
        for (component, block) in self.blocks.matrices[step.matrix].iter().enumerate() {
            let operand = DMatrixView::from_slice(&operand.0[component], n, self.frames());
            let mut result = DMatrixViewMut::from_slice(&mut result.0[component ^ step.parity], n, self.frames());
            result.gemm(1.0, block, &operand, 0.0);
        }
    }

    fn combine(&self, _: usize, [a, b, c]: [&Columns<W>; 3], (): (), result: &mut Columns<W>) {
        for (frame, [mu_x, mu_y]) in self.friction.iter().enumerate() {
            let parts = [a, b, c].map(|part| self.column(part, frame));
            for (component, result) in self.column_mut(result, frame).into_iter().enumerate() {
                let [a, b, c] = parts.map(|part| part[component]);
                for (result, ((a, b), c)) in result.iter_mut().zip(a.iter().zip(b).zip(c)) {
                    *result = a + mu_x * b + mu_y * c;
                }
            }
        }
    }

    fn part(&self, y: &mut Columns<W>, pull: &mut Columns<W>, weight: &mut Vec<f64>) {
        self.for_each(|at, first, taxels| {
            let values = butterfly(y.0.each_ref().map(|component| component[at])).map(|sum| Self::SHARE * sum);
            let magnitudes = values.map(|value| (-value).max(0.0));
            for (taxel, magnitude) in taxels.iter().zip(magnitudes) {
                weight[first + taxel] = magnitude;
            }
            y.0.iter_mut().zip(butterfly(magnitudes)).for_each(|(component, sum)| component[at] = sum);
            let pulls = butterfly(values.map(|value| value.max(0.0)));
            pull.0.iter_mut().zip(pulls).for_each(|(component, sum)| component[at] = sum);
        });
    }

    fn clip_negate(&self, y: &mut Columns<W>) {
        y.0.iter_mut().flatten().for_each(|value| *value = (-*value).max(0.0));
    }

    fn add(&self, result: &mut Columns<W>, other: &Columns<W>) {
        result.0.iter_mut().flatten().zip(other.0.iter().flatten()).for_each(|(value, other)| *value += other);
    }

    fn add_stress(&self, _: usize, result: &mut Columns<W>, stress: &Columns<W>) {
        self.add(result, stress);
    }

    fn unfold(&self, vector: &Columns<W>, values: &mut Vec<f64>) {
        self.for_each(|at, first, taxels| {
            for (taxel, sum) in taxels.iter().zip(butterfly(vector.0.each_ref().map(|component| component[at]))) {
                values[first + taxel] = Self::SHARE * sum;
            }
        });
    }

    fn sums(&self, _: usize, pull: &Columns<W>, weight: &Columns<W>, sums: &mut Vec<ByPq<f64>>) {
        let Sums::Rows(rows) = &self.blocks.sums else { return };
        for (frame, sums) in sums[..self.frames()].iter_mut().enumerate() {
            let [pull, weight] = [pull, weight].map(|vector| self.column(vector, frame));
            *sums = rows.of(|orbit, component| pull[component][orbit], |orbit, component| weight[component][orbit]);
        }
    }

    fn sum(&self, g: &Columns<W>, p: usize, q: usize, sums: &mut Vec<ByPq<f64>>) {
        let Sums::Arms(arms) = &self.blocks.sums else { return };
        for (frame, sums) in sums[..self.frames()].iter_mut().enumerate() {
            let mut totals = [0.0; 3];
            for (&value, [x, y]) in self.column(g, frame)[0].iter().zip(arms) {
                for (total, part) in totals.iter_mut().zip([value, x * value, y * value]) {
                    *total += part;
                }
            }
            let [sum, along_x, along_y] = totals;
            put_moments(sums, (p, q), sum, [along_x, along_y]);
        }
    }
}
