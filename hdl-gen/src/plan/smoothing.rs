//! Smoothing: how frames are averaged, in integers.

use golden::design::Design;
use golden::smoothing::RESTART;

use super::factor::{Factor, WITH_FRACTION};
use crate::cores::LONG_BITS;
use crate::format::{Format, pow2};

/// Largest rate.
pub const MOST_RATE: u32 = 8;
/// Bits of an average below the step of a stress: with a weight of `2^-8` what is constant is reached to a quarter of a step.
const FRACTION: u32 = 9;
/// Added to each average: cut to the step of the stress, it is rounded.
const HALF: i64 = 1 << (FRACTION - 1);
/// Fraction bits of the variance of the noise left.
pub const VARIANCE_FRACTION: u32 = 24;
/// Bits of the parameter.
pub const PARAMETER_BITS: u32 = LONG_BITS + WITH_FRACTION;
/// Bits that the memory keeps of a taxel: its stress, its average.
pub const WORD_BITS: u32 = LONG_BITS + LONG_BITS + FRACTION;

/// How frames are averaged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SmoothingPlan {
    /// The weight of a frame is `2^-rate`, unless a register says otherwise.
    pub rate: u32,
    /// A step beyond so many times the largest stress, cut to whole steps, restarts the average.
    pub restart: Factor,
    /// Of this stress in place of the frame's largest, where the noise was measured.
    pub largest: Option<i64>,
}

/// The average of the frames so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Average {
    /// None before the first.
    stress: Vec<i64>,
    /// Variance of the noise in it, over that of a frame, [`VARIANCE_FRACTION`] fraction bits.
    pub variance: i64,
}

impl Default for Average {
    fn default() -> Self {
        Self { stress: Vec::new(), variance: 1 << VARIANCE_FRACTION }
    }
}

impl SmoothingPlan {
    /// That of a design, if it averages frames.
    pub fn new(design: &Design, stress: Format) -> Option<Self> {
        let input = &design.input;
        (input.smoothing > 0).then(|| Self {
            rate: input.smoothing,
            restart: Factor::new(RESTART * input.noise),
            largest: input.typical_pa().map(|pascals| ((pascals * pow2(-stress.lsb)).round() as i64).max(1)),
        })
    }

    /// As the hardware has it: the stress that a step is compared with, or 0, above the factor.
    pub fn bits(&self) -> u64 {
        (self.largest.unwrap_or(0).unsigned_abs() << WITH_FRACTION) | self.restart.bits()
    }

    /// Takes a good frame into the average, with the weight `2^-rate`, and puts the average in its place. Steps of `replaced`
    /// taxels restart nothing.
    pub fn take(&self, rate: u32, average: &mut Average, stress: &mut [i64], replaced: &[usize]) {
        let Average { stress: average, variance } = average;
        let most = stress.iter().fold(0, |most, stress| most.max(stress.abs()));
        let limit = self.restart.times(self.largest.unwrap_or(most));
        let exact = |stress: i64| (stress << FRACTION) + HALF;
        let is_far = |(taxel, (average, stress)): (usize, (&i64, &i64))| {
            let step = (exact(*stress) - average) >> FRACTION;
            !replaced.contains(&taxel) && (if step < 0 { !step } else { step }) > limit
        };
        if average.len() != stress.len() || average.iter().zip(&*stress).enumerate().any(is_far) {
            *average = stress.iter().copied().map(exact).collect();
            *variance = 1 << VARIANCE_FRACTION;
            return;
        }
        for (average, stress) in average.iter_mut().zip(stress) {
            *average += ((((exact(*stress) - *average) * 2) >> rate) + 1) >> 1;
            *stress = *average >> FRACTION;
        }
        let lessened = *variance - (*variance >> rate);
        *variance = lessened - (lessened >> rate) + ((1 << VARIANCE_FRACTION) >> (2 * rate));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::format::largest;

    const TAXELS: usize = 4;

    fn plan() -> SmoothingPlan {
        let text = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 6\nrows = 5\n\
                    pitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\nnoise = 0.1\nsmoothing = 4";
        let stress = Format { bits: LONG_BITS, lsb: 0, bound: largest(LONG_BITS) };
        SmoothingPlan::new(&Design::from_toml(text, "pad.toml").unwrap(), stress).unwrap()
    }

    fn stress() -> impl Strategy<Value = Vec<i64>> {
        let most = largest(LONG_BITS);
        prop::collection::vec(prop_oneof![-most..=most, Just(-most), Just(most), -3..=3_i64], TAXELS)
    }

    proptest! {
        /// Whatever comes: no average leaves its word, and none is outside of what the taxel has read.
        #[test]
        fn averages_stay_within_what_was_read(
            frames in prop::collection::vec((stress(), 0..=8_u32, any::<bool>()), 1..60),
        ) {
            let (plan, mut average) = (plan(), Average::default());
            let mut range = [[i64::MAX, i64::MIN]; TAXELS];
            for (frame, rate, free) in frames {
                let mut stress = frame.clone();
                // Nothing restarts where every taxel is replaced.
                plan.take(rate, &mut average, &mut stress, if free { &[0, 1, 2, 3] } else { &[] });
                for (taxel, [least, most]) in range.iter_mut().enumerate() {
                    (*least, *most) = ((*least).min(frame[taxel]), (*most).max(frame[taxel]));
                    prop_assert!((*least..=*most).contains(&stress[taxel]));
                    prop_assert!(average.stress[taxel].unsigned_abs() < 1 << (LONG_BITS + FRACTION - 1));
                }
            }
        }

        /// A constant frame is its own average. One at most 1,000 steps away is reached within `20 2^rate` frames.
        #[test]
        fn what_is_constant_is_reached(from in stress(), by in -1_000_i64..=1_000, rate in 0..=8_u32) {
            let (plan, mut average) = (plan(), Average::default());
            let mut take = |frame: &[i64]| {
                let mut stress = frame.to_vec();
                plan.take(rate, &mut average, &mut stress, &[0, 1, 2, 3]);
                stress
            };
            for _ in 0..3 {
                prop_assert_eq!(take(&from), from.clone());
            }
            let to: Vec<i64> = from.iter().map(|stress| stress + by).collect();
            let frames = 20 << rate;
            let last = (0..frames).map(|_| take(&to)).last().unwrap();
            prop_assert_eq!(last, to);
        }

        /// A step beyond the limit is there at once, in all taxels; one below it is not.
        #[test]
        fn steps_restart_from_the_limit_on(from in 1_000..1_000_000_i64, share in 0.0..2.0_f64, rate in 1..=8_u32) {
            let (plan, mut average) = (plan(), Average::default());
            let mut first = vec![from, -from, 0, 0];
            plan.take(rate, &mut average, &mut first, &[]);
            // The largest stress stays; the limit is 0.6 of it.
            let step = (share * 0.6 * from as f64).round() as i64;
            let second = vec![from, -from, step, 1];
            let mut found = second.clone();
            plan.take(rate, &mut average, &mut found, &[]);
            // Measured noise has one limit, however much presses.
            let measured = SmoothingPlan { largest: Some(from), ..plan.clone() };
            for scale in [1, 3] {
                let (mut average, mut second) = (Average::default(), [scale * from, 0, scale * from + step, 0]);
                measured.take(rate, &mut average, &mut [scale * from, 0, scale * from, 0], &[]);
                measured.take(rate, &mut average, &mut second, &[]);
                if share > 1.0 + 1e-2 {
                    prop_assert_eq!(second[2], scale * from + step);
                } else if share < 1.0 - 1e-2 && step > 1 {
                    prop_assert!(second[2] < scale * from + step, "{}", scale);
                }
            }
            if share > 1.0 + 1e-2 {
                prop_assert_eq!(found, second);
            } else if share < 1.0 - 1e-2 && step > 1 {
                prop_assert!(found[2] < step, "{} {}", found[2], step);
            }
        }
    }
}
