//! The pass that makes integers of coefficients, and chooses formats that no input within the full scale can overflow.
//!
//! The list is taken in groups whose results share a format, in the order of the data. The worst case of a group's
//! quantised rows bounds its results, and these are the operands of later groups.

mod bounds;
mod composed;
mod sums;

use std::collections::BTreeMap;

use golden::design::Design;
use golden::names::{MatrixName, ReducedName};
use golden::parity::COMPONENTS;
use golden::products::{Epilogue, Form, ProductList, Source, Step, Vector};

use super::PlanError;
use super::filtered::Filtered;
use super::matrix::{ANY_LSB, QuantisedMatrix};
use super::product::{SELECT_MU_X, SELECT_MU_Y, SELECT_ONE};
use super::vector_formats::{FOLD_BITS, FoldedFormats, Formats, arm_exponent};
use crate::format::{FRICTION_FRACTION, Factors, Format, MOST_SHIFT, largest, round_shift};
use bounds::{Operand, Term};

/// A friction component lies in [-2, 2).
const LARGEST_FRICTION: i64 = 2;
/// Largest factor of a residual's three parts together.
const LARGEST_COMBINATION: i64 = 1 + 2 * LARGEST_FRICTION;

/// A list in integers.
pub struct Quantised {
    /// Matrices as stored.
    pub matrices: Vec<QuantisedMatrix>,
    /// Where each matrix of the list is stored.
    pub place: Vec<usize>,
    /// Where the rows of the sums are stored, if the list has them.
    pub sums: Option<usize>,
    /// Formats of all vectors.
    pub formats: Formats,
    /// Most that the roundings of a frame's vectors can add to a taxel's force, in newtons; 0 where it is little.
    pub rounding_n: f64,
}

/// Quantises the matrices of a list, for stresses of this format.
///
/// # Errors
/// [`PlanError`] when the widths of the design leave too few bits.
pub fn quantise(
    list: &ProductList,
    filtered: &Filtered,
    design: &Design,
    stress: Format,
) -> Result<Quantised, PlanError> {
    let mut pass = Pass::new(list, filtered, design);
    let arm_exponent = arm_exponent(&design.sensor);
    let base = pass.unfolded(stress);
    pass.operands.insert(Vector::Stress, base);
    let y = pass.group(|result| result == Vector::Weight)?;
    let weights = pass.weights(y);
    pass.operands.extend([Vector::Weight, Vector::Pull].map(|vector| (vector, weights)));
    let Some(ten) = filtered.ten() else {
        let g = pass.group(|result| matches!(result, Vector::Partial(_) | Vector::G(..)))?;
        pass.operands.extend([0, 1, 2].map(|q| (Vector::G(3, q), Operand { folded: g, taxel: g })));
        let u = pass.group(|result| matches!(result, Vector::U(_)))?;
        let torque_lsb = g.lsb + arm_exponent;
        return Ok(pass.finish(Formats { stress, weight: y, g, torque_lsb, u, folded: None }, 0.0));
    };
    let u = pass.group(|result| matches!(result, Vector::U(_)))?;
    let (rows, g) = sums::quantise(ten, pass.factors, weights, arm_exponent)?;
    pass.sums = Some(pass.matrices.len());
    pass.matrices.push(rows);
    let field = if list.has_forces() { pass.field(weights, taxel_force_n(design))? } else { Field::none(u) };
    let taxel = |folded: Format| Format { lsb: folded.lsb - FOLD_BITS as i32, ..folded };
    let Field { residual, explained, force, rounding_n } = field;
    let folded = FoldedFormats {
        stress: base.folded,
        y,
        weight: weights.folded,
        u,
        residual,
        explained,
        force,
        taxel_force: taxel(force),
    };
    let (weight, torque_lsb) = (weights.taxel, g.lsb + arm_exponent);
    Ok(pass.finish(Formats { stress, weight, g, torque_lsb, u: taxel(u), folded: Some(folded) }, rounding_n))
}

/// The force of a taxel whose cell is pressed with the full scale.
pub fn taxel_force_n(design: &Design) -> f64 {
    let [x, y] = design.sensor.pitch_mm;
    design.hardware.full_scale_pa * x * y * 1e-6
}

/// The formats behind the weights, folded.
struct Field {
    residual: Format,
    explained: Format,
    force: Format,
    rounding_n: f64,
}

impl Field {
    /// Nobody reads them.
    fn none(any: Format) -> Self {
        Self { residual: any, explained: any, force: any, rounding_n: 0.0 }
    }
}

/// The pass under way.
struct Pass<'a> {
    list: &'a ProductList,
    filtered: &'a Filtered<'a>,
    factors: Factors,
    /// Factor on all forces: the weights are taken times it, and what makes stress of them again divided by it.
    gain: f64,
    /// Formats of the vectors that are operands.
    operands: BTreeMap<Vector, Operand>,
    matrices: Vec<QuantisedMatrix>,
    place: Vec<usize>,
    sums: Option<usize>,
}

impl<'a> Pass<'a> {
    fn new(list: &'a ProductList, filtered: &'a Filtered<'a>, design: &Design) -> Self {
        Self {
            list,
            filtered,
            factors: Factors::of(design),
            gain: design.algorithm.gain(),
            operands: BTreeMap::new(),
            matrices: Vec::new(),
            place: vec![0; list.matrices.len()],
            sums: None,
        }
    }

    fn is_folded(&self) -> bool {
        self.filtered.ten().is_some()
    }

    /// Taxels' values of this format as an operand; folding them loses their last bits, unless the operands' words are
    /// wider.
    fn unfolded(&self, taxel: Format) -> Operand {
        if self.is_folded() && self.factors.has_wide_data() {
            // There is room for the sum of four.
            return Operand {
                folded: Format { bits: self.factors.data_bits, bound: taxel.bound << FOLD_BITS, ..taxel },
                taxel,
            };
        }
        let bits = if self.is_folded() { FOLD_BITS as i32 } else { 0 };
        Operand { folded: Format { lsb: taxel.lsb + bits, ..taxel }, taxel }
    }

    /// Quantises the matrices of the steps with these results, as finely as the one format of all results lets them be
    /// of use, and says which format that is.
    fn group(&mut self, is_in: impl Fn(Vector) -> bool) -> Result<Format, PlanError> {
        let steps: Vec<&Step> = self.list.steps.iter().filter(|step| is_in(step.result)).collect();
        let alone = self.format(&steps, &self.terms(&steps, |_| ANY_LSB)?);
        let least = |operand: Operand| alone.lsb - operand.folded.lsb - (MOST_SHIFT + self.factors.dropped()) as i32;
        // The last bits of the small ones have changed, and with them perhaps the bound.
        let terms = self.terms(&steps, least)?;
        let format = self.format(&steps, &terms);
        for (index, (matrix, _)) in terms {
            self.place[index] = self.matrices.len();
            self.matrices.push(matrix);
        }
        Ok(format)
    }

    /// The group's matrices by their place in the list, in the order of its steps, with their operands.
    fn terms(&self, steps: &[&Step], least: impl Fn(Operand) -> i32) -> Result<Terms, PlanError> {
        let mut terms = Terms::new();
        for step in steps {
            if terms.iter().all(|&(index, _)| index != step.matrix) {
                let operand = self.operands[&step.operand()];
                let form = &self.list.matrices[step.matrix];
                let rows = self.filtered.rows(form, self.scale(form));
                let bound = operand.folded.bound;
                let matrix = QuantisedMatrix::new(&form.label(), &rows, self.factors, bound, least(operand))?;
                terms.push((step.matrix, (matrix, operand)));
            }
        }
        Ok(terms)
    }

    /// What the gain makes of a matrix.
    fn scale(&self, form: &Form) -> f64 {
        match form.source {
            Source::Ten(ReducedName::C33inv) | Source::Thirteen(MatrixName::C33inv) => self.gain,
            Source::Ten(ReducedName::K0 | ReducedName::K1 | ReducedName::K2) => 1.0 / self.gain,
            _ => 1.0,
        }
    }

    /// The finest format for all results of a group. Its step is never finer than that of an accumulator it is rounded
    /// from.
    fn format(&self, steps: &[&Step], terms: &Terms) -> Format {
        let term = |wanted: usize| -> Option<Term> {
            terms.iter().find(|&&(index, _)| index == wanted).map(|(_, (matrix, operand))| (matrix, *operand))
        };
        let worst = |step: &Step, lsb: i32| -> i64 {
            let unfolds = matches!(step.epilogue, Epilogue::Part | Epilogue::Unfold | Epilogue::AddStress);
            let own = term(step.matrix).map_or(0, |term| {
                let lanes = bounds::folded(term, lsb);
                if unfolds { lanes.max(bounds::unfolded(term, lsb)) } else { lanes }
            });
            let partial = |vector| steps.iter().find(|step| step.result == vector);
            match step.epilogue {
                Epilogue::Add(vector) => {
                    let added = partial(vector).and_then(|step| term(step.matrix));
                    own + added.map_or(0, |term| bounds::folded(term, lsb))
                }
                _ => own,
            }
        };
        let added = steps.iter().any(|step| step.epilogue == Epilogue::AddStress);
        let stress = self.operands.get(&Vector::Stress).filter(|_| added);
        bounds::finest(terms.iter().map(|(_, (matrix, operand))| (matrix, *operand)), self.factors.data_bits, |lsb| {
            let worst = steps.iter().map(|step| worst(step, lsb)).max().unwrap_or(0);
            worst + stress.map_or(0, |stress| bounds::added(*stress, lsb))
        })
    }

    /// The operand that weights and `y+` are, from the format of y.
    fn weights(&self, y: Format) -> Operand {
        if !self.is_folded() {
            return Operand { folded: y, taxel: y };
        }
        let taxel = Format { lsb: y.lsb - FOLD_BITS as i32, ..y };
        // Four weights of one sign add up; the folded ones give up as many bits as that takes.
        Operand { folded: narrowed(taxel, COMPONENTS as i64 * taxel.bound).0, taxel }
    }

    /// Residual and field. `taxel_n` is the force of a taxel at full scale.
    fn field(&mut self, weights: Operand, taxel_n: f64) -> Result<Field, PlanError> {
        let residual = self.group(|result| matches!(result, Vector::Residual(_)))?;
        let parts = self.of_results(|result| matches!(result, Vector::Residual(_)));
        let combination = |bound: fn(bounds::Term, i32) -> i64| -> i64 {
            let bounds: Vec<i64> = parts.iter().map(|matrix| bound((matrix, weights), residual.lsb)).collect();
            match bounds[..] {
                // A step more for what is dropped of the three products.
                [one, x, y] if self.factors.has_wide_data() => one + LARGEST_FRICTION * (x + y) + 1,
                _ => LARGEST_COMBINATION * bounds.into_iter().max().unwrap_or(0),
            }
        };
        let (explained, shift) = narrowed(residual, combination(bounds::folded));
        // As many quarters of a step as the sum of four folded parts can be.
        let taxel_bound = round_shift(combination(bounds::unfolded), shift) + COMPONENTS as i64;
        let taxel = Format { lsb: explained.lsb - FOLD_BITS as i32, bound: taxel_bound, ..explained };
        self.operands.insert(Vector::Explained, Operand { folded: explained, taxel });
        self.friction();

        let mut force = self.group(|result| matches!(result, Vector::Force(_)))?;
        let mut rounding_n = 0.0;
        if composed::is_coarse(force, taxel_n) {
            let inverse = self.of_results(|result| matches!(result, Vector::Force(_)));
            let lsb = inverse.iter().map(|matrix| matrix.accumulator_lsb(explained)).max().unwrap_or(force.lsb);
            let worst = composed::worst(&parts, &inverse, composed::Path { weights, residual, explained });
            (force, rounding_n) = (composed::format(worst, lsb, self.factors.data_bits), worst.rounding);
        }
        Ok(Field { residual, explained, force, rounding_n })
    }

    /// Stores `r = r0 + mu_x r1 + mu_y r2`, row by row; the coefficients are codes.
    fn friction(&mut self) {
        let Some(index) = self.list.matrices.iter().position(|form| form.source == Source::Friction) else { return };
        let orbits = self.matrices[0].rows.len();
        let row = |orbit: usize| {
            let codes = [SELECT_ONE, SELECT_MU_X, SELECT_MU_Y].into_iter().enumerate();
            codes.map(|(part, code)| ((part * orbits + orbit) as u32, [code; COMPONENTS])).collect()
        };
        let fraction = FRICTION_FRACTION + self.factors.friction_shift();
        let (rows, lsb) = ((0..orbits).map(row).collect(), -(fraction as i32));
        let mut matrix = QuantisedMatrix::from_rows(&self.list.matrices[index].label(), rows, lsb);
        matrix.row_sum = LARGEST_COMBINATION << fraction;
        matrix.dropped = self.factors.dropped_of_friction();
        self.place[index] = self.matrices.len();
        self.matrices.push(matrix);
    }

    /// The matrices of the products with these results, mirrored where that is meant.
    fn of_results(&self, is_in: impl Fn(Vector) -> bool) -> Vec<QuantisedMatrix> {
        let steps = self.list.steps.iter().filter(|step| is_in(step.result));
        let matrix = |step: &Step| {
            let stored = &self.matrices[self.place[step.matrix]];
            step.mirrored.map_or_else(|| stored.clone(), |side| stored.mirrored(side))
        };
        steps.map(matrix).collect()
    }

    fn finish(self, formats: Formats, rounding_n: f64) -> Quantised {
        let Self { matrices, place, sums, .. } = self;
        Quantised { matrices, place, sums, formats, rounding_n }
    }
}

/// Matrices of a group by their place in the list, with their operands.
type Terms = Vec<(usize, (QuantisedMatrix, Operand))>;

/// The finest format of the same width, no finer than `format`, that holds `bound` of its steps; and the bits it gives up.
fn narrowed(format: Format, bound: i64) -> (Format, u32) {
    let mut shift = 0;
    while round_shift(bound, shift) > largest(format.bits) {
        shift += 1;
    }
    (Format { lsb: format.lsb + shift as i32, bound: round_shift(bound, shift), ..format }, shift)
}
