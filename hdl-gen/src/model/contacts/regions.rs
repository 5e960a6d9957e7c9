//! Where the bodies are, in integers: what `sptfra_regions` finds of `|w|`.
//!
//! Whole numbers as weights are what [`golden::bodies::Finder`] takes, too, and up to 2^26 of 4,096 taxels all of its sums and
//! shares are whole multiples of 1/64 below 2^53: there both find the same, also at the very limits.

use golden::bodies::Labels;

use super::super::bodies::{SHARE, SHARE_OF};

/// What there is of a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Bodies, with those that have no region.
    pub bodies: u32,
    /// Taxels that each body with a region touches, the one with most `|w|` first.
    pub taxels: Vec<u32>,
    /// Of several bodies the nearest of each taxel, else nothing.
    pub regions: Vec<u8>,
    /// Taxels of each region.
    pub sizes: Vec<u32>,
    /// The taxels by body, in raster order each.
    pub list: Vec<u16>,
}

impl Found {
    /// Bodies with a region.
    pub fn kept(&self) -> usize {
        self.taxels.len()
    }
}

/// Tells bodies apart by the steps of each taxel's `|w|` on a grid of `columns`: at most `contacts` get a region. Lengths
/// of a step along x, along y and along the diagonal are those of [`crate::blocks::regions::steps`].
pub fn find(weight: &[i64], columns: usize, steps: [u32; 3], contacts: usize) -> Found {
    let largest = weight.iter().copied().max().unwrap_or(0);
    let touched: Vec<bool> = weight.iter().map(|&weight| SHARE_OF * weight > SHARE * largest).collect();
    let mut labels = Labels::default();
    labels.find(&touched, columns);
    // Of each blob what presses, its number, its taxels.
    let mut blobs: Vec<(i64, usize, u32)> = (0..labels.count).map(|blob| (0, blob, 0)).collect();
    for (blob, &weight) in labels.blobs.iter().zip(weight) {
        if let &Some(blob) = blob {
            blobs[blob].0 += weight;
            blobs[blob].2 += 1;
        }
    }
    // Of equal ones the first stays first.
    blobs.sort_by_key(|&(sum, ..)| -sum);
    let total: i64 = weight.iter().sum();
    let large = blobs.iter().filter(|&&(sum, ..)| SHARE_OF * sum >= SHARE * total).count();
    let bodies = large.max(blobs.len().min(1));
    let kept = &blobs[..bodies.min(contacts)];
    let mut found =
        Found { bodies: bodies as u32, taxels: kept.iter().map(|blob| blob.2).collect(), ..Found::default() };
    if kept.len() > 1 {
        let body = |blob: usize| kept.iter().position(|kept| kept.1 == blob);
        let bodies: Vec<Option<usize>> = labels.blobs.iter().map(|blob| blob.and_then(body)).collect();
        let regions = spread(&bodies, columns, steps);
        let of = |body: usize| regions.iter().enumerate().filter(move |(_, region)| **region == body);
        found.sizes = (0..kept.len()).map(|body| of(body).count() as u32).collect();
        found.list = (0..kept.len()).flat_map(|body| of(body).map(|(taxel, _)| taxel as u16)).collect();
        found.regions = regions.iter().map(|&region| region as u8).collect();
    }
    found
}

/// The nearest body of each taxel, by steps from neighbour to neighbour: a sweep in raster order, where each taxel looks at
/// the four before it, and one back; of equal distances the lower body.
fn spread(bodies: &[Option<usize>], columns: usize, [x, y, diagonal]: [u32; 3]) -> Vec<usize> {
    const NONE: (u32, usize) = (u32::MAX, usize::MAX);
    let mut nearest: Vec<(u32, usize)> = bodies.iter().map(|body| body.map_or(NONE, |body| (0, body))).collect();
    for back in [false, true] {
        // Backwards the grid is turned by half: its first taxel is the last.
        for step in 0..nearest.len() {
            let (column, row) = (step % columns, step / columns);
            let at = |step: usize| if back { bodies.len() - 1 - step } else { step };
            let neighbours = [
                (column > 0, 1, x),
                (row > 0 && column + 1 < columns, columns - 1, diagonal),
                (row > 0, columns, y),
                (row > 0 && column > 0, columns + 1, diagonal),
            ];
            let mut best = nearest[at(step)];
            for (_, before, length) in neighbours.into_iter().filter(|neighbour| neighbour.0) {
                let (distance, body) = nearest[at(step - before)];
                if body != NONE.1 {
                    best = best.min((distance + length, body));
                }
            }
            nearest[at(step)] = best;
        }
    }
    nearest.into_iter().map(|(_, body)| body).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(drawing: &[&str], contacts: usize) -> Found {
        let weight: Vec<i64> = drawing
            .iter()
            .flat_map(|row| row.bytes().map(|at| if at == b'.' { 0 } else { (at - b'0').into() }))
            .collect();
        super::find(&weight, drawing[0].len(), [2000, 2000, 2828], contacts)
    }

    #[test]
    fn the_largest_come_first_and_have_the_nearest_taxels() {
        let found = find(&["11..22", "......", "1....."], 2);
        // The third is no longer counted among those with a region.
        assert_eq!((found.bodies, found.kept(), found.taxels), (3, 2, vec![2, 2]));
        assert_eq!(found.regions, [1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0]);
        assert_eq!(found.sizes, [9, 9]);
        assert_eq!(found.list, [3, 4, 5, 9, 10, 11, 15, 16, 17, 0, 1, 2, 6, 7, 8, 12, 13, 14]);
    }

    #[test]
    fn one_and_none_have_no_regions() {
        let found = find(&["....", ".9..", "...."], 8);
        assert_eq!((found.bodies, found.taxels, found.regions.len(), found.list.len()), (1, vec![1], 0, 0));
        assert_eq!(find(&["....", "...."], 8), Found::default());
    }

    #[test]
    fn limits_are_met_exactly() {
        // 5 of 64 do not touch; 5 of all 64 are a body; and 4 of them are none.
        let mut weight = vec![0; 30];
        (weight[0], weight[2]) = (64, 5);
        assert_eq!(super::find(&weight, 10, [1, 1, 1], 2).bodies, 1);
        weight[2] = 6;
        assert_eq!(super::find(&weight, 10, [1, 1, 1], 2).taxels, [1, 1]);
        (weight[0], weight[2], weight[4]) = (54, 5, 5);
        assert_eq!(super::find(&weight, 10, [1, 1, 1], 4).bodies, 3);
        (weight[0], weight[10]) = (30, 25);
        weight[4] = 4;
        assert_eq!(super::find(&weight, 10, [1, 1, 1], 4).bodies, 2);
    }
}
