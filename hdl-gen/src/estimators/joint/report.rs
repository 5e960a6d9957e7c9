//! The grid search in the words of `sptfra inspect`.

use golden::design::{Correction, Design, Kernel};
use golden::kernel::gain;
use golden::parity::COMPONENTS;

use super::{JointPlan, SearchPlan, timing};
use crate::format::{MANY_LANES, short};

/// Share by which the gain may differ from what the kernel lacks under a wide contact.
const STALE_GAIN: f64 = 0.1;

/// What the estimator is made of.
pub fn report(plan: &JointPlan, design: &Design) -> String {
    let constants = &design.algorithm.joint;
    let [c1, c3] = constants.friction_correction;
    let correction = match (&plan.network, &constants.correction) {
        (Some(network), Some(correction)) => format!(
            "{} hidden units, {} inputs, weights in steps of 2^{}; {} passes of {} words, {} MACs",
            correction.hidden.len(),
            Correction::inputs(correction.half_window),
            network.weight_lsb,
            network.passes,
            network.length,
            COMPONENTS * network.at_once
        ),
        _ => "none: `sptfra calibrate` trains one".to_owned(),
    };
    format!(
        "\nFriction, grid search\n  search       {}\n  gain         {}, in the matrices\n  \
         friction     c1 {c1:.4}, c3 {c3:.4}\n  network      {correction}\n{}",
        grid(plan, design),
        short(constants.gain),
        stages(plan, design)
    )
}

/// How many points of the grid are evaluated at a time.
fn grid(plan: &JointPlan, design: &Design) -> String {
    let SearchPlan { side, parallel, taxels, .. } = plan.search;
    let at_a_time = if plan.search.is_serial() {
        format!("{parallel} at a time, as optimise is \"area\"")
    } else {
        match taxels {
            1 if design.hardware.lanes > MANY_LANES => {
                "all at a time, a taxel a cycle: contacts are counted as slowly".to_owned()
            }
            1 => "all at a time, a taxel a cycle".to_owned(),
            _ => format!("all at a time, {taxels} taxels a cycle with more than {MANY_LANES} lanes"),
        }
    };
    format!("{side} x {side} points, {at_a_time}")
}

/// What the search spends its cycles on. Each stage has a frame of its own; the lanes work beside them.
fn stages(plan: &JointPlan, design: &Design) -> String {
    let sensor = &design.sensor;
    let cycles: Vec<u64> = timing::stages(sensor, plan).iter().map(|stage| stage.cycles).collect();
    let level = plan.search.level(sensor);
    let after = match (&plan.network, &cycles[1..]) {
        (Some(network), [features, correction]) => format!(
            "  features     {features} cycles, and a window of {}\n  correction   {correction} cycles: first word of the window {}, network {}, friction {}\n",
            timing::window(network),
            timing::FIRST_WORD,
            timing::network(network),
            timing::CORRECTED
        ),
        _ => format!("  correction   {} cycles: friction\n", timing::FRICTION),
    };
    format!(
        "  search       {} cycles: first row of points {}, level set {level}\n{after}",
        cycles[0],
        cycles[0] - level
    )
}

/// Forces are divided by the gain, which should be the kernel's.
pub fn kernel_advice(design: &Design, indent: &str) -> String {
    let algorithm = &design.algorithm;
    let (wants, has) = (gain(&design.sensor, algorithm.kernel), algorithm.joint.gain);
    // On layers of less than half a pitch the kernels change places.
    let is_better = (algorithm.kernel == Kernel::Cell) == design.sensor.wants_cells();
    let [own, other] = match algorithm.kernel {
        Kernel::Point => ["\"point\"", "\"cell\""],
        Kernel::Cell => ["\"cell\"", "\"point\""],
    };
    let verdict = match (is_better, (has / wants - 1.0).abs() > STALE_GAIN) {
        (_, true) => "run sptfra calibrate, or F_z is off by as much as they differ".to_owned(),
        (true, false) => format!("so F_z is right, and mu comes out better than with {other}"),
        (false, false) => format!("so F_z is right; mu comes out better with {other} than with {own}, calibrated anew"),
    };
    format!("{}: wants a gain of {wants:.3}, the grid search has {has:.3}:\n{indent}{verdict}", algorithm.kernel)
}
