//! The designs that are proved: the 4 × 3 one of `golden/tests/designs/small.toml`, changed.

use golden::design::{CalibrationIn, Correction, Design, Estimator, Optimise, Outputs, Overrun, PlanKind, Scaling};

pub fn paper(design: &mut Design) {
    design.algorithm.plan = PlanKind::Paper;
    design.hardware.lanes = 2;
}

pub fn reduced(design: &mut Design) {
    design.algorithm.plan = PlanKind::Reduced;
}

pub fn reduced_for_latency(design: &mut Design) {
    reduced(design);
    design.hardware.optimise = Optimise::Latency;
}

fn calibrated(design: &mut Design) {
    reduced(design);
    design.hardware.control = true;
    design.hardware.calibration = CalibrationIn::Ram;
    design.input.pa_per_count = Some(-12.5);
}

pub fn mapped(design: &mut Design) {
    calibrated(design);
    design.input.room = 1;
}

pub fn scanned(design: &mut Design) {
    reduced(design);
    design.hardware.overrun = Overrun::Drop;
}

pub fn scaled(design: &mut Design) {
    paper(design);
    design.hardware.scaling = Scaling::PerFrame;
}

pub fn joint(design: &mut Design) {
    reduced(design);
    design.algorithm.estimator = Estimator::Joint;
}

/// One hidden unit that sees one taxel.
pub fn corrected(design: &mut Design) {
    joint(design);
    let inputs = Correction::inputs([0, 0]);
    design.algorithm.joint.correction =
        Some(Correction { half_window: [0, 0], hidden: vec![vec![1; inputs]], output: [vec![1], vec![1]] });
}

pub fn corrected_resultants(design: &mut Design) {
    corrected(design);
    design.algorithm.outputs = Outputs::Resultants;
}

pub fn resultants(design: &mut Design) {
    reduced(design);
    design.algorithm.outputs = Outputs::Resultants;
}
