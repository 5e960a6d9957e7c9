//! Creep: how it is removed, in integers.

use golden::design::Design;

use super::factor::{Factor, WITH_FRACTION};
use crate::cores::LONG_BITS;
use crate::format::Format;

/// Bits of a taxel's creep below a step of the stress.
const FRACTION: u32 = 17;
/// Bits of [`CreepPlan::bits`].
pub const PARAMETER_BITS: u32 = 2 * WITH_FRACTION;
/// Bits of a word of the memory.
pub const WORD_BITS: u32 = LONG_BITS + FRACTION;
/// No creep: cut to the step of the stress, what is added to it is rounded.
const NONE: i64 = 1 << (FRACTION - 1);

/// What removes creep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CreepPlan {
    /// Creep in the end over the stress.
    pub strength: Factor,
    /// Share of the way there from a frame to the next; more fraction bits than a creep has.
    pub share: Factor,
}

impl CreepPlan {
    /// That of a design, if its readings creep.
    pub fn new(design: &Design) -> Option<Self> {
        let creep = design.input.creep?;
        Some(Self { strength: Factor::new(creep.strength), share: Factor::new(creep.share()) })
    }

    /// As the hardware has it: the strength above the share.
    pub fn bits(&self) -> u64 {
        (self.strength.bits() << WITH_FRACTION) | self.share.bits()
    }

    /// Takes creep off a good frame and lets it go on; `creep` is empty before the first frame.
    pub fn remove(&self, creep: &mut Vec<i64>, stress: &mut [i64], format: Format) {
        creep.resize(stress.len(), NONE);
        for (creep, stress) in creep.iter_mut().zip(stress) {
            let whole = *creep >> FRACTION;
            *stress = (*stress - whole).clamp(-format.bound, format.bound);
            let end = self.strength.times(*stress);
            *creep += (self.share.factor * ((end - whole) >> 1)) >> (self.share.fraction - FRACTION - 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use golden::creep::{Creep, FRAMES};
    use proptest::prelude::*;

    use super::*;

    fn creep(strength: f64, frames: f64) -> Creep {
        Creep { strength, seconds: frames / 1024.0, frames_per_second: 1024.0 }
    }

    fn plan(creep: &Creep) -> CreepPlan {
        let text = format!(
            "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 6\nrows = 5\n\
             pitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n\
             creep = {{ strength = {:?}, seconds = {:?}, frames_per_second = {:?} }}",
            creep.strength, creep.seconds, creep.frames_per_second
        );
        CreepPlan::new(&Design::from_toml(&text, "pad.toml").unwrap()).unwrap()
    }

    proptest! {
        /// Whatever comes: no word overflows, and the integers stay at `golden`'s creep within what factors of 17 bits and four
        /// roundings leave.
        #[test]
        fn creep_is_that_of_golden(
            strength in 0.001..=1.0_f64,
            frames in prop_oneof![Just(FRAMES[0]), Just(FRAMES[1]), 2.0..2000.0_f64],
            levels in prop::collection::vec((-1.0..=1.0_f64, 1..300_usize), 1..12),
        ) {
            let format = Format::covering(f64::from(1 << 20), LONG_BITS);
            let exact = creep(strength, frames);
            let plan = plan(&exact);
            let (mut past, mut exact_past) = (Vec::new(), Vec::new());
            for (level, times) in levels {
                for _ in 0..times {
                    let mut stress = [(level * format.bound as f64).round() as i64];
                    let mut expected = [stress[0] as f64];
                    plan.remove(&mut past, &mut stress, format);
                    exact.remove(&mut exact_past, &mut expected, format.bound as f64);
                    prop_assert!(past[0].unsigned_abs() < 1 << (WORD_BITS - 1));
                    let far = (stress[0] as f64 - expected[0]).abs();
                    prop_assert!(far < 4.0 + 4e-5 * format.bound as f64, "{far}");
                }
            }
        }
    }

    #[test]
    fn a_share_has_more_fraction_bits_than_a_creep() {
        for frames in FRAMES {
            assert!(plan(&creep(1.0, frames)).share.fraction > FRACTION, "{frames}");
        }
    }
}
