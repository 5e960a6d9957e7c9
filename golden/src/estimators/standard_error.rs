//! The standard error of the tangential force, as a share of the normal force: what noise, the model and the grid's
//! border each add to it.
//!
//! `s = |model, noise sigma max|b| / sum|b|, border e|`, where `e` is the share of `sum|b|` on taxels at the border beyond
//! [`BORDER`], and `|x, y|` is [`added`]: the hardware takes the same steps. Three numbers of a design, fitted to contacts of
//! all kinds by [`crate::calibrate::state_errors`]. Where the noise was measured, a typical largest reading takes the place of
//! `max|b|`: the deviation `sigma max|b|` is that of every frame.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fraction bits of the logarithm.
pub const ERROR_FRACTION: u32 = 12;
/// Least and largest logarithm of base 2: a thousandth of the normal force, and four times as much.
pub const ERROR_RANGE: [i32; 2] = [-10, 2];
/// Share of `sum|b|` that taxels at the grid's border have of a contact inside the grid.
pub const BORDER: f64 = 1.0 / 32.0;

/// The three numbers of a design.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StandardError {
    /// The error without noise, as a share of the normal force.
    #[schemars(range(min = 0.001, max = 3.9))]
    pub model: f64,
    /// The error for noise: times `sensor.noise`, and the largest reading over the sum of all.
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub noise: f64,
    /// The error for contacts at the grid's border: times the share of stress there.
    #[schemars(range(min = 0.0, max = 15.9))]
    pub border: f64,
}

/// What the standard error depends on in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Marks {
    /// `max|b| / sum|b|`.
    pub(crate) peak: f64,
    /// Share of `sum|b|` at the grid's border, beyond [`BORDER`].
    pub(crate) border: f64,
}

impl Marks {
    /// Of the stress `b`, in rows of `columns`, with noise in proportion to its largest, or to that of a typical contact.
    pub(crate) fn of(b: &[f64], columns: usize, typical_pa: Option<f64>) -> Self {
        let (mut largest, mut sum, mut border) = (0.0_f64, 0.0, 0.0);
        let rows = b.len() / columns;
        for (taxel, stress) in b.iter().enumerate() {
            let (x, y, stress) = (taxel % columns, taxel / columns, stress.abs());
            largest = largest.max(stress);
            sum += stress;
            if x == 0 || y == 0 || x + 1 == columns || y + 1 == rows {
                border += stress;
            }
        }
        let share = |part: f64| if sum > 0.0 { part / sum } else { 0.0 };
        Self { peak: share(typical_pa.unwrap_or(largest)), border: (share(border) - BORDER).max(0.0) }
    }
}

impl StandardError {
    /// The standard error over `|F_z|` at a noise that is a share of the frame's largest reading.
    pub(crate) fn share(&self, noise: f64, marks: Marks) -> f64 {
        let share = added(added(self.model, self.noise * noise * marks.peak), self.border * marks.border);
        let [least, most] = ERROR_RANGE.map(|log| f64::from(log).exp2());
        share.clamp(least, most * (1.0 - (-f64::from(ERROR_FRACTION)).exp2()))
    }
}

/// Two independent errors together: `sqrt(x^2 + y^2)` within 3 %, without a square or a root.
pub(crate) fn added(x: f64, y: f64) -> f64 {
    let (larger, smaller) = (x.max(y), x.min(y));
    larger.max(0.875 * larger + 0.5 * smaller)
}

/// The logarithm of base 2 that stands for a ratio above 0: `n + f` for `2^n (1 + f)`, as the hardware has it.
pub fn log(ratio: f64) -> f64 {
    let whole = ratio.log2().floor();
    whole + ratio / whole.exp2() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_add_as_squares() {
        for (x, y) in [(1.0, 0.0), (0.3, 0.1), (0.2, 0.2), (0.1, 0.7), (1.0, 0.25)] {
            let exact = f64::hypot(x, y);
            assert!((added(x, y) / exact - 1.0).abs() < 0.031, "{x} {y}");
            assert_eq!(added(x, y).to_bits(), added(y, x).to_bits());
        }
        assert!((log(0.125) + 3.0).abs() < 1e-12 && (log(0.1875) + 2.5).abs() < 1e-12);
    }

    #[test]
    fn each_mark_has_its_share() {
        let of = StandardError { model: 0.03, noise: 100.0, border: 1.0 };
        let middle: Vec<f64> = (0..25).map(|taxel| if taxel == 12 { -4.0 } else { 0.0 }).collect();
        let edge: Vec<f64> = (0..25).map(|taxel| if taxel == 10 { -4.0 } else { 0.0 }).collect();
        let [middle, edge] = [middle, edge].map(|b| Marks::of(&b, 5, None));
        assert_eq!(middle, Marks { peak: 1.0, border: 0.0 });
        assert_eq!(edge, Marks { peak: 1.0, border: 1.0 - BORDER });
        assert!((of.share(0.0, middle) - 0.03).abs() < 1e-12);
        assert!((of.share(0.01, middle) - added(0.03, 1.0)).abs() < 1e-12);
        assert!(of.share(0.0, edge) > 0.9);
        // Measured noise is as large under a light contact: twice the share where it reads half.
        let light: Vec<f64> = (0..25).map(|taxel| if taxel == 12 { -2.0 } else { 0.0 }).collect();
        assert_eq!(Marks::of(&light, 5, Some(4.0)), Marks { peak: 2.0, border: 0.0 });
        // Nothing at all has no share.
        assert_eq!(Marks::of(&[0.0; 25], 5, None), Marks { peak: 0.0, border: 0.0 });
    }
}
