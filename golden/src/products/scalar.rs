//! Arithmetics of one frame at a time: what those in real numbers and those in integers have in common.

use std::ops::{Add, Neg, Sub};

use super::interpreter::Arithmetic;
use super::step::Step;
use crate::parity::{butterfly, mirror, swapped};
use crate::sums::ByPq;

/// A kind of numbers, and the products in it. Vectors have `W` values an element: one for each taxel, or four for each
/// orbit, by component.
pub trait Number<const W: usize> {
    /// One number.
    type Element: Copy
        + Default
        + PartialOrd
        + Add<Output = Self::Element>
        + Sub<Output = Self::Element>
        + Neg<Output = Self::Element>;
    /// Memory for the time of a product.
    type Scratch;

    /// That memory.
    fn scratch(&self) -> Self::Scratch;
    /// The product with the stored matrix of a step, whose mirror image is not meant.
    fn multiply(
        &self,
        index: usize,
        step: &Step,
        operand: &[[Self::Element; W]],
        result: &mut [[Self::Element; W]],
        scratch: &mut Self::Scratch,
    );
    /// One value of each part, times one and the friction components, added up.
    fn combine(&self, index: usize, parts: [Self::Element; 3], friction: [Self::Element; 2]) -> Self::Element;
    /// The sums `G_pq` from y+ and the weights.
    fn sums(&self, index: usize, pull: &[[Self::Element; W]], weight: &[[Self::Element; W]]) -> ByPq<Self::Element>;
    /// `G_pq` as the sum of `g_pq`, and what it adds to those of the torques.
    fn sum(&self, g: &[[Self::Element; W]], p: usize, q: usize, sums: &mut ByPq<Self::Element>);
    /// Folded stress in the format of an operand.
    fn folded_stress(&self, sum: Self::Element) -> Self::Element;
    /// Folded weights, or y+, in the format of an operand.
    fn folded_weight(&self, sum: Self::Element) -> Self::Element;
    /// The value of a taxel from the sum over the components, W times as much.
    fn unfolded(&self, sum: Self::Element) -> Self::Element;
    /// Folded stress in the format of a result.
    fn added_stress(&self, index: usize, stress: Self::Element) -> Self::Element;
}

/// The arithmetic of a kind of numbers.
#[derive(Clone, Debug)]
pub struct Scalar<N, const W: usize> {
    /// The numbers.
    pub numbers: N,
    /// The taxels of each element, see [`crate::parity::Orbits::images`].
    images: Vec<[usize; W]>,
    taxels: usize,
}

impl<N, const W: usize> Scalar<N, W> {
    /// For elements that stand for these of `taxels` taxels.
    pub fn new(numbers: N, images: Vec<[usize; W]>, taxels: usize) -> Self {
        Self { numbers, images, taxels }
    }
}

impl<N: Number<W>, const W: usize> Arithmetic for Scalar<N, W> {
    type Vector = Vec<[N::Element; W]>;
    type Taxels = Vec<N::Element>;
    type Sums = ByPq<N::Element>;
    type Friction = [N::Element; 2];
    type Scratch = N::Scratch;

    fn vector(&self) -> Self::Vector {
        vec![[N::Element::default(); W]; self.images.len()]
    }

    fn taxels(&self) -> Self::Taxels {
        vec![N::Element::default(); self.taxels]
    }

    fn no_sums(&self) -> Self::Sums {
        ByPq::default()
    }

    fn scratch(&self) -> Self::Scratch {
        self.numbers.scratch()
    }

    fn load(&self, stress: &Self::Taxels, operand: &mut Self::Vector) {
        for (element, taxels) in operand.iter_mut().zip(&self.images) {
            *element = butterfly(taxels.map(|taxel| stress[taxel])).map(|sum| self.numbers.folded_stress(sum));
        }
    }

    fn multiply(
        &self,
        index: usize,
        step: &Step,
        operand: &Self::Vector,
        result: &mut Self::Vector,
        scratch: &mut N::Scratch,
    ) {
        let Some(side) = step.mirrored else { return self.numbers.multiply(index, step, operand, result, scratch) };
        let mut image = self.vector();
        self.numbers.multiply(index, step, &mirrored(operand, side), &mut image, scratch);
        *result = mirrored(&image, side);
    }

    fn combine(
        &self,
        index: usize,
        [a, b, c]: [&Self::Vector; 3],
        friction: Self::Friction,
        result: &mut Self::Vector,
    ) {
        for (result, ((a, b), c)) in result.iter_mut().zip(a.iter().zip(b).zip(c)) {
            *result = std::array::from_fn(|way| self.numbers.combine(index, [a[way], b[way], c[way]], friction));
        }
    }

    fn clip_negate(&self, y: &mut Self::Vector) {
        for value in y.as_flattened_mut() {
            *value = positive(-*value);
        }
    }

    fn part(&self, y: &mut Self::Vector, pull: &mut Self::Vector, weight: &mut Self::Taxels) {
        let folded = |values: [N::Element; W]| butterfly(values).map(|sum| self.numbers.folded_weight(sum));
        for ((y, pull), taxels) in y.iter_mut().zip(pull).zip(&self.images) {
            let values = butterfly(*y).map(|sum| self.numbers.unfolded(sum));
            let magnitude = values.map(|value| positive(-value));
            for (&taxel, magnitude) in taxels.iter().zip(magnitude) {
                weight[taxel] = magnitude;
            }
            (*y, *pull) = (folded(magnitude), folded(values.map(positive)));
        }
    }

    fn add(&self, result: &mut Self::Vector, other: &Self::Vector) {
        for (value, &other) in result.as_flattened_mut().iter_mut().zip(other.as_flattened()) {
            *value = *value + other;
        }
    }

    fn add_stress(&self, index: usize, result: &mut Self::Vector, stress: &Self::Vector) {
        for (value, &stress) in result.as_flattened_mut().iter_mut().zip(stress.as_flattened()) {
            *value = *value + self.numbers.added_stress(index, stress);
        }
    }

    fn unfold(&self, vector: &Self::Vector, values: &mut Self::Taxels) {
        for (element, taxels) in vector.iter().zip(&self.images) {
            for (&taxel, sum) in taxels.iter().zip(butterfly(*element)) {
                values[taxel] = self.numbers.unfolded(sum);
            }
        }
    }

    fn sums(&self, index: usize, pull: &Self::Vector, weight: &Self::Vector, sums: &mut Self::Sums) {
        *sums = self.numbers.sums(index, pull, weight);
    }

    fn sum(&self, g: &Self::Vector, p: usize, q: usize, sums: &mut Self::Sums) {
        self.numbers.sum(g, p, q, sums);
    }
}

/// Puts a sum of `g_pq` and its moments, those of `x g_pq` and `y g_pq`, where they belong: `T_x` is the sum of `y f_z`,
/// `T_y` that of `-x f_z`, `T_z` that of `x f_y - y f_x`.
pub fn put_moments<E>(sums: &mut ByPq<E>, (p, q): (usize, usize), sum: E, [along_x, along_y]: [E; 2])
where
    E: Copy + Add<Output = E> + Neg<Output = E>,
{
    sums[p][q] = sum;
    match p {
        0 => sums[5][q] = -along_y,
        1 => sums[5][q] = sums[5][q] + along_x,
        _ => (sums[3][q], sums[4][q]) = (along_y, -along_x),
    }
}

/// The value, or zero if it is below.
fn positive<E: Copy + Default + PartialOrd>(value: E) -> E {
    if value > E::default() { value } else { E::default() }
}

/// A folded vector on the other side of the diagonal, on a square grid of `side` by `side` orbits.
fn mirrored<E: Copy, const W: usize>(vector: &[[E; W]], side: usize) -> Vec<[E; W]> {
    let element = |orbit| {
        let mirrored: [E; W] = vector[mirror(orbit, side)];
        std::array::from_fn(|component| mirrored[swapped(component)])
    };
    (0..vector.len()).map(element).collect()
}
