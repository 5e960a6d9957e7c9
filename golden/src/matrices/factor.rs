//! Factorisations of the blocks, and from them the inverses.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::parity::{CLASSES, FoldedMatrix, Quads};

/// C33 and A as far as they concern stresses of each class.
///
/// C33 commutes with both mirrors of the grid, C31 is odd in x, C32 odd in y: A falls apart into four blocks of a
/// quarter the size, and a factorisation of a block costs a 64th.
pub(super) struct Factors {
    classes: Vec<Class>,
}

/// The part of one class of stresses, in orthonormal bases of the classes.
struct Class {
    /// Its quads, and those of the classes of forces along x, y and z that cause such stresses.
    stress: Basis,
    forces: [Basis; 3],
    c33: DMatrix<f64>,
    /// `A^T = Q R`.
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

/// The quads that exist in a class, and the lengths of the vectors that are 1 at all members of one: the folded blocks
/// times the quotient of two lengths are those in an orthonormal basis, which a factorisation needs.
struct Basis {
    class: usize,
    quads: Vec<(usize, f64)>,
}

impl Basis {
    fn new(quads: &Quads, class: usize) -> Self {
        let exist = (0..quads.count()).filter(|&q| quads.exists(class, q));
        Self { class, quads: exist.map(|q| (q, (quads.size(q) as f64).sqrt())).collect() }
    }

    fn len(&self) -> usize {
        self.quads.len()
    }
}

/// The block of `matrix` from `operand` to `result` in orthonormal bases.
fn orthonormal(matrix: &FoldedMatrix, result: &Basis, operand: &Basis) -> DMatrix<f64> {
    let block = &matrix.blocks[operand.class];
    DMatrix::from_fn(result.len(), operand.len(), |i, j| {
        let ((q, length), (column, other)) = (result.quads[i], operand.quads[j]);
        block[(q, column)] * (length / other)
    })
}

/// Undoes [`orthonormal`], for a block of n by n.
fn folded(block: &DMatrix<f64>, result: &Basis, operand: &Basis, n: usize) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(n, n);
    for (j, &(column, other)) in operand.quads.iter().enumerate() {
        for (i, &(q, length)) in result.quads.iter().enumerate() {
            whole[(q, column)] = block[(i, j)] * (other / length);
        }
    }
    whole
}

/// Eigenvalues of C33 as the sensor has it, which is symmetric: the stress of a force depends on the distance alone.
pub(super) struct Spectrum(Vec<f64>);

impl Spectrum {
    pub(super) fn new(quads: &Quads, c33: &FoldedMatrix) -> Self {
        let of_class = |class| {
            let basis = Basis::new(quads, class);
            orthonormal(c33, &basis, &basis).symmetric_eigenvalues().as_slice().to_vec()
        };
        Self((0..CLASSES).into_par_iter().flat_map(of_class).collect())
    }

    /// Largest singular value.
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().fold(0.0, |largest, value| value.abs().max(largest))
    }

    /// Condition number in the 2-norm of C33 with `share` added to its diagonal.
    pub(super) fn condition(&self, share: f64) -> f64 {
        condition(self.0.iter().map(|value| (value + share).abs()))
    }
}

/// The largest of singular values over the smallest.
fn condition(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(0.0, f64::max) / values.fold(f64::INFINITY, f64::min)
}

impl Factors {
    pub(super) fn new(quads: &Quads, c: &[FoldedMatrix; 3]) -> Self {
        let classes = (0..CLASSES).into_par_iter().map(|class| Class::new(quads, c, class)).collect();
        Self { classes }
    }

    /// Condition number of A in the 2-norm.
    pub(super) fn condition_a(&self) -> f64 {
        let values: Vec<DVector<f64>> = self.classes.par_iter().map(|class| class.r.singular_values()).collect();
        condition(values.iter().flat_map(|of_class| of_class.iter().copied()))
    }

    /// C33^-1 and the three parts of A+; `None` where there is no inverse.
    pub(super) fn inverses(self, quads: &Quads) -> Option<[FoldedMatrix; 4]> {
        let n = quads.count();
        let by_class: Vec<[DMatrix<f64>; 4]> =
            self.classes.into_par_iter().map(|class| class.inverses(n)).collect::<Option<_>>()?;
        // Stresses are what the inverses multiply: the blocks are in the order of their classes already.
        let mut parts: [Vec<DMatrix<f64>>; 4] = Default::default();
        for blocks in by_class {
            for (part, block) in parts.iter_mut().zip(blocks) {
                part.push(block);
            }
        }
        let [c33inv, a1, a2, a3] = parts.map(|blocks| <[DMatrix<f64>; CLASSES]>::try_from(blocks).ok());
        let matrix = |parity, blocks| FoldedMatrix { parity, quads: *quads, blocks };
        Some([matrix(0, c33inv?), matrix(1, a1?), matrix(2, a2?), matrix(0, a3?)])
    }
}

impl Class {
    fn new(quads: &Quads, c: &[FoldedMatrix; 3], class: usize) -> Self {
        let stress = Basis::new(quads, class);
        let forces = c.each_ref().map(|matrix| Basis::new(quads, class ^ matrix.parity));
        let mut transposed = DMatrix::zeros(forces.iter().map(Basis::len).sum(), stress.len());
        let mut first = 0;
        for (matrix, basis) in c.iter().zip(&forces) {
            transposed.rows_mut(first, basis.len()).copy_from(&orthonormal(matrix, &stress, basis).transpose());
            first += basis.len();
        }
        let (q, r) = transposed.qr().unpack();
        let c33 = orthonormal(&c[2], &stress, &stress);
        Self { stress, forces, c33, q, r }
    }

    /// The blocks of C33^-1 and of the three parts of A+ for stresses of this class.
    fn inverses(self, n: usize) -> Option<[DMatrix<f64>; 4]> {
        let c33inv = folded(&self.c33.lu().try_inverse()?, &self.stress, &self.stress, n);
        // A+ = Q R^-T: unlike A^T (A A^T)^-1 this does not square the condition number.
        let a_plus = self.r.solve_upper_triangular(&self.q.transpose())?.transpose();
        let mut first = 0;
        let a = self.forces.each_ref().map(|basis| {
            let rows = a_plus.rows(first, basis.len()).into_owned();
            first += basis.len();
            folded(&rows, basis, &self.stress, n)
        });
        let [a1, a2, a3] = a;
        Some([c33inv, a1, a2, a3])
    }
}
