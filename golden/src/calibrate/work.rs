//! How much work a calibration is asked to take on.

use super::{CalibrateError, Settings};
use crate::estimators::joint::{MAX_HIDDEN, TrainingSet};

/// Hidden units for sliding contacts: with twice as many a frame takes a quarter longer on 16 lanes.
const HIDDEN_SLIDING: usize = 64;

impl Settings {
    /// What a user asks for: `hidden` units if the usual number is not wanted, `quick` for a tenth of the work, `thorough`
    /// for four times as much and more.
    ///
    /// # Errors
    ///
    /// [`CalibrateError::Wrong`] for more units than the hardware has room for.
    pub fn of(
        training_set: TrainingSet,
        seed: u64,
        hidden: Option<usize>,
        quick: bool,
        thorough: bool,
    ) -> Result<Self, CalibrateError> {
        if let Some(hidden) = hidden.filter(|&hidden| hidden > MAX_HIDDEN) {
            return Err(CalibrateError::Wrong(format!(
                "--hidden {hidden}: the hardware has room for {MAX_HIDDEN}; use at most {MAX_HIDDEN}"
            )));
        }
        let usual = if quick { Self::quick() } else { Self::default() };
        let usual = match training_set {
            TrainingSet::Sliding => Self { hidden: usual.hidden.min(HIDDEN_SLIDING), ..usual },
            // A contact has one direction only, so there are more of them.
            TrainingSet::General => {
                Self { contacts: 2 * usual.contacts, samples: usual.samples + usual.samples / 5, ..usual }
            }
        };
        let settings = Self { seed, hidden: hidden.unwrap_or(usual.hidden), ..usual };
        Ok(if thorough { settings.thorough() } else { settings })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliding_contacts_have_fewer_units() {
        let units = |training_set, quick, hidden| Settings::of(training_set, 1, hidden, quick, false).unwrap().hidden;
        assert_eq!(units(TrainingSet::Sliding, false, None), 64);
        assert_eq!(units(TrainingSet::General, false, None), 128);
        assert_eq!(units(TrainingSet::Sliding, true, None), 24);
        assert_eq!(units(TrainingSet::Sliding, false, Some(200)), 200);
    }
}
