//! Latency against error, and what width and lanes do to both.

use golden::design::{Estimator, PlanKind, TrainingSet};

use super::dots::{self, Dot, Rim};
use super::paper::TABLE_3;
use crate::svg::{Axis, INK, MARK, Svg};
use crate::sweep::point::{Hardware, Point, paper_sensor};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 472.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 36.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 84.0;
/// What a point is drawn in: its name, its colour, and which points they are.
type Kind = (&'static str, &'static str, fn(&Point) -> bool);
const KINDS: [Kind; 6] = [
    ("line, reduced plan, no filter", "#0b84d8", |point| point.plan == PlanKind::Reduced && point.filter == "none"),
    ("line, reduced plan, F1 or F2", "#62b6f0", |point| point.plan == PlanKind::Reduced),
    ("line, paper's plan, no filter", "#8a6d3b", |point| point.filter == "none"),
    ("line, paper's plan, F1", "#d9730d", |point| point.filter.starts_with("f1")),
    ("line, paper's plan, F2", "#e0a800", |point| point.filter.starts_with("f2")),
    ("line, paper's plan, F3", "#8e5bd0", |point| point.filter == "f3"),
];
const JOINT: (&str, &str) = ("grid search", "#2a9d5c");
const GENERAL: (&str, &str) = ("grid search, trained on general contacts", "#8fb821");
/// Errors above are drawn at the rim.
const MOST_PERCENT: f64 = 100.0;
const LEAST_PERCENT: f64 = 1.0;

/// One entry of a legend.
pub type Legend = Vec<(&'static str, &'static str)>;

/// The entries of the fronts' legend that points of a page have.
pub fn legend(points: &[Point]) -> Legend {
    let used = |colour: &str| points.iter().any(|point| style(point).1 == colour);
    let ours = KINDS.iter().map(|&(name, colour, _)| (name, colour)).chain([JOINT, GENERAL]);
    ours.filter(|(_, colour)| used(colour)).chain([("the paper, Table 3", MARK)]).collect()
}

/// The name and colour of a point's kind, the same in all plots.
pub fn style(point: &Point) -> (&'static str, &'static str) {
    if point.estimator == Estimator::Joint {
        return match point.calibration {
            Some(joint) if joint.training_set == TrainingSet::General => GENERAL,
            _ => JOINT,
        };
    }
    let kind = KINDS.iter().find(|(_, _, is)| is(point)).unwrap_or(&KINDS[0]);
    (kind.0, kind.1)
}

/// The front of one scene's points: latency in µs against the largest tangential error in percent, both logarithmic.
/// `with_paper` marks the paper's points of this sensor; without `tells` no line joins the best.
///
/// Narrower words stand in a plot of their own: here they would lie upon each other.
pub fn front(points: &[&Point], with_paper: bool, tells: bool) -> String {
    let widest = points.iter().map(|point| (point.coefficient_bits, point.data_bits)).max();
    let points: Vec<&Point> =
        points.iter().copied().filter(|point| Some((point.coefficient_bits, point.data_bits)) == widest).collect();
    let built: Vec<(&Point, &Hardware)> =
        points.iter().filter_map(|&point| Some((point, point.hardware.as_ref()?))).collect();
    let paper: Vec<(f64, f64, &str)> = TABLE_3
        .iter()
        .filter(|row| with_paper && points.first().and_then(|point| paper_sensor(&point.sensor)) == Some(row.sensor))
        .map(|row| (1000.0 * row.milliseconds, row.max[0].max(row.max[1]), row.name))
        .collect();
    let times = built.iter().map(|(_, hardware)| hardware.latency_us).chain(paper.iter().map(|&(time, ..)| time));
    let x = Axis::covering(times, false, LEFT, WIDTH - RIGHT);
    let y = Axis::covering([LEAST_PERCENT, MOST_PERCENT].into_iter(), false, HEIGHT - BOTTOM, TOP);
    let height = |percent: f64| y.place(percent.clamp(LEAST_PERCENT, MOST_PERCENT));
    let mut svg =
        Svg::new(WIDTH, HEIGHT, "Largest tangential error against latency").with_names_at((LEFT, HEIGHT - 20.0));
    axes(
        &mut svg,
        x,
        y,
        ["latency, µs (logarithmic); left is faster", "largest error of F_x and F_y, %; lower is more exact"],
    );
    let mut best: Vec<(f64, f64)> =
        built.iter().map(|(point, hardware)| (hardware.latency_us, point.tangential())).collect();
    let corners: Vec<(f64, f64)> =
        frontier(&mut best).into_iter().map(|(time, e)| (x.place(time), height(e))).collect();
    if tells {
        svg.line(&corners, INK, "2 3");
    }
    let dots = built.iter().map(|&(point, hardware)| Dot {
        place: (x.place(hardware.latency_us), height(point.tangential())),
        rim: match point.tangential() {
            more if more > MOST_PERCENT => Rim::Above,
            less if less < LEAST_PERCENT => Rim::Below,
            _ => Rim::Within,
        },
        kind: style(point),
        point,
        hardware,
    });
    dots::draw(&mut svg, dots.collect());
    // What has an error and no latency.
    for point in points.iter().filter(|point| point.hardware.is_none()) {
        let (name, colour) = style(point);
        let place = height(point.tangential());
        svg.line(&[(LEFT, place), (WIDTH - RIGHT, place)], colour, "7 4");
        let text = format!("{name}, not in hardware: {:.1} %", point.tangential());
        svg.text((WIDTH - RIGHT - 6.0, place - 6.0), "end", colour, &text);
    }
    let mut free: Vec<(f64, f64)> = Vec::new();
    for (time, percent, name) in paper {
        let place = (x.place(time), height(percent));
        svg.cross(place);
        // Names that would stand on each other go one below the other.
        let mut line = place.1 - 12.0;
        while free.iter().any(|&(x, y)| (x - place.0).abs() < 90.0 && (y - line).abs() < 13.0) {
            line -= 13.0;
        }
        free.push((place.0, line));
        svg.sized_text((place.0 + 10.0, line), "middle", MARK, 11, name);
    }
    svg.finish()
}

/// The points that no other is faster than and at least as good, fastest first.
fn frontier(points: &mut [(f64, f64)]) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    points
        .iter()
        .copied()
        .filter(|&(_, error)| {
            let better = error < best;
            best = best.min(error);
            better
        })
        .collect()
}

/// Values over a width, as one line of a plot.
#[derive(Clone, Debug)]
pub struct Series {
    /// For people.
    pub name: String,
    /// That of the points in all plots.
    pub colour: &'static str,
    /// Where another series has the colour.
    pub dashes: &'static str,
    /// Bits, and what they come to.
    pub values: Vec<(u32, f64)>,
}

/// Height of a line of a series' name above its plot, the letters that it has room for, and the length of the piece of line
/// in front of it.
const NAME: f64 = 17.0;
const LETTERS: usize = 50;
const SAMPLE: f64 = 28.0;
/// Dashes of the series of one colour, one after the other.
pub const DASHES: [&str; 4] = ["", "7 3", "2 3", "9 3 2 3"];

/// Error against the f64 solver over the width of coefficients or vectors; one line for each series.
pub fn widths(series: &[Series], unit: &str) -> String {
    // Names stand above the plot, each in a line of its own or, a long one, in two.
    let names: Vec<Vec<&str>> = series.iter().map(|series| in_lines(&series.name)).collect();
    let top = 20.0 + NAME * names.iter().map(Vec::len).sum::<usize>() as f64;
    let (width, height) = (480.0, 308.0 + top);
    let values = series.iter().flat_map(|series| &series.values);
    let (low, high) = values.clone().fold((u32::MAX, 0), |(low, high), &(bits, _)| (low.min(bits), high.max(bits)));
    let y = Axis::covering(values.map(|&(_, error)| error).filter(|&error| error > 0.0), false, height - 74.0, top);
    let place =
        |bits: u32| LEFT + 20.0 + f64::from(bits - low) / f64::from((high - low).max(1)) * (width - LEFT - 60.0);
    let label = format!("Error of the number format against {unit}");
    let mut svg = Svg::new(width, height, &label).with_names_at((LEFT, height - 20.0));
    svg.decades_beside(y, [LEFT, width - RIGHT]);
    let mut line = 16.0;
    for (Series { name, colour, dashes, values }, lines) in series.iter().zip(names) {
        let places: Vec<(f64, f64)> =
            values.iter().filter(|(_, e)| *e > 0.0).map(|&(bits, e)| (place(bits), y.place(e))).collect();
        svg.line(&places, colour, dashes);
        for (&at, (bits, error)) in places.iter().zip(values) {
            svg.named_dot(at, 4.0, colour, &format!("{name}, {bits} bits: {error:.1e}"));
        }
        svg.line(&[(LEFT, line - 4.0), (LEFT + SAMPLE, line - 4.0)], colour, dashes);
        for part in lines {
            svg.text((LEFT + SAMPLE + 8.0, line), "start", colour, part);
            line += NAME;
        }
    }
    let mut widths: Vec<u32> = series.iter().flat_map(|series| series.values.iter().map(|&(bits, _)| bits)).collect();
    widths.sort_unstable();
    widths.dedup();
    for bits in widths {
        svg.text((place(bits), height - 56.0), "middle", INK, &bits.to_string());
    }
    svg.text((f64::midpoint(LEFT, width - RIGHT), height - 38.0), "middle", INK, unit);
    svg.finish()
}

/// A name in lines of [`LETTERS`] at most, broken behind a comma where there is one.
fn in_lines(name: &str) -> Vec<&str> {
    let end = name.char_indices().nth(LETTERS).map_or(name.len(), |(end, _)| end);
    match name[..end].rfind(", ").filter(|_| end < name.len()) {
        Some(comma) => [&name[..=comma]].into_iter().chain(in_lines(&name[comma + 2..])).collect(),
        None => vec![name],
    }
}

fn axes(svg: &mut Svg, x: Axis, y: Axis, names: [&str; 2]) {
    svg.decades_below(x, [y.from, y.to]);
    for decade in y.decades() {
        for step in [1.0, 2.0, 5.0] {
            let value = step * 10_f64.powi(decade);
            let place = y.place(value);
            if place < y.to - 0.5 {
                continue;
            }
            svg.grid((x.from, place), (x.to, place));
            svg.text((x.from - 8.0, place + 4.0), "end", INK, &format!("{value}"));
        }
    }
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 42.0), "middle", INK, names[0]);
    svg.text((6.0, 14.0), "start", INK, names[1]);
}

#[cfg(test)]
mod tests {
    use super::super::conclusion::tests::point;
    use super::{DASHES, front, frontier, in_lines};

    #[test]
    fn long_names_are_broken_behind_a_comma() {
        let long = "reduced plan, no filter, grid search, 160 units, general";
        assert_eq!(in_lines(long), ["reduced plan, no filter, grid search, 160 units,", "general"]);
        assert_eq!(in_lines("paper, f3, line"), ["paper, f3, line"]);
    }

    #[test]
    fn the_front_has_no_dominated_point() {
        let mut points = [(3.0, 1.0), (1.0, 5.0), (2.0, 5.0), (2.0, 2.0), (4.0, 1.5)];
        assert_eq!(frontier(&mut points), [(1.0, 5.0), (2.0, 2.0), (3.0, 1.0)]);
    }

    /// Where forces cancel nothing is best; what lies beyond the plot is no dot at its rim.
    #[test]
    fn the_best_are_joined_where_the_scene_tells_and_what_is_beyond_is_marked() {
        let points = [point("a", 16, 2000, 2.0), point("a", 64, 1000, 3.0), point("a", 8, 4000, 150.0)];
        let points: Vec<_> = points.iter().collect();
        let line = format!("stroke-dasharray=\"{}\"", DASHES[2]);
        let [joined, alone] = [true, false].map(|tells| front(&points, false, tells));
        assert_eq!((joined.matches(&line).count(), alone.matches(&line).count()), (1, 0));
        assert_eq!((joined.matches("<circle").count(), joined.matches("<path").count()), (2, 1));
        let exact = front(&[&point("a", 16, 2000, 0.3)], false, true);
        assert_eq!((exact.matches("<circle").count(), exact.matches("<path").count()), (0, 1), "below the plot");
    }
}
