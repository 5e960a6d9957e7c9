//! The line search in the words of `sptfra inspect`.

use golden::design::{Design, Kernel};
use golden::kernel::gain;

use super::{LinePlan, ONE_POINT_LANES, SEARCH_STEPS, THREE_POINTS_ELEMENTS, timing};

/// How the line is searched, and why so.
pub fn report(plan: &LinePlan, design: &Design) -> String {
    let (lanes, taxels) = (design.hardware.lanes, plan.cells.elements);
    let rounds = timing::rounds(plan);
    let rounds = if plan.points > 1 {
        format!(
            "{rounds} of two bisections: {lanes} lanes, more than {ONE_POINT_LANES}, would wait for {SEARCH_STEPS}; \
             {taxels} taxels a cell, {THREE_POINTS_ELEMENTS} at most"
        )
    } else if lanes <= ONE_POINT_LANES {
        format!(
            "{rounds} of a bisection: up to {ONE_POINT_LANES} lanes do not wait for them; two at a time take more adders"
        )
    } else {
        format!(
            "{rounds} of a bisection: {taxels} taxels a cell, more than {THREE_POINTS_ELEMENTS}, take most of a round's time"
        )
    };
    format!(
        "\nFriction, line search\n  search       {} cycles: minimum, then both ends of the level set\n  rounds       {rounds}\n",
        timing::search(plan)
    )
}

/// Forces are not divided by a gain, so that a wide contact's are found too small or too large by the kernel's.
pub fn kernel_advice(design: &Design, indent: &str) -> String {
    let gain = |of| gain(&design.sensor, of);
    let off = |of| 100.0 * (1.0 / gain(of) - 1.0);
    let lost = 100.0 * (1.0 - gain(Kernel::Cell) / gain(Kernel::Point));
    // On layers of less than half a pitch mu is far off by either, and by cells at least F_z is right.
    if design.sensor.wants_cells() {
        let of = design.algorithm.kernel;
        return format!(
            "{of}: F_z of a wide contact is off by {:+.1} %;\n{indent}on so thin a layer take \"cell\", and for mu \
             estimator = \"joint\"",
            off(of)
        );
    }
    match design.algorithm.kernel {
        Kernel::Point => format!(
            "point: F_z of a wide contact is off by {:+.1} %;\n{indent}\"cell\" makes it right, with mu {lost:.0} % \
             lower or a little more, and phi the same",
            off(Kernel::Point)
        ),
        Kernel::Cell => format!(
            "cell: F_z of a wide contact is off by {:+.1} %;\n{indent}mu is {lost:.0} % lower than with \
             \"point\" or a little more, phi the same",
            off(Kernel::Cell)
        ),
    }
}
