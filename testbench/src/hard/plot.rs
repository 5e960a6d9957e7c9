//! What depth does to the errors of sensors, as a picture.

use golden::design::Estimator;

use super::cases::{DEPTHS, NOISE, PLAIN, REGULARISED};
use super::judge::{Judged, Row};
use crate::svg::{Axis, INK, Svg, power};

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 320.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 20.0;
/// Errors are drawn from here.
const LEAST_PERCENT: f64 = 0.1;
const MOST_PERCENT: f64 = 100.0;

/// A line of a plot: its name, the rows that it joins, and how it is drawn.
struct Line {
    name: &'static str,
    estimator: Estimator,
    group: &'static str,
    colour: &'static str,
    dashes: &'static str,
}

const LINES: [Line; 3] = [
    Line {
        name: "line, no regularisation",
        estimator: Estimator::Line,
        group: PLAIN,
        colour: "#d9730d",
        dashes: "7 4",
    },
    Line { name: "line, regularised", estimator: Estimator::Line, group: REGULARISED, colour: "#0b84d8", dashes: "" },
    Line { name: "joint, regularised", estimator: Estimator::Joint, group: REGULARISED, colour: "#2a9d5c", dashes: "" },
];

/// A force whose error is drawn.
#[derive(Clone, Copy)]
pub struct Force {
    /// What it is called.
    pub name: &'static str,
    error: fn(&Judged) -> Option<f64>,
}

/// Both.
pub const FORCES: [Force; 2] = [
    Force { name: "tangential force", error: |judged| judged.tangential },
    Force { name: "normal force", error: |judged| judged.normal },
];

/// The error of a force over depth by pitch, both logarithmic.
pub fn of(rows: &[Row], force: &Force) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT, &format!("Error of the {} over depth by pitch", force.name));
    draw(&mut svg, rows, force, 0.0);
    svg.finish()
}

/// Both forces beside each other.
pub fn both(rows: &[Row]) -> String {
    let mut svg = Svg::new(2.0 * WIDTH, HEIGHT, "Errors of the tangential and the normal force over depth by pitch");
    for (force, left) in FORCES.iter().zip([0.0, WIDTH]) {
        draw(&mut svg, rows, force, left);
    }
    svg.finish()
}

fn draw(svg: &mut Svg, rows: &[Row], force: &Force, left: f64) {
    let noisy = format!("noise {} %", 100.0 * NOISE);
    let right = left + WIDTH - RIGHT;
    let x = Axis::covering(DEPTHS.into_iter(), true, left + LEFT, right);
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
    for (number, Line { name, estimator, group, colour, dashes }) in LINES.iter().enumerate() {
        let of_group =
            rows.iter().filter(|row| row.estimator == *estimator && row.group == *group && row.case.contains(&noisy));
        let places: Vec<(f64, f64)> = DEPTHS
            .into_iter()
            .zip(of_group)
            .filter_map(|(depth, row)| Some((depth, (force.error)(row.f64.as_ref()?)?)))
            .map(|(depth, error)| (x.place(depth), y.place(error.clamp(LEAST_PERCENT, MOST_PERCENT))))
            .collect();
        svg.line(&places, colour, dashes);
        for &place in &places {
            svg.dot(place, 3.5, colour);
        }
        svg.text((right - 4.0, 40.0 + 17.0 * number as f64), "end", colour, name);
    }
    svg.text((left + 6.0, 14.0), "start", INK, &format!("largest error of the {}, %", force.name));
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 8.0), "middle", INK, "depth / pitch");
}
