//! A frame by the reduced plan: the stages We, Co and Op on folded vectors.

use std::sync::OnceLock;

use super::Solution;
use super::batch::Stacks;
use super::cean::Contact;
use super::fours::{Fours, Members, times};
use crate::design::Outputs;
use crate::estimators::{Friction, FrictionScratch, Seen};
use crate::parity::{CLASSES, Quads, butterfly};
use crate::reduced::{ReducedMatrices, ReducedName as Name};

/// Everything of the reduced plan that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct Reduced {
    pub(super) members: Members,
    pub(super) matrices: ReducedMatrices,
    pub(super) outputs: Outputs,
    /// The blocks for several frames at once, made when first used.
    stacks: OnceLock<Stacks>,
}

/// Memory of a frame.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    /// The folded operands: stress, y+, |w|, r; and what becomes of one product.
    stress: Fours,
    positive: Fours,
    magnitude: Fours,
    residual: Fours,
    result: Fours,
    /// The sums `G_pq`.
    pub(super) sums: [[f64; 3]; 3],
    pub(super) frame: FrameScratch,
    pub(super) friction: FrictionScratch,
}

/// What a frame needs besides products.
#[derive(Clone, Debug)]
pub(super) struct FrameScratch {
    /// |w| by quad and member.
    pub(super) press: Fours,
    /// `u_q` in pascals, by taxel.
    pub(super) u: [Vec<f64>; 3],
}

impl FrameScratch {
    pub(super) fn new(quads: usize, taxels: usize) -> Self {
        let u = std::array::from_fn(|_| vec![0.0; taxels]);
        Self { press: vec![[0.0; CLASSES]; quads], u }
    }

    pub(super) fn stresses(&self) -> [&[f64]; 3] {
        self.u.each_ref().map(Vec::as_slice)
    }
}

impl Reduced {
    pub(super) fn new(quads: &Quads, matrices: ReducedMatrices, outputs: Outputs) -> Self {
        Self { members: Members::new(quads), matrices, outputs, stacks: OnceLock::new() }
    }

    pub(super) fn quads(&self) -> usize {
        self.members.quads()
    }

    pub(super) fn stacks(&self) -> &Stacks {
        self.stacks.get_or_init(|| Stacks::new(&self.matrices))
    }

    pub(super) fn scratch(&self, taxels: usize) -> Scratch {
        let fours = || vec![[0.0; CLASSES]; self.quads()];
        Scratch {
            stress: fours(),
            positive: fours(),
            magnitude: fours(),
            residual: fours(),
            result: fours(),
            sums: [[0.0; 3]; 3],
            frame: FrameScratch::new(self.quads(), taxels),
            friction: FrictionScratch::default(),
        }
    }

    /// Finds the forces for the stress `b` (pascals, length m). The resultant is that of the sums `G_pq`, which no
    /// filter touches.
    pub(super) fn solve(
        &self,
        friction: &Friction,
        b: &[f64],
        contact: Contact,
        scratch: &mut Scratch,
        solution: &mut Solution,
    ) {
        self.coefficients(b, scratch);
        let Scratch { positive, magnitude, residual, result, sums, frame, .. } = scratch;
        let seen = Seen { b, contact, sums, u: frame.stresses() };
        let [mu_x, mu_y] = optimum(friction, &seen, &mut scratch.friction, solution);
        if self.outputs == Outputs::Resultants {
            return;
        }
        self.times(Name::C33, positive, residual);
        for (name, mu) in [(Name::C31, mu_x), (Name::C32, mu_y)] {
            self.times(name, magnitude, result);
            for (residual, stress) in residual.iter_mut().zip(&*result) {
                for (residual, stress) in residual.iter_mut().zip(stress) {
                    *residual -= mu * stress;
                }
            }
        }
        for (p, name) in [Name::A1, Name::A2, Name::A3].into_iter().enumerate() {
            self.times(name, residual, result);
            self.put_force(p, |q| result[q], frame, solution);
        }
    }

    /// Finds the folded operands y+ and |w|, the sums `G_pq` and `u_q`.
    pub(super) fn coefficients(&self, b: &[f64], scratch: &mut Scratch) {
        let Scratch { stress, positive, magnitude, result, sums, frame, .. } = scratch;
        for (q, fold) in stress.iter_mut().enumerate() {
            *fold = self.members.fold(b, q);
        }
        self.times(Name::C33inv, stress, result);
        for (q, y) in result.iter().enumerate() {
            (positive[q], magnitude[q]) = split(*y, &mut frame.press[q]);
        }
        self.times(Name::K0, positive, result);
        self.put_u(0, b, |q| result[q], frame);
        self.times(Name::K1, magnitude, result);
        self.put_u(1, b, |q| result[q], frame);
        self.times(Name::K2, magnitude, result);
        self.put_u(2, b, |q| result[q], frame);
        *sums = self.sums(|q| positive[q], |q| magnitude[q]);
    }

    fn times(&self, name: Name, x: &Fours, result: &mut Fours) {
        times(self.matrices.get(name), x, result);
    }

    /// Puts `u_q` in place for the folded product with `K_q`.
    pub(super) fn put_u(&self, q: usize, b: &[f64], product: impl Fn(usize) -> [f64; 4], frame: &mut FrameScratch) {
        let u = &mut frame.u[q];
        self.members.unfold(product, |_, _, taxel, stress| u[taxel] = if q == 0 { b[taxel] - stress } else { -stress });
    }

    /// The sums `G_pq` from the folded y+ and |w|.
    pub(super) fn sums(
        &self,
        positive: impl Fn(usize) -> [f64; 4],
        magnitude: impl Fn(usize) -> [f64; 4],
    ) -> [[f64; 3]; 3] {
        let mut sums = [[0.0; 3]; 3];
        for quad in 0..self.quads() {
            let (y, w) = (positive(quad), magnitude(quad));
            for (p, sums) in sums.iter_mut().enumerate() {
                for (q, sum) in sums.iter_mut().enumerate() {
                    let row = self.matrices.sums(p, q);
                    *sum += row.weights[quad] * if q == 0 { y[row.class] } else { w[row.class] };
                }
            }
            sums[2][0] -= self.matrices.weight_sum().weights[quad] * w[0];
        }
        sums
    }

    /// Puts the forces along axis p in place for the folded product `A_p r`.
    pub(super) fn put_force(
        &self,
        p: usize,
        product: impl Fn(usize) -> [f64; 4],
        frame: &FrameScratch,
        solution: &mut Solution,
    ) {
        let share = [solution.mu_x, solution.mu_y, -1.0][p];
        let field = &mut solution.field[p];
        let press = &frame.press;
        self.members.unfold(product, |q, member, taxel, force| field[taxel] = force + share * press[q][member]);
    }
}

/// One quad of y, folded, to y+ and |w|, folded; |w| itself goes to `press`, by member.
pub(super) fn split(y: [f64; CLASSES], press: &mut [f64; 4]) -> ([f64; CLASSES], [f64; CLASSES]) {
    let y = butterfly(y).map(|force| 0.25 * force);
    *press = y.map(|force| (-force).max(0.0));
    (butterfly(y.map(|force| force.max(0.0))), butterfly(*press))
}

/// Finds the friction components, and puts them and what follows from them into the solution.
pub(super) fn optimum(
    friction: &Friction,
    seen: &Seen,
    scratch: &mut FrictionScratch,
    solution: &mut Solution,
) -> [f64; 2] {
    let (status, mu) = friction.find(seen, scratch);
    solution.status.insert(status);
    solution.put_friction(mu, seen.sums.map(|[g0, g1, g2]| g0 + mu[0] * g1 + mu[1] * g2));
    mu
}
