//! The lag between two logs that do not begin together, by cross-correlation of the readings' sum with the load.

use crate::numbers::correlation;

/// A lag is used only if it explains this share of the variance.
const EXPLAINS: f64 = 0.7;
/// A share of the variance that rounding alone leaves.
const ROUNDING: f64 = 1e-6;
/// Fewer frames tell no lag.
const FRAMES: usize = 40;
/// Lags of more than this share of the frames are not looked at.
const SHARE: usize = 4;
/// Products at most.
const WORK: usize = 20_000_000;

/// What each lag leaves unexplained of the readings' variance.
pub(super) struct Lags {
    /// From the farthest lag before to the farthest behind.
    left: Vec<f64>,
    /// A lag that leaves more is another one than the best.
    alike: f64,
}

impl Lags {
    /// Of readings and loads; a lag is as good as the best if it leaves at most `apart` times its variance. Nothing where no
    /// lag explains the readings.
    pub(super) fn of(readings: &[f64], loads: &[Option<f64>], apart: f64) -> Option<Self> {
        let count = readings.len().min(loads.len());
        if count < FRAMES {
            return None;
        }
        let farthest = (count / SHARE).min(WORK / count) as isize;
        let left: Vec<f64> = (-farthest..=farthest).map(|lag| unexplained(readings, loads, lag)).collect();
        let best = left.iter().copied().fold(f64::INFINITY, f64::min);
        (best <= 1.0 - EXPLAINS).then(|| Self { left, alike: apart * best.max(ROUNDING) })
    }

    fn zero(&self) -> usize {
        self.left.len() / 2
    }

    /// Whether this lag is as good as the best.
    pub(super) fn allow(&self, lag: isize) -> bool {
        let place = self.zero().checked_add_signed(lag);
        place.and_then(|place| self.left.get(place)).is_some_and(|left| *left <= self.alike)
    }

    /// By how many frames the loads come late, 0 where that is as good as any.
    ///
    /// # Errors
    ///
    /// Two lags that are as good as each other, and better than none.
    pub(super) fn best(&self) -> Result<isize, [isize; 2]> {
        let (left, zero) = (&self.left, self.zero());
        let best = (0..left.len()).fold(zero, |best, lag| if left[lag] < left[best] { lag } else { best });
        let alike = |lag: usize| left[lag] <= self.alike;
        if alike(zero) {
            return Ok(0);
        }
        // The lags around the best are those of the same edges.
        let first = (0..best).rfind(|&lag| !alike(lag)).unwrap_or(0);
        let last = (best..left.len()).find(|&lag| !alike(lag)).unwrap_or(left.len());
        let lag = |place: usize| place as isize - zero as isize;
        match (0..first).chain(last..left.len()).find(|&place| alike(place)) {
            Some(other) => Err([lag(best), lag(other)]),
            None => Ok(lag(best)),
        }
    }
}

/// The share of the readings' variance that a straight line of the loads leaves, if these come `lag` frames late.
fn unexplained(readings: &[f64], loads: &[Option<f64>], lag: isize) -> f64 {
    let skip = |late: isize| usize::try_from(late).unwrap_or(0);
    let lines = loads.iter().skip(skip(lag));
    let pairs = readings.iter().skip(skip(-lag)).zip(lines).filter_map(|(&reading, load)| Some((reading, (*load)?)));
    1.0 - correlation(pairs).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without noise every period fits up to rounding, on either side of zero.
    #[test]
    fn periodic_loads_without_noise_are_paired_as_they_are() {
        let load = |n: usize| [0.0, 0.1, 0.7, 0.3, 2.3, 1.1, 4.7, 0.9, 0.2, 0.6][n % 10];
        for factor in [0.1, 0.3, 0.7, 1.0, 3.3, 10.0, 17.9] {
            let loads: Vec<_> = (0..100).map(|n| Some(-load(n))).collect();
            let readings: Vec<_> = (0..100).map(|n| 5.0 + factor * load(n)).collect();
            assert_eq!(Lags::of(&readings, &loads, 4.0).unwrap().best(), Ok(0), "{factor}");
        }
    }
}
