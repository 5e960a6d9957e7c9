//! The hard cases on the page: their table, and what regularisation does to deep sensors.

use golden::design::Estimator;
use serde::Serialize;

use super::matrices::Figure;
use crate::hard::cases::{DEPTHS, NOISE, PLAIN, REGULARISED};
use crate::hard::judge::{Judged, Row};
use crate::hard::tables::{Group, groups};
use crate::svg::{Axis, INK, Svg, power};

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 320.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 20.0;
/// Errors are drawn from here.
const LEAST_PERCENT: f64 = 1.0;
const MOST_PERCENT: f64 = 1000.0;
/// Name, group of rows, colour, dashes.
const LINES: [(&str, &str, &str, &str); 2] =
    [("no regularisation", PLAIN, "#d9730d", "7 4"), ("regularised by the noise", REGULARISED, "#0b84d8", "")];

/// The section.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    depths: Vec<Figure>,
    groups: Vec<Group>,
    refusals: Vec<String>,
}

/// The section of rows.
pub fn section(rows: &[Row]) -> Section {
    let groups = groups(rows);
    let refusals = groups.iter().flat_map(|group| group.refusals.clone()).collect();
    let tangential: fn(&Judged) -> Option<f64> = |judged| judged.tangential;
    let normal: fn(&Judged) -> Option<f64> = |judged| judged.normal;
    let depths = [("tangential force", tangential), ("normal force", normal)]
        .map(|(what, value)| Figure {
            svg: depths(rows, value, what),
            caption: format!(
                "largest error of the {what} in f64 over depth / pitch, with {} % of noise; a line ends where the \
                 design is refused",
                100.0 * NOISE
            ),
        })
        .to_vec();
    Section { depths, groups, refusals }
}

/// Error over depth, both logarithmic.
fn depths(rows: &[Row], value: fn(&Judged) -> Option<f64>, what: &str) -> String {
    let noisy = format!("noise {} %", 100.0 * NOISE);
    let mut svg = Svg::new(WIDTH, HEIGHT, &format!("Error of the {what} over depth by pitch"));
    let x = Axis::covering(DEPTHS.into_iter(), true, LEFT, WIDTH - RIGHT);
    let y = Axis::covering([LEAST_PERCENT, MOST_PERCENT].into_iter(), false, HEIGHT - 46.0, 24.0);
    for depth in DEPTHS {
        svg.grid((x.place(depth), y.from), (x.place(depth), y.to));
        svg.text((x.place(depth), y.from + 18.0), "middle", INK, &depth.to_string());
    }
    for decade in y.decades() {
        let place = y.place(10_f64.powi(decade));
        svg.grid((x.from, place), (x.to, place));
        svg.text((x.from - 8.0, place + 4.0), "end", INK, &power(decade));
    }
    for (number, (name, group, colour, dashes)) in LINES.into_iter().enumerate() {
        let of_group = rows
            .iter()
            .filter(|row| row.estimator == Estimator::Line && row.group == group && row.case.contains(&noisy));
        let places: Vec<(f64, f64)> = DEPTHS
            .into_iter()
            .zip(of_group)
            .filter_map(|(depth, row)| Some((depth, value(row.f64.as_ref()?)?)))
            .map(|(depth, error)| (x.place(depth), y.place(error.clamp(LEAST_PERCENT, MOST_PERCENT))))
            .collect();
        svg.line(&places, colour, dashes);
        for &place in &places {
            svg.dot(place, 3.5, colour);
        }
        svg.text((WIDTH - RIGHT - 4.0, 40.0 + 17.0 * number as f64), "end", colour, name);
    }
    svg.text((6.0, 14.0), "start", INK, &format!("error of the {what}, %"));
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 8.0), "middle", INK, "depth / pitch");
    svg.finish()
}
