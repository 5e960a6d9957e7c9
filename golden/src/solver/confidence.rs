//! Standard error of a design's frames, and where confidence ends.

use crate::design::{Algorithm, Design};
use crate::estimators::StandardError;
use crate::estimators::standard_error::Marks;

/// The standard error of a design's frames, and where confidence ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Confidence {
    of: StandardError,
    noise: f64,
    typical_pa: Option<f64>,
    columns: usize,
    /// A frame with a larger one has low confidence.
    pub(super) most: f64,
}

impl Confidence {
    /// That of a design, if its standard error was fitted.
    pub(super) fn of(design: &Design) -> Option<Self> {
        let Algorithm { standard_error, max_standard_error: most, .. } = &design.algorithm;
        let (noise, typical_pa, columns) = (design.input.noise, design.input.typical_pa(), design.sensor.columns);
        standard_error.map(|of| Self { of, noise, typical_pa, columns, most: *most })
    }

    /// The standard error over `|F_z|` of the stress `b`, in which this much is left of a frame's noise.
    pub(super) fn share(&self, b: &[f64], noise_left: f64) -> f64 {
        self.of.share(self.noise * noise_left, Marks::of(b, self.columns, self.typical_pa))
    }
}
