//! Where the values of a frame stand in a file.

use crate::design::Design;
use crate::sensor::Sensor;

/// Lines and columns of a file that hold frames. The default is a frame a line, or what a header says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Columns before the values.
    pub labels: usize,
    /// First and last column of the values, from 1; in place of `labels`, where columns follow them.
    pub columns: Option<[usize; 2]>,
    /// Lines at the beginning that are skipped.
    pub skip_lines: usize,
    /// Whether frames with a value that is no number are left out and counted.
    pub skip_bad: bool,
}

impl From<usize> for Layout {
    /// Columns of labels before the values.
    fn from(labels: usize) -> Self {
        Self { labels, ..Self::default() }
    }
}

impl Layout {
    /// Columns before the values.
    pub(super) fn first(&self) -> usize {
        self.columns.map_or(self.labels, |[first, _]| first.saturating_sub(1))
    }
}

/// What frames are read for.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) sensor: Sensor,
    /// Taxels that may read anything.
    pub(super) dead: Vec<usize>,
    /// Whether values are counts.
    pub(super) counts: bool,
    /// Pascals of a count, without its sign, where one number says so.
    pub(super) per_count: Option<f64>,
}

impl From<&Design> for Target {
    fn from(design: &Design) -> Self {
        Self {
            sensor: design.sensor.clone(),
            dead: design.input.dead.clone(),
            counts: design.input.counts(),
            per_count: design.input.pa_per_count.map(f64::abs),
        }
    }
}
