//! The interpreter: executes a list of products in any arithmetic.

use super::step::{Coefficients, Epilogue, Step, Vector};

/// What the interpreter computes with: how vectors look, and what one step does to them.
///
/// `index` is a step's number in its list, so that an arithmetic can have constants of its own for each.
pub trait Arithmetic {
    /// A vector as products read and write it.
    type Vector: Default;
    /// A value for each taxel.
    type Taxels;
    /// The sums `G_pq` of a frame.
    type Sums;
    /// Both friction components of a frame.
    type Friction: Copy;
    /// Memory for the time of a product.
    type Scratch;

    /// Memory of a vector.
    fn vector(&self) -> Self::Vector;
    /// Memory of the taxels' values.
    fn taxels(&self) -> Self::Taxels;
    /// Sums of nothing.
    fn no_sums(&self) -> Self::Sums;
    /// Memory for the time of a product.
    fn scratch(&self) -> Self::Scratch;

    /// The stress of each taxel as an operand.
    fn load(&self, stress: &Self::Taxels, operand: &mut Self::Vector);
    /// The product with the stored matrix.
    fn multiply(
        &self,
        index: usize,
        step: &Step,
        operand: &Self::Vector,
        result: &mut Self::Vector,
        scratch: &mut Self::Scratch,
    );
    /// The parts times one and the friction components, added up.
    fn combine(&self, index: usize, parts: [&Self::Vector; 3], friction: Self::Friction, result: &mut Self::Vector);
    /// `max(-y, 0)`.
    fn clip_negate(&self, y: &mut Self::Vector);
    /// Parts y, which becomes the magnitude of the weights; `weight` takes that of each taxel.
    fn part(&self, y: &mut Self::Vector, pull: &mut Self::Vector, weight: &mut Self::Taxels);
    /// Adds another vector to a result of the same format.
    fn add(&self, result: &mut Self::Vector, other: &Self::Vector);
    /// Adds the stress to a result.
    fn add_stress(&self, index: usize, result: &mut Self::Vector, stress: &Self::Vector);
    /// The values of the taxels.
    fn unfold(&self, vector: &Self::Vector, taxels: &mut Self::Taxels);
    /// All sums, from y+ and the weights.
    fn sums(&self, index: usize, pull: &Self::Vector, weight: &Self::Vector, sums: &mut Self::Sums);
    /// `G_pq` as the sum of `g_pq`, and what it adds to those of the torques; p from 0, `g_1q` before `g_2q`.
    fn sum(&self, g: &Self::Vector, p: usize, q: usize, sums: &mut Self::Sums);
}

/// What is known of a frame so far.
#[derive(Clone, Debug)]
pub struct Frame<A: Arithmetic> {
    /// By [`Vector::slot`]; those that no product of the list makes are empty.
    vectors: Vec<A::Vector>,
    /// Stress of each taxel.
    pub stress: A::Taxels,
    /// Magnitude of the weight of each taxel, where the list parts.
    pub weight: A::Taxels,
    /// `u_q` of each taxel.
    pub u: [A::Taxels; 3],
    /// `A_p r` of each taxel, where the list makes it.
    pub force: [A::Taxels; 3],
    /// The sums `G_pq`.
    pub sums: A::Sums,
    scratch: A::Scratch,
}

impl<A: Arithmetic> Frame<A> {
    /// Memory for the frames of a list.
    pub fn new<'a>(arithmetic: &A, steps: impl IntoIterator<Item = &'a Step>) -> Self {
        let mut vectors: Vec<A::Vector> = (0..Vector::COUNT).map(|_| A::Vector::default()).collect();
        vectors[Vector::Stress.slot()] = arithmetic.vector();
        for step in steps {
            vectors[step.result.slot()] = arithmetic.vector();
            if step.epilogue == Epilogue::Part {
                vectors[Vector::Pull.slot()] = arithmetic.vector();
            }
        }
        Self {
            vectors,
            stress: arithmetic.taxels(),
            weight: arithmetic.taxels(),
            u: std::array::from_fn(|_| arithmetic.taxels()),
            force: std::array::from_fn(|_| arithmetic.taxels()),
            sums: arithmetic.no_sums(),
            scratch: arithmetic.scratch(),
        }
    }

    /// A vector as it is now.
    pub fn get(&self, vector: Vector) -> &A::Vector {
        &self.vectors[vector.slot()]
    }

    /// Makes the stress an operand.
    pub fn load(&mut self, arithmetic: &A) {
        arithmetic.load(&self.stress, &mut self.vectors[Vector::Stress.slot()]);
    }

    /// Executes one step. `friction` counts for those products only that have no other coefficients.
    pub fn step(&mut self, arithmetic: &A, index: usize, step: &Step, friction: A::Friction) {
        let mut result = std::mem::take(&mut self.vectors[step.result.slot()]);
        match step.coefficients {
            Coefficients::Rom => {
                let operand = &self.vectors[step.operand().slot()];
                arithmetic.multiply(index, step, operand, &mut result, &mut self.scratch);
            }
            Coefficients::Friction => {
                let parts = [0, 1, 2].map(|part| self.get(step.operands[part]));
                arithmetic.combine(index, parts, friction, &mut result);
            }
        }
        if step.sums {
            let [pull, weight] = [Vector::Pull, Vector::Weight].map(|vector| &self.vectors[vector.slot()]);
            arithmetic.sums(index, pull, weight, &mut self.sums);
        }
        match step.epilogue {
            Epilogue::ClipNegate => arithmetic.clip_negate(&mut result),
            Epilogue::Add(partial) => arithmetic.add(&mut result, self.get(partial)),
            Epilogue::Part => {
                arithmetic.part(&mut result, &mut self.vectors[Vector::Pull.slot()], &mut self.weight);
            }
            Epilogue::AddStress => arithmetic.add_stress(index, &mut result, self.get(Vector::Stress)),
            Epilogue::Keep | Epilogue::Store | Epilogue::Unfold => {}
        }
        match step.result {
            Vector::U(q) => arithmetic.unfold(&result, &mut self.u[usize::from(q)]),
            Vector::Force(p) => arithmetic.unfold(&result, &mut self.force[usize::from(p) - 1]),
            Vector::G(p, q) => arithmetic.sum(&result, usize::from(p) - 1, usize::from(q), &mut self.sums),
            _ => {}
        }
        self.vectors[step.result.slot()] = result;
    }
}
