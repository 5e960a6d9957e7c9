//! The plan: what the hardware computes, in which formats, where and when. Pure data.
//!
//! Everything else is derived from it: the integer model interprets it, the emitter prints it, the report
//! describes it. Nothing here knows Verilog.

pub mod format;
pub mod layout;
pub mod optimum;
pub mod paper;
pub mod product;
pub mod quantise;
pub mod resources;
pub mod schedule;
pub mod timing;

use golden::design::Design;
use golden::filter::{FilterError, FilteredMatrices};
use golden::matrices::{Matrices, MatrixError, MatrixName};
use serde::Serialize;
use thiserror::Error;

use format::{Format, pow2};
use layout::OperandLayout;
use optimum::{DirectionPlan, OptimumPlan};
use product::{Block, Product, Vector};
use quantise::QuantisedMatrix;
use resources::Resources;
use schedule::Schedule;
use timing::Timeline;

/// Why a checked design has no hardware plan.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The matrices of this geometry cannot be computed.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// The filter leaves nothing to compute with.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// The accumulator bound leaves too few coefficient bits.
    #[error(
        "[hardware] coefficient_bits = {bits}: matrix {matrix} keeps fewer than {needed} bits beside a 48-bit \
         accumulator; lower data_bits or filter more"
    )]
    CoefficientWidth {
        /// The matrix as stored.
        matrix: String,
        /// Coefficient width of the design.
        bits: u32,
        /// Fewest useful bits.
        needed: u32,
    },
    /// The stress step is so coarse that the noise floor disappears in it.
    #[error(
        "[hardware] data_bits = {bits}: one step of stress is {step_pa} Pa, more than 16 times the noise floor of \
         {floor_pa} Pa; raise data_bits, lower full_scale_pa, or state a higher [algorithm] noise_floor_pa"
    )]
    Resolution {
        /// Vector width of the design.
        bits: u32,
        /// Worth of one step.
        step_pa: f64,
        /// Noise floor of the design.
        floor_pa: f64,
    },
    /// The geometry amplifies so much that the worst case leaves the forces too few bits.
    #[error(
        "[hardware] data_bits = {bits}: the worst case of {vector} is {worst_n:.3e} N, so one step is {step_n:.3e} N, \
         more than 1/{FEWEST_FORCE_STEPS} of a taxel's force at full scale ({taxel_n:.3e} N); the condition number of \
         A A^T is {condition:.1e}: lower [sensor] depth_mm, raise the pitch, or raise data_bits"
    )]
    ForceResolution {
        /// The vector.
        vector: &'static str,
        /// Vector width of the design.
        bits: u32,
        /// Largest magnitude that the format must hold.
        worst_n: f64,
        /// Worth of one step.
        step_n: f64,
        /// Full-scale stress times the area of a taxel.
        taxel_n: f64,
        /// 2-norm condition number of A Aᵀ.
        condition: f64,
    },
}

/// Fewest steps of a force format that a taxel's force at full scale must span.
const FEWEST_FORCE_STEPS: u32 = 64;

/// Formats of the four kinds of vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Formats {
    /// `b_z` in Pa; its bound is the full scale, to which larger inputs are clamped.
    pub stress: Format,
    /// `|w_z|` in N.
    pub weight: Format,
    /// All nine `g_pq`, and `A_p b_z`, in N.
    pub g: Format,
    /// `u_q` in Pa.
    pub u: Format,
}

impl Formats {
    /// The format of `vector`.
    pub fn of(&self, vector: Vector) -> Format {
        match vector {
            Vector::Stress => self.stress,
            Vector::Weight => self.weight,
            Vector::Partial(_) | Vector::G(..) => self.g,
            Vector::U(_) => self.u,
        }
    }
}

/// Thresholds of the frame statuses, in steps of the stress format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Thresholds {
    /// A taxel counts as compressed or tensile beyond this magnitude.
    pub taxel: i64,
    /// A frame with a smaller `sum |b|` has no contact.
    pub contact: i64,
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
    /// Status thresholds.
    pub thresholds: Thresholds,
    /// Constants of `CeAn`.
    pub direction: DirectionPlan,
    /// Constants of Op.
    pub optimum: OptimumPlan,
    /// Vectors in each lane's operand memory.
    pub operands: OperandLayout,
    /// The lanes' work, cycle by cycle.
    pub schedule: Schedule,
    /// Predicted cycles.
    pub timeline: Timeline,
    /// Predicted resources.
    pub resources: Resources,
}

impl Plan {
    /// Plans the hardware of `design`.
    ///
    /// # Errors
    /// [`PlanError`] if the geometry is singular, the filter empties a matrix, or the widths are too small.
    pub fn new(design: &Design) -> Result<Self, PlanError> {
        let matrices = Matrices::new(&design.sensor, design.algorithm.kernel)?;
        let filtered = FilteredMatrices::new(&matrices, &design.algorithm.filter)?;
        Self::from_parts(design, &matrices, &filtered)
    }

    /// Plans the hardware from matrices that are already there.
    ///
    /// # Errors
    /// [`PlanError`] if the widths are too small.
    pub fn from_parts(design: &Design, matrices: &Matrices, filtered: &FilteredMatrices) -> Result<Self, PlanError> {
        let hardware = &design.hardware;
        let stress = Format::covering(hardware.full_scale_pa, hardware.data_bits);
        let thresholds = thresholds(design, stress)?;
        let paper = paper::build(matrices, filtered, stress, hardware.coefficient_bits, hardware.data_bits)?;
        let condition = Condition { c33: matrices.condition_c33(), aat: matrices.condition_aat() };
        check_force_resolution(design, &paper.formats, condition)?;
        let schedule = Schedule::new(&paper.products, &paper.matrices, hardware.lanes);
        let taxels = design.sensor.taxels();
        let direction = DirectionPlan::new(design.sensor.pitch_mm);
        let optimum = OptimumPlan::new(taxels, hardware.lanes, &paper.formats);
        let operands = OperandLayout::new(&paper.products, taxels);
        let timeline = Timeline::new(taxels, &paper.products, &schedule, &optimum);
        let resources = Resources::new(design, &operands, &schedule, &optimum);
        Ok(Self {
            design: design.clone(),
            condition,
            nnz: Nnz(MatrixName::ALL.into_iter().map(|name| (name, filtered.nnz(name))).collect()),
            matrices: paper.matrices,
            products: paper.products,
            formats: paper.formats,
            thresholds,
            direction,
            optimum,
            operands,
            schedule,
            timeline,
            resources,
        })
    }

    /// Number of taxels m.
    pub fn taxels(&self) -> usize {
        self.design.sensor.taxels()
    }

    /// Index of the first product of `block`, and of the first after it.
    pub fn turn(&self, block: Block) -> (usize, usize) {
        let first = self.products.iter().position(|product| product.block == block).unwrap_or(0);
        let count = self.products.iter().filter(|product| product.block == block).count();
        (first, first + count)
    }
}

fn check_force_resolution(design: &Design, formats: &Formats, condition: Condition) -> Result<(), PlanError> {
    let [x, y] = design.sensor.pitch_mm;
    let taxel_n = design.hardware.full_scale_pa * x * y * 1e-6;
    for (vector, format) in [("|w|", formats.weight), ("g", formats.g)] {
        if format.step() * f64::from(FEWEST_FORCE_STEPS) > taxel_n {
            return Err(PlanError::ForceResolution {
                vector,
                bits: format.bits,
                worst_n: format.bound as f64 * format.step(),
                step_n: format.step(),
                taxel_n,
                condition: condition.aat,
            });
        }
    }
    Ok(())
}

fn thresholds(design: &Design, stress: Format) -> Result<Thresholds, PlanError> {
    let floor_pa = design.algorithm.noise_floor_pa;
    if stress.step() > 16.0 * floor_pa {
        return Err(PlanError::Resolution { bits: stress.bits, step_pa: stress.step(), floor_pa });
    }
    let taxel = ((floor_pa * pow2(-stress.lsb)).round() as i64).max(1);
    let contact = ((floor_pa * design.sensor.taxels() as f64 * pow2(-stress.lsb)).round() as i64).max(1);
    Ok(Thresholds { taxel, contact })
}
