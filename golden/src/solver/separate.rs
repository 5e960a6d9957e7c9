//! Frames of several contacts: each is solved as a frame of its own, see [`crate::contacts`].

use nalgebra::DVector;

use super::{Solution, Solver, Status, quotient};
use crate::contacts::{ContactForces, Regions};
use crate::estimators::Contact;
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

/// Memory for frames of several contacts, to be used again for others.
#[derive(Clone, Debug, Default)]
pub(super) struct Separations {
    /// Of each frame that is to be separated, the first `used`.
    frames: Vec<Separation>,
    used: usize,
    /// The frames that their contacts would cause alone, in pascals, one after the other, and what they have.
    parts: Vec<(DVector<f64>, Contact)>,
    /// The solutions of those.
    alone: Vec<Solution>,
    /// What presses on each taxel, in newtons.
    weight: Vec<f64>,
    /// The part of a frame that no forces explain.
    unexplained: DVector<f64>,
    /// A folded vector, and a folded product.
    folded: [[Vec<f64>; COMPONENTS]; 2],
}

/// A frame of several contacts.
#[derive(Clone, Debug, Default)]
struct Separation {
    /// Place of its solution among those of the frames that are solved together.
    index: usize,
    /// Bits that each of its contacts has.
    status: Status,
    /// Of a frame's noise, left in it and in the frames of its contacts.
    noise_left: f64,
    /// Its stress, in pascals.
    whole: DVector<f64>,
    found: Regions,
    /// Forces `f_x, f_y, f_z` of each taxel that are separated, in newtons without the estimator's gain.
    forces: [Vec<f64>; 3],
    /// `(F_x, F_y)` of each contact in the round before, in newtons.
    before: Vec<[f64; 2]>,
    /// Change of that in the last round, in newtons.
    changed: Vec<f64>,
}

impl Separations {
    /// Begins with frames that are solved together.
    pub(super) fn clear(&mut self) {
        self.used = 0;
    }
}

/// Numbers of contacts in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counted {
    /// All contacts.
    contacts: usize,
    /// Taxels that the first one touches.
    taxels: usize,
}

impl Solver {
    /// Finds the contacts in the stress `b` (Pa) as connected components of the weights `|w|` (N); none for a design that does
    /// not ask. A frame that has several is noted, to be separated.
    ///
    /// `solution` is that of the frame as one contact, at `index` among those solved together; `status` the frame's before
    /// it was solved, and `noise_left` as of [`Contact`]. The hardware counts by the same rule.
    pub(super) fn count_contacts(
        &self,
        separations: &mut Separations,
        (b, mut status, noise_left): (&DVector<f64>, Status, f64),
        (index, solution): (usize, &mut Solution),
    ) -> Counted {
        let Some(finder) = &self.finder else { return Counted::default() };
        let Separations { frames, used, weight, .. } = separations;
        let normal = &*self.matrices.folded(MatrixName::C33inv) * b;
        weight.clear();
        weight.extend(normal.iter().map(|force| (-force).max(0.0)));
        if *used == frames.len() {
            frames.push(Separation::default());
        }
        let separation = &mut frames[*used];
        let found = &mut separation.found;
        if finder.records() == 0 {
            finder.count(weight, found);
            return Counted { contacts: found.contacts, ..Counted::default() };
        }
        finder.find(weight, found);
        let taxels = found.taxels.first().copied().unwrap_or(0);
        let counted = Counted { contacts: found.contacts, taxels };
        if found.taxels.len() > 1 {
            *used += 1;
            separation.before.clear();
            separation.before.resize(found.taxels.len(), [0.0; 2]);
            separation.changed.clear();
            separation.whole.clone_from(b);
            std::mem::swap(&mut separation.forces, &mut solution.field);
            // Tension is judged of the whole frame, at the friction of all its contacts.
            if !solution.status.contains(Status::NO_TENSION) {
                status.remove(Status::NO_TENSION);
            }
            solution.reset(status, self.solved_length());
            (separation.index, separation.status) = (index, ContactForces::bits_of(status));
            separation.noise_left = noise_left;
        }
        counted
    }

    /// Finds the forces of each contact of the frames that were noted, from the frame that it would cause alone, and their
    /// sums.
    ///
    /// `solve` solves frames of one contact each.
    pub(super) fn separate(
        &self,
        separations: &mut Separations,
        solutions: &mut [Solution],
        mut solve: impl FnMut(&[(DVector<f64>, Contact)], &mut [Solution]),
    ) {
        for round in 1..=ROUNDS {
            let contacts = self.find_parts(separations);
            solve(&separations.parts[..contacts], &mut separations.alone[..contacts]);
            let mut alone = separations.alone.iter();
            for separation in &mut separations.frames[..separations.used] {
                let Separation { index, found, forces, before, changed, .. } = separation;
                let solution = &mut solutions[*index];
                for component in &mut *forces {
                    component.fill(0.0);
                }
                for ((&taxels, before), alone) in found.taxels.iter().zip(before).zip(alone.by_ref()) {
                    let all = forces.iter_mut().flatten();
                    all.zip(alone.field.iter().flatten()).for_each(|(all, force)| *all += force);
                    let [x, y, _] = alone.resultant;
                    let [before_x, before_y] = std::mem::replace(before, [x, y]);
                    if round == ROUNDS {
                        changed.push((x - before_x).hypot(y - before_y));
                        solution.records.push(self.record(taxels, alone));
                        solution.add(alone);
                    }
                }
            }
        }
        for Separation { index, changed, .. } in &separations.frames[..separations.used] {
            let solution = &mut solutions[*index];
            self.widen_standard_errors(changed, solution);
            solution.sum_up();
            ContactForces::largest_first(&mut solution.records);
        }
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

    /// Finds the frames that the contacts of all frames would cause alone: the stress of the forces in their regions, and the
    /// part of the frame there that no forces explain. Returns their number.
    ///
    /// They add up to the whole frame. Of a sensor that reads no tension their tension is 0.
    fn find_parts(&self, separations: &mut Separations) -> usize {
        let Separations { frames, used, parts, alone, unexplained, folded: [folded, product], .. } = separations;
        let Matrices { c31, c32, c33, .. } = &self.matrices;
        let orbits = self.matrices.orbits();
        let mut first = 0;
        for &Separation { ref whole, ref found, ref forces, status, noise_left, .. } in &frames[..*used] {
            let contacts = found.taxels.len();
            if parts.len() < first + contacts {
                parts.resize_with(first + contacts, || (whole.clone(), Contact::default()));
                alone.resize_with(first + contacts, || Solution::zeros(Status::default(), 0));
            }
            let parts = &mut parts[first..first + contacts];
            unexplained.clone_from(whole);
            for (contact, (part, _)) in parts.iter_mut().enumerate() {
                for component in &mut *product {
                    component.clear();
                    component.resize(orbits.count(), 0.0);
                }
                for (matrix, forces) in [c31, c32, c33].into_iter().zip(forces) {
                    let own = |taxel: usize| if found.regions[taxel] == Some(contact) { forces[taxel] } else { 0.0 };
                    orbits.fold_into(folded, own);
                    matrix.add_to(product, folded);
                }
                orbits.unfold_into(product, part.as_mut_slice());
                *unexplained -= &*part;
            }
            // Without a filter, which makes forces inexact, this is rounding.
            for (taxel, (&stress, &contact)) in unexplained.iter().zip(&found.regions).enumerate() {
                if let Some(contact) = contact {
                    parts[contact].0[taxel] += stress;
                }
            }
            for ((part, contact), alone) in parts.iter_mut().zip(&mut alone[first..]) {
                if !self.reader.reads_tension() {
                    part.apply(|stress| *stress = stress.min(0.0));
                }
                *contact = Contact { noise_left, ..self.reader.analyse(part) };
                alone.reset(status, self.solved_length());
            }
            first += contacts;
        }
        first
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
