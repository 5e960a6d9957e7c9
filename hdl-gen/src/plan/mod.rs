//! The plan: what the hardware computes, in which formats, where and when. Pure data.
//!
//! Everything else is derived from it: the integer model interprets it, the emitter prints it, the report
//! describes it. Nothing here knows Verilog.

pub mod calibration;
pub mod counts;
pub mod creep;
pub mod crosstalk;
pub mod curve;
mod curve_format;
pub mod dead;
pub mod energy;
mod error;
pub mod factor;
pub mod filtered;
pub mod gain;
pub mod layout;
pub mod luts;
pub mod matrix;
mod partition;
pub mod passes;
pub mod pe;
pub mod product;
pub mod quantise;
pub mod savings;
pub mod schedule;
pub mod smoothing;
pub mod standard_error;
pub mod streams;
pub mod vector_formats;
pub mod words;

use golden::design::{Design, Outputs, PlanKind, Scaling};
use golden::matrices::MatrixName;
use golden::parity::{COMPONENTS, Orbits};
use serde::Serialize;

use crate::estimators::EstimatorPlan;
use crate::format::Factors;
use crate::resources::Resources;
use crate::timing::Timeline;
use calibration::CalibrationPlan;
use counts::CountsPlan;
use creep::CreepPlan;
use crosstalk::CrosstalkPlan;
use dead::DeadPlan;
pub use error::PlanError;
use layout::OperandLayout;
use matrix::QuantisedMatrix;
use product::Product;
use schedule::Schedule;
use smoothing::SmoothingPlan;
use standard_error::StandardErrorPlan;
use streams::Streams;
use vector_formats::Formats;
pub use words::SUMMARY_WORDS;

/// Thresholds of the frame statuses, in steps of the stress format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Thresholds {
    /// A taxel counts as compressed or tensile beyond this magnitude.
    pub taxel: i64,
    /// A frame with a smaller `sum |b|` has no contact.
    pub contact: i64,
    /// Friction at which a frame slips, and at which it still does if the one before did, with
    /// [`crate::format::FRICTION_FRACTION`] fraction bits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip: Option<[i64; 2]>,
    /// The standard error, if it was fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<StandardErrorPlan>,
    /// Whether every answer has low confidence, as the layer is too thin for the taxels.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub thin: bool,
}

/// Number of entries per filtered matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Nnz(pub Vec<(MatrixName, usize)>);

/// 2-norm condition numbers of the geometry.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// Of C33.
    #[serde(rename = "C33")]
    pub c33: f64,
    /// Of A Aᵀ.
    #[serde(rename = "AAT")]
    pub aat: f64,
}

/// A design's hardware, complete.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The checked design.
    pub design: Design,
    /// Condition numbers of the geometry.
    pub condition: Condition,
    /// Entries of the 13 matrices after the filter.
    pub nnz: Nnz,
    /// Matrices as stored in the ROMs.
    pub matrices: Vec<QuantisedMatrix>,
    /// Sparse products in order.
    pub products: Vec<Product>,
    /// Vector formats.
    pub formats: Formats,
    /// Arms of the taxels' forces, where sums of torques are made of them; empty where rows of sums have them.
    pub arms: Vec<[i32; 2]>,
    /// Conversion of counts, if the frames are not in pascals and it stands in ROM.
    pub counts: Option<CountsPlan>,
    /// Conversion of counts, if gains and offsets stand in RAM.
    pub calibration: Option<CalibrationPlan>,
    /// Weights that replace the readings of dead taxels, if there are any.
    pub dead: Option<DeadPlan>,
    /// What removes crosstalk, if the sensor has it.
    pub crosstalk: Option<CrosstalkPlan>,
    /// What removes creep, if readings creep.
    pub creep: Option<CreepPlan>,
    /// How frames are averaged, if they are.
    pub smoothing: Option<SmoothingPlan>,
    /// Status thresholds.
    pub thresholds: Thresholds,
    /// The estimator of friction: `CeAn`, and the search in Op.
    pub estimator: EstimatorPlan,
    /// Vectors in each PE's operand memory.
    pub operands: OperandLayout,
    /// The lanes' work, cycle by cycle.
    pub schedule: Schedule,
    /// Predicted cycles.
    pub timeline: Timeline,
    /// Predicted resources.
    pub resources: Resources,
}

impl Plan {
    /// Multiply-accumulates of a frame in the lanes, all channels counted.
    pub fn macs(&self) -> u64 {
        self.schedule.windows.iter().map(|window| window.macs * self.channels() as u64).sum()
    }

    /// What a lane multiplies with.
    pub fn factors(&self) -> Factors {
        Factors::of(&self.design)
    }

    /// Lanes of a PE: the parity components of the reduced plan, else one.
    pub fn channels(&self) -> usize {
        channels(&self.design)
    }

    /// PEs, each with MCSR data of its own: the design's lanes over the channels.
    pub fn pes(&self) -> usize {
        self.schedule.pes.len()
    }

    /// Dead taxels that a frame has room for, in ROM or in the banks of a calibration.
    pub fn places_for_dead(&self) -> usize {
        let of_banks = self.calibration.as_ref().map_or(0, |of| of.power_up.dead.room);
        self.dead.as_ref().map_or(of_banks, |dead| dead.taxels.len())
    }

    /// Whether each frame is scaled by its own largest stress.
    pub fn scales_frames(&self) -> bool {
        self.design.hardware.scaling == Scaling::PerFrame
    }

    /// Elements of a vector as the lanes see it: taxels, or orbits of the folded grid.
    pub fn elements(&self) -> usize {
        elements(&self.design)
    }

    /// The orbits of the sensor's grid.
    pub fn orbits(&self) -> Orbits {
        orbits(&self.design)
    }

    /// Number of taxels m.
    pub fn taxels(&self) -> usize {
        self.design.sensor.taxels()
    }

    /// The shape of both streams.
    pub fn streams(&self) -> Streams {
        Streams::of(&self.design)
    }

    /// Words of every output frame: 16, and for the field 3 m more.
    pub fn words_out(&self) -> usize {
        self.streams().words_out
    }

    /// Words of the field in an output frame: 3 m, or none.
    pub fn field_words(&self) -> usize {
        self.words_out() - SUMMARY_WORDS
    }

    /// Whether the core computes the field.
    pub fn has_field(&self) -> bool {
        self.design.algorithm.outputs == Outputs::Field
    }
}

pub(crate) fn channels(design: &Design) -> usize {
    match design.algorithm.plan {
        PlanKind::Paper => 1,
        PlanKind::Reduced => COMPONENTS,
    }
}

fn orbits(design: &Design) -> Orbits {
    Orbits::new(design.sensor.columns, design.sensor.rows)
}

pub(crate) fn elements(design: &Design) -> usize {
    match design.algorithm.plan {
        PlanKind::Paper => design.sensor.taxels(),
        PlanKind::Reduced => orbits(design).count(),
    }
}
