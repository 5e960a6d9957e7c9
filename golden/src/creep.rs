//! Creep: what readings rise by under constant load, removed by one strength and one time for all taxels.
//!
//! A taxel under a stress s reads s + c, where c approaches `strength` times s with the time constant `seconds`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Frames that a time constant has at least and at most: the hardware's fixed point holds these.
pub const FRAMES: [f64; 2] = [2.0, 131_072.0];
/// Time constants that a fit tries, a ratio apart.
const TRIED: i32 = 1000;
/// A step of load has at least so many frames.
const FEWEST: usize = 20;
/// Rise of readings below which there is nothing to correct.
const LEAST_RISE: f64 = 0.01;

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

    /// Takes creep off a good frame, within `bound`, and lets it go on; `creep` is empty before the first frame.
    pub fn remove(&self, creep: &mut Vec<f64>, frame: &mut [f64], bound: f64) {
        creep.resize(frame.len(), 0.0);
        let share = self.share();
        for (creep, stress) in creep.iter_mut().zip(frame) {
            *stress = (*stress - *creep).clamp(-bound, bound);
            *creep += share * (self.strength * *stress - *creep);
        }
    }
}

/// Creep found in a recording.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fitted {
    /// What was found.
    pub creep: Creep,
    /// Seconds of constant load.
    pub held: f64,
    /// Share by which the readings rose in that time.
    pub rise: f64,
    /// Share by which they still change when creep is removed.
    pub left: f64,
}

/// Finds strength and time constant from a step of load: `sums` are those of each frame's stresses, `seconds` apart, from a
/// rest on. What lies above half of the largest is under load.
///
/// # Errors
///
/// What the recording lacks and what to do.
pub fn fit(sums: &[f64], seconds: f64) -> Result<Fitted, String> {
    let largest = sums.iter().fold(0.0_f64, |largest, sum| largest.max(sum.abs()));
    let loaded = |sum: &f64| sum.abs() > 0.5 * largest;
    let begin = sums.iter().position(loaded).unwrap_or(0);
    let end = begin + sums[begin..].iter().position(|sum| !loaded(sum)).unwrap_or(sums.len() - begin);
    // The load may arrive within a frame; the next one is taken for what it weighs.
    let held: Vec<f64> = sums[(begin + 1).min(end)..end].iter().map(|sum| sum.abs()).collect();
    if begin == 0 || held.len() < FEWEST {
        return Err(format!(
            "{} frames under load after {begin} without: begin without load, put a weight on in one move, and leave it \
             for at least {FEWEST} frames",
            held.len()
        ));
    }
    let duration = seconds * held.len() as f64;
    let ratio = (3.0 * held.len() as f64 / FRAMES[0]).powf(1.0 / f64::from(TRIED));
    let tried = (0..=TRIED).map(|step| strength(&held, FRAMES[0] * ratio.powi(step)));
    let Some((_, frames, strength)) = tried.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Err("no frames under load".to_owned());
    };
    let creep = Creep { strength, seconds: seconds * frames, frames_per_second: 1.0 / seconds };
    let rise = creep.strength * (1.0 - (-(held.len() as f64) / frames).exp());
    if rise < LEAST_RISE {
        return Err(format!(
            "the readings rise by {:.1} % in {duration:.1} s: there is no creep to correct",
            100.0 * rise
        ));
    }
    if frames > held.len() as f64 {
        return Err(format!("the readings still rise after {duration:.1} s: leave the load for three times as long"));
    }
    if creep.strength > 1.0 || frames > FRAMES[1] {
        return Err(format!(
            "the readings rise by {:.0} % with a time constant of {:.1} s: a correction reaches 100 % and {} frames",
            100.0 * creep.strength,
            creep.seconds,
            FRAMES[1]
        ));
    }
    let mut past = Vec::new();
    let corrected: Vec<f64> = held
        .iter()
        .map(|&sum| {
            let mut frame = [sum];
            creep.remove(&mut past, &mut frame, f64::INFINITY);
            frame[0]
        })
        .collect();
    let left = spread(&corrected);
    if 2.0 * left > spread(&held) {
        return Err(format!(
            "one time constant leaves {:.1} % of a change by {:.1} %: this sensor's creep is of another kind, or the load moved",
            100.0 * left,
            100.0 * spread(&held)
        ));
    }
    Ok(Fitted { creep, held: duration, rise, left })
}

/// Least squares of the strength for a time constant in frames, with squared error, from the first reading on: that has crept
/// for a frame.
fn strength(sums: &[f64], frames: f64) -> (f64, f64, f64) {
    let shape = |n: usize| -(-(n as f64) / frames).exp_m1();
    let first = sums[0];
    let points = || sums.iter().zip(1..).map(|(sum, n)| (sum / first - 1.0, shape(n) - shape(1) * sum / first));
    let [cross, square] = points().fold([0.0; 2], |[cross, square], (y, x)| [cross + x * y, square + x * x]);
    let strength = cross / square;
    (points().map(|(y, x)| (y - strength * x).powi(2)).sum(), frames, strength)
}

/// Standard deviation over the mean.
fn spread(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt() / mean
}

#[cfg(test)]
mod tests {
    use super::*;

    const CREEP: Creep = Creep { strength: 0.4, seconds: 10.0, frames_per_second: 20.0 };

    /// What a taxel with this creep reads of a load.
    fn readings(creep: &Creep, load: &[f64]) -> Vec<f64> {
        let mut added = 0.0;
        load.iter()
            .map(|load| {
                let read = load + added;
                added += creep.share() * (creep.strength * load - added);
                read
            })
            .collect()
    }

    fn step(frames: usize) -> Vec<f64> {
        (0..frames).map(|n| if n < 9 { 0.0 } else { -700.0 }).collect()
    }

    #[test]
    fn what_creeps_is_corrected_whatever_the_load() {
        let load: Vec<f64> = (0..900).map(|n| if n % 170 < 60 { -900.0 } else { 20.0 }).collect();
        let mut past = Vec::new();
        for (load, read) in load.iter().zip(readings(&CREEP, &load)) {
            let mut frame = [read];
            CREEP.remove(&mut past, &mut frame, 1e4);
            assert!((frame[0] - load).abs() < 1e-9, "{} {load}", frame[0]);
        }
    }

    #[test]
    fn a_step_of_load_tells_strength_and_time() {
        let found = fit(&readings(&CREEP, &step(800)), 0.05).unwrap();
        assert!((found.creep.strength - 0.4).abs() < 0.01, "{found:?}");
        assert!((found.creep.seconds - 10.0).abs() < 0.3, "{found:?}");
        assert!((found.creep.frames_per_second - 20.0).abs() < 1e-9, "{found:?}");
        assert!(found.left < 0.01, "{found:?}");
    }

    #[test]
    fn a_recording_that_does_not_tell_is_refused() {
        let creep = readings(&CREEP, &step(800));
        for (sums, said) in [
            (creep[9..].to_vec(), "begin without load"),
            (creep[..20].to_vec(), "begin without load"),
            (creep[..80].to_vec(), "still rise after"),
            (step(800), "no creep to correct"),
            (Vec::new(), "begin without load"),
        ] {
            let refusal = fit(&sums, 0.05).unwrap_err();
            assert!(refusal.contains(said), "{refusal}");
        }
        // The weight is moved.
        let moved: Vec<f64> = creep.iter().enumerate().map(|(n, sum)| if n > 500 { 0.7 * sum } else { *sum }).collect();
        assert!(fit(&moved, 0.05).is_err());
    }
}
