//! Noise above the stated one, which restarts the average of `sensor.smoothing`.

use super::quiet::TOGETHER;
use super::{count, largest, together};
use crate::design::Design;
use crate::numbers::rounded;
use crate::smoothing::{Average, RESTART};

/// From so many frames on.
const FRAMES: usize = 8;
/// Restarts in this share of the frames cost much of what smoothing brings.
const OFTEN: f64 = 0.1;

/// A message where steps of single taxels restart the average of loaded frames, in pascals.
pub(super) fn check(design: &Design, loaded: &[Vec<f64>]) -> Option<String> {
    let smoothing = design.smoothing().filter(|_| loaded.len() >= FRAMES)?;
    let (mut average, mut before) = (Average::default(), loaded[0].clone());
    let mut restarts = |frame: &Vec<f64>| {
        let step: Vec<f64> = frame.iter().zip(&before).map(|(stress, before)| stress - before).collect();
        before.clone_from(frame);
        let left = smoothing.take(&mut average, &mut before, &design.input.dead);
        left >= 1.0 && largest(&step) > 0.0 && together(&design.sensor, &step) < TOGETHER
    };
    let restarts = loaded.iter().filter(|frame| restarts(frame)).count();
    (restarts as f64 > OFTEN * loaded.len() as f64).then(|| {
        format!(
            "noise restarts the average in {restarts} of {}: readings of single taxels step by more than {RESTART} times \
             sensor.noise = {}, so that little is averaged. Measure the noise: `sptfra check DESIGN --frames UNLOADED \
             --unloaded --loaded FRAMES`",
            count(loaded.len()),
            rounded(design.input.noise, 4)
        )
    })
}
