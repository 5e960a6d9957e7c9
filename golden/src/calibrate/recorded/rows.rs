//! The normal force as a weighted sum of the stress.
//!
//! With the friction found, and as long as no taxel changes from pressed to pulled, `F_z` is linear in the stress:
//! `F_z = sum over k of q_k y_k` with `y = C33inv b`, and from Eqs. 11 to 16 of Pinto-Salamanca et al., Sensors 2024,
//! `q_k = 1 - mu_x s31_k - mu_y s32_k` where `y_k` presses and `-s30_k` where it pulls, `s3q` being the column sums of
//! D3q. So `F_z = J b` with `J = C33inv q`, C33 being its own transpose; gains and curves that change the stress by little
//! change `F_z` by J times that.

use nalgebra::DVector;

use crate::crosstalk::Crosstalk;
use crate::dead_taxels::DeadTaxels;
use crate::design::{Design, Outputs, PlanKind};
use crate::names::MatrixName;
use crate::numbers::magnitude;
use crate::parity::FoldedMatrix;
use crate::solver::{Solution, Solver, SolverError, Status, Workspace};

/// Largest stress of a frame as it is solved, and the noise floor then: all is homogeneous.
const PEAK: f64 = 65_536.0;

/// The solver of a design for frames in pascals of any size.
pub(super) struct Rows {
    solver: Solver,
    workspace: Workspace,
    solution: Solution,
    dead: DeadTaxels,
    crosstalk: Option<Crosstalk>,
    c33inv: FoldedMatrix,
    /// Column sums of D30, D31, D32.
    sums: [Vec<f64>; 3],
}

impl Rows {
    pub(super) fn new(design: &Design) -> Result<Self, SolverError> {
        let mut design = design.clone();
        design.input = design.input.of_pascals();
        design.hardware.full_scale_pa = 1e3 * PEAK;
        design.algorithm.noise_floor_pa = 1.0;
        if design.algorithm.plan == PlanKind::Reduced {
            design.algorithm.outputs = Outputs::Resultants;
        }
        let solver = Solver::new(&design)?;
        let matrices = solver.matrices();
        let c33inv = matrices.folded(MatrixName::C33inv).into_owned();
        let sums = [MatrixName::D30, MatrixName::D31, MatrixName::D32].map(|name| {
            let matrix = matrices.dense(name);
            matrix.column_iter().map(|column| column.sum()).collect()
        });
        let dead = DeadTaxels::new(&design.sensor, design.algorithm.kernel, &design.input.dead);
        Ok(Self {
            workspace: solver.workspace(),
            solution: Solution::zeros(Status::default(), 0),
            solver,
            dead,
            crosstalk: design.crosstalk(),
            c33inv,
            sums,
        })
    }

    /// The forces `[F_x, F_y, F_z]` of stress that presses, in pascals; nothing of a frame without contact.
    pub(super) fn solve(&mut self, pressing: &[f64]) -> Option<[f64; 3]> {
        let peak = magnitude(pressing);
        if peak <= 0.0 || !peak.is_finite() {
            return None;
        }
        let frame: Vec<f64> = pressing.iter().map(|stress| -stress * PEAK / peak).collect();
        self.solver.solve_into(&mut self.workspace, &frame, &mut self.solution).ok()?;
        if self.solution.status.contains(Status::NO_CONTACT) {
            return None;
        }
        Some(self.solution.resultant.map(|force| force * peak / PEAK))
    }

    /// What each taxel's stress weighs in the normal force.
    ///
    /// Newtons that press for a pascal that presses; nothing of a frame that no contact makes.
    pub(super) fn row(&mut self, pressing: &[f64]) -> Option<Vec<f64>> {
        let [_, _, fz] = self.solve(pressing)?;
        let [mu_x, mu_y] = [self.solution.mu_x, self.solution.mu_y];
        let mut stress: Vec<f64> = pressing.iter().map(|stress| -stress).collect();
        self.dead.replace(&mut stress);
        let read = stress.clone();
        if let Some(crosstalk) = &self.crosstalk {
            crosstalk.remove(&mut stress);
        }
        let y = &self.c33inv * &DVector::from_vec(stress);
        let [s30, s31, s32] = &self.sums;
        let q = y.iter().enumerate().map(|(k, &y)| if y < 0.0 { 1.0 - mu_x * s31[k] - mu_y * s32[k] } else { -s30[k] });
        let q = DVector::from_iterator(y.len(), q);
        let mut weights = (&self.c33inv * &q).as_slice().to_vec();
        // What removes crosstalk is its own transpose.
        if let Some(crosstalk) = &self.crosstalk {
            crosstalk.remove(&mut weights);
        }
        // Gain of the estimator, and what a filter changes, are in the force that the solver finds.
        let linear: f64 = weights.iter().zip(&read).map(|(weight, stress)| weight * stress).sum();
        let factor = fz / linear;
        if !factor.is_finite() || fz >= 0.0 {
            return None;
        }
        for weight in &mut weights {
            *weight *= factor;
        }
        // What stands for a dead taxel is the others' stress.
        for (&taxel, of) in self.dead.taxels().iter().zip(self.dead.weights()) {
            let weight = std::mem::take(&mut weights[taxel]);
            weights.iter_mut().zip(of).for_each(|(total, share)| *total += weight * share);
        }
        Some(weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_are_the_derivative_of_the_normal_force() {
        let text = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
            name = \"pad\"\n[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\ndead = [14]\n\
                    [algorithm]\nestimator = \"joint\"\ngain = 1.1\nfriction_correction = [1, 0]\n";
        let design = Design::from_toml(text, "pad.toml").expect("a design");
        let mut rows = Rows::new(&design).expect("matrices");
        let pressing: Vec<f64> = (0..30)
            .map(|i| {
                let (x, y) = (f64::from(i % 6) - 2.3, f64::from(i / 6) - 1.8);
                9e3 * (-(x * x + y * y) / 2.5).exp() * (1.0 + 0.3 * x)
            })
            .collect();
        let weights = rows.row(&pressing).expect("a contact");
        let [_, _, fz] = rows.solve(&pressing).expect("a contact");
        let load = -fz;
        let sum: f64 = weights.iter().zip(&pressing).map(|(weight, stress)| weight * stress).sum();
        assert!((sum / load - 1.0).abs() < 1e-12, "{sum} {load}");
        assert!(weights[14] == 0.0, "a dead taxel");
        let found = Solver::new(&design).expect("matrices");
        let frame: Vec<f64> = pressing.iter().map(|stress| -stress).collect();
        let fz = found.solve(&frame).expect("a frame").resultant[2];
        assert!((fz + load).abs() < 1e-3 * load, "{fz} {load}");
        for taxel in [7, 13, 20] {
            let mut more = pressing.clone();
            more[taxel] *= 1.01;
            let step = -rows.solve(&more).expect("a contact")[2] - load;
            let told = weights[taxel] * 0.01 * pressing[taxel];
            assert!((step - told).abs() < 0.1 * told.abs() + 1e-5 * load, "{taxel}: {step} {told}");
        }
    }
}
