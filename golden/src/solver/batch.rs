//! Several frames at once.

use std::sync::Arc;

use super::Solution;
use crate::estimators::{Contact, Friction, FrictionScratch, Seen};
use crate::names::ReducedName;
use crate::parity::{CLASSES, Quads};
use crate::products::batch::{Batch, Blocks};
use crate::products::{Frame, ProductList};
use crate::reduced::ReducedMatrices;

/// Whether frames together are faster than one by one: the blocks hold zeros for what a filter has dropped, so at
/// least a quarter of the entries must be left.
pub(super) fn pays(matrices: &ReducedMatrices, quads: &Quads) -> bool {
    let kept: usize = ReducedName::ALL.into_iter().map(|name| matrices.nnz(name)).sum();
    4 * kept >= ReducedName::ALL.len() * CLASSES * quads.count() * quads.count()
}

/// Memory of a batch.
#[derive(Clone, Debug)]
pub(super) struct BatchFrame {
    list: ProductList,
    batch: Batch,
    frame: Frame<Batch>,
    taxels: usize,
    /// Place among the solutions, and what the contact analysis found. Only frames with a contact take part.
    contacts: Vec<(usize, Contact)>,
}

impl BatchFrame {
    pub(super) fn new(list: &ProductList, blocks: &Arc<Blocks>) -> Self {
        let batch = Batch::new(Arc::clone(blocks));
        let frame = Frame::new(&batch, &list.steps);
        Self { list: list.clone(), frame, taxels: blocks.taxels(), batch, contacts: Vec::new() }
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
    pub(super) fn solve(&mut self, friction: &Friction, scratch: &mut FrictionScratch, solutions: &mut [Solution]) {
        let before_friction = self.list.before_friction();
        self.frame.load(&self.batch);
        self.run(0..before_friction);
        for (column, (index, contact)) in self.contacts.iter().enumerate() {
            let of_frame = column * self.taxels..(column + 1) * self.taxels;
            let u = self.frame.u.each_ref().map(|u| &u[of_frame.clone()]);
            let b = &self.frame.stress[of_frame];
            let seen = Seen { b, contact: *contact, sums: &self.frame.sums[column], u };
            self.batch.friction[column] = solutions[*index].optimum(friction, &seen, scratch);
        }
        self.run(before_friction..self.list.steps.len());
        if !self.list.has_forces() {
            return;
        }
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

    fn run(&mut self, steps: std::ops::Range<usize>) {
        for index in steps {
            self.frame.step(&self.batch, index, &self.list.steps[index], ());
        }
    }
}
