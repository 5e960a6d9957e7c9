//! The reference solver: one frame of normal stress in, forces and friction out.
//!
//! [`Solver`] analyses the contact ([`cean`]), executes the products of the design's plan as a list ([`crate::products`]) and
//! finds the friction by the design's estimator. With the reduced plan that is the same mathematics on folded vectors. A frame
//! without an answer gets a [`Status`] and zeros, never a NaN.

mod batch;
pub mod cean;
mod confidence;
mod cores;
pub(crate) mod reading;
mod separate;
mod slips;
mod workspace;

pub use crate::status::Status;
pub use cores::PIECE;
pub use reading::Past;
pub use separate::{CHANGE, REACH};
pub use slips::Slips;
pub use workspace::Workspace;

use std::fmt::Display;
use std::sync::{Arc, OnceLock};

use crate::contacts::{ContactForces, Finder};
use crate::design::{Design, Outputs, PlanKind, Slip};
use crate::estimators::{Estimate, Friction, FrictionScratch, Inputs};
use crate::filter::FilteredMatrices;
use crate::matrices::Matrices;
use crate::parity::COMPONENTS;
use crate::products::batch::Blocks;
use crate::products::{Engine, PaperMatrices, ProductList};
use crate::reduced::ReducedMatrices;
use confidence::Confidence;
use reading::Reader;

/// Friction, `|mu_x| + |mu_y|`, from which on a layer that is dragged shows tension somewhere. Below it a contact in the
/// middle may show none.
pub const PULLING: f64 = 0.35;

/// Why a solver cannot be made or a frame cannot be solved, in words.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SolverError(String);

impl SolverError {
    /// A frame of the wrong length.
    fn length(found: usize, expected: usize) -> Self {
        Self(format!("the frame has {found} values, the sensor {expected} taxels; give one value for each taxel"))
    }
}

/// What one frame yields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// What is to be known about the result.
    pub status: Status,
    /// Sum of the forces `[F_x, F_y, F_z]` in newtons.
    pub resultant: [f64; 3],
    /// Their torque `[T_x, T_y, T_z]` in N m about the middle of the grid at the surface.
    pub torque: [f64; 3],
    /// Standard error of `(F_x, F_y)` in newtons; 0 where the estimator has none.
    pub standard_error: f64,
    /// Number of contacts in touch, 0 without an answer. A design with `contacts = 1` knows of no more than one, but
    /// for one that counts them.
    pub contacts: usize,
    /// The separated contacts, the one that presses most first, then zeros: as many as the design's `contacts`,
    /// and none with `contacts = 1`.
    pub records: Vec<ContactForces>,
    /// `sqrt(F_x^2 + F_y^2) / |F_z|`, 0 where `F_z` is 0 (Eq. 29).
    pub mu: f64,
    /// Direction of the tangential resultant, `atan2(F_y, F_x)`, in radians.
    pub phi: f64,
    /// Friction component along x.
    pub mu_x: f64,
    /// Friction component along y.
    pub mu_y: f64,
    /// Forces `f_x, f_y, f_z` in newtons, one value for each taxel; empty if the design asks for resultants only.
    pub field: [Vec<f64>; 3],
}

impl Solution {
    /// The answer to a frame without one: the status and zeros, in a field of `taxels` values.
    pub fn zeros(status: Status, taxels: usize) -> Self {
        Self { status, field: std::array::from_fn(|_| vec![0.0; taxels]), ..Self::default() }
    }

    /// As [`Solution::zeros`], in place.
    fn reset(&mut self, status: Status, taxels: usize) {
        let mut field = std::mem::take(&mut self.field);
        for component in &mut field {
            component.clear();
            component.resize(taxels, 0.0);
        }
        let mut records = std::mem::take(&mut self.records);
        records.clear();
        *self = Self { status, records, field, ..Self::default() };
    }

    /// Multiplies all forces by a gain.
    fn scale(&mut self, gain: f64) {
        let resultants = self.resultant.iter_mut().chain(&mut self.torque).chain([&mut self.standard_error]);
        let of_contacts = self.records.iter_mut().flat_map(|contact| {
            let ContactForces { force, torque, standard_error, .. } = contact;
            force.iter_mut().chain(torque).chain([standard_error])
        });
        self.field.iter_mut().flatten().chain(resultants).chain(of_contacts).for_each(|force| *force *= gain);
    }

    /// Finds the friction components, and puts them and what follows from them in place.
    fn optimum(&mut self, estimators: &Estimators, inputs: &Inputs, scratch: &mut FrictionScratch) -> [f64; 2] {
        let Estimators { friction, confidence } = estimators;
        let Estimate { status, mu } = friction.find(inputs, scratch);
        self.status.insert(status);
        if !status.contains(Status::DIRECTION_UNKNOWN) && mu[0].abs() + mu[1].abs() < PULLING {
            self.status.remove(Status::NO_TENSION);
        }
        let [fx, fy, fz, tx, ty, tz] = inputs.sums.map(|[g0, g1, g2]| g0 + mu[0] * g1 + mu[1] * g2);
        let resultant = [fx, fy, fz];
        [self.mu_x, self.mu_y] = mu;
        (self.resultant, self.torque, self.contacts) = (resultant, [tx, ty, tz], 1);
        if let Some(of) = confidence {
            // Without a direction the error is as much as presses.
            let unknown = status.contains(Status::DIRECTION_UNKNOWN);
            let share = if unknown { 1.0 } else { of.share(inputs.b, inputs.contact.noise_left) };
            self.standard_error = share * fz.abs();
            if share > of.most {
                self.status.insert(Status::LOW_CONFIDENCE);
            }
        }
        (self.mu, self.phi) = (quotient(resultant), fy.atan2(fx));
        mu
    }
}

/// Friction of a resultant: tangential over normal force, 0 where there is no normal force (Eq. 29).
fn quotient([x, y, z]: [f64; 3]) -> f64 {
    if z == 0.0 { 0.0 } else { x.hypot(y) / z.abs() }
}

/// Everything that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Solver {
    reader: Reader,
    matrices: Matrices,
    products: Products,
    estimators: Estimators,
    /// Where contacts are separated, or counted.
    finder: Option<Finder>,
    /// Whether solutions have the forces of all taxels.
    keeps_field: bool,
    /// Standard error as a share of the normal force above which a contact has low confidence.
    max_standard_error: f64,
    slip: Option<Slip>,
}

/// What a frame's friction and standard error are found with.
#[derive(Clone, Debug)]
struct Estimators {
    friction: Friction,
    confidence: Option<Confidence>,
}

/// The products of the design's plan.
#[derive(Clone, Debug)]
enum Products {
    Paper(Box<OfPlan<PaperMatrices, 1>>),
    Reduced(Box<OfPlan<ReducedMatrices, COMPONENTS>>),
}

/// Those of one plan, and what several frames at once need.
#[derive(Clone, Debug)]
struct OfPlan<S, const W: usize> {
    engine: Engine<f64, S, W>,
    /// Made when first used.
    blocks: OnceLock<Arc<Blocks<W>>>,
}

impl Solver {
    /// Computes and filters the matrices of a design, for the plan it names.
    ///
    /// # Errors
    ///
    /// [`SolverError`] for a sensor whose matrices are singular or too ill-conditioned, or a filter that leaves nothing of a
    /// row.
    pub fn new(design: &Design) -> Result<Self, SolverError> {
        let wrong = |error: &dyn Display| SolverError(format!("{}: {error}", design.name));
        let matrices = Matrices::of(design).map_err(|error| wrong(&error))?;
        let filter = &design.algorithm.filter;
        match design.algorithm.plan {
            PlanKind::Paper => {
                FilteredMatrices::new(&matrices, filter).map(|filtered| Self::from_parts(design, matrices, filtered))
            }
            PlanKind::Reduced => ReducedMatrices::new(&matrices, matrices.orbits(), filter).map(|reduced| {
                let field = design.algorithm.outputs == Outputs::Field || design.algorithm.contacts > 1;
                let list = ProductList::paper().fewer_products(field).folded();
                let orbits = *matrices.orbits();
                let engine = Engine::new(list, reduced, orbits.all(), orbits.taxels());
                Self::with(design, matrices, Products::Reduced(Box::new(OfPlan { engine, blocks: OnceLock::new() })))
            }),
        }
        .map_err(|error| wrong(&error))
    }

    /// A solver by the paper's plan from matrices already computed for the same design, whatever plan that names.
    pub fn from_parts(design: &Design, matrices: Matrices, filtered: FilteredMatrices) -> Self {
        let taxels = matrices.orbits().taxels();
        let stored = PaperMatrices::new(&matrices, filtered);
        let images = (0..taxels).map(|taxel| [taxel]).collect();
        let engine = Engine::new(ProductList::paper(), stored, images, taxels);
        Self::with(design, matrices, Products::Paper(Box::new(OfPlan { engine, blocks: OnceLock::new() })))
    }

    fn with(design: &Design, matrices: Matrices, products: Products) -> Self {
        let estimators = Estimators {
            friction: Friction::new(design.algorithm.constants(), &design.sensor),
            confidence: Confidence::of(design),
        };
        let contacts = design.algorithm.contacts;
        let finder = (contacts > 1 || design.algorithm.count_contacts).then(|| Finder::new(&design.sensor, contacts));
        let (reader, slip) = (Reader::new(design), design.algorithm.slip);
        let max_standard_error = design.algorithm.max_standard_error;
        // By the paper's plan every solution has them.
        let keeps_field = design.algorithm.outputs == Outputs::Field || matches!(products, Products::Paper(_));
        Self { reader, matrices, products, estimators, finder, keeps_field, max_standard_error, slip }
    }

    /// The unfiltered matrices.
    pub fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// The matrices the solver uses, with the paper's plan.
    pub fn filtered(&self) -> Option<&FilteredMatrices> {
        match &self.products {
            Products::Paper(paper) => Some(&paper.engine.stored().filtered),
            Products::Reduced(_) => None,
        }
    }

    /// The matrices the solver uses, with the reduced plan.
    pub fn reduced(&self) -> Option<&ReducedMatrices> {
        match &self.products {
            Products::Paper(_) => None,
            Products::Reduced(reduced) => Some(reduced.engine.stored()),
        }
    }

    /// Number of values in a frame.
    pub fn taxels(&self) -> usize {
        self.reader.taxels()
    }

    /// Solves one frame of values in taxel order, stresses in pascals or the counts that the design's input says. No frame is
    /// before it: nothing has crept, and nothing is averaged.
    ///
    /// # Errors
    ///
    /// A frame of another length only. A frame with a NaN, without contact or without a direction gets a status.
    pub fn solve(&self, frame: &[f64]) -> Result<Solution, SolverError> {
        let mut solution = Solution::zeros(Status::default(), 0);
        self.solve_into(&mut self.workspace(), frame, &mut solution)?;
        Ok(solution)
    }

    /// Solves frames that follow each other, as [`Solver::solve_into`] does.
    ///
    /// # Errors
    ///
    /// As [`Solver::solve`], for any of the frames.
    pub fn solve_in_order<F: AsRef<[f64]>>(
        &self,
        frames: impl IntoIterator<Item = F>,
    ) -> Result<Vec<Solution>, SolverError> {
        let mut workspace = self.workspace();
        let mut solve = |frame: F| {
            let mut solution = Solution::zeros(Status::default(), 0);
            self.solve_into(&mut workspace, frame.as_ref(), &mut solution).map(|()| solution)
        };
        frames.into_iter().map(&mut solve).collect()
    }

    /// Records of contacts in each solution: the design's `contacts`, or 0 where that is 1.
    pub fn records(&self) -> usize {
        self.finder.as_ref().map_or(0, Finder::records)
    }

    /// Number of forces along each axis in a solution's field: m, or 0 where the design asks the reduced plan for resultants
    /// only.
    pub fn field_length(&self) -> usize {
        if self.keeps_field { self.solved_length() } else { 0 }
    }

    /// The same while a frame is solved: several contacts are separated by their field, whatever the design asks for.
    fn solved_length(&self) -> usize {
        match &self.products {
            Products::Reduced(reduced) if !reduced.engine.list.has_forces() => 0,
            _ => self.taxels(),
        }
    }
}
