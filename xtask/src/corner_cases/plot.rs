//! What depth does to the errors of sensors, as a picture.

use golden::design::Estimator;

use super::cases::{DEPTHS, NOISE, PLAIN, REGULARISED};
use super::judge::{Judged, Row};
use testbench::svg::{Axis, INK, Svg};

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 376.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 20.0;
/// The axes begin below the title and the names of the lines.
const TOP: f64 = 84.0;
/// Height of a name, and the length of the piece of line in front of it.
const NAME: f64 = 17.0;
const SAMPLE: f64 = 28.0;
const DOT: f64 = 3.5;
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
        colour: "#0b84d8",
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
    let y = Axis::covering([LEAST_PERCENT, MOST_PERCENT].into_iter(), false, HEIGHT - 46.0, TOP);
    for depth in DEPTHS {
        svg.grid((x.place(depth), y.from), (x.place(depth), y.to));
        svg.text((x.place(depth), y.from + 18.0), "middle", INK, &depth.to_string());
    }
    svg.decades_beside(y, [x.from, x.to]);
    for (number, Line { name, estimator, group, colour, dashes }) in LINES.iter().enumerate() {
        let of_group =
            rows.iter().filter(|row| row.estimator == *estimator && row.group == *group && row.case.contains(&noisy));
        let errors: Vec<(f64, f64)> = DEPTHS
            .into_iter()
            .zip(of_group)
            .filter_map(|(depth, row)| Some((depth, (force.error)(row.f64.as_ref()?)?)))
            .collect();
        let place = |(depth, error): (f64, f64)| (x.place(depth), y.place(error.clamp(LEAST_PERCENT, MOST_PERCENT)));
        svg.line(&errors.iter().copied().map(place).collect::<Vec<_>>(), colour, dashes);
        for &(depth, error) in &errors {
            let (at, what) = (place((depth, error)), format!("{name}, depth / pitch {depth}: {error:.1} %"));
            match error {
                more if more > MOST_PERCENT => svg.named_triangle(at, DOT + 1.0, colour, &what),
                less if less < LEAST_PERCENT => svg.named_triangle(at, -DOT - 1.0, colour, &what),
                _ => svg.named_dot(at, DOT, colour, &what),
            }
        }
        let line = 32.0 + NAME * number as f64;
        svg.line(&[(left + LEFT, line - 4.0), (left + LEFT + SAMPLE, line - 4.0)], colour, dashes);
        svg.text((left + LEFT + SAMPLE + 8.0, line), "start", colour, name);
    }
    svg.text((left + 6.0, 14.0), "start", INK, &format!("largest error of the {}, %", force.name));
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 8.0), "middle", INK, "depth / pitch");
}
