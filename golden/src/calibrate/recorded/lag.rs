//! The lag between two logs that do not begin together, by cross-correlation of the readings' sum with the load.

/// A lag is another one if it leaves more than so many times the variance of the best.
pub(super) const APART: f64 = 2.0;
/// A lag is used only if it explains this share of the variance.
const EXPLAINS: f64 = 0.7;
/// Fewer frames tell no lag.
const FRAMES: usize = 40;
/// Lags of more than this share of the frames are not looked at.
const SHARE: usize = 4;
/// Products at most.
const WORK: usize = 20_000_000;

/// By how many frames the loads come late, 0 where that is as good as any: where it leaves at most `apart` times the variance.
///
/// # Errors
///
/// Two lags that are as good as each other, and better than none.
pub(super) fn find(readings: &[f64], loads: &[Option<f64>], apart: f64) -> Result<isize, [isize; 2]> {
    let count = readings.len().min(loads.len());
    if count < FRAMES {
        return Ok(0);
    }
    let farthest = (count / SHARE).min(WORK / count) as isize;
    let left: Vec<f64> = (-farthest..=farthest).map(|lag| unexplained(readings, loads, lag)).collect();
    let zero = farthest as usize;
    let best = (0..left.len()).fold(zero, |best, lag| if left[lag] < left[best] { lag } else { best });
    let alike = |lag: usize| left[lag] <= apart * left[best];
    if left[best] > 1.0 - EXPLAINS || alike(zero) {
        return Ok(0);
    }
    // The lags around the best are those of the same edges.
    let first = (0..best).rfind(|&lag| !alike(lag)).unwrap_or(0);
    let last = (best..left.len()).find(|&lag| !alike(lag)).unwrap_or(left.len());
    let lag = |place: usize| place as isize - farthest;
    match (0..first).chain(last..left.len()).find(|&place| alike(place)) {
        Some(other) => Err([lag(best), lag(other)]),
        None => Ok(lag(best)),
    }
}

/// The share of the readings' variance that a straight line of the loads leaves, if these come `lag` frames late.
fn unexplained(readings: &[f64], loads: &[Option<f64>], lag: isize) -> f64 {
    let pairs = || {
        let skip = |late: isize| usize::try_from(late).unwrap_or(0);
        let lines = loads.iter().skip(skip(lag));
        readings.iter().skip(skip(-lag)).zip(lines).filter_map(|(&reading, load)| Some((reading, (*load)?)))
    };
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for (reading, load) in pairs() {
        count += 1.0;
        sums[0] += reading;
        sums[1] += load;
    }
    let means = sums.map(|sum| sum / count);
    let (mut squares, mut product) = ([0.0; 2], 0.0);
    for (reading, load) in pairs() {
        let [a, b] = [reading - means[0], load - means[1]];
        squares[0] += a * a;
        squares[1] += b * b;
        product += a * b;
    }
    if squares[0] * squares[1] > 0.0 { 1.0 - product * product / (squares[0] * squares[1]) } else { 1.0 }
}
