//! Calibrations by recordings with weights, from seeds and indenters that no choice was made on.

use std::fmt::Write;

use super::simulated::{Indenter, Recipe, study};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,curve,curve_worst,gains_before,gains_before_worst,gains_after,gains_after_worst,fz_median,fz_median_worst,fz_p95,fz_p95_worst,fz_worst,fz_worst_worst,saturated,saturated_worst,printed_median,printed_median_worst";
/// Recordings of a kind.
const RECORDINGS: u64 = 9;

/// The table, in percent: of each figure the median of all recordings and the worst.
pub fn rows() -> String {
    let plain = Recipe { noise: 2.0, spread: 0.1, ..Recipe::new(0, Indenter::Ball) };
    let root = Recipe { power: 0.57, scale: 1200.0, ..plain.clone() };
    let repeats = |repeat| Recipe { rest: 60.0, creep: 0.33, repeat, frames: 10, ..root.clone() };
    let kinds = [
        ("straight, gains 10 %", Recipe { scale: 40.0, ..plain.clone() }),
        ("power 1.25, gains 10 %", Recipe { power: 1.25, scale: 5.0, ..plain.clone() }),
        ("power 0.57, gains 10 %", root.clone()),
        ("power 0.57, 12 places", Recipe { places: 12, ..root.clone() }),
        ("power 0.57, repeats to 10 %", repeats(0.1)),
        ("power 0.57, repeats to 18 %", repeats(0.18)),
    ];
    let mut rows = String::new();
    for (what, recipe) in kinds {
        let mut figures: [Vec<f64>; 8] = Default::default();
        for index in 0..RECORDINGS {
            let indenter = [Indenter::Ball, Indenter::Disc, Indenter::Block][index as usize % 3];
            let (found, of_recording) = study(&Recipe { seed: 200 + index, indenter, ..recipe.clone() });
            let printed = found.errors.map_or(0.0, |errors| errors.median);
            figures.iter_mut().zip(of_recording.into_iter().chain([printed])).for_each(|(all, of)| all.push(of));
        }
        let cells = figures.map(|mut values| {
            values.sort_by(f64::total_cmp);
            format!("{:.1},{:.1}", values[values.len() / 2], values[values.len() - 1])
        });
        // Writing to a String cannot fail.
        let _ = writeln!(rows, "\"{what}\",{}", cells.join(","));
    }
    rows
}
