//! What a real sensor does to the stress before it is read: unequal gains, noise, quantisation, broken taxels.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::design::Tension;
use crate::numbers::magnitude;

/// What a sensor does to the stress, in the order of the fields. The default is a sensor without errors, whose taxels are
/// points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorErrors {
    /// Sides of the part of its cell over which a taxel averages the stress, in metres; a point if absent.
    pub taxel_m: Option<[f64; 2]>,
    /// Share by which the layer is really deeper than the sensor says.
    pub depth: f64,
    /// What the taxels read of a pull. Where they read nothing, noise is no pull either.
    pub tension: Tension,
    /// Seed of all that is random; the same seed gives the same frames.
    pub seed: u64,
    /// Standard deviation of the taxels' gains around 1; a gain stays the same in all frames.
    pub gain_spread: f64,
    /// Standard deviation of the noise as a share of the largest |b| of the frame, before it; normally distributed
    /// and independent for every taxel and frame.
    pub noise: f64,
    /// Converter between the taxels and the frame.
    pub converter: Option<Converter>,
    /// Taxels that always read 0.
    pub dead: Vec<usize>,
    /// Taxels that always read the same stress in pascals, such as the end of the range.
    pub stuck: Vec<(usize, f64)>,
}

/// A converter of two's complement range: it rounds to a step, and clips at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    /// Width in bits.
    pub bits: u32,
    /// Stress in pascals at the end of the range; a step is this over `2^(bits - 1)`.
    pub full_scale_pa: f64,
}

impl Converter {
    /// The stress that is read in place of `stress`.
    fn read(self, stress: f64) -> f64 {
        let steps = f64::from(self.bits - 1).exp2();
        let step = self.full_scale_pa / steps;
        (stress / step).round().clamp(-steps, steps - 1.0) * step
    }
}

impl SensorErrors {
    /// Applies the errors to frame number `frame`, in place.
    pub(super) fn apply(&self, frame: usize, stress: &mut [f64]) {
        for value in &mut *stress {
            *value = self.tension.of(*value);
        }
        // A stream for the gains and one for each frame: a frame does not depend on how many there are before it.
        if self.gain_spread > 0.0 {
            let mut gains = stream(self.seed, 0);
            for value in &mut *stress {
                *value *= 1.0 + self.gain_spread * normal(&mut gains);
            }
        }
        if self.noise > 0.0 {
            let mut noise = stream(self.seed, 1 + frame as u64);
            let deviation = self.noise * magnitude(&*stress);
            for value in &mut *stress {
                *value += deviation * normal(&mut noise);
            }
        }
        for value in &mut *stress {
            *value = self.tension.of(*value);
        }
        if let Some(converter) = self.converter {
            for value in &mut *stress {
                *value = converter.read(*value);
            }
        }
        let broken = self.dead.iter().map(|&taxel| (taxel, 0.0)).chain(self.stuck.iter().copied());
        for (taxel, reading) in broken {
            if let Some(value) = stress.get_mut(taxel) {
                *value = reading;
            }
        }
    }
}

/// A stream of random numbers of a seed.
pub(crate) fn stream(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream);
    random
}

/// A normally distributed number with mean 0 and deviation 1 (Box and Muller).
pub fn normal(generator: &mut ChaCha8Rng) -> f64 {
    // Within (0, 1], so that the logarithm is finite.
    let radius = 1.0 - generator.random::<f64>();
    let angle = generator.random::<f64>();
    (-2.0 * radius.ln()).sqrt() * (TAU * angle).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(errors: &SensorErrors, frame: usize) -> Vec<f64> {
        let mut stress: Vec<f64> = (0..4000).map(|taxel| if taxel % 2 == 0 { -1000.0 } else { 500.0 }).collect();
        errors.apply(frame, &mut stress);
        stress
    }

    fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        [mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()]
    }

    #[test]
    fn noise_is_a_share_of_the_peak_and_new_in_each_frame() {
        let errors = SensorErrors { seed: 7, noise: 0.01, ..SensorErrors::default() };
        let clean = read(&SensorErrors::default(), 0);
        let noise = |frame| -> Vec<f64> { read(&errors, frame).iter().zip(&clean).map(|(a, b)| a - b).collect() };
        let [mean, deviation] = mean_and_deviation(&noise(0));
        // 4000 values: the mean lies within 0.16, the deviation within 0.11 of what is expected, times four.
        assert!(mean.abs() < 0.64 && (deviation - 10.0).abs() < 0.45, "{mean} {deviation}");
        assert_eq!(noise(3), noise(3));
        assert_ne!(noise(3), noise(4));
        assert_ne!(read(&SensorErrors { seed: 8, ..errors.clone() }, 0), read(&errors, 0));
    }

    #[test]
    fn gains_stay_from_frame_to_frame() {
        let errors = SensorErrors { gain_spread: 0.05, ..SensorErrors::default() };
        let clean = read(&SensorErrors::default(), 0);
        let gains: Vec<f64> = read(&errors, 0).iter().zip(&clean).map(|(a, b)| a / b).collect();
        let [mean, deviation] = mean_and_deviation(&gains);
        assert!((mean - 1.0).abs() < 0.0032 && (deviation - 0.05).abs() < 0.0023, "{mean} {deviation}");
        assert_eq!(read(&errors, 0), read(&errors, 9));
    }

    #[test]
    fn a_converter_rounds_and_clips() {
        let converter = Converter { bits: 8, full_scale_pa: 1280.0 };
        for (stress, reading) in [(-14.9, -10.0), (-15.1, -20.0), (4.9, 0.0), (2000.0, 1270.0), (-2000.0, -1280.0)] {
            assert!((converter.read(stress) - reading).abs() < 1e-12, "{stress}");
        }
    }

    #[test]
    fn broken_taxels_read_what_they_read() {
        let errors =
            SensorErrors { noise: 0.1, dead: vec![0, 3], stuck: vec![(2, -1e5), (5, 1e5)], ..SensorErrors::default() };
        let stress = read(&errors, 0);
        let expected = [Some(0.0), None, Some(-1e5), Some(0.0), None, Some(1e5)];
        for (taxel, expected) in expected.into_iter().enumerate() {
            assert!(expected.is_none_or(|value: f64| value.to_bits() == stress[taxel].to_bits()), "{taxel}");
        }
        assert!(stress[1] != 0.0);
    }
}
