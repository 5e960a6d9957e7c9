//! The arithmetic of a plan: integers, every product rounded to the step of its result.

use golden::parity::COMPONENTS;
use golden::products::{ByPq, Number, Scalar, Step, put_moments};

use crate::format::{FRICTION_FRACTION, round_shift};
use crate::plan::Plan;
use crate::plan::matrix::product;
use crate::plan::product::{SHARE_ROW, sum_channel, sum_row};
use crate::plan::vector_formats::ARM_FRACTION;

/// The integers of a plan. Order of summation does not matter: every sum is exact in its width, by the bounds of the
/// plan.
#[derive(Clone, Copy, Debug)]
pub struct Integer<'plan> {
    plan: &'plan Plan,
}

/// The paper's plan has one value a taxel.
pub fn by_taxel(plan: &Plan) -> Scalar<Integer<'_>, 1> {
    Scalar::new(Integer { plan }, (0..plan.taxels()).map(|taxel| [taxel]).collect(), plan.taxels())
}

/// The reduced plan has four an orbit.
pub fn by_orbit(plan: &Plan) -> Scalar<Integer<'_>, COMPONENTS> {
    Scalar::new(Integer { plan }, plan.orbits().all(), plan.taxels())
}

impl<const W: usize> Number<W> for Integer<'_> {
    type Element = i64;
    type Scratch = ();

    fn scratch(&self) {}

    fn multiply(&self, index: usize, step: &Step, operand: &[[i64; W]], result: &mut [[i64; W]], (): &mut ()) {
        let shift = self.plan.products[index].shift;
        let matrix = &self.plan.matrices[step.matrix];
        for (row, result) in matrix.rows.iter().zip(result) {
            let mut sums = [0; W];
            for (column, channels) in row {
                for ((sum, &channel), value) in sums.iter_mut().zip(channels).zip(operand[*column as usize]) {
                    *sum += product(channel, value, matrix.dropped);
                }
            }
            *result = std::array::from_fn(|component| round_shift(sums[component ^ step.parity], shift));
        }
    }

    fn combine(&self, index: usize, [a, b, c]: [i64; 3], [mu_x, mu_y]: [i64; 2]) -> i64 {
        let (factors, shift) = (self.plan.factors(), self.plan.products[index].shift);
        let part = |friction: i64, value| {
            product((friction << factors.friction_shift()) as i32, value, factors.dropped_of_friction())
        };
        round_shift(part(1 << FRICTION_FRACTION, a) + part(mu_x, b) + part(mu_y, c), shift)
    }

    fn sums(&self, index: usize, pull: &[[i64; W]], weight: &[[i64; W]]) -> ByPq<i64> {
        let Some(preload) = self.plan.products[index].preload else { return ByPq::default() };
        let matrix = &self.plan.matrices[preload.matrix];
        let operand: [Vec<i64>; W] =
            std::array::from_fn(|channel| pull.iter().chain(weight).map(|element| element[channel]).collect());
        let row = |row: usize, channel: usize| {
            round_shift(matrix.row_product(row, channel, &operand[channel]), preload.shift)
        };
        let mut sums: ByPq<i64> =
            std::array::from_fn(|p| std::array::from_fn(|q| row(sum_row(p, q), sum_channel(p, q))));
        for (p, sums) in sums.iter_mut().enumerate().skip(2).take(3) {
            sums[0] -= row(SHARE_ROW, sum_channel(p, 0));
        }
        sums
    }

    fn sum(&self, g: &[[i64; W]], p: usize, q: usize, sums: &mut ByPq<i64>) {
        let values = g.as_flattened();
        let moment = |axis: usize| {
            let arms = self.plan.arms.iter().map(|arms| i64::from(arms[axis]));
            arms.zip(values).map(|(arm, value)| round_shift(arm * value, ARM_FRACTION)).sum()
        };
        put_moments(sums, (p, q), values.iter().sum(), [moment(0), moment(1)]);
    }

    fn folded_stress(&self, sum: i64) -> i64 {
        let formats = &self.plan.formats;
        round_shift(sum, formats.folded.map_or(0, |folded| (folded.stress.lsb - formats.stress.lsb) as u32))
    }

    fn folded_weight(&self, sum: i64) -> i64 {
        let formats = &self.plan.formats;
        round_shift(sum, formats.folded.map_or(0, |folded| (folded.weight.lsb - formats.weight.lsb) as u32))
    }

    /// Four times the taxels' values are, at a quarter of the step, the values.
    fn unfolded(&self, sum: i64) -> i64 {
        sum
    }

    fn added_stress(&self, _: usize, stress: i64) -> i64 {
        match self.plan.formats.folded.map_or(0, |folded| folded.u.lsb - folded.stress.lsb) {
            shift if shift >= 0 => round_shift(stress, shift as u32),
            shift => stress << -shift,
        }
    }
}
