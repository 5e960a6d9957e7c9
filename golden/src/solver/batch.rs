//! Several frames at once.

use std::sync::Arc;

use super::{Estimators, Solution};
use crate::estimators::{Contact, FrictionScratch, Inputs};
use crate::filter::FilteredMatrices;
use crate::matrices::MatrixName;
use crate::names::ReducedName;
use crate::parity::{COMPONENTS, Orbits};
use crate::products::batch::{Batch, Blocks};
use crate::products::{Frame, ProductList, Vector};
use crate::reduced::ReducedMatrices;

/// Whether frames together are faster than one by one, where so many entries of `all` are kept: the blocks hold zeros for
/// what a filter has dropped, so at least a quarter must be left.
fn pays(kept: usize, all: usize) -> bool {
    4 * kept >= all
}

/// Whether it pays in the reduced plan.
pub(super) fn pays_folded(matrices: &ReducedMatrices, orbits: &Orbits) -> bool {
    let kept = ReducedName::ALL.into_iter().map(|name| matrices.nnz(name)).sum();
    pays(kept, ReducedName::ALL.len() * COMPONENTS * orbits.count() * orbits.count())
}

/// Whether it pays in the paper's plan.
pub(super) fn pays_whole(matrices: &FilteredMatrices, taxels: usize) -> bool {
    let kept = MatrixName::ALL.into_iter().map(|name| matrices.nnz(name)).sum();
    pays(kept, MatrixName::ALL.len() * taxels * taxels)
}

/// Memory of a batch.
#[derive(Clone, Debug)]
pub(super) struct BatchFrame<const W: usize> {
    list: ProductList,
    batch: Batch<W>,
    frame: Frame<Batch<W>>,
    taxels: usize,
    /// Place among the solutions, and what the contact analysis found. Only frames with a contact take part.
    contacts: Vec<(usize, Contact)>,
}

impl<const W: usize> BatchFrame<W> {
    pub(super) fn new(list: &ProductList, blocks: &Arc<Blocks<W>>) -> Self {
        let batch = Batch::new(Arc::clone(blocks));
        let frame = Frame::new(&batch, &list.steps);
        Self { list: list.clone(), frame, taxels: blocks.taxels(), batch, contacts: Vec::new() }
    }

    /// Whether it computes with these matrices.
    pub(super) fn is_of(&self, blocks: &Arc<Blocks<W>>) -> bool {
        self.batch.is_of(blocks)
    }

    /// Begins anew.
    pub(super) fn clear(&mut self) {
        self.batch.friction.clear();
        self.contacts.clear();
    }

    /// Adds the stress `b` (pascals, length m), whose solution is that at `index`.
    pub(super) fn push(&mut self, index: usize, contact: Contact, b: &[f64]) {
        self.frame.stress[self.contacts.len() * self.taxels..][..self.taxels].copy_from_slice(b);
        self.contacts.push((index, contact));
        self.batch.friction.push([0.0; 2]);
    }

    /// Finds the forces of all frames.
    pub(super) fn solve(&mut self, estimators: &Estimators, scratch: &mut FrictionScratch, solutions: &mut [Solution]) {
        let before_friction = self.list.before_friction();
        self.frame.load(&self.batch);
        self.run(0..before_friction);
        for (column, (index, contact)) in self.contacts.iter().enumerate() {
            let of_frame = column * self.taxels..(column + 1) * self.taxels;
            let u = self.frame.u.each_ref().map(|u| &u[of_frame.clone()]);
            let b = &self.frame.stress[of_frame];
            let inputs = Inputs { b, contact: *contact, sums: &self.frame.sums[column], u };
            self.batch.friction[column] = solutions[*index].optimum(estimators, &inputs, scratch);
        }
        self.run(before_friction..self.list.steps.len());
        if self.list.has_forces() {
            self.put_forces(solutions);
        } else {
            self.put_parts(solutions);
        }
    }

    /// Each taxel's force from `A_p r` and the weights.
    fn put_forces(&self, solutions: &mut [Solution]) {
        for (column, (index, _)) in self.contacts.iter().enumerate() {
            let of_frame = column * self.taxels..(column + 1) * self.taxels;
            let [mu_x, mu_y] = self.batch.friction[column];
            let weight = &self.frame.weight[of_frame.clone()];
            let components = solutions[*index].field.iter_mut().zip(&self.frame.force);
            for ((component, force), share) in components.zip([mu_x, mu_y, -1.0]) {
                for ((result, force), weight) in component.iter_mut().zip(&force[of_frame.clone()]).zip(weight) {
                    *result = force + share * weight;
                }
            }
        }
    }

    /// Each taxel's force from the `g_pq`, if the list makes any.
    fn put_parts(&self, solutions: &mut [Solution]) {
        for p in 0..3 {
            let parts = [0, 1, 2].map(|q| self.frame.get(Vector::G(1 + p as u8, q)).0[0].as_slice());
            for (column, (index, _)) in self.contacts.iter().enumerate() {
                let [mu_x, mu_y] = self.batch.friction[column];
                let first = column * self.taxels;
                let [g0, g1, g2] = parts.map(|part| part.get(first..first + self.taxels).unwrap_or_default());
                for (result, ((g0, g1), g2)) in solutions[*index].field[p].iter_mut().zip(g0.iter().zip(g1).zip(g2)) {
                    *result = g0 + mu_x * g1 + mu_y * g2;
                }
            }
        }
    }

    fn run(&mut self, steps: std::ops::Range<usize>) {
        for index in steps {
            self.frame.step(&self.batch, index, &self.list.steps[index], ());
        }
    }
}
