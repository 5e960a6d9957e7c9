//! Frames of several contacts: each is solved as a frame of its own, see [`crate::contacts`].

use nalgebra::DVector;

use super::{Solution, Solver, Status, Workspace, quotient};
use crate::contacts::{ContactForces, Found};
use crate::matrices::{Matrices, MatrixName};
use crate::parity::COMPONENTS;

/// Rounds of separation: by the forces of the frame as one contact, then by the forces of the separated contacts. More rounds
/// change next to nothing.
const ROUNDS: usize = 2;

/// Standard error of a contact due to the other ones: this times the change of its force in the last round, and the normal
/// forces of the others, each over `1 + (d / REACH)^4` at a distance of d of the coarser pitch.
///
/// Fitted by likelihood to 5,256 contacts in frames of eighteen kinds (`docs/explanation/accuracy.md`).
pub const CHANGE: f64 = 1.25;
/// See [`CHANGE`].
pub const REACH: f64 = 2.0;

/// The contacts of a frame, to be used again for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Separation {
    found: Found,
    /// What presses on each taxel, in newtons.
    weight: Vec<f64>,
    /// Forces `f_x, f_y, f_z` of each taxel that are separated, in newtons without the estimator's gain.
    forces: [Vec<f64>; 3],
    /// `(F_x, F_y)` of each contact in the round before, in newtons.
    before: Vec<[f64; 2]>,
    /// Change of that in the last round, in newtons.
    changed: Vec<f64>,
    /// The frame that each contact would cause alone, in pascals.
    frames: Vec<DVector<f64>>,
    /// The part of the frame that no forces explain.
    unexplained: DVector<f64>,
    /// A folded vector, and a folded product.
    folded: [[Vec<f64>; COMPONENTS]; 2],
    /// The solution of one contact.
    alone: Option<Box<Solution>>,
}

/// Numbers of contacts in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counted {
    /// All contacts.
    contacts: usize,
    /// Those that have a region.
    regions: usize,
    /// Taxels that the first one touches.
    taxels: usize,
}

impl Counted {
    /// Whether the frame has contacts to separate.
    pub(super) fn has_several(self) -> bool {
        self.regions > 1
    }
}

impl Solver {
    /// Finds the contacts in the stress `b` (Pa) as connected components of the weights `|w|` (N); none for a design that does
    /// not ask.
    ///
    /// The hardware counts by the same rule.
    pub(super) fn count_contacts(&self, b: &DVector<f64>, separation: &mut Separation) -> Counted {
        let Some(finder) = &self.finder else { return Counted::default() };
        let Separation { found, weight, .. } = separation;
        let normal = &*self.matrices.folded(MatrixName::C33inv) * b;
        weight.clear();
        weight.extend(normal.iter().map(|force| (-force).max(0.0)));
        if finder.records() == 0 {
            finder.count(weight, found);
            return Counted { contacts: found.contacts, ..Counted::default() };
        }
        finder.find(weight, found);
        let taxels = found.taxels.first().copied().unwrap_or(0);
        Counted { contacts: found.contacts, regions: found.taxels.len(), taxels }
    }

    /// Finds the forces of each contact, from the frame that it would cause alone, and their sums.
    ///
    /// `solution` is that of the frame as one contact, `status` the frame's before it was solved.
    pub(super) fn solve_contacts(&self, workspace: &mut Workspace, mut status: Status, solution: &mut Solution) {
        // Tension is judged of the whole frame, at the friction of all its contacts.
        if !solution.status.contains(Status::NO_TENSION) {
            status.remove(Status::NO_TENSION);
        }
        let nothing = || Box::new(Solution::zeros(Status::default(), 0));
        let mut alone = workspace.separation.alone.take().unwrap_or_else(nothing);
        let whole = workspace.b.clone();
        let contacts = workspace.separation.found.taxels.len();
        std::mem::swap(&mut workspace.separation.forces, &mut solution.field);
        solution.reset(status, self.solved_length());
        let status = ContactForces::bits_of(status);
        workspace.separation.before.clear();
        workspace.separation.before.resize(contacts, [0.0; 2]);
        workspace.separation.changed.clear();
        for round in 1..=ROUNDS {
            self.find_frames(&mut workspace.separation, &whole);
            workspace.separation.forces.iter_mut().for_each(|component| component.fill(0.0));
            for number in 0..contacts {
                workspace.b.copy_from(&workspace.separation.frames[number]);
                let contact = self.reader.analyse(&workspace.b);
                alone.reset(status, self.solved_length());
                self.solve_alone(workspace, contact, &mut alone);
                let all = workspace.separation.forces.iter_mut().flatten();
                all.zip(alone.field.iter().flatten()).for_each(|(all, force)| *all += force);
                let [x, y, _] = alone.resultant;
                let [before_x, before_y] = std::mem::replace(&mut workspace.separation.before[number], [x, y]);
                if round == ROUNDS {
                    workspace.separation.changed.push((x - before_x).hypot(y - before_y));
                    solution.records.push(self.record(workspace.separation.found.taxels[number], &alone));
                    solution.add(&alone);
                }
            }
        }
        workspace.b = whole;
        workspace.separation.alone = Some(alone);
        self.widen_standard_errors(&workspace.separation.changed, solution);
        solution.sum_up();
        ContactForces::largest_first(&mut solution.records);
    }

    /// Adds to the standard error of each contact that due to the other ones, see [`CHANGE`]: the estimator sees one at a time.
    ///
    /// `changed` is the change of each in the last round, in newtons. A standard error of 0 stays, as of an estimator without.
    fn widen_standard_errors(&self, changed: &[f64], solution: &mut Solution) {
        let [x, y] = self.matrices.sensor().pitch_mm;
        let reach = 1e-3 * REACH * x.max(y);
        let contacts = solution.records.clone();
        for ((index, contact), changed) in solution.records.iter_mut().enumerate().zip(changed) {
            if contact.standard_error <= 0.0 {
                continue;
            }
            let others = contacts.iter().enumerate().filter(|&(other, _)| other != index).map(|(_, other)| other);
            let felt: f64 = others
                .map(|other| {
                    let [x, y] = [0, 1].map(|axis| other.centre_m[axis] - contact.centre_m[axis]);
                    let near = (x * x + y * y) / (reach * reach);
                    other.force[2].abs() / (1.0 + near * near)
                })
                .sum();
            contact.standard_error = contact.standard_error.hypot(CHANGE * changed).hypot(felt);
            if contact.standard_error > self.max_standard_error * contact.force[2].abs() {
                contact.status.insert(Status::LOW_CONFIDENCE);
            }
        }
        // Errors of contacts are independent.
        solution.standard_error = solution.records.iter().fold(0.0, |all, contact| contact.standard_error.hypot(all));
    }

    /// Finds the frame that each contact would cause alone: the stress of the forces in its region, and the part of the frame
    /// there that no forces explain.
    ///
    /// They add up to the whole frame. Of a sensor that reads no tension their tension is 0.
    fn find_frames(&self, separation: &mut Separation, whole: &DVector<f64>) {
        let Separation { found, forces, frames, unexplained, folded: [folded, product], .. } = separation;
        let Matrices { c31, c32, c33, .. } = &self.matrices;
        let orbits = self.matrices.orbits();
        frames.resize_with(found.taxels.len(), || whole.clone());
        unexplained.clone_from(whole);
        for (contact, frame) in frames.iter_mut().enumerate() {
            for component in &mut *product {
                component.clear();
                component.resize(orbits.count(), 0.0);
            }
            for (matrix, forces) in [c31, c32, c33].into_iter().zip(&*forces) {
                let own = |taxel: usize| if found.regions[taxel] == Some(contact) { forces[taxel] } else { 0.0 };
                orbits.fold_into(folded, own);
                matrix.add_to(product, folded);
            }
            orbits.unfold_into(product, frame.as_mut_slice());
            *unexplained -= &*frame;
        }
        // Without a filter, which makes forces inexact, this is rounding.
        for (taxel, (&stress, &contact)) in unexplained.iter().zip(&found.regions).enumerate() {
            if let Some(contact) = contact {
                frames[contact][taxel] += stress;
            }
        }
        if !self.reader.reads_tension() {
            for frame in frames {
                frame.apply(|stress| *stress = stress.min(0.0));
            }
        }
    }

    /// The record of the contact that a solution is of.
    fn record(&self, taxels: usize, solution: &Solution) -> ContactForces {
        let Solution { status, resultant, torque, mu, standard_error, .. } = solution;
        ContactForces {
            taxels,
            status: ContactForces::bits_of(*status),
            centre_m: ContactForces::centre_of(self.matrices.sensor(), *resultant, *torque),
            force: *resultant,
            torque: *torque,
            mu: *mu,
            standard_error: *standard_error,
        }
    }

    /// Sets the number of contacts and their records, where the design asks for them. The record of a single contact is that
    /// of the frame.
    pub(super) fn note_contacts(&self, counted: Counted, solution: &mut Solution) {
        let Some(finder) = &self.finder else { return };
        if solution.contacts > 0 {
            if finder.records() > 0 && solution.records.is_empty() {
                solution.records.push(self.record(counted.taxels, solution));
            }
            solution.contacts = counted.contacts.max(1);
            if counted.contacts > 1 {
                solution.status.insert(Status::SEVERAL_CONTACTS);
            }
        }
        solution.records.resize(finder.records(), ContactForces::default());
    }
}

impl Solution {
    /// Adds the forces of another contact.
    fn add(&mut self, other: &Self) {
        let sums = self.resultant.iter_mut().chain(&mut self.torque).chain(self.field.iter_mut().flatten());
        let parts = other.resultant.iter().chain(&other.torque).chain(other.field.iter().flatten());
        sums.zip(parts).for_each(|(sum, part)| *sum += part);
        self.contacts += 1;
    }

    /// Sets what follows from the sums over several contacts: friction, direction, and the status bits of all.
    fn sum_up(&mut self) {
        let [x, y, z] = self.resultant;
        (self.mu, self.phi) = (quotient(self.resultant), y.atan2(x));
        [self.mu_x, self.mu_y] = [x, y].map(|force| if z == 0.0 { 0.0 } else { force / z.abs() });
        self.status.remove(ContactForces::bits_of(self.status));
        self.records.iter().for_each(|contact| self.status.insert(contact.status));
    }
}
