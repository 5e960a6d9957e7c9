//! The predicted times of a design, exact: each is compared with simulation. `plan::control` finds them.

use serde::Serialize;

/// Frames back to back that show the interval, around the middle: every buffer is full by then, and there is still a next
/// frame.
pub const INTERVAL_FRAMES: usize = 14;
/// Frames before and behind the middle over which the interval is the mean: frames may take turns in how long they take,
/// by twos or by fours.
const AROUND: usize = 2;

/// Mean distance between the ends of the frames around the middle, rounded up.
pub fn middle_interval(ends: &[u64]) -> u64 {
    let middle = ends.len() / 2;
    let (first, last) = (middle.saturating_sub(AROUND), (middle + AROUND).min(ends.len().saturating_sub(1)));
    if first < last { (ends[last] - ends[first]).div_ceil((last - first) as u64) } else { 0 }
}

/// Longest distance between the ends of frames from the middle on: what every frame keeps, where they take turns in how
/// long they take.
pub fn longest_interval(ends: &[u64]) -> u64 {
    ends.windows(2).skip((ends.len() / 2).saturating_sub(1)).map(|pair| pair[1] - pair[0]).max().unwrap_or(0)
}

/// Predicted times of one design, in clock cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Timeline {
    /// First beat in to last beat out of a single frame, both included, with streams that never wait.
    pub latency_cycles: u64,
    /// Distance of consecutive frames' last beats, input always there, sink always ready: its mean, rounded up, or the
    /// longest of them where frames are dropped that come sooner.
    pub interval_cycles: u64,
    /// First to last issue of the lanes.
    pub spmv_cycles: u64,
    /// Start to end of the optimum search.
    pub search_cycles: u64,
}
