//! Frames of several bodies: each solved as a frame of its own, see [`crate::bodies`].

use nalgebra::DVector;

use super::{Solution, Solver, Status, Workspace, op};
use crate::bodies::{Body, Found};
use crate::matrices::{Matrices, MatrixName};

/// Times that the bodies are solved: first with the forces parted that are found as if there were one body, then with those
/// that the bodies were found to have. More rounds change next to nothing.
const ROUNDS: usize = 2;

/// What is not known of the other bodies, in a body's standard error: so many times what the last round has changed of its
/// force, and the others' normal forces, each over `1 + (d / REACH)^4` for a distance of so many of the coarser pitch between
/// the centres. Of 5,256 bodies in frames of eighteen kinds, by likelihood (`docs/explanation/accuracy.md`).
pub const CHANGE: f64 = 1.25;
/// See [`CHANGE`].
pub const REACH: f64 = 2.0;

/// The bodies of a frame, to be used again for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Parted {
    found: Found,
    /// What presses on each taxel, in newtons.
    weight: Vec<f64>,
    /// Forces `f_x, f_y, f_z` of each taxel that are parted, in newtons without the estimator's gain.
    forces: [Vec<f64>; 3],
    /// `(F_x, F_y)` of each body in the round before, in newtons.
    before: Vec<[f64; 2]>,
    /// What the last round has changed of that.
    changed: Vec<f64>,
    /// What one of the bodies is found to do.
    alone: Option<Box<Solution>>,
}

/// What is to be known of a frame's bodies before they are solved.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Census {
    /// Bodies that there are,
    bodies: usize,
    /// those that have a region,
    regions: usize,
    /// and the taxels that the first one touches.
    taxels: usize,
}

impl Census {
    /// Whether the frame has to be parted.
    pub(super) fn has_several(self) -> bool {
        self.regions > 1
    }
}

impl Solver {
    /// Finds the contacts in the stress `b` (Pa) as connected components of the weights `|w|` (N); none for a design that does
    /// not ask.
    ///
    /// The hardware counts by the same rule.
    pub(super) fn part(&self, b: &DVector<f64>, parted: &mut Parted) -> Census {
        let Some(finder) = &self.finder else { return Census::default() };
        let Parted { found, weight, .. } = parted;
        let normal = &*self.matrices.folded(MatrixName::C33inv) * b;
        weight.clear();
        weight.extend(normal.iter().map(|force| (-force).max(0.0)));
        if finder.records() == 0 {
            finder.count(weight, found);
            return Census { bodies: found.bodies, ..Census::default() };
        }
        finder.find(weight, found);
        let taxels = found.taxels.first().copied().unwrap_or(0);
        Census { bodies: found.bodies, regions: found.taxels.len(), taxels }
    }

    /// Finds the forces of each body, by the frame that it would cause alone, and their sums. The solution is that of the frame
    /// as if there were one body; `status` is what was to be said before it was solved.
    pub(super) fn solve_bodies(&self, workspace: &mut Workspace, mut status: Status, solution: &mut Solution) {
        // That nothing pulls is a matter of the frame, and of the friction that it has as a whole.
        if !solution.status.contains(Status::NO_TENSION) {
            status.remove(Status::NO_TENSION);
        }
        let nothing = || Box::new(Solution::zeros(Status::default(), 0));
        let mut alone = workspace.parted.alone.take().unwrap_or_else(nothing);
        let whole = workspace.b.clone();
        let bodies = workspace.parted.found.taxels.len();
        std::mem::swap(&mut workspace.parted.forces, &mut solution.field);
        solution.reset(status, self.solved_length());
        let status = Body::bits_of(status);
        workspace.parted.before.clear();
        workspace.parted.before.resize(bodies, [0.0; 2]);
        workspace.parted.changed.clear();
        for round in 1..=ROUNDS {
            let parts = self.frames_alone(&workspace.parted, &whole);
            workspace.parted.forces.iter_mut().for_each(|component| component.fill(0.0));
            for (body, part) in parts.into_iter().enumerate() {
                workspace.b = part;
                let contact = self.reader.analyse(&workspace.b);
                alone.reset(status, self.solved_length());
                self.solve_alone(workspace, contact, &mut alone);
                let all = workspace.parted.forces.iter_mut().flatten();
                all.zip(alone.field.iter().flatten()).for_each(|(all, force)| *all += force);
                let [x, y, _] = alone.resultant;
                let [before_x, before_y] = std::mem::replace(&mut workspace.parted.before[body], [x, y]);
                if round == ROUNDS {
                    workspace.parted.changed.push((x - before_x).hypot(y - before_y));
                    solution.records.push(self.body(workspace.parted.found.taxels[body], &alone));
                    solution.add(&alone);
                }
            }
        }
        workspace.b = whole;
        workspace.parted.alone = Some(alone);
        self.widen_standard_errors(&workspace.parted.changed, solution);
        solution.sum_up();
        Body::largest_first(&mut solution.records);
    }

    /// Makes the standard errors of several bodies larger by what is not known of the others, which the estimator, that sees
    /// one at a time, does not know of; `changed` is what the last round has changed of each, in newtons. An estimator without a
    /// standard error has none here either.
    fn widen_standard_errors(&self, changed: &[f64], solution: &mut Solution) {
        let [x, y] = self.matrices.sensor().pitch_mm;
        let reach = 1e-3 * REACH * x.max(y);
        let bodies = solution.records.clone();
        for ((index, body), changed) in solution.records.iter_mut().enumerate().zip(changed) {
            if body.standard_error <= 0.0 {
                continue;
            }
            let others = bodies.iter().enumerate().filter(|&(other, _)| other != index).map(|(_, other)| other);
            let felt: f64 = others
                .map(|other| {
                    let [x, y] = [0, 1].map(|axis| other.centre_m[axis] - body.centre_m[axis]);
                    let near = (x * x + y * y) / (reach * reach);
                    other.force[2].abs() / (1.0 + near * near)
                })
                .sum();
            body.standard_error = body.standard_error.hypot(CHANGE * changed).hypot(felt);
            if body.standard_error > self.max_standard_error * body.force[2].abs() {
                body.status.insert(Status::LOW_CONFIDENCE);
            }
        }
        // Errors of bodies are independent.
        solution.standard_error = solution.records.iter().fold(0.0, |all, body| body.standard_error.hypot(all));
    }

    /// The frame that each body would cause alone, in pascals: the stress of the forces in its region, and what a filter has
    /// them leave of the frame there. They add up to the whole one, but where the sensor reads no tension: there what pulls
    /// is nothing in these frames either.
    fn frames_alone(&self, parted: &Parted, whole: &DVector<f64>) -> Vec<DVector<f64>> {
        let Parted { found, forces, .. } = parted;
        let Matrices { c31, c32, c33, .. } = &self.matrices;
        let frame = |body: usize| {
            let [x, y, z] = forces.each_ref().map(|component| {
                let own = component.iter().zip(&found.regions);
                let own = own.map(|(&force, &of)| if of == Some(body) { force } else { 0.0 });
                DVector::from_iterator(component.len(), own)
            });
            c31 * &x + c32 * &y + c33 * &z
        };
        let mut parts: Vec<DVector<f64>> = (0..found.taxels.len()).map(frame).collect();
        // Without a filter it is rounding.
        let left = parts.iter().fold(whole.clone(), |left, part| left - part);
        for (taxel, (&left, &body)) in left.iter().zip(&found.regions).enumerate() {
            if let Some(body) = body {
                parts[body][taxel] += left;
            }
        }
        if !self.reader.reads_tension() {
            for part in &mut parts {
                part.apply(|stress| *stress = stress.min(0.0));
            }
        }
        parts
    }

    /// The record of the body that a solution is of.
    fn body(&self, taxels: usize, solution: &Solution) -> Body {
        let Solution { status, resultant, torque, mu, standard_error, .. } = solution;
        Body {
            taxels,
            status: Body::bits_of(*status),
            centre_m: Body::centre_of(self.matrices.sensor(), *resultant, *torque),
            force: *resultant,
            torque: *torque,
            mu: *mu,
            standard_error: *standard_error,
        }
    }

    /// Puts the number of bodies and their records in place, where the design asks for them; that of a single body is what
    /// the frame is.
    pub(super) fn note_body(&self, census: Census, solution: &mut Solution) {
        let Some(finder) = &self.finder else { return };
        if solution.bodies > 0 {
            if finder.records() > 0 && solution.records.is_empty() {
                solution.records.push(self.body(census.taxels, solution));
            }
            solution.bodies = census.bodies.max(1);
            if census.bodies > 1 {
                solution.status.insert(Status::SEVERAL_CONTACTS);
            }
        }
        solution.records.resize(finder.records(), Body::default());
    }
}

impl Solution {
    /// Adds what another body does.
    fn add(&mut self, other: &Self) {
        let sums = self.resultant.iter_mut().chain(&mut self.torque).chain(self.field.iter_mut().flatten());
        let parts = other.resultant.iter().chain(&other.torque).chain(other.field.iter().flatten());
        sums.zip(parts).for_each(|(sum, part)| *sum += part);
        self.bodies += 1;
    }

    /// What follows from the sums over several bodies: friction and direction of the whole force, and the bits of all
    /// bodies.
    fn sum_up(&mut self) {
        let [x, y, z] = self.resultant;
        (self.mu, self.phi) = (op::quotient(self.resultant), y.atan2(x));
        [self.mu_x, self.mu_y] = [x, y].map(|force| if z == 0.0 { 0.0 } else { force / z.abs() });
        self.status.remove(Body::bits_of(self.status));
        self.records.iter().for_each(|body| self.status.insert(body.status));
    }
}
