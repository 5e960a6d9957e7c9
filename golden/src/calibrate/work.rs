//! How much work a calibration is asked to take on.

use super::{CalibrateError, Settings};
use crate::estimators::joint::{MAX_HIDDEN, TrainingSet};

/// Hidden units for sliding contacts: with twice as many a frame takes a quarter longer on 16 lanes.
const HIDDEN_SLIDING: usize = 64;

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
    /// What that means for a training set.
    ///
    /// # Errors
    ///
    /// [`CalibrateError::Hidden`] for more units than the hardware has room for.
    pub fn settings(self, training_set: TrainingSet) -> Result<Settings, CalibrateError> {
        if let Some(hidden) = self.hidden.filter(|&hidden| hidden > MAX_HIDDEN) {
            return Err(CalibrateError::Hidden { hidden });
        }
        let usual = if self.quick { Settings::quick() } else { Settings::default() };
        let usual = match training_set {
            TrainingSet::Sliding => Settings { hidden: usual.hidden.min(HIDDEN_SLIDING), ..usual },
            // A contact has one direction only, so there are more of them.
            TrainingSet::General => {
                Settings { contacts: 2 * usual.contacts, samples: usual.samples + usual.samples / 5, ..usual }
            }
        };
        let settings = Settings { seed: self.seed, hidden: self.hidden.unwrap_or(usual.hidden), ..usual };
        Ok(if self.thorough { settings.thorough() } else { settings })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliding_contacts_have_fewer_units() {
        let units = |training_set, quick, hidden| {
            let work = Work { seed: 1, hidden, quick, thorough: false };
            work.settings(training_set).unwrap().hidden
        };
        assert_eq!(units(TrainingSet::Sliding, false, None), 64);
        assert_eq!(units(TrainingSet::General, false, None), 128);
        assert_eq!(units(TrainingSet::Sliding, true, None), 24);
        assert_eq!(units(TrainingSet::Sliding, false, Some(200)), 200);
    }
}
