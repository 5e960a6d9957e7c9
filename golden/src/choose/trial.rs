//! All reference frames at once, with one matrix filtered.

use nalgebra::{DMatrix, DVector, RowDVector};

use crate::design::{Design, MatrixFilter};
use crate::estimators::{Friction, FrictionScratch, Seen};
use crate::filter;
use crate::matrices::{Matrices, MatrixName};
use crate::products::ByPq;
use crate::scene::SceneFrame;
use crate::solver::SolverError;
use crate::solver::cean::Contact;
use crate::solver::op;
use crate::solver::reading::{Given, Reader, Reading};

/// What a matrix multiplies.
#[derive(Clone, Copy, PartialEq)]
enum Factor {
    /// The stress `b`.
    Stress,
    /// The weights `w`.
    Weights,
    /// Their magnitude `|w|`.
    Magnitude,
}

/// The coefficient `g_pq` a matrix contributes to (Eqs. 11 to 13 and 16), as `(p - 1, q)`, and what it multiplies;
/// `None` for C33inv, which makes the weights.
fn role(name: MatrixName) -> Option<(usize, usize, Factor)> {
    use Factor::{Magnitude, Stress, Weights};
    Some(match name {
        MatrixName::C33inv => return None,
        MatrixName::A1 => (0, 0, Stress),
        MatrixName::D10 => (0, 0, Weights),
        MatrixName::D11 => (0, 1, Magnitude),
        MatrixName::D12 => (0, 2, Magnitude),
        MatrixName::A2 => (1, 0, Stress),
        MatrixName::D20 => (1, 0, Weights),
        MatrixName::D21 => (1, 1, Magnitude),
        MatrixName::D22 => (1, 2, Magnitude),
        MatrixName::A3 => (2, 0, Stress),
        MatrixName::D30 => (2, 0, Weights),
        MatrixName::D31 => (2, 1, Magnitude),
        MatrixName::D32 => (2, 2, Magnitude),
    })
}

/// The sums `G_pq` of one frame.
type Sums = [[f64; 3]; 3];

/// All that the friction coefficient of a frame depends on besides its contact; one entry or column a frame.
#[derive(Clone)]
struct Coefficients {
    sums: Vec<Sums>,
    /// `u_q = C33 g_3q`, m rows.
    u: [DMatrix<f64>; 3],
}

/// The reference frames that have a solution, and what does not depend on the filtered matrix.
///
/// A matrix of the tangential coefficients changes a single `G_pq`, by the column sums of what is dropped of it; one of
/// the normal coefficients changes a `G_pq` and one `u_q`; only C33inv, by way of the weights, changes all.
pub(super) struct Trial {
    /// The 13 matrices, and C33.
    matrices: Vec<DMatrix<f64>>,
    c33: DMatrix<f64>,
    friction: Friction,
    contacts: Vec<Contact>,
    /// True friction.
    truth: Vec<f64>,
    /// Sum of the errors of the frames without a solution, whose estimate is 0.
    unsolved: f64,
    frames: usize,
    column_sums: Vec<RowDVector<f64>>,
    /// Stress, one column a frame, and the weights.
    stress: DMatrix<f64>,
    weights: DMatrix<f64>,
    magnitude: DMatrix<f64>,
    /// The share of the stress in the coefficients, without the weights.
    of_stress: Coefficients,
    /// The coefficients with nothing filtered.
    unfiltered: Coefficients,
}

impl Trial {
    pub(super) fn new(design: &Design, matrices: &Matrices, frames: &[SceneFrame]) -> Result<Self, SolverError> {
        let reader = Reader::new(design);
        let (mut columns, mut contacts, mut truth, mut unsolved) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
        let mut b = DVector::zeros(reader.taxels());
        for frame in frames {
            match reader.read(Given::Values(&frame.stress), &mut b)? {
                Reading::Contact { contact, .. } => {
                    columns.extend_from_slice(b.as_slice());
                    contacts.push(contact);
                    truth.push(frame.friction);
                }
                Reading::Nothing(_) => unsolved += 100.0 * frame.friction.abs(),
            }
        }
        let stress = DMatrix::from_vec(reader.taxels(), contacts.len(), columns);
        let c33 = matrices.c33.dense();
        let matrices = MatrixName::ALL.map(|name| matrices.dense(name)).to_vec();
        let weights = weights(&matrices[MatrixName::C33inv.index()], &stress);
        let zero = DMatrix::zeros(stress.nrows(), stress.ncols());
        let nothing =
            Coefficients { sums: vec![Sums::default(); contacts.len()], u: [zero.clone(), zero.clone(), zero] };
        let mut trial = Self {
            column_sums: matrices.iter().map(DMatrix::row_sum).collect(),
            matrices,
            c33,
            friction: Friction::new(design.algorithm.constants(), &design.sensor),
            contacts,
            truth,
            unsolved,
            frames: frames.len(),
            stress,
            magnitude: -&weights,
            weights,
            of_stress: nothing.clone(),
            unfiltered: nothing,
        };
        let mut coefficients = trial.of_stress.clone();
        trial.add_products(&mut coefficients, Factor::Stress, &trial.stress);
        trial.of_stress = coefficients;
        trial.unfiltered = trial.with_weights(&trial.weights, &trial.magnitude);
        Ok(trial)
    }

    /// Mean error of friction in percent with nothing filtered.
    pub(super) fn unfiltered(&self) -> f64 {
        let Coefficients { sums, u: [u0, u1, u2] } = &self.unfiltered;
        self.mean_error(sums, [u0, u1, u2])
    }

    /// Entries kept, and the mean error of friction in percent, with only one matrix filtered.
    pub(super) fn judge(&self, name: MatrixName, filter: MatrixFilter) -> (usize, f64) {
        let matrix = &self.matrices[name.index()];
        let keeps = filter::rule(matrix, filter);
        let mut nnz = 0;
        let dropped = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
            if keeps(row, column) {
                nnz += 1;
                0.0
            } else {
                matrix[(row, column)]
            }
        });
        let Some((p, q, factor)) = role(name) else {
            let weights = weights(&(matrix - dropped), &self.stress);
            let Coefficients { sums, u: [u0, u1, u2] } = self.with_weights(&weights, &-&weights);
            return (nnz, self.mean_error(&sums, [&u0, &u1, &u2]));
        };
        let vectors = match factor {
            Factor::Stress => &self.stress,
            Factor::Weights => &self.weights,
            Factor::Magnitude => &self.magnitude,
        };
        let mut sums = self.unfiltered.sums.clone();
        for (sums, loss) in sums.iter_mut().zip((dropped.row_sum() * vectors).iter()) {
            sums[p][q] -= loss;
        }
        let mut u = self.unfiltered.u.each_ref();
        let changed;
        if p == 2 {
            changed = u[q] - &self.c33 * (dropped * vectors);
            u[q] = &changed;
        }
        (nnz, self.mean_error(&sums, u))
    }

    /// The coefficients for other weights.
    fn with_weights(&self, weights: &DMatrix<f64>, magnitude: &DMatrix<f64>) -> Coefficients {
        let mut coefficients = self.of_stress.clone();
        self.add_products(&mut coefficients, Factor::Weights, weights);
        self.add_products(&mut coefficients, Factor::Magnitude, magnitude);
        // Besides the products |w| is in g_11 and g_22, and w in g_30.
        for (sums, weights) in coefficients.sums.iter_mut().zip(weights.column_iter()) {
            let sum = weights.sum();
            sums[0][1] -= sum;
            sums[1][2] -= sum;
            sums[2][0] += sum;
        }
        coefficients.u[0] += &self.c33 * weights;
        coefficients
    }

    /// Adds the products of all matrices that multiply this factor.
    fn add_products(&self, coefficients: &mut Coefficients, factor: Factor, vectors: &DMatrix<f64>) {
        for name in MatrixName::ALL {
            let Some((p, q, _)) = role(name).filter(|(_, _, wanted)| *wanted == factor) else { continue };
            let totals = &self.column_sums[name.index()] * vectors;
            for (sums, total) in coefficients.sums.iter_mut().zip(totals.iter()) {
                sums[p][q] += total;
            }
            if p == 2 {
                coefficients.u[q] += &self.c33 * (&self.matrices[name.index()] * vectors);
            }
        }
    }

    /// Mean error of friction over all frames, in percent.
    fn mean_error(&self, sums: &[Sums], u: [&DMatrix<f64>; 3]) -> f64 {
        let mut total = self.unsolved;
        let mut scratch = FrictionScratch::default();
        let m = self.stress.nrows();
        for (index, ((contact, sums), truth)) in self.contacts.iter().zip(sums).zip(&self.truth).enumerate() {
            let of_frame = index * m..(index + 1) * m;
            let b = &self.stress.as_slice()[of_frame.clone()];
            let u = u.map(|u| &u.as_slice()[of_frame.clone()]);
            // No estimator asks for torques.
            let mut with_torques = ByPq::default();
            with_torques[..3].copy_from_slice(sums);
            let seen = Seen { b, contact: *contact, sums: &with_torques, u };
            let [mu_x, mu_y] = self.friction.find(&seen, &mut scratch).mu;
            let resultant = sums.map(|[g0, g1, g2]| g0 + g1 * mu_x + g2 * mu_y);
            total += 100.0 * (truth - op::quotient(resultant)).abs();
        }
        total / self.frames as f64
    }
}

/// `w = min(C33inv b, 0)` (Eq. 15), column by column.
fn weights(inverse: &DMatrix<f64>, stress: &DMatrix<f64>) -> DMatrix<f64> {
    (inverse * stress).map(|force| force.min(0.0))
}
