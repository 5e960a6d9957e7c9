//! How much work a calibration is asked to take on.

use super::{CalibrateError, MOST_HIDDEN_WIDE, Settings};
use crate::estimators::joint::{Family, MAX_HIDDEN};

/// What a user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// Seed of all that is random.
    pub seed: u64,
    /// Hidden units of the correction, if the usual number is not wanted.
    pub hidden: Option<usize>,
    /// Whether a tenth of the work must do.
    pub quick: bool,
}

impl Work {
    /// What that means for a family of contacts.
    ///
    /// # Errors
    ///
    /// [`CalibrateError::Hidden`] for more units than the hardware has room for.
    pub fn settings(self, family: Family) -> Result<Settings, CalibrateError> {
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
        Ok(Settings { seed: self.seed, hidden: self.hidden.unwrap_or(usual.hidden), ..usual })
    }
}
