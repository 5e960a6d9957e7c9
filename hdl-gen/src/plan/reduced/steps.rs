//! The products of the reduced plan, step by step, with the formats that each step needs.

use golden::parity::CLASSES;
use golden::reduced::{ReducedMatrices, ReducedName};

use super::super::format::{FRICTION_FRACTION, Format, MOST_SHIFT, largest, round_shift};
use super::super::product::{Block, Coefficients, Epilogue, Lead, Product, Vector};
use super::super::quantise::{ANY_LSB, QuantisedMatrix, RealRows};
use super::super::{Formats, PlanError};
use super::bounds::{self, Operand};
use super::composed;
use super::{FOLD_BITS, SELECT_MU_X, SELECT_MU_Y, SELECT_ONE, sum_way};

/// A friction component lies in [-2, 2).
pub(super) const LARGEST_FRICTION: i64 = 2;

/// The plan while it grows.
pub(super) struct Steps<'a> {
    reduced: &'a ReducedMatrices,
    coefficient_bits: u32,
    data_bits: u32,
    /// Factor on all forces: the weights are taken times it, and what makes stress of them again divided by it.
    gain: f64,
    /// Whether products of the weights and of y+ pass over zeros.
    skips: bool,
    pub matrices: Vec<QuantisedMatrix>,
    pub products: Vec<Product>,
}

impl<'a> Steps<'a> {
    pub fn new(reduced: &'a ReducedMatrices, [coefficient_bits, data_bits]: [u32; 2], gain: f64, skips: bool) -> Self {
        Self { reduced, coefficient_bits, data_bits, gain, skips, matrices: Vec::new(), products: Vec::new() }
    }

    /// `C33inv b`, parted. Returns the operand that weights and `y+` are.
    pub fn weights(&mut self, base: Operand) -> Result<Operand, PlanError> {
        let matrix = self.quantise(ReducedName::C33inv, self.gain, base, ANY_LSB)?;
        let y = bounds::unfolding(&[(&matrix, base)], None, self.data_bits);
        let taxel = Format { lsb: y.lsb - FOLD_BITS as i32, ..y };
        // Four weights of one sign add up; the folded ones give up as many bits as that takes.
        let mut shift = 0;
        while round_shift(4 * taxel.bound, shift) > largest(taxel.bits) {
            shift += 1;
        }
        let folded =
            Format { bits: taxel.bits, lsb: taxel.lsb + shift as i32, bound: round_shift(4 * taxel.bound, shift) };
        self.push(matrix, &[Vector::Stress], (Block::We, 0), Epilogue::Part, Vector::Weight);
        Ok(Operand { folded, taxel })
    }

    /// `u1, u0, u2`; returns their folded format.
    pub fn coefficients(&mut self, base: Operand, weights: Operand, side: Option<usize>) -> Result<Format, PlanError> {
        let names = [ReducedName::K1, ReducedName::K0, ReducedName::K2];
        let first = |least| self.quantise_all(names, &[-1.0 / self.gain; 3], weights, least);
        let terms = first(ANY_LSB)?;
        let alone = bounds::unfolding(&bounds::with(&terms, weights), Some(base), self.data_bits);
        let least = alone.lsb - weights.folded.lsb - MOST_SHIFT as i32;
        let terms = self.quantise_all(names, &[-1.0 / self.gain; 3], weights, least)?;
        let u = bounds::unfolding(&bounds::with(&terms, weights), Some(base), self.data_bits);
        let turn = (Block::Co, 0);
        let [k1, k0, k2] = <[QuantisedMatrix; 3]>::try_from(terms).unwrap_or_else(|_| unreachable!("three names"));
        let stored_k1 = self.push(k1, &[Vector::Weight], turn, Epilogue::Unfold, Vector::U(1));
        self.push(k0, &[Vector::Pull, Vector::Weight], turn, Epilogue::AddStress, Vector::U(0));
        match side {
            Some(_) => self.again(stored_k1, side, &[Vector::Weight], turn, Epilogue::Unfold, Vector::U(2)),
            None => drop(self.push(k2, &[Vector::Weight], turn, Epilogue::Unfold, Vector::U(2))),
        }
        Ok(u)
    }

    /// The rows of the sums, in front of `K0 y+`; returns their format.
    pub fn sums(&mut self, weights: Operand) -> Result<Format, PlanError> {
        let count = self.reduced.get(ReducedName::K0).rows.len();
        let row = |q: usize| {
            // y+ stands first among the operands, |w| next to it.
            let first_column = if q == 0 { 0 } else { count };
            let ways = |quad: usize| {
                let mut ways = [0.0; CLASSES];
                for p in 0..3 {
                    ways[sum_way(p, q)] = self.reduced.sums(p, q).weights[quad];
                }
                ways
            };
            (0..count).map(|quad| ((first_column + quad) as u32, ways(quad))).collect::<Vec<_>>()
        };
        let total = self.reduced.weight_sum();
        let total = total.weights.iter().enumerate().map(|(quad, &one)| ((count + quad) as u32, [one, 0.0, 0.0, 0.0]));
        let rows: RealRows = (0..3).map(row).chain([total.collect()]).collect();
        let bits = self.coefficient_bits;
        let matrix = QuantisedMatrix::new("sums", &rows, bits, weights.folded.bound, ANY_LSB)?;
        let mut format = bounds::folded(&[(&matrix, weights)], self.data_bits);
        // G30 is a row's result less the sum of the weights.
        while 2 * format.bound > largest(format.bits) {
            format.lsb += 1;
            format.bound = format.bound / 2 + 1;
        }
        format.bound *= 2;
        let lead = Lead { matrix: self.matrices.len(), shift: 0 };
        self.matrices.push(matrix);
        for product in &mut self.products {
            if product.result == Vector::U(0) {
                product.lead = Some(lead);
            }
        }
        Ok(format)
    }

    /// Residual and field; returns the formats of the residual's parts, of r and of `A_p r`, all folded, and what
    /// rounding can make of a taxel's force, in newtons, if that is much. `taxel_n` is the force of a taxel at full
    /// scale.
    pub fn field(
        &mut self,
        weights: Operand,
        side: Option<usize>,
        taxel_n: f64,
    ) -> Result<([Format; 3], f64), PlanError> {
        let names = [ReducedName::C33, ReducedName::C31, ReducedName::C32];
        let signs = [1.0, -1.0, -1.0];
        let terms = self.quantise_all(names, &signs, weights, ANY_LSB)?;
        let alone = bounds::folded(&bounds::with(&terms, weights), self.data_bits);
        let least = alone.lsb - weights.folded.lsb - MOST_SHIFT as i32;
        let terms = self.quantise_all(names, &signs, weights, least)?;
        let residual = bounds::folded(&bounds::with(&terms, weights), self.data_bits);
        let mut shift = 0;
        let worst = (1 + 2 * LARGEST_FRICTION) * residual.bound;
        while round_shift(worst, shift) > largest(residual.bits) {
            shift += 1;
        }
        let explained =
            Format { bits: residual.bits, lsb: residual.lsb + shift as i32, bound: round_shift(worst, shift) };

        // As many quarters of a step as the sum of four folded parts can be.
        let parts_bound =
            bounds::with(&terms, weights).iter().map(|term| bounds::unfolded_bound(term, residual.lsb)).max();
        let taxel_bound = round_shift((1 + 2 * LARGEST_FRICTION) * parts_bound.unwrap_or(0), shift) + CLASSES as i64;
        let taxel = Format { lsb: explained.lsb - FOLD_BITS as i32, bound: taxel_bound, ..explained };
        let operand = Operand { folded: explained, taxel };
        let (inverse, force, rounding) =
            self.inverse(&terms, operand, composed::Way { weights, residual, explained }, taxel_n)?;

        let [c33, c31, c32] = <[QuantisedMatrix; 3]>::try_from(terms).unwrap_or_else(|_| unreachable!("three names"));
        let count = c33.rows.len();
        let turn = (Block::Co, 1);
        self.push(c33, &[Vector::Pull], turn, Epilogue::Store, Vector::Residual(0));
        let stored = self.push(c31, &[Vector::Weight], turn, Epilogue::Store, Vector::Residual(1));
        match side {
            Some(_) => self.again(stored, side, &[Vector::Weight], turn, Epilogue::Store, Vector::Residual(2)),
            None => drop(self.push(c32, &[Vector::Weight], turn, Epilogue::Store, Vector::Residual(2))),
        }

        let turn = (Block::Op, 2);
        let parts = [Vector::Residual(0), Vector::Residual(1), Vector::Residual(2)];
        self.push(friction_matrix(count), &parts, turn, Epilogue::Store, Vector::Explained);
        if let Some(product) = self.products.last_mut() {
            product.coefficients = Coefficients::Friction;
        }
        let [a1, a2, a3] = inverse;
        let stored = self.push(a1, &[Vector::Explained], turn, Epilogue::Unfold, Vector::Force(1));
        match side {
            Some(_) => self.again(stored, side, &[Vector::Explained], turn, Epilogue::Unfold, Vector::Force(2)),
            None => drop(self.push(a2, &[Vector::Explained], turn, Epilogue::Unfold, Vector::Force(2))),
        }
        self.push(a3, &[Vector::Explained], turn, Epilogue::Unfold, Vector::Force(3));
        Ok(([residual, explained, force], rounding))
    }

    /// The three parts of A+ behind the `terms` of r, the format of `A_p r`, and what rounding can make of it.
    fn inverse(
        &self,
        terms: &[QuantisedMatrix],
        operand: Operand,
        way: composed::Way,
        taxel_n: f64,
    ) -> Result<([QuantisedMatrix; 3], Format, f64), PlanError> {
        let names = [ReducedName::A1, ReducedName::A2, ReducedName::A3];
        let quantise = |least| self.quantise_all(names, &[1.0; 3], operand, least);
        let alone = bounds::unfolding(&bounds::with(&quantise(ANY_LSB)?, operand), None, self.data_bits);
        let least = alone.lsb - operand.folded.lsb - MOST_SHIFT as i32;
        let inverse = quantise(least)?;
        let mut force = bounds::unfolding(&bounds::with(&inverse, operand), None, self.data_bits);
        let mut rounding = 0.0;
        if composed::is_coarse(force, taxel_n) {
            let lsb = inverse.iter().map(|matrix| matrix.lsb + operand.folded.lsb).max().unwrap_or(force.lsb);
            let worst = composed::worst(terms, &inverse, way);
            (force, rounding) = (composed::format(worst, lsb, self.data_bits), worst.rounding);
        }
        let inverse = <[QuantisedMatrix; 3]>::try_from(inverse).unwrap_or_else(|_| unreachable!("three names"));
        Ok((inverse, force, rounding))
    }

    /// A matrix times `factor`, as stored. Its label has the sign.
    fn quantise(
        &self,
        name: ReducedName,
        factor: f64,
        operand: Operand,
        least_lsb: i32,
    ) -> Result<QuantisedMatrix, PlanError> {
        let bits = self.coefficient_bits;
        let rows = &self.reduced.get(name).rows;
        let scaled = |row: &Vec<(u32, [f64; CLASSES])>| {
            row.iter().map(|&(column, ways)| (column, ways.map(|value| factor * value))).collect()
        };
        let label = if factor < 0.0 { format!("-{name}") } else { name.to_string() };
        let rows: RealRows = rows.iter().map(scaled).collect();
        QuantisedMatrix::new(&label, &rows, bits, operand.folded.bound, least_lsb)
    }

    fn quantise_all(
        &self,
        names: [ReducedName; 3],
        factors: &[f64; 3],
        operand: Operand,
        least_lsb: i32,
    ) -> Result<Vec<QuantisedMatrix>, PlanError> {
        names.into_iter().zip(factors).map(|(name, &factor)| self.quantise(name, factor, operand, least_lsb)).collect()
    }

    /// Stores a matrix and adds its product; returns the matrix's index.
    fn push(
        &mut self,
        matrix: QuantisedMatrix,
        operands: &[Vector],
        turn: (Block, usize),
        epilogue: Epilogue,
        result: Vector,
    ) -> usize {
        self.matrices.push(matrix);
        let matrix = self.matrices.len() - 1;
        self.again(matrix, None, operands, turn, epilogue, result);
        matrix
    }

    /// Adds a product with a matrix that is stored.
    fn again(
        &mut self,
        matrix: usize,
        mirrored: Option<usize>,
        operands: &[Vector],
        (block, program): (Block, usize),
        epilogue: Epilogue,
        result: Vector,
    ) {
        let parity = match result {
            Vector::U(1) | Vector::Residual(1) | Vector::Force(1) => 1,
            Vector::U(2) | Vector::Residual(2) | Vector::Force(2) => 2,
            _ => 0,
        };
        // The mirror image of a matrix that is odd in x is one that is odd in y.
        let parity = if mirrored.is_some() { 3 - parity } else { parity };
        let skips = self.skips && matches!(operands[0], Vector::Weight | Vector::Pull);
        let (lead, coefficients, operands) = (None, Coefficients::Rom, operands.to_vec());
        let shift = 0;
        self.products.push(Product {
            matrix,
            lead,
            operands,
            block,
            program,
            coefficients,
            parity,
            mirrored,
            skips,
            epilogue,
            result,
            shift,
        });
    }

    /// Puts in the shifts, now that all formats are known.
    pub fn finish(&mut self, formats: &Formats) {
        let Some(folded) = formats.folded else { return };
        for product in &mut self.products {
            let operand = folded.of(product.operands[0]);
            let result = if product.epilogue == Epilogue::Part { folded.y } else { folded.of(product.result) };
            let shift = |matrix: &QuantisedMatrix, result: Format| (result.lsb - matrix.lsb - operand.lsb) as u32;
            product.shift = shift(&self.matrices[product.matrix], result);
            if let Some(lead) = &mut product.lead {
                lead.shift = shift(&self.matrices[lead.matrix], formats.g);
            }
        }
    }
}

/// `r = r0 + mu_x r1 + mu_y r2`, row by row; the coefficients are codes.
fn friction_matrix(quads: usize) -> QuantisedMatrix {
    let row = |quad: usize| {
        [SELECT_ONE, SELECT_MU_X, SELECT_MU_Y]
            .into_iter()
            .enumerate()
            .map(|(part, code)| ((part * quads + quad) as u32, [code; CLASSES]))
            .collect()
    };
    let mut matrix =
        QuantisedMatrix::from_rows("1, mu_x, mu_y", (0..quads).map(row).collect(), -(FRICTION_FRACTION as i32));
    matrix.row_sum = (1 + 2 * LARGEST_FRICTION) << FRICTION_FRACTION;
    matrix
}
