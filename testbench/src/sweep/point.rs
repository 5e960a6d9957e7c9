//! What is known of one point.

use std::collections::BTreeMap;

use golden::design::{Algorithm, Estimator, JointConstants, Kernel, PlanKind, Sensor, TrainingSet};
use golden::metrics::ErrorSummary;
use serde::{Deserialize, Serialize};

use crate::accuracy::StatusCounts;

/// How the answers of a point were found, from the weakest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verified {
    /// By the f64 solver alone: there is no hardware of this design.
    Golden,
    /// By the integer model of the plan, which tests hold to the RTL bit for bit.
    Model,
    /// By the RTL in Verilator, every word and every cycle as the model and the plan say.
    Rtl,
}

impl Verified {
    /// For people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Golden => "f64 only",
            Self::Model => "integer model",
            Self::Rtl => "RTL simulated",
        }
    }
}

/// What tells one grid search from another.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Calibration {
    /// Hidden units of the correction; 0 without one.
    pub units: usize,
    /// Contacts that it was trained on.
    pub training_set: TrainingSet,
}

impl Calibration {
    /// That of a design.
    pub fn of(algorithm: &Algorithm) -> Option<Self> {
        let JointConstants { training_set, correction, .. } = algorithm.joint.as_ref();
        let units = correction.as_ref().map_or(0, |correction| correction.hidden.len());
        (algorithm.estimator == Estimator::Joint).then_some(Self { units, training_set: *training_set })
    }
}

/// What the plan predicts.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Hardware {
    /// First beat in to last beat out of a frame alone.
    pub latency_cycles: u64,
    /// Between the last beats of consecutive frames.
    pub interval_cycles: u64,
    /// The latency at the design's clock.
    pub latency_us: f64,
    /// The interval at the design's clock.
    pub interval_us: f64,
    /// DSP48E2.
    pub dsp: usize,
    /// RAMB36.
    pub bram36: f64,
    /// Bits in ROM files.
    pub rom_bits: u64,
    /// Multiply-accumulates of a frame.
    pub macs: u64,
}

/// The hardware's answers against the f64 solver with the same filter; `None` where that is beyond all bounds.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct AgainstSolver {
    /// As [`crate::accuracy::SolverError::resultant_max`].
    pub resultant_max: Option<f64>,
    /// As [`crate::accuracy::SolverError::field_max`].
    pub field_max: Option<f64>,
}

/// One point: a variant of a design on a scene.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Point {
    /// What the point is filed under.
    pub key: String,
    /// The sensor.
    pub sensor: Sensor,
    /// Name of the scene.
    pub scene: String,
    /// The plan.
    pub plan: PlanKind,
    /// What each force loads.
    pub kernel: Kernel,
    /// `none`, `f1 l=40`, `f2 p=50` or `f3`.
    pub filter: String,
    /// The estimator.
    pub estimator: Estimator,
    /// Which grid search; none for another one.
    pub calibration: Option<Calibration>,
    /// Width of the coefficients.
    pub coefficient_bits: u32,
    /// Width of the vectors.
    pub data_bits: u32,
    /// `SpMV` lanes.
    pub lanes: usize,
    /// How the answers were found.
    pub verified: Verified,
    /// Why the design is not in hardware.
    pub refusal: Option<String>,
    /// Speed and size; none without hardware.
    pub hardware: Option<Hardware>,
    /// Entries of the 13 matrices after the filter, as Table 1 of the paper counts them.
    pub nnz: BTreeMap<String, usize>,
    /// Their sum.
    pub nnz_total: usize,
    /// Frames of the scene.
    pub frames: usize,
    /// Mean of the friction coefficients found.
    pub mean_mu: f64,
    /// Errors against the true forces in percent.
    pub errors: ErrorSummary,
    /// The same of the f64 solver.
    pub solver_errors: ErrorSummary,
    /// Against the f64 solver; none without hardware.
    pub against_solver: Option<AgainstSolver>,
    /// Frames by status.
    pub status_counts: StatusCounts,
}

impl Point {
    /// The larger of the largest errors along x and y, in percent: what the front is drawn of.
    pub fn tangential(&self) -> f64 {
        self.errors.e_fx.max.max(self.errors.e_fy.max)
    }

    /// What varies, in a line.
    pub fn label(&self) -> String {
        format!(
            "{}, {} plan, {}, {} lanes, {} × {} bits",
            self.filter_title(),
            self.plan,
            self.estimator_title(),
            self.lanes,
            self.coefficient_bits,
            self.data_bits
        )
    }

    /// The estimator with what tells one calibration from another: `joint, 48 units`.
    pub fn estimator_title(&self) -> String {
        let Some(Calibration { units, training_set }) = self.calibration else { return self.estimator.to_string() };
        let general = if training_set == TrainingSet::General { ", general" } else { "" };
        let correction = if units > 0 { format!("{units} units{general}") } else { "no correction".to_owned() };
        format!("{}, {correction}", self.estimator)
    }

    /// The filter as people write it: `no filter`, `F1 L = 40`.
    pub fn filter_title(&self) -> String {
        if self.filter == "none" {
            return "no filter".to_owned();
        }
        self.filter.replace("f1 l=", "F1 L = ").replace("f2 p=", "F2 p = ").replace("f3", "F3")
    }
}

/// A sensor's geometry for people.
pub fn sensor_title(sensor: &Sensor) -> String {
    let Sensor { columns, rows, pitch_mm: [x, y], depth_mm } = sensor;
    format!("{columns} × {rows} taxels of {x} × {y} mm, {depth_mm} mm deep")
}

/// The sensors of points, each once, in order.
pub fn sensors(points: &[Point]) -> Vec<Sensor> {
    let mut sensors: Vec<Sensor> = Vec::new();
    for point in points {
        if !sensors.contains(&point.sensor) {
            sensors.push(point.sensor.clone());
        }
    }
    sensors
}
