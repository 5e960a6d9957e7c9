//! From a checked design to its plan on so many lanes.

mod durations;
mod target_search;

use golden::design::{Design, Outputs, PlanKind, Slip};
use golden::matrices::Matrices;

use crate::blocks;
use crate::cores::{DspBlock, LONG_BITS, Multiplier};
use crate::estimators::{Config, EstimatorPlan};
use crate::format::{FRICTION_FRACTION, Factors, Format, MANY_LANES, pow2};
use crate::plan::calibration::CalibrationPlan;
use crate::plan::counts::CountsPlan;
use crate::plan::creep::CreepPlan;
use crate::plan::crosstalk::CrosstalkPlan;
use crate::plan::dead::DeadPlan;
use crate::plan::filtered::Filtered;
use crate::plan::layout::OperandLayout;
use crate::plan::passes;
use crate::plan::quantise::{Quantised, quantise, taxel_force_n};
use crate::plan::schedule::Schedule;
use crate::plan::smoothing::SmoothingPlan;
use crate::plan::standard_error::StandardErrorPlan;
use crate::plan::vector_formats::{Formats, arms};
use crate::plan::{Condition, Nnz, Plan, PlanError, Thresholds, channels, elements};
use crate::resources::Resources;
use crate::timing::{Timeline, control};
use durations::durations;

/// Fewest steps of a force format that a taxel's force at full scale must span.
const FEWEST_FORCE_STEPS: u32 = 64;

/// The roundings of a frame may add at most this part of a taxel's force at full scale to it, if all of them add up;
/// as they come they make less than a tenth of that.
const MOST_ROUNDING: f64 = 4.0;

/// Words that do not fit one multiplier a lane have hardware where two make one product.
fn check_widths(design: &Design) -> Result<(), PlanError> {
    let factors = Factors::of(design);
    let wide = |key, bits, why, cure| Err(PlanError::Key(format!("[hardware] {key} = {bits}: {why}; write {cure}")));
    let data = |why, cure| wide("data_bits", factors.data_bits, why, cure);
    if factors.is_wide() && Multiplier::of_part(&design.hardware.part) == Multiplier::Split {
        let why = "the part multiplies 18 x 18 bits, and words beyond 18 x 27 take multipliers of 18 x 27";
        let cure = "coefficient_bits = 18 and data_bits = 27, or another part";
        if !factors.has_wide_data() {
            return wide("coefficient_bits", factors.coefficient_bits, why, cure);
        }
        return data(why, cure);
    }
    if factors.has_wide_data() && design.algorithm.plan == PlanKind::Paper {
        return data(
            "the paper's plan has vectors of at most 27 bits",
            "data_bits = 27, or plan = \"reduced\" under [algorithm]",
        );
    }
    if factors.data_bits == LONG_BITS + 1 {
        return data("vectors wider than a multiplier hold the sum of four stresses of 27 bits", "29 to 35, or 27");
    }
    Ok(())
}

impl Plan {
    /// The plan of a design whose estimator and widths have hardware.
    fn of(design: &Design) -> Result<Self, PlanError> {
        let hardware = &design.hardware;
        let (elements, channels) = (elements(design), channels(design));
        let geometry = Matrices::of(design)?;
        // What a frame can bring of it, so that a reading of just the full scale reaches the bound.
        let stress = Format::covering(hardware.full_scale_in_frames(), Factors::of(design).outside_bits());
        let thresholds = thresholds(design, stress)?;
        let calibration = CalibrationPlan::new(design, stress, &thresholds)?;
        let counts = if calibration.is_some() { None } else { CountsPlan::new(design, stress)? };
        let list = passes::products(design);
        let filtered = Filtered::new(design, &geometry)?;
        let quantised = quantise(&list, &filtered, design, stress)?;
        let products = passes::bind(&list, &quantised);
        let nnz = Nnz(filtered.nnz(&design.algorithm.filter)?);
        let Quantised { matrices, formats, rounding_n, .. } = quantised;
        let condition = Condition { c33: geometry.condition_c33(), aat: geometry.condition_aat() };
        check_force_resolution(design, &formats, condition, rounding_n)?;
        let mut plan = Self {
            design: design.clone(),
            condition,
            nnz,
            matrices,
            formats,
            arms: if channels == 1 { arms(&design.sensor) } else { Vec::new() },
            counts,
            calibration,
            dead: DeadPlan::new(design),
            crosstalk: CrosstalkPlan::new(design),
            creep: CreepPlan::new(design),
            smoothing: SmoothingPlan::new(design, stress),
            thresholds,
            estimator: estimator(design, &formats),
            operands: OperandLayout::new(&products, elements, channels as u32 * hardware.data_bits),
            products,
            schedule: Schedule::default(),
            timeline: Timeline::default(),
            resources: Resources::default(),
        };
        plan.lay_out();
        Ok(plan)
    }

    /// The same plan on so many lanes.
    fn on_lanes(&self, lanes: usize) -> Self {
        let mut plan = self.clone();
        plan.design.hardware.lanes = lanes;
        plan.estimator = estimator(&plan.design, &plan.formats);
        plan.lay_out();
        plan
    }

    /// What the design's lanes decide: who computes what, and when.
    fn lay_out(&mut self) {
        let lanes = self.design.hardware.lanes;
        self.schedule = Schedule::new(&self.products, &self.matrices, lanes / self.channels(), lanes > MANY_LANES);
        self.timeline = control::timeline(&durations(self), self.schedule.issue_cycles());
        self.resources = Resources::of(blocks::costs(self), DspBlock::of_part(&self.design.hardware.part));
    }
}

fn estimator(design: &Design, formats: &Formats) -> EstimatorPlan {
    let Formats { stress, u, .. } = *formats;
    let (elements, channels) = (elements(design), channels(design));
    EstimatorPlan::new(&Config { design, elements, channels, stress, u: u.narrowed() })
}

fn check_force_resolution(
    design: &Design,
    formats: &Formats,
    condition: Condition,
    rounding_n: f64,
) -> Result<(), PlanError> {
    let (taxel_n, condition) = (taxel_force_n(design), condition.aat);
    let wrong = |bits: u32, problem: &str| {
        Err(PlanError::Key(format!(
            "[hardware] data_bits = {bits}: {problem} ({taxel_n:.3e} N); the condition number of A A^T is {condition:.1e}: \
             write a larger regularisation under [algorithm], lower [sensor] depth_mm, raise the pitch, or raise data_bits"
        )))
    };
    if rounding_n * MOST_ROUNDING > taxel_n {
        let moved = format!("rounding alone could move the force of a taxel by {rounding_n:.1e} N");
        return wrong(
            design.hardware.data_bits,
            &format!("{moved}, more than 1/{MOST_ROUNDING} of that at full scale"),
        );
    }
    let force = match (formats.folded, design.algorithm.outputs) {
        (Some(folded), Outputs::Field) => Some(("A+ r", folded.taxel_force)),
        // Sums over the frame only, which are larger than a taxel's force.
        (Some(_), Outputs::Resultants) => None,
        (None, _) => Some(("g", formats.g)),
    };
    for (vector, format) in std::iter::once(("|w|", formats.weight)).chain(force) {
        if format.step() * f64::from(FEWEST_FORCE_STEPS) > taxel_n {
            let step_n = format.step();
            let problem = format!(
                "the worst case of {vector} is {:.3e} N, so one step is {step_n:.3e} N, more than 1/{FEWEST_FORCE_STEPS} of a \
                 taxel's force at full scale",
                format.bound as f64 * step_n
            );
            return wrong(format.bits, &problem);
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
    let slip = design.algorithm.slip.map(|Slip { limit, hysteresis }| {
        // Never 0: that friction of 0 slips is no limit's meaning.
        [limit, limit - hysteresis].map(|friction| ((friction * pow2(FRICTION_FRACTION as i32)).round() as i64).max(1))
    });
    let error = StandardErrorPlan::of(design, stress);
    Ok(Thresholds { taxel, contact, slip, error, thin: design.thin_layer().is_some() })
}
