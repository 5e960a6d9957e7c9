//! Creep: what readings rise by under constant load, removed by one strength and one time for all taxels.
//!
//! A taxel under a stress s reads s + c, where c approaches `strength` times s with the time constant `seconds`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Frames that a time constant has at least and at most: the hardware's fixed point holds these.
pub const FRAMES: [f64; 2] = [2.0, 131_072.0];

/// Key `sensor.creep`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Creep {
    /// Share of the stress that creep adds in the end.
    #[schemars(range(min = 0.001, max = 1.0))]
    pub strength: f64,
    /// Time in which it has gone all but 1/e of the way.
    #[schemars(range(min = 0.001, max = 100_000.0))]
    pub seconds: f64,
    /// Frames a second that the sensor delivers.
    #[schemars(range(min = 0.01, max = 1_000_000.0))]
    pub frames_per_second: f64,
}

impl Creep {
    /// The time constant in frames.
    pub fn frames(&self) -> f64 {
        self.seconds * self.frames_per_second
    }

    /// Share of the way to its end that creep goes from a frame to the next.
    pub fn share(&self) -> f64 {
        -(-1.0 / self.frames()).exp_m1()
    }

    /// Takes creep off a good frame of stresses, within `bound`, and lets it go on. Before the first frame `creep` is empty,
    /// or of another sensor's length.
    pub fn remove(&self, creep: &mut Vec<f64>, frame: &mut [f64], bound: f64) {
        let share = self.share();
        for (creep, stress) in taxels(creep, frame) {
            *stress = (*stress - *creep).clamp(-bound, bound);
            *creep += share * (self.strength * *stress - *creep);
        }
    }

    /// Adds creep to a frame of true stresses, as a sensor does, and lets it go on.
    pub fn add(&self, creep: &mut Vec<f64>, frame: &mut [f64]) {
        let share = self.share();
        for (creep, stress) in taxels(creep, frame) {
            let before = *creep;
            *creep += share * (self.strength * *stress - *creep);
            *stress += before;
        }
    }
}

/// The creep of each taxel beside its stress: none where there was no frame before, or another sensor's.
fn taxels<'a>(creep: &'a mut Vec<f64>, frame: &'a mut [f64]) -> impl Iterator<Item = (&'a mut f64, &'a mut f64)> {
    if creep.len() != frame.len() {
        *creep = vec![0.0; frame.len()];
    }
    creep.iter_mut().zip(frame)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const CREEP: Creep = Creep { strength: 0.4, seconds: 10.0, frames_per_second: 20.0 };

    /// What a taxel with this creep reads of a load.
    pub(crate) fn readings(creep: &Creep, load: &[f64]) -> Vec<f64> {
        let mut past = Vec::new();
        let mut read = |load: &f64| {
            let mut frame = [*load];
            creep.add(&mut past, &mut frame);
            frame[0]
        };
        load.iter().map(&mut read).collect()
    }

    #[test]
    fn a_step_creeps_exponentially() {
        for frames in [2.0, 200.0] {
            let creep = Creep { strength: 0.4, seconds: frames / 20.0, frames_per_second: 20.0 };
            let read = readings(&creep, &[-700.0; 300]);
            for (n, read) in read.iter().enumerate() {
                let expected = -700.0 * (1.0 + 0.4 * (1.0 - f64::exp(-(n as f64) / frames)));
                assert!((read - expected).abs() < 1e-9, "{frames}, {n}: {read} {expected}");
            }
        }
    }

    #[test]
    fn what_creeps_is_corrected_whatever_the_load() {
        let load: Vec<f64> = (0..900).map(|n| if n % 170 < 60 { -900.0 } else { 20.0 }).collect();
        let mut past = vec![5.0; 3];
        for (load, read) in load.iter().zip(readings(&CREEP, &load)) {
            let mut frame = [read];
            CREEP.remove(&mut past, &mut frame, 1e4);
            assert!((frame[0] - load).abs() < 1e-9, "{} {load}", frame[0]);
        }
        let mut frame = [-700.0];
        CREEP.remove(&mut past, &mut frame, 100.0);
        assert_eq!(frame[0].to_bits(), (-100.0_f64).to_bits(), "within the bound");
    }
}
