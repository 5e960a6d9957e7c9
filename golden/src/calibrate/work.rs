//! How much work a calibration is asked to take on.

use super::{CalibrateError, MOST_HIDDEN_WIDE, Settings};
use crate::estimators::joint::{Family, Grid, MAX_HIDDEN};

/// Hidden units for the narrow family on the coarse grid, which is for speed: with twice as many a frame takes a quarter
/// longer on 16 lanes.
const HIDDEN_COARSE: usize = 64;

/// What a user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// Seed of all that is random.
    pub seed: u64,
    /// Hidden units of the correction, if the usual number is not wanted.
    pub hidden: Option<usize>,
    /// Whether a tenth of the work must do.
    pub quick: bool,
    /// Whether it may be four times the work, and more.
    pub thorough: bool,
}

impl Work {
    /// What that means for a family of contacts and a grid of the search.
    ///
    /// # Errors
    ///
    /// [`CalibrateError::Hidden`] for more units than the hardware has room for.
    pub fn settings(self, family: Family, grid: Grid) -> Result<Settings, CalibrateError> {
        let (most, why) = match family {
            Family::Narrow => (MAX_HIDDEN, ""),
            Family::Wide => {
                (MOST_HIDDEN_WIDE, "with family \"wide\" a quarter as many units more tell the error, and ")
            }
        };
        if let Some(hidden) = self.hidden.filter(|&hidden| hidden > most) {
            return Err(CalibrateError::Hidden { hidden, why, most });
        }
        let usual = Settings::of(family, self.quick);
        let coarse = family == Family::Narrow && grid == Grid::COARSE;
        let units = if coarse { usual.hidden.min(HIDDEN_COARSE) } else { usual.hidden };
        let settings = Settings { seed: self.seed, hidden: self.hidden.unwrap_or(units), ..usual };
        Ok(if self.thorough { settings.thorough() } else { settings })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coarse_grid_has_fewer_units() {
        let units = |family, grid, quick, hidden| {
            let work = Work { seed: 1, hidden, quick, thorough: false };
            work.settings(family, grid).unwrap().hidden
        };
        assert_eq!(units(Family::Narrow, Grid::COARSE, false, None), 64);
        assert_eq!(units(Family::Narrow, Grid::FINE, false, None), 128);
        assert_eq!(units(Family::Wide, Grid::COARSE, false, None), 128);
        assert_eq!(units(Family::Narrow, Grid::COARSE, true, None), 24);
        assert_eq!(units(Family::Narrow, Grid::COARSE, false, Some(200)), 200);
    }
}
