//! Cross-validation that leaves whole places out, or, at few places, whole loads.

use super::holds::Hold;
use crate::numbers::sorted;

/// Most parts.
const MOST: usize = 8;
/// Fewer groups than this tell no error.
const FEWEST: usize = 3;
/// Loads that differ by less than this factor are one.
const SAME_LOAD: f64 = 1.15;

/// What is left out at a time.
#[derive(Clone, Debug)]
pub(super) struct Folds {
    /// The part of each hold.
    of: Vec<usize>,
    count: usize,
    /// What the groups are, for people.
    pub(super) what: &'static str,
    pub(super) groups: usize,
}

impl Folds {
    /// Parts such that no place is in two of them; at few places, no load at a place. None if there are too few of both.
    pub(super) fn new(holds: &[Hold]) -> Option<Self> {
        let places: Vec<usize> = holds.iter().map(|hold| hold.place).collect();
        let by_load: Vec<usize> = {
            let levels = levels(holds.iter().map(|hold| hold.load));
            let level = |load: f64| levels.iter().position(|&[low, high]| load >= low && load <= high).unwrap_or(0);
            let mut seen: Vec<(usize, usize)> = Vec::new();
            holds
                .iter()
                .map(|hold| {
                    let key = (hold.place, level(hold.load));
                    seen.iter().position(|&known| known == key).unwrap_or_else(|| {
                        seen.push(key);
                        seen.len() - 1
                    })
                })
                .collect()
        };
        let groups = |of: &[usize]| of.iter().max().map_or(0, |&most| most + 1);
        let (of, what) = if groups(&places) > FEWEST { (places, "places") } else { (by_load, "loads") };
        let groups = groups(&of);
        (groups >= FEWEST).then(|| {
            let count = groups.min(MOST);
            Self { of: of.into_iter().map(|group| group % count).collect(), count, what, groups }
        })
    }

    /// For each part, the holds to fit to and those left out.
    pub(super) fn parts(&self) -> impl Iterator<Item = [Vec<usize>; 2]> {
        (0..self.count).map(|part| {
            let (left, kept) = (0..self.of.len()).partition(|&hold| self.of[hold] == part);
            [kept, left]
        })
    }
}

/// Ranges of loads that are one, from the smallest on.
pub(super) fn levels(loads: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    let mut levels: Vec<[f64; 2]> = Vec::new();
    for load in sorted(loads) {
        match levels.last_mut() {
            Some([low, high]) if load <= SAME_LOAD * *low => *high = load,
            _ => levels.push([load, load]),
        }
    }
    levels
}
