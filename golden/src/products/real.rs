//! Products in real numbers.

use std::marker::PhantomData;

use super::interpreter::Frame;
use super::list::ProductList;
use super::scalar::{Number, Scalar, put_moments};
use super::step::{Step, Vector};
use super::stored::{Quarters, Stored};
use crate::float::Float;
use crate::sums::ByPq;

/// Products with stored matrices in floating point.
#[derive(Clone, Debug)]
pub struct Real<T, S> {
    /// The matrices.
    pub stored: S,
    list: ProductList,
    number: PhantomData<T>,
}

impl<T: Float, S: Stored<W>, const W: usize> Number<W> for Real<T, S> {
    type Element = T;
    type Scratch = Quarters<T>;

    fn scratch(&self) -> Quarters<T> {
        Default::default()
    }

    fn multiply(&self, _: usize, step: &Step, operand: &[[T; W]], result: &mut [[T; W]], scratch: &mut Quarters<T>) {
        let form = &self.list.matrices[step.matrix];
        self.stored.times(form.source, operand, result, scratch);
        let pairs = result.as_flattened_mut().iter_mut().zip(operand.as_flattened());
        match (form.with_identity, form.sign < 0.0) {
            (false, false) => {}
            (false, true) => pairs.for_each(|(result, _)| *result = -*result),
            (true, false) => pairs.for_each(|(result, &x)| *result = *result + x),
            (true, true) => pairs.for_each(|(result, &x)| *result = -(*result + x)),
        }
    }

    fn combine(&self, _: usize, [a, b, c]: [T; 3], [mu_x, mu_y]: [T; 2]) -> T {
        a + mu_x * b + mu_y * c
    }

    fn sums(&self, _: usize, pull: &[[T; W]], weight: &[[T; W]]) -> ByPq<T> {
        self.stored.sums(pull, weight)
    }

    fn sum(&self, g: &[[T; W]], p: usize, q: usize, sums: &mut ByPq<T>) {
        let mut totals = [T::default(); 3];
        for (taxel, &value) in g.as_flattened().iter().enumerate() {
            let [x, y] = self.stored.arm_m(taxel).map(T::of);
            let parts = [value, x * value, y * value];
            totals.iter_mut().zip(parts).for_each(|(total, part)| *total = *total + part);
        }
        let [sum, along_x, along_y] = totals;
        put_moments(sums, (p, q), sum, [along_x, along_y]);
    }

    fn folded_stress(&self, sum: T) -> T {
        sum
    }

    fn folded_weight(&self, sum: T) -> T {
        sum
    }

    fn unfolded(&self, sum: T) -> T {
        T::of(1.0 / W as f64) * sum
    }

    fn added_stress(&self, _: usize, stress: T) -> T {
        stress
    }
}

/// A list and what executes it, frame by frame.
#[derive(Clone, Debug)]
pub struct Engine<T, S, const W: usize> {
    /// The products.
    pub list: ProductList,
    arithmetic: Scalar<Real<T, S>, W>,
    before_friction: usize,
}

impl<T: Float, S: Stored<W>, const W: usize> Engine<T, S, W> {
    /// For a list, its matrices, and elements that stand for these of `taxels` taxels.
    pub fn new(list: ProductList, stored: S, images: Vec<[usize; W]>, taxels: usize) -> Self {
        let before_friction = list.before_friction();
        let numbers = Real { stored, list: list.clone(), number: PhantomData };
        Self { list, arithmetic: Scalar::new(numbers, images, taxels), before_friction }
    }

    /// The matrices.
    pub fn stored(&self) -> &S {
        &self.arithmetic.numbers.stored
    }

    /// Memory for a frame.
    pub fn frame(&self) -> RealFrame<T, S, W> {
        Frame::new(&self.arithmetic, &self.list.steps)
    }

    /// Finds the sums `G_pq` and `u_q` for the stress of the frame.
    pub fn until_friction(&self, frame: &mut RealFrame<T, S, W>) {
        frame.load(&self.arithmetic);
        self.run(0..self.before_friction, [T::default(); 2], frame);
    }

    /// Finds the forces of each taxel, now that the friction is known.
    pub fn field(&self, mu: [T; 2], frame: &mut RealFrame<T, S, W>, mut put: impl FnMut(usize, usize, T)) {
        self.run(self.before_friction..self.list.steps.len(), mu, frame);
        let [mu_x, mu_y] = mu;
        if self.list.has_forces() {
            for (p, (force, share)) in frame.force.iter().zip([mu_x, mu_y, T::of(-1.0)]).enumerate() {
                for (taxel, (&force, &weight)) in force.iter().zip(&frame.weight).enumerate() {
                    put(p, taxel, force + share * weight);
                }
            }
        } else {
            for p in 0..3 {
                let [g0, g1, g2] = [0, 1, 2].map(|q| frame.get(Vector::G(1 + p as u8, q)).as_flattened());
                for (taxel, ((&g0, &g1), &g2)) in g0.iter().zip(g1).zip(g2).enumerate() {
                    put(p, taxel, g0 + mu_x * g1 + mu_y * g2);
                }
            }
        }
    }

    fn run(&self, steps: std::ops::Range<usize>, mu: [T; 2], frame: &mut RealFrame<T, S, W>) {
        for index in steps {
            frame.step(&self.arithmetic, index, &self.list.steps[index], mu);
        }
    }
}

/// A frame of an [`Engine`].
pub type RealFrame<T, S, const W: usize> = Frame<Scalar<Real<T, S>, W>>;
