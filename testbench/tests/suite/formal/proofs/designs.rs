//! The designs that are proved: the 4 × 3 one of `designs/small.toml`, changed.

use golden::design::{
    CalibrationIn, Correction, Curve, Design, Estimator, Optimise, Outputs, Overrun, PlanKind, Scaling,
};
use golden::estimators::joint::Grid;

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

pub fn calibrated(design: &mut Design) {
    reduced(design);
    design.hardware.control = true;
    design.hardware.calibration = CalibrationIn::Ram;
    design.input.pa_per_count = Some(-12.5);
}

pub fn curved(design: &mut Design) {
    calibrated(design);
    design.input.pa_per_count = None;
    design.input.curve = Some(Curve { points: vec![[0.0, 0.0], [50.0, -100.0], [4095.0, -2e5]], law: None });
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
    design.algorithm.joint.correction = Some(Correction {
        half_window: [0, 0],
        hidden: vec![vec![1; inputs]],
        output: [vec![1], vec![1]],
        doubt: None,
    });
}

pub fn corrected_after_points(design: &mut Design) {
    corrected(design);
    design.algorithm.joint.grid = Grid::COARSE;
}

pub fn corrected_resultants(design: &mut Design) {
    corrected_after_points(design);
    design.algorithm.outputs = Outputs::Resultants;
}

pub fn resultants(design: &mut Design) {
    reduced(design);
    design.algorithm.outputs = Outputs::Resultants;
}
