//! The reduced plan in integers: vectors folded into parity classes, products class by class.

use std::collections::BTreeMap;

use golden::parity::{CLASSES, Quads};

use crate::cores::fixed_to_float;
use crate::estimators::ByPq;
use crate::plan::Plan;
use crate::plan::format::{FRICTION_FRACTION, round_shift};
use crate::plan::product::{Coefficients, Epilogue, Product, Vector, mirror};
use crate::plan::reduced::{
    FOLD_BITS, FoldedFormats, SELECT_MU_X, SELECT_MU_Y, SELECT_ONE, SUM_ROWS, field_shifts, sum_way,
};

/// One value a quad and class.
type Folded = [Vec<i64>; CLASSES];

/// The output frame of a frame with contact.
pub fn answer(plan: &Plan, folded: &FoldedFormats, counter: u32, stress: &[i64], saturated: bool) -> Vec<u32> {
    let mut frame = Frame::new(plan, stress);
    let programs =
        |first: usize, end: usize| plan.products.iter().filter(move |product| (first..end).contains(&product.program));
    for product in programs(0, 2) {
        frame.multiply(product, [0, 0], folded);
    }
    let (mut words, summary) = super::scalars(plan, counter, stress, saturated, &frame.sums, &frame.u);
    for product in programs(2, 3) {
        frame.multiply(product, summary.friction, folded);
    }
    if !frame.force[0].is_empty() {
        let [mu_x, mu_y] = summary.friction;
        let shares = [mu_x, mu_y, -(1 << FRICTION_FRACTION)];
        let (force_shift, weight_shift, exponent) = field_shifts(&plan.formats, folded);
        for taxel in 0..plan.taxels() {
            for (force, share) in frame.force.iter().zip(shares) {
                let sum = (force[taxel] << force_shift) + ((share * frame.weight[taxel]) << weight_shift);
                words.push(fixed_to_float::convert(sum, exponent));
            }
        }
    }
    words
}

/// What is known of a frame so far.
struct Frame<'plan> {
    plan: &'plan Plan,
    quads: Quads,
    vectors: BTreeMap<Vector, Folded>,
    /// Of each taxel.
    weight: Vec<i64>,
    u: [Vec<i64>; 3],
    force: [Vec<i64>; 3],
    sums: ByPq<i64>,
}

impl<'plan> Frame<'plan> {
    fn new(plan: &'plan Plan, stress: &[i64]) -> Self {
        let quads = plan.quads();
        let folded = fold(&quads, stress, FOLD_BITS);
        Self {
            plan,
            quads,
            vectors: BTreeMap::from([(Vector::Stress, folded)]),
            weight: Vec::new(),
            u: [const { Vec::new() }; 3],
            force: [const { Vec::new() }; 3],
            sums: [[0; 3]; 3],
        }
    }

    fn multiply(&mut self, product: &Product, friction: [i64; 2], formats: &FoldedFormats) {
        let operand = self.operand(product);
        if let Some(lead) = product.lead {
            let matrix = &self.plan.matrices[lead.matrix];
            let row = |q: usize, way: usize| round_shift(matrix.row_product(q, way, &operand[way]), lead.shift);
            let total = row(SUM_ROWS - 1, 0);
            self.sums = std::array::from_fn(|p| std::array::from_fn(|q| row(q, sum_way(p, q))));
            self.sums[2][0] -= total;
        }
        let result = self.result(product, &operand, friction);
        match product.epilogue {
            Epilogue::Part => {
                let y = unfold(&self.quads, &result);
                let shift = (formats.weight.lsb - self.plan.formats.weight.lsb) as u32;
                self.weight = y.iter().map(|&value| (-value).max(0)).collect();
                let pull: Vec<i64> = y.iter().map(|&value| value.max(0)).collect();
                self.vectors.insert(Vector::Weight, fold(&self.quads, &self.weight, shift));
                self.vectors.insert(Vector::Pull, fold(&self.quads, &pull, shift));
            }
            Epilogue::Unfold | Epilogue::AddStress => {
                let mut result = result;
                if product.epilogue == Epilogue::AddStress {
                    self.add_stress(&mut result, formats);
                }
                let taxels = unfold(&self.quads, &result);
                match product.result {
                    Vector::Force(p) => self.force[usize::from(p) - 1] = taxels,
                    Vector::U(q) => self.u[usize::from(q)] = taxels,
                    _ => {}
                }
            }
            _ => drop(self.vectors.insert(product.result, result)),
        }
    }

    /// The operand by way: its vectors one after the other, mirrored at the diagonal if that is meant.
    fn operand(&self, product: &Product) -> Folded {
        std::array::from_fn(|way| {
            let parts = product.operands.iter().filter_map(|vector| self.vectors.get(vector));
            match product.mirrored {
                None => parts.flat_map(|part| part[way].iter().copied()).collect(),
                Some(side) => parts
                    .flat_map(|part| {
                        let class = &part[swapped(way)];
                        (0..class.len()).map(|quad| class[mirror(quad, side)])
                    })
                    .collect(),
            }
        })
    }

    /// The rounded results by class.
    fn result(&self, product: &Product, operand: &Folded, friction: [i64; 2]) -> Folded {
        let matrix = &self.plan.matrices[product.matrix];
        let ways = product.ways();
        std::array::from_fn(|class| {
            let way = ways[class];
            let row = |row: usize| {
                let row = product.mirrored.map_or(row, |side| mirror(row, side));
                let sum = match product.coefficients {
                    Coefficients::Rom => matrix.row_product(row, way, &operand[way]),
                    Coefficients::Friction => {
                        let entries = matrix.rows[row].iter();
                        entries
                            .map(|&(column, codes)| chosen(codes[way], friction) * operand[way][column as usize])
                            .sum()
                    }
                };
                round_shift(sum, product.shift)
            };
            (0..self.quads.count()).map(row).collect()
        })
    }

    /// Adds the folded stress, at the step of `u`.
    fn add_stress(&self, result: &mut Folded, formats: &FoldedFormats) {
        let shift = formats.u.lsb - formats.stress.lsb;
        let stress = &self.vectors[&Vector::Stress];
        for (class, result) in result.iter_mut().enumerate() {
            for (value, &stress) in result.iter_mut().zip(&stress[class]) {
                *value += if shift >= 0 { round_shift(stress, shift as u32) } else { stress << -shift };
            }
        }
    }
}

/// The friction coefficient that a code stands for, with the fraction bits of the friction components.
fn chosen(code: i32, [mu_x, mu_y]: [i64; 2]) -> i64 {
    match code {
        SELECT_ONE => 1 << FRICTION_FRACTION,
        SELECT_MU_X => mu_x,
        SELECT_MU_Y => mu_y,
        _ => 0,
    }
}

/// The class that `class` is on the other side of the diagonal.
fn swapped(class: usize) -> usize {
    (class & 1) << 1 | class >> 1
}

/// Folds and rounds `shift` bits away.
fn fold(quads: &Quads, values: &[i64], shift: u32) -> Folded {
    let mut folded: Folded = [const { Vec::new() }; CLASSES];
    for quad in 0..quads.count() {
        let sums = butterfly(quads.members(quad).map(|taxel| values[taxel]));
        for (class, sum) in folded.iter_mut().zip(sums) {
            class.push(round_shift(sum, shift));
        }
    }
    folded
}

/// Four times the taxels' values, or, at a quarter of the step, the values.
fn unfold(quads: &Quads, folded: &Folded) -> Vec<i64> {
    let mut values = vec![0; quads.taxels()];
    for quad in 0..quads.count() {
        let sums = butterfly(folded.each_ref().map(|class| class[quad]));
        for (taxel, sum) in quads.members(quad).into_iter().zip(sums) {
            values[taxel] = sum;
        }
    }
    values
}

fn butterfly([a, b, c, d]: [i64; CLASSES]) -> [i64; CLASSES] {
    [a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d]
}

#[cfg(test)]
mod tests;
