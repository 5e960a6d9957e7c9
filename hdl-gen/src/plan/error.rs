//! Why a checked design has no hardware plan.

use golden::filter::FilterError;
use golden::matrices::MatrixError;
use thiserror::Error;

/// Fewest steps of a force format that a taxel's force at full scale must span.
pub(crate) const FEWEST_FORCE_STEPS: u32 = 64;

/// The roundings of a frame may add at most this part of a taxel's force at full scale to it, if all of them add up;
/// as they come they make less than a tenth of that.
pub(crate) const MOST_ROUNDING: f64 = 4.0;

/// Why a checked design has no hardware plan.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The estimator has no hardware in this plan.
    #[error(
        "[algorithm] plan = \"paper\": the paper's plan has the line search only; write plan = \"reduced\", or \
         estimator = \"line\" and remove gain, friction_correction and correction"
    )]
    JointEstimator,
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
    /// Words that take two multipliers a lane, where there are none of that kind.
    #[error("[hardware] {key} = {bits}: {why}; write {cure}")]
    Wide {
        /// The key.
        key: &'static str,
        /// Its value.
        bits: u32,
        /// What does not have it.
        why: &'static str,
        /// What to write instead.
        cure: &'static str,
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
    /// An offset that a bank of the calibration does not take.
    #[error(
        "[sensor] calibration: the offset of taxel {taxel} is {counts} counts; with [hardware] calibration = \"ram\" at most \
         {most:.1} of either sign, two full scales, have room; correct the file, state a full_scale_pa that fits the \
         sensor, or write calibration = \"rom\""
    )]
    BankOffset {
        /// The taxel, from 0.
        taxel: usize,
        /// Its offset.
        counts: f64,
        /// The largest one that has room.
        most: f64,
    },
    /// A contact threshold that has no room in a bank of the calibration.
    #[error(
        "[hardware] calibration = \"ram\": with [algorithm] noise_floor_pa = {floor_pa} the threshold of contact has more \
         than 32 bits; lower it to {most_pa:.0} or less, or write calibration = \"rom\""
    )]
    Contact {
        /// Noise floor of the design.
        floor_pa: f64,
        /// The largest one that has room.
        most_pa: f64,
    },
    /// A part of the curve that no slope can follow.
    #[error(
        "[sensor] curve: between the counts {from} and {to} it rises so steeply that the hardware's numbers have no step \
         for it; move the points apart, or leave one out"
    )]
    Curve {
        /// Count at which the part begins.
        from: f64,
        /// Count at which it ends.
        to: f64,
    },
    /// A curve that has no room in a bank of the calibration.
    #[error(
        "[sensor] curve: with [hardware] calibration = \"ram\" its values have room up to {pascals:.0} Pa, eight full scales, \
         its counts up to {counts:.0}, and it may have {segments} parts; leave out the points beyond, state a full_scale_pa that \
         fits the sensor, or write calibration = \"rom\""
    )]
    CurveReach {
        /// Largest magnitude of its values.
        pascals: f64,
        /// Of its counts.
        counts: f64,
        /// Most segments.
        segments: usize,
    },
    /// The geometry amplifies so much that the worst case leaves the forces too few bits.
    #[error(
        "[hardware] data_bits = {bits}: the worst case of {vector} is {worst_n:.3e} N, so one step is {step_n:.3e} N, \
         more than 1/{FEWEST_FORCE_STEPS} of a taxel's force at full scale ({taxel_n:.3e} N); the condition number of \
         A A^T is {condition:.1e}: write a larger regularisation under [algorithm], lower [sensor] depth_mm, raise the \
         pitch, or raise data_bits"
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
    /// The geometry amplifies so much that rounding alone moves the forces.
    #[error(
        "[hardware] data_bits = {bits}: rounding alone could move the force of a taxel by {rounding_n:.1e} N, more \
         than 1/{MOST_ROUNDING} of that at full scale ({taxel_n:.3e} N); the condition number of A A^T is {condition:.1e}: \
         write a larger regularisation under [algorithm], lower [sensor] depth_mm, raise the pitch, or raise data_bits"
    )]
    ForceRounding {
        /// Vector width of the design.
        bits: u32,
        /// Most that roundings can add up to.
        rounding_n: f64,
        /// Full-scale stress times the area of a taxel.
        taxel_n: f64,
        /// 2-norm condition number of A Aᵀ.
        condition: f64,
    },
    /// Lanes are found in the reduced plan only.
    #[error(
        "a target of {target_us} us: lanes are found for the reduced plan only; write plan = \"reduced\" under [algorithm], \
         or state [hardware] lanes and leave the target out"
    )]
    TargetOfPaper {
        /// What was asked for.
        target_us: f64,
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
