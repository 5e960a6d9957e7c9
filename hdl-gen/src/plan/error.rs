//! Why a checked design has no hardware plan.

use golden::filter::FilterError;
use golden::matrices::MatrixError;
use thiserror::Error;

/// Why a checked design has no hardware plan.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The matrices of this geometry cannot be computed.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// The filter leaves nothing to compute with.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// A key of the design that has no hardware as it is, and what to write instead.
    #[error("{0}")]
    Key(String),
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
    /// An offset of the calibration so large that little of the full scale is left beside it.
    #[error(
        "[sensor] calibration: the offset of taxel {taxel} is {counts} counts where the full scale is {full_scale:.1} \
         counts: a number that holds both has steps above the noise floor; correct the file, or state a \
         full_scale_pa that fits the sensor"
    )]
    Offset {
        /// The taxel, from 0.
        taxel: usize,
        /// Its offset.
        counts: f64,
        /// The full scale in counts.
        full_scale: f64,
    },
    /// No number of lanes is fast enough.
    #[error(
        "a target of {target_us} us: the fastest plan has {lanes} lanes and takes {latency_us:.2} us at \
         {clock_mhz} MHz; it would take a clock of {needed_mhz:.0} MHz, {remedies}fewer taxels, or a target of {latency_us:.2} us"
    )]
    Target {
        /// What was asked for.
        target_us: f64,
        /// Lanes of the fastest plan.
        lanes: usize,
        /// Its latency at the design's clock.
        latency_us: f64,
        /// The design's clock.
        clock_mhz: f64,
        /// The clock at which it would meet the target.
        needed_mhz: f64,
        /// Another estimator or output with which it was found to meet the target, as `"key = value, "`, or nothing.
        remedies: String,
    },
}
