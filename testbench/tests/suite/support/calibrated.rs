//! Designs with their calibration in RAM.

use golden::design::{Calibration, CalibrationIn, Curve, Design, Outputs, PlanKind};

use super::{by_plan, shipped};

/// The small design with counts and its calibration in RAM.
pub fn design(outputs: Outputs) -> Design {
    let mut design = by_plan(shipped("small-control"), PlanKind::Reduced, outputs);
    design.name += "_calibrated";
    design.hardware.calibration = CalibrationIn::Ram;
    design.input.pa_per_count = Some(-12.5);
    let gain = (0..12).map(|taxel| 0.7 + 0.05 * f64::from(taxel)).collect();
    let offset = (0..12).map(|taxel| 3.25 * f64::from(taxel) - 20.0).collect();
    design.input.calibration = Some(Calibration { gain, offset });
    design
}

/// The small design along a curve, with gains and offsets.
pub fn design_with_curve() -> Design {
    let mut design = design(Outputs::Resultants);
    design.name += "_curve";
    design.input.pa_per_count = None;
    let points = vec![[0.0, 0.0], [200.0, -900.0], [1500.0, -20e3], [5000.0, -90e3], [9000.0, -300e3]];
    design.input.curve = Some(Curve { points, law: None });
    let gain = (0..12).map(|taxel| 0.7 + 0.05 * f64::from(taxel)).collect();
    let offset = (0..12).map(|taxel| 30.25 * f64::from(taxel) - 200.0).collect();
    design.input.calibration = Some(Calibration { gain, offset });
    design
}
