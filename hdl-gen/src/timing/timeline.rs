//! The predicted times of a design, exact: each is compared with simulation. [`super::control`] finds them.

/// Frames back to back that show the interval: from before the middle on every buffer is full, and there is still a next
/// frame.
pub const INTERVAL_FRAMES: usize = 24;
/// Distances before the middle one that count, and those at the end that do not: behind their frames too few follow to hold
/// them up.
const BEFORE: usize = 2;
const LAST: usize = 4;

/// Mean distance between the ends of frames that follow each other without a pause, rounded up.
///
/// Frames may take turns in how long they take, by twos, by fours or by fives: the mean is over one turn, as short as the
/// distances repeat, or over all of them where they do not.
pub fn mean_interval(ends: &[u64]) -> u64 {
    let distances = distances(ends);
    let full = full(&distances);
    mean(turn(full).unwrap_or(full))
}

fn distances(ends: &[u64]) -> Vec<u64> {
    ends.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Those of frames before and behind which the core is full.
fn full(distances: &[u64]) -> &[u64] {
    let from = (distances.len() / 2).saturating_sub(BEFORE);
    let to = distances.len().saturating_sub(LAST).max(from + 1).min(distances.len());
    &distances[from.min(to)..to]
}

/// The distances that are repeated.
fn turn(full: &[u64]) -> Option<&[u64]> {
    let repeats = |turn: &usize| full.iter().zip(&full[*turn..]).all(|(distance, next)| distance == next);
    (1..=full.len() / 2).find(repeats).map(|turn| &full[..turn])
}

/// Rounded up.
fn mean(distances: &[u64]) -> u64 {
    if distances.is_empty() { 0 } else { distances.iter().sum::<u64>().div_ceil(distances.len() as u64) }
}

/// Predicted times of one design, in clock cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timeline {
    /// First beat in to last beat out of a single frame, both included, with streams that never wait.
    pub latency_cycles: u64,
    /// Distance of consecutive frames' last beats, input always there, sink always ready: its mean over a turn of frames, rounded
    /// up. Where frames without room are dropped, the smallest distance of their beginnings at which none is, however many
    /// there are.
    pub interval_cycles: u64,
    /// First to last issue of the lanes.
    pub spmv_cycles: u64,
    /// Start to end of the optimum search.
    pub search_cycles: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ends of frames at these distances, again and again.
    fn ends(distances: &[u64]) -> Vec<u64> {
        let mut end = 1000;
        let later = distances.iter().cycle().take(INTERVAL_FRAMES - 1).map(|distance| {
            end += distance;
            end
        });
        [1000].into_iter().chain(later).collect()
    }

    #[test]
    fn the_mean_is_over_whole_turns() {
        assert_eq!(mean_interval(&ends(&[470])), 470);
        assert_eq!(mean_interval(&ends(&[400, 501])), 451);
        assert_eq!(mean_interval(&ends(&[10, 20, 30, 40])), 25);
        // Four of these five are 300 on average at most, all of them 360.
        assert_eq!(mean_interval(&ends(&[300, 300, 300, 300, 600])), 360);
        // What does not repeat: all that is known.
        let grows: Vec<u64> = (0..30).map(|index| 100 + index).collect();
        assert_eq!(mean_interval(&ends(&grows)), 114);
    }

    #[test]
    fn few_frames_have_an_interval_too() {
        assert_eq!([&[][..], &[5], &[5, 12], &[5, 12, 20]].map(mean_interval), [0, 0, 7, 7]);
    }
}
