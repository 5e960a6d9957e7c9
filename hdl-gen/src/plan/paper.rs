//! The plan of the paper: thirteen filtered products, then `u_q = C33 g_3q` (Eqs. 9 to 16).

use golden::filter::FilteredMatrices;
use golden::matrices::{Matrices, MatrixName};
use nalgebra_sparse::{CooMatrix, CsrMatrix};

use super::format::{Format, MOST_SHIFT, largest};
use super::product::{Block, Coefficients, Epilogue, Product, Vector};
use super::quantise::{ANY_LSB, QuantisedMatrix, one_way};
use super::{Formats, PlanError};

/// How the twelve products of Co follow each other. `A_p b` come first: they keep the lanes busy while the
/// last weights arrive. `g_3q` come next: Op needs them first.
const CO_ORDER: [MatrixName; 12] = [
    MatrixName::A1,
    MatrixName::A2,
    MatrixName::A3,
    MatrixName::D30,
    MatrixName::D31,
    MatrixName::D32,
    MatrixName::D10,
    MatrixName::D11,
    MatrixName::D12,
    MatrixName::D20,
    MatrixName::D21,
    MatrixName::D22,
];

/// Matrices as stored, products in order, and the formats that hold every result.
pub struct PaperPlan {
    /// The thirteen matrices, and C33 last.
    pub matrices: Vec<QuantisedMatrix>,
    /// The sixteen products.
    pub products: Vec<Product>,
    /// Vector formats.
    pub formats: Formats,
}

/// A product whose shift is not known yet.
struct Draft {
    operand: Vector,
    block: Block,
    epilogue: Epilogue,
    result: Vector,
}

/// Quantises the matrices and chooses, from worst-case row sums, formats that no input within the full scale
/// can overflow.
///
/// # Errors
/// [`PlanError`] when the widths of the design leave too few bits.
pub fn build(
    matrices: &Matrices,
    filtered: &FilteredMatrices,
    stress: Format,
    coefficient_bits: u32,
    data_bits: u32,
) -> Result<PaperPlan, PlanError> {
    let quantise = |name: MatrixName, bound, least_lsb| {
        let (label, stored) = stored_form(name, filtered.get(name));
        QuantisedMatrix::new(&label, &one_way(&stored), coefficient_bits, bound, least_lsb)
    };
    let inverse = quantise(MatrixName::C33inv, stress.bound, ANY_LSB)?;
    let weight = result_format(&[vec![(&inverse, stress)]], data_bits);

    let operand = |name| if is_pseudo_inverse(name) { stress } else { weight };
    let mut of_co = Vec::with_capacity(CO_ORDER.len());
    for name in CO_ORDER {
        of_co.push(quantise(name, operand(name).bound, ANY_LSB)?);
    }
    let alone = g_format(&of_co, stress, weight, data_bits);
    for (name, matrix) in CO_ORDER.into_iter().zip(&mut of_co) {
        let least_lsb = alone.lsb - operand(name).lsb - MOST_SHIFT as i32;
        if matrix.lsb < least_lsb {
            *matrix = quantise(name, operand(name).bound, least_lsb)?;
        }
    }
    // The last bits of the small ones have changed, and with them perhaps the bound.
    let g = g_format(&of_co, stress, weight, data_bits);
    let base = QuantisedMatrix::new(
        "C33",
        &one_way(&CsrMatrix::from(&matrices.c33.dense())),
        coefficient_bits,
        g.bound,
        ANY_LSB,
    )?;
    let u = result_format(&[vec![(&base, g)]], data_bits);
    let mut stored = vec![inverse];
    stored.append(&mut of_co);
    stored.push(base);

    let formats = Formats { stress, weight, g, u, folded: None };
    let products = drafts()
        .into_iter()
        .map(|(matrix, draft)| {
            let accumulator_lsb = stored[matrix].lsb + formats.of(draft.operand).lsb;
            Product {
                matrix,
                lead: None,
                operands: vec![draft.operand],
                block: draft.block,
                program: 0,
                coefficients: Coefficients::Rom,
                parity: 0,
                mirrored: None,
                skips: false,
                epilogue: draft.epilogue,
                result: draft.result,
                shift: (formats.of(draft.result).lsb - accumulator_lsb) as u32,
            }
        })
        .collect();
    Ok(PaperPlan { matrices: stored, products, formats })
}

/// The products as `(stored matrix, draft)`.
fn drafts() -> Vec<(usize, Draft)> {
    let we =
        Draft { operand: Vector::Stress, block: Block::We, epilogue: Epilogue::ClipNegate, result: Vector::Weight };
    let mut drafts = vec![(0, we)];
    for (index, name) in CO_ORDER.into_iter().enumerate() {
        let (p, q) = indices(name);
        let draft = match q {
            None => Draft {
                operand: Vector::Stress,
                block: Block::Co,
                epilogue: Epilogue::Keep,
                result: Vector::Partial(p),
            },
            Some(q) => Draft {
                operand: Vector::Weight,
                block: Block::Co,
                epilogue: if q == 0 { Epilogue::Add(Vector::Partial(p)) } else { Epilogue::Keep },
                result: Vector::G(p, q),
            },
        };
        drafts.push((1 + index, draft));
    }
    for q in 0..3 {
        let draft =
            Draft { operand: Vector::G(3, q), block: Block::Op, epilogue: Epilogue::Keep, result: Vector::U(q) };
        drafts.push((1 + CO_ORDER.len(), draft));
    }
    drafts
}

/// `(p, Some(q))` of `D_pq`, `(p, None)` of `A_p`; `C33inv` counts as `(0, None)`.
fn indices(name: MatrixName) -> (u8, Option<u8>) {
    match name {
        MatrixName::C33inv => (0, None),
        MatrixName::A1 => (1, None),
        MatrixName::A2 => (2, None),
        MatrixName::A3 => (3, None),
        MatrixName::D10 => (1, Some(0)),
        MatrixName::D11 => (1, Some(1)),
        MatrixName::D12 => (1, Some(2)),
        MatrixName::D20 => (2, Some(0)),
        MatrixName::D21 => (2, Some(1)),
        MatrixName::D22 => (2, Some(2)),
        MatrixName::D30 => (3, Some(0)),
        MatrixName::D31 => (3, Some(1)),
        MatrixName::D32 => (3, Some(2)),
    }
}

fn is_pseudo_inverse(name: MatrixName) -> bool {
    indices(name).1.is_none()
}

/// The matrix as it multiplies `|w|`: since `w = -|w|`, `D_p0` is negated; the terms `|w|` of `g11` and `g22`
/// and `w` of `g30` become ones on the diagonal.
fn stored_form(name: MatrixName, matrix: &CsrMatrix<f64>) -> (String, CsrMatrix<f64>) {
    let (label, sign, diagonal) = match name {
        MatrixName::D10 | MatrixName::D20 => (format!("-{name}"), -1.0, 0.0),
        MatrixName::D11 | MatrixName::D22 => (format!("(I + {name})"), 1.0, 1.0),
        MatrixName::D30 => (format!("-(I + {name})"), -1.0, -1.0),
        _ => (name.to_string(), 1.0, 0.0),
    };
    let mut coo = CooMatrix::new(matrix.nrows(), matrix.ncols());
    for (row, column, value) in matrix.triplet_iter() {
        coo.push(row, column, sign * value);
    }
    if diagonal != 0.0 {
        for index in 0..matrix.nrows() {
            coo.push(index, index, diagonal); // duplicates are summed
        }
    }
    (label, CsrMatrix::from(&coo))
}

/// The format of all nine `g_pq` and of `A_p b`; `matrices` are those of [`CO_ORDER`].
fn g_format(matrices: &[QuantisedMatrix], stress: Format, weight: Format, bits: u32) -> Format {
    let terms = || CO_ORDER.into_iter().zip(matrices);
    let of_p = |name| indices(name).0;
    let mut sums: Vec<Vec<(&QuantisedMatrix, Format)>> = Vec::new();
    for (name, matrix) in terms() {
        match indices(name).1 {
            None => sums.push(vec![(matrix, stress)]),
            Some(0) => {
                let partial = terms().find(|&(other, _)| is_pseudo_inverse(other) && of_p(other) == of_p(name));
                sums.push(partial.map(|(_, matrix)| (matrix, stress)).into_iter().chain([(matrix, weight)]).collect());
            }
            Some(_) => sums.push(vec![(matrix, weight)]),
        }
    }
    result_format(&sums, bits)
}

/// The finest `bits`-bit format for results that are sums of products: `sums` lists, per result, its terms as
/// `(matrix, operand format)`. Its step is never finer than that of an accumulator it is rounded from.
fn result_format(sums: &[Vec<(&QuantisedMatrix, Format)>], bits: u32) -> Format {
    let accumulator_lsb = |&(matrix, operand): &(&QuantisedMatrix, Format)| matrix.lsb + operand.lsb;
    let bound = |lsb: i32| -> i64 {
        let of_term = |term: &(&QuantisedMatrix, Format)| {
            Product::result_bound(term.0, term.1.bound, (lsb - accumulator_lsb(term)) as u32)
        };
        sums.iter().map(|terms| terms.iter().map(of_term).sum()).max().unwrap_or(0)
    };
    let mut lsb = sums.iter().flatten().map(accumulator_lsb).max().unwrap_or(0);
    while bound(lsb) > largest(bits) {
        lsb += 1;
    }
    Format { bits, lsb, bound: bound(lsb) }
}
