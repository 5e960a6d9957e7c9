//! What hardware for several bodies has of its own: coefficients by distance, and frames that have a place.

pub mod instructions;
pub mod records;
mod writer;

use std::borrow::Cow;

use golden::design::{CalibrationIn, Design, Outputs, Overrun, Samples};
use golden::matrices::Matrices;
use golden::sensor::Sensor;
use nalgebra::DVector;

use super::error::PlanError;
use super::format::pow2;
use super::streams::WORD_BITS;
use super::timing::Timeline;
use crate::cores::{LONG_BITS, SHORT_BITS};

/// Bits of a force in steps of its frame: one operand of a multiplier.
pub const FORCE_BITS: u32 = LONG_BITS;
/// Bits of what a body causes at a taxel.
pub const PART_BITS: u32 = 48;
/// Most frames that have a place.
const MOST_BANKS: usize = 8;

/// What parts the forces of several bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContactsPlan {
    /// Most bodies that have a region and a record.
    pub contacts: usize,
    /// Power of two of a step of the coefficients in Pa/N.
    pub unit: i32,
    /// Coefficients `[C31, C32, C33]` of taxels so many columns and rows apart, row after row: of a taxel with higher numbers
    /// for a force at one with lower ones.
    pub coefficients: Vec<[i32; 3]>,
    /// Frames that have a place, from their first word until they are answered.
    pub banks: usize,
    /// Cycles of the core for one body by itself.
    pub core: Timeline,
}

impl ContactsPlan {
    /// That of a design for several bodies, if it is one.
    ///
    /// # Errors
    /// [`PlanError::Contacts`] if the design has what the hardware for several bodies has not.
    pub(super) fn new(design: &Design, matrices: &Matrices) -> Result<Option<Self>, PlanError> {
        let contacts = design.algorithm.contacts;
        if contacts < 2 {
            return Ok(None);
        }
        if let Some(needs) = needs(design) {
            return Err(PlanError::Contacts { contacts, needs });
        }
        // The core's forces have the estimator's gain.
        let gain = design.algorithm.constants().gain().unwrap_or(1.0);
        let mut first = DVector::zeros(design.sensor.taxels());
        first[0] = 1.0 / gain;
        let columns = [&matrices.c31, &matrices.c32, &matrices.c33].map(|matrix| matrix * &first);
        let at = |taxel: usize| columns.each_ref().map(|column| column[taxel]);
        let coefficients: Vec<[f64; 3]> = (0..design.sensor.taxels()).map(at).collect();
        let needs = "a [sensor] pitch_mm and depth_mm by which a newton causes less than 1e30 Pa";
        let unit = unit(&design.sensor, &coefficients).ok_or(PlanError::Contacts { contacts, needs })?;
        let coefficients = coefficients.iter().map(|of| of.map(|value| (value * pow2(-unit)).round() as i32)).collect();
        Ok(Some(Self { contacts, unit, coefficients, banks: 2, core: Timeline::default() }))
    }

    /// Gives as many frames a place as are under way at a time.
    pub(super) fn with_room(mut self, core: Timeline, whole: &Timeline) -> Self {
        let inside = whole.latency_cycles.div_ceil(core.interval_cycles.max(1)) as usize + 1;
        self.banks = inside.next_power_of_two().clamp(2, MOST_BANKS);
        self.core = core;
        self
    }

    /// The coefficient of the distance of two taxels, with the signs of its direction.
    pub fn coefficient(&self, columns: usize, [to_x, to_y]: [usize; 2], [from_x, from_y]: [usize; 2]) -> [i64; 3] {
        let [x, y, z] = self.coefficients[to_y.abs_diff(from_y) * columns + to_x.abs_diff(from_x)].map(i64::from);
        [if from_x > to_x { -x } else { x }, if from_y > to_y { -y } else { y }, z]
    }
}

/// The smallest step with which coefficients fit a multiplier, and sums over all taxels their accumulators, even together; none
/// if they are no numbers, or too large for any.
fn unit(sensor: &Sensor, coefficients: &[[f64; 3]]) -> Option<i32> {
    let most = coefficients.as_flattened().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    // Each distance comes twice along each axis, but that of 0.
    let often = |taxel: usize| {
        [taxel % sensor.columns, taxel / sensor.columns]
            .iter()
            .fold(1.0, |often, &away| often * [1.0, 2.0][usize::from(away > 0)])
    };
    let all: f64 = coefficients
        .iter()
        .enumerate()
        .map(|(taxel, of)| often(taxel) * of.iter().map(|value| value.abs()).sum::<f64>())
        .sum();
    let fits = |unit: &i32| {
        let step = pow2(*unit);
        // Rounding adds half a step to each of them.
        let rounded = all / step + 1.5 * (4 * coefficients.len()) as f64;
        (most / step).round() < pow2(SHORT_BITS as i32 - 1) && rounded < pow2((PART_BITS - FORCE_BITS) as i32)
    };
    (-100..100).find(fits)
}

/// The design of the core for one body, which several share: it answers with the whole field, by which bodies are parted, and
/// what the answer to the user has of that is not its matter. Its streams are of a word, and held.
pub fn core(design: &Design) -> Cow<'_, Design> {
    if design.algorithm.contacts < 2 {
        return Cow::Borrowed(design);
    }
    let mut core = design.clone();
    (core.algorithm.contacts, core.algorithm.outputs, core.algorithm.slip) = (1, Outputs::Field, None);
    (core.hardware.stream_bits, core.hardware.overrun) = (WORD_BITS as u32, Overrun::Stall);
    Cow::Owned(core)
}

/// What hardware for several bodies needs that a design does not say, if there is something.
pub fn needs(design: &Design) -> Option<&'static str> {
    let hardware = &design.hardware;
    let wrong = [
        (hardware.samples != Samples::Float32, "[hardware] samples = \"float32\""),
        (hardware.calibration != CalibrationIn::Rom, "[hardware] calibration = \"rom\""),
        (design.input.counts(), "frames in pascals: no [sensor] pa_per_count, curve or calibration"),
        (!design.input.dead.is_empty(), "no [sensor] dead"),
    ];
    wrong.into_iter().find(|&(is_wrong, _)| is_wrong).map(|(_, needs)| needs)
}
