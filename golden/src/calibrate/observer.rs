//! One frame as the estimator of a design sees it, before it is calibrated.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::CalibrateError;
use crate::design::{Design, Sensor, Tension};
use crate::estimators::joint::{self, Features, JointScratch, TrainingSet};
use crate::numbers::magnitude;
use crate::products::ByPq;
use crate::scene::normal;
use crate::smoothing::noise_left;
use crate::solver::{Solver, Status, Workspace};

/// Most noise of a frame over the design's: a network that was trained with no more is less exact at what the design says.
const MOST_NOISE: f64 = 1.5;
/// Share of frames with the whole noise where averages have less: a restart leaves all of it. On sensor 1 at 1 % and
/// `smoothing = 4` averages have a median error of 1.5 %, and single frames 6 %; 10 % with a share of 0. With a half,
/// averages have 0.1 points more.
const SINGLE: f64 = 0.25;

/// One frame as the calibration needs it.
pub(super) struct Sample {
    /// Estimate before the calibration.
    pub(super) mu: [f64; 2],
    /// The contact as the correction sees it.
    pub(super) features: Features,
    /// Sums `G_pq` in newtons.
    pub(super) sums: ByPq<f64>,
    /// True resultant in newtons.
    pub(super) force: [f64; 3],
}

impl Sample {
    /// Length of the error of `(F_x, F_y)` over `|F_z|` with a gain and friction components.
    pub(super) fn error(&self, mu: [f64; 2], gain: f64) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|p| gain * (self.sums[p][0] + mu[0] * self.sums[p][1] + mu[1] * self.sums[p][2]));
        (x - self.force[0]).hypot(y - self.force[1]) / z.abs()
    }
}

/// What frames are seen with: the estimator of a design, before it is calibrated.
pub(super) struct Observer<'a> {
    design: &'a Design,
    solver: Solver,
    workspace: Workspace,
    scratch: JointScratch,
    half_window: [usize; 2],
    noise_left: f64,
}

impl<'a> Observer<'a> {
    /// For a design that averages nothing; its frames may have the noise that an average with a `smoothing` leaves.
    pub(super) fn new(design: &'a Design, smoothing: u32, half_window: [usize; 2]) -> Result<Self, CalibrateError> {
        let solver = Solver::new(design)?;
        let (workspace, scratch) = (solver.workspace(), JointScratch::default());
        Ok(Self { design, workspace, solver, scratch, half_window, noise_left: noise_left(smoothing) })
    }

    /// The sensor of the design.
    pub(super) fn sensor(&self) -> &'a Sensor {
        &self.design.sensor
    }

    /// What the sensor of the design makes of a pull.
    pub(super) fn tension(&self) -> Tension {
        self.design.input.tension
    }

    /// Draws the standard deviation of a frame's noise, as a share of its largest reading.
    pub(super) fn noise(&self, random: &mut ChaCha8Rng) -> f64 {
        // A design that averages nothing draws nothing more.
        let single = self.noise_left >= 1.0 || random.random::<f64>() < SINGLE;
        let left = if single { 1.0 } else { self.noise_left };
        MOST_NOISE * self.design.input.noise * left * random.random::<f64>()
    }

    /// The contacts that the design is trained on.
    pub(super) fn training_set(&self) -> TrainingSet {
        self.design.algorithm.joint.training_set
    }

    /// Estimates a frame with its true resultant, of any size, and with noise of a deviation that is a share of its largest
    /// stress; nothing if it has no answer.
    pub(super) fn sample(
        &mut self,
        mut frame: Vec<f64>,
        force: [f64; 3],
        noise: f64,
        random: &mut ChaCha8Rng,
    ) -> Result<Option<Sample>, CalibrateError> {
        // What reads no pull has no noise that pulls either.
        let tension = self.tension();
        for stress in &mut *frame {
            *stress = tension.of(*stress);
        }
        let peak = magnitude(&frame);
        let deviation = noise * peak;
        // The estimator has no scale; the frame is put where neither the full scale nor the noise floor matters.
        let scale = 0.5 * self.design.hardware.full_scale_pa / peak;
        for stress in &mut frame {
            *stress = tension.of(scale * (*stress + deviation * normal(random)));
        }
        let Some(inputs) = self.solver.inputs(&mut self.workspace, &frame)? else { return Ok(None) };
        let found = joint::raw(&inputs, &mut self.scratch);
        if found.status.contains(Status::DIRECTION_UNKNOWN) {
            return Ok(None);
        }
        joint::features(&inputs, found.mu, self.design.sensor.columns, self.half_window, 0.0, &mut self.scratch);
        let force = force.map(|component| scale * component);
        Ok(Some(Sample { mu: found.mu, features: self.scratch.features.clone(), sums: *inputs.sums, force }))
    }
}
