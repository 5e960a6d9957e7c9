//! The line estimator in the words of `hdl-gen inspect`.

use golden::design::{Design, Kernel};
use golden::kernel::gain;

/// Forces are not divided by a gain, so that a wide contact's are found too small or too large by the kernel's.
pub fn kernel_advice(design: &Design, indent: &str) -> String {
    let gain = |of| gain(&design.sensor, of);
    let off = |of| 100.0 * (1.0 / gain(of) - 1.0);
    let lost = 100.0 * (1.0 - gain(Kernel::Cell) / gain(Kernel::Point));
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
