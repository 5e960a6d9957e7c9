//! Factorisations of the blocks, and from them the inverses.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::parity::{COMPONENTS, FoldedMatrix, Orbits};

/// C33 and A by parity component of the stress.
///
/// C33 commutes with both mirrors of the grid, C31 is odd in x, C32 odd in y: A falls apart into four blocks of a
/// quarter the size, and a factorisation of a block costs a 64th.
pub(super) struct Factors {
    components: Vec<Component>,
}

/// C33 and A for one parity component of the stress, in orthonormal bases of the components.
struct Component {
    /// Its orbits, and those of the components of forces along x, y and z that cause such stresses.
    stress: Basis,
    forces: [Basis; 3],
    c33: DMatrix<f64>,
    /// `A^T = Q R`.
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

/// The orbits that exist in a component, each with the length of the vector that is 1 at its images. Folded blocks times
/// the quotient of two lengths are those in an orthonormal basis, which a factorisation needs.
struct Basis {
    component: usize,
    orbits: Vec<(usize, f64)>,
}

impl Basis {
    fn new(orbits: &Orbits, component: usize) -> Self {
        let exist = (0..orbits.count()).filter(|&q| orbits.exists(component, q));
        Self { component, orbits: exist.map(|q| (q, (orbits.size(q) as f64).sqrt())).collect() }
    }

    fn len(&self) -> usize {
        self.orbits.len()
    }
}

/// The block of `matrix` from `operand` to `result` in orthonormal bases.
fn orthonormal(matrix: &FoldedMatrix, result: &Basis, operand: &Basis) -> DMatrix<f64> {
    let block = &matrix.blocks[operand.component];
    DMatrix::from_fn(result.len(), operand.len(), |i, j| {
        let ((q, length), (column, other)) = (result.orbits[i], operand.orbits[j]);
        block[(q, column)] * (length / other)
    })
}

/// Undoes [`orthonormal`], for a block of n by n.
fn folded(block: &DMatrix<f64>, result: &Basis, operand: &Basis, n: usize) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(n, n);
    for (j, &(column, other)) in operand.orbits.iter().enumerate() {
        for (i, &(q, length)) in result.orbits.iter().enumerate() {
            whole[(q, column)] = block[(i, j)] * (other / length);
        }
    }
    whole
}

/// Eigenvalues of C33 as the sensor has it, which is symmetric: the stress of a force depends on the distance alone.
pub(super) struct Spectrum(Vec<f64>);

impl Spectrum {
    pub(super) fn new(orbits: &Orbits, c33: &FoldedMatrix) -> Self {
        let of_component = |component| {
            let basis = Basis::new(orbits, component);
            orthonormal(c33, &basis, &basis).symmetric_eigenvalues().as_slice().to_vec()
        };
        Self((0..COMPONENTS).into_par_iter().flat_map(of_component).collect())
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
    pub(super) fn new(orbits: &Orbits, c: &[FoldedMatrix; 3]) -> Self {
        let components =
            (0..COMPONENTS).into_par_iter().map(|component| Component::new(orbits, c, component)).collect();
        Self { components }
    }

    /// Condition number of A in the 2-norm.
    pub(super) fn condition_a(&self) -> f64 {
        let values: Vec<DVector<f64>> =
            self.components.par_iter().map(|component| component.r.singular_values()).collect();
        condition(values.iter().flat_map(|of_component| of_component.iter().copied()))
    }

    /// C33^-1 and the three parts of A+; `None` where there is no inverse.
    pub(super) fn inverses(self, orbits: &Orbits) -> Option<[FoldedMatrix; 4]> {
        let n = orbits.count();
        let by_component: Vec<[DMatrix<f64>; 4]> =
            self.components.into_par_iter().map(|component| component.inverses(n)).collect::<Option<_>>()?;
        // Stresses are what the inverses multiply: the blocks are in the order of their components already.
        let mut parts: [Vec<DMatrix<f64>>; 4] = Default::default();
        for blocks in by_component {
            for (part, block) in parts.iter_mut().zip(blocks) {
                part.push(block);
            }
        }
        let [c33inv, a1, a2, a3] = parts.map(|blocks| <[DMatrix<f64>; COMPONENTS]>::try_from(blocks).ok());
        let matrix = |parity, blocks| FoldedMatrix { parity, orbits: *orbits, blocks };
        Some([matrix(0, c33inv?), matrix(1, a1?), matrix(2, a2?), matrix(0, a3?)])
    }
}

impl Component {
    fn new(orbits: &Orbits, c: &[FoldedMatrix; 3], component: usize) -> Self {
        let stress = Basis::new(orbits, component);
        let forces = c.each_ref().map(|matrix| Basis::new(orbits, component ^ matrix.parity));
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

    /// The blocks of C33^-1 and of the three parts of A+ for stresses of this component.
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
