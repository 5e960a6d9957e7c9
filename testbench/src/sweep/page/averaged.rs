//! Plot of the expected error against frames averaged, beside the bound.

use std::ops::RangeInclusive;

use golden::design::{Design, ExpectedError};
use golden::scene::bound;
use golden::smoothing::noise_left;
use serde::Serialize;

use super::{PageError, front, kinds};
use crate::svg::INK;
use crate::sweep::{FIRST_SEED, FRICTION, SweepError};

/// Values of `smoothing`; 0: one frame.
const SMOOTHING: RangeInclusive<u32> = 0..=8;
/// Contacts of the bound.
const CONTACTS: u64 = 200;
/// Smaller errors in percent are drawn here: none has a place on a logarithmic axis.
const LEAST: f64 = 0.01;

/// What is known of a sensor's designs.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Section {
    plot: Option<Plot>,
    /// Names of designs without expected errors.
    uncalibrated: Vec<String>,
}

/// The calibrated designs, with their colours.
#[derive(Clone, Debug, Serialize)]
struct Plot {
    legend: Vec<(String, &'static str)>,
    svg: String,
}

/// Errors in percent by frames averaged, the line's colour, and its dashes.
type Line = (Vec<(f64, f64)>, &'static str, &'static str);

/// The section of a sensor's unfiltered designs, in the order of the page.
///
/// # Errors
/// [`PageError::Sweep`] if the bound's contacts cannot be computed.
pub fn section(designs: &[&Design]) -> Result<Section, PageError> {
    let mut known: Vec<(&Design, &ExpectedError)> = Vec::new();
    let mut uncalibrated = Vec::new();
    for design in kinds::distinct(designs) {
        match &design.algorithm.expected_error {
            Some(errors) => known.push((design, errors)),
            None => uncalibrated.push(design.name.clone()),
        }
    }
    let Some(&(first, _)) = known.first() else { return Ok(Section { plot: None, uncalibrated }) };
    let seeds = FIRST_SEED..FIRST_SEED + CONTACTS;
    let [bound, _] = bound(&first.sensor, FRICTION, seeds).map_err(SweepError::from)?;
    Ok(Section { plot: Some(plot(&known, bound)), uncalibrated })
}

/// Median (solid) and 95 % (dotted) of each design at its own noise. For each noise the bound of the median (dashed): `bound`
/// is that at 1 %.
fn plot(designs: &[(&Design, &ExpectedError)], bound: f64) -> Plot {
    let frames = |k: u32| f64::from(2_u32.pow(k + 1) - 1);
    let mut lines: Vec<Line> = Vec::new();
    let mut noises: Vec<f64> = Vec::new();
    let mut legend = Vec::new();
    for (index, (design, errors)) in designs.iter().enumerate() {
        let (noise, colour) = (design.input.noise, front::colour(index));
        legend.push((format!("{}, noise {} %", design.name, in_percent(noise)), colour));
        for (which, dashes) in ["", "2 3"].into_iter().enumerate() {
            // Beyond the table's last noise nothing is known.
            let inside = SMOOTHING.filter(|&k| errors.noise.last().is_some_and(|&last| noise * noise_left(k) <= last));
            let places = inside.map(|k| (frames(k), errors.at(noise * noise_left(k))[which]));
            lines.push((places.collect(), colour, dashes));
        }
        if (noise * bound).is_normal() && !noises.contains(&noise) {
            noises.push(noise);
        }
    }
    let bound = |noise: f64, k| (frames(k), 100.0 * noise * noise_left(k) * bound);
    lines.extend(noises.iter().map(|&noise| (SMOOTHING.map(|k| bound(noise, k)).collect(), INK, "7 4")));
    for (_, error) in lines.iter_mut().flat_map(|(places, ..)| places) {
        *error = error.max(LEAST);
    }
    let values: Vec<f64> = lines.iter().flat_map(|(places, ..)| places).map(|(_, error)| *error).collect();
    let counts: Vec<f64> = SMOOTHING.map(frames).collect();
    let titles = ["frames averaged, for smoothing = 0 to 8 (logarithmic)", "expected error of the tangential force, %"];
    let label = "Expected error against frames averaged";
    let (mut svg, x, y) = front::plot(label, [&counts, &values], Some(&counts), titles);
    let place = |&(count, error): &(f64, f64)| (x.place(count), y.place(error));
    for (places, colour, dashes) in lines {
        svg.line(&places.iter().map(place).collect::<Vec<_>>(), colour, dashes);
    }
    for noise in noises {
        let (count, error) = bound(noise, *SMOOTHING.end());
        let (right, height) = place(&(count, error.max(LEAST)));
        svg.text((right, height + 16.0), "end", INK, &format!("bound, noise {} %", in_percent(noise)));
    }
    Plot { legend, svg: svg.finish() }
}

/// A share in percent with two decimals at most.
fn in_percent(share: f64) -> f64 {
    (1e4 * share).round() / 100.0
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn design(name: &str) -> Design {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs");
        Design::load(&folder.join(format!("{name}.toml"))).expect("a design")
    }

    /// The places of a line with these dashes.
    fn places(svg: &str, dashes: &str) -> Vec<Vec<(f64, f64)>> {
        let drawn = svg.lines().filter(|line| line.ends_with(&format!("stroke-dasharray=\"{dashes}\"/>")));
        let pair = |text: &str| text.split_once(',').map(|(x, y)| (x.parse().expect("x"), y.parse().expect("y")));
        drawn.map(|line| line.split('"').nth(1).expect("points").split(' ').filter_map(pair).collect()).collect()
    }

    #[test]
    fn each_design_has_its_errors_and_each_noise_its_bound() {
        let [mut fast, mut wide, mut bare] = ["sensor1-fast", "sensor1-wide", "sensor1-reduced"].map(design);
        (fast.input.noise, wide.input.noise) = (0.01, 0.04);
        bare.algorithm.expected_error = None;
        let found = section(&[&fast, &wide, &bare]).expect("a section");
        assert_eq!(found.uncalibrated, ["sensor1_reduced"]);
        let Plot { legend, svg } = found.plot.expect("a plot");
        assert_eq!([&legend[0].0, &legend[1].0], ["sensor1_fast, noise 1 %", "sensor1_wide, noise 4 %"]);
        let [medians, most, bounds] = ["", "2 3", "7 4"].map(|dashes| places(&svg, dashes));
        assert_eq!([medians.len(), most.len(), bounds.len()], [2; 3]);
        // What calibration knows ends at 2 %: that is beyond one frame, and three, with 4 %.
        assert_eq!([&medians, &most, &bounds].map(|of| [of[0].len(), of[1].len()]), [[9, 7], [9, 7], [9, 9]]);
        for (median, most) in medians.iter().flatten().zip(most.iter().flatten()) {
            assert!(most.1 < median.1, "95 % lie above: {most:?} {median:?}");
        }
        // A factor of 4 on the axis measures the fall by the root of 511, and the bound, known as 3.66, beneath a median.
        let four = bounds[0][0].1 - bounds[1][0].1;
        let factor = |from: (f64, f64), to: (f64, f64)| 4_f64.powf((to.1 - from.1) / four);
        for bound in &bounds {
            assert!((factor(bound[0], bound[8]) / 511_f64.sqrt() - 1.0).abs() < 0.02, "{bound:?}");
        }
        let below = factor(medians[0][0], bounds[0][0]);
        let median = fast.expected_error_at(0.01).expect("calibrated").median_percent;
        assert!((median / below / 3.66 - 1.0).abs() < 0.04, "{median} / {below}");
    }
}
