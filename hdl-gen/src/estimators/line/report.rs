//! The line estimator in the words of `hdl-gen inspect`.

use golden::design::{Design, Kernel};
use golden::kernel::gain;

use super::{BISECTING_LANES, EIGHTHS_ELEMENTS, LinePlan, PART_BITS, SEARCH_STEPS, timing};

/// How the line is searched, and why so.
pub fn report(plan: &LinePlan, design: &Design) -> String {
    let (lanes, taxels) = (design.hardware.lanes, plan.cells.elements);
    let rounds = if plan.eighths {
        let eighths = PART_BITS.len();
        format!(
            "{eighths} of eight parts: {lanes} lanes, more than {BISECTING_LANES}, would wait for {SEARCH_STEPS} of two; \
             {taxels} taxels a cell, {EIGHTHS_ELEMENTS} at most"
        )
    } else if lanes <= BISECTING_LANES {
        format!(
            "{SEARCH_STEPS} of two parts: up to {BISECTING_LANES} lanes do not wait for them; eight parts take more adders"
        )
    } else {
        format!(
            "{SEARCH_STEPS} of two parts: {taxels} taxels a cell, more than {EIGHTHS_ELEMENTS}, take most of a round's time"
        )
    };
    format!(
        "\nFriction, line estimator\n  search       {} cycles: minimum, then both ends of the level set\n  rounds       {rounds}\n",
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
