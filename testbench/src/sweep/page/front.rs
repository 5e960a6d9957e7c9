//! Plot of latency against error for the points of one scene, with the line of the best.

use golden::design::{Estimator, PlanKind, TrainingSet};

use crate::svg::{Axis, INK, Svg};
use crate::sweep::point::{Hardware, Point, Verified};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 472.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 36.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 84.0;
const RADIUS: f64 = 4.5;
/// Radius of the ring around a point that was simulated.
const RING: f64 = 7.5;

/// A kind of points: its name, its colour, and which points belong to it.
type Kind = (&'static str, &'static str, fn(&Point) -> bool);
/// The first kind that a point belongs to is its own.
const KINDS: [Kind; 8] = [
    ("grid search, trained on general contacts", "#8fb821", |point| {
        point.calibration.is_some_and(|joint| joint.training_set == TrainingSet::General)
    }),
    ("grid search", "#2a9d5c", |point| point.estimator == Estimator::Joint),
    ("line, reduced plan, no filter", "#0b84d8", |point| point.plan == PlanKind::Reduced && point.filter == "none"),
    ("line, reduced plan, F1 or F2", "#62b6f0", |point| point.plan == PlanKind::Reduced),
    ("line, paper's plan, no filter", "#8a6d3b", |point| point.filter == "none"),
    ("line, paper's plan, F1", "#d9730d", |point| point.filter.starts_with("f1")),
    ("line, paper's plan, F2", "#e0a800", |point| point.filter.starts_with("f2")),
    ("line, paper's plan, F3", "#8e5bd0", |_| true),
];
/// Ends of the error axis; points beyond are triangles at the rim.
const PERCENT: [f64; 2] = [1.0, 100.0];

/// Names and colours of the kinds that a page's points have.
pub fn legend(points: &[Point]) -> Vec<(&'static str, &'static str)> {
    let named = KINDS.iter().map(|&(name, colour, _)| (name, colour));
    named.filter(|&(_, colour)| points.iter().any(|point| colour_of(point) == colour)).collect()
}

/// A colour for each of several lines.
pub(super) fn colour(index: usize) -> &'static str {
    KINDS[index % KINDS.len()].1
}

fn colour_of(point: &Point) -> &'static str {
    KINDS.iter().find(|(.., is)| is(point)).map_or(INK, |&(_, colour, _)| colour)
}

/// Latency in µs against the largest tangential error in percent, both logarithmic. A dashed line joins the best if the
/// scene `tells` which they are. Only the widest words are drawn: narrower ones would lie upon them.
pub fn front(points: &[&Point], tells: bool) -> String {
    let bits = |point: &Point| (point.coefficient_bits, point.data_bits);
    let widest = points.iter().map(|point| bits(point)).max();
    let mut built: Vec<(&Point, &Hardware)> = points
        .iter()
        .filter(|point| Some(bits(point)) == widest)
        .filter_map(|&point| Some((point, point.hardware.as_ref()?)))
        .collect();
    let latencies: Vec<f64> = built.iter().map(|(_, hardware)| hardware.latency_us).collect();
    let titles = ["latency, µs (logarithmic); left is faster", "largest error of F_x and F_y, %; lower is more exact"];
    let (mut svg, x, y) = plot("Largest tangential error against latency", [&latencies, &PERCENT], None, titles);
    let height = |percent: f64| y.place(percent.clamp(PERCENT[0], PERCENT[1]));
    if tells {
        let mut best: Vec<(f64, f64)> =
            built.iter().map(|(point, hardware)| (hardware.latency_us, point.tangential())).collect();
        let corners = frontier(&mut best).into_iter().map(|(time, error)| (x.place(time), height(error)));
        svg.line(&corners.collect::<Vec<_>>(), INK, "2 3");
    }
    // The most exact lie above the others.
    built.sort_by(|(a, _), (b, _)| b.tangential().total_cmp(&a.tangential()));
    for (point, hardware) in built {
        let (error, colour) = (point.tangential(), colour_of(point));
        let place = (x.place(hardware.latency_us), height(error));
        let name = format!(
            "{}: {} cycles, {error:.1} % tangential, e_mu {:.1} %, {} DSP; {}",
            point.label(),
            hardware.latency_cycles,
            point.errors.e_mu.max,
            hardware.dsp,
            point.verified.title()
        );
        let names_at = (LEFT, HEIGHT - 20.0);
        match error {
            _ if error > PERCENT[1] => svg.named_triangle(place, RADIUS, colour, &name, names_at),
            _ if error < PERCENT[0] => svg.named_triangle(place, -RADIUS, colour, &name, names_at),
            _ => svg.named_dot(place, RADIUS, colour, &name, names_at),
        }
        if point.verified == Verified::Rtl {
            svg.ring(place, RING, colour);
        }
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

/// An empty plot with logarithmic axes that cover these values; with marks along x at powers of ten, or where they are given.
pub(super) fn plot(
    label: &str,
    [along_x, along_y]: [&[f64]; 2],
    marks: Option<&[f64]>,
    [below, above]: [&str; 2],
) -> (Svg, Axis, Axis) {
    let x = Axis::covering(along_x.iter().copied(), LEFT, WIDTH - RIGHT);
    let y = Axis::covering(along_y.iter().copied(), HEIGHT - BOTTOM, TOP);
    let mut svg = Svg::new(WIDTH, HEIGHT, label);
    for value in marks.map_or_else(|| x.marks(&[1.0]).collect(), <[f64]>::to_vec) {
        svg.grid((x.place(value), y.from), (x.place(value), y.to));
        svg.text((x.place(value), y.from + 18.0), "middle", INK, &format!("{value}"));
    }
    for value in y.marks(&[1.0, 2.0, 5.0]) {
        svg.grid((x.from, y.place(value)), (x.to, y.place(value)));
        svg.text((x.from - 8.0, y.place(value) + 4.0), "end", INK, &format!("{value}"));
    }
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 42.0), "middle", INK, below);
    svg.text((6.0, 14.0), "start", INK, above);
    (svg, x, y)
}

#[cfg(test)]
mod tests {
    use super::super::conclusion::tests::point;
    use super::{front, frontier};

    #[test]
    fn the_front_has_no_dominated_point() {
        let mut points = [(3.0, 1.0), (1.0, 5.0), (2.0, 5.0), (2.0, 2.0), (4.0, 1.5)];
        assert_eq!(frontier(&mut points), [(1.0, 5.0), (2.0, 2.0), (3.0, 1.0)]);
    }

    /// Where forces cancel nothing is best; what lies beyond the plot is no dot at its rim.
    #[test]
    fn the_best_are_joined_where_the_scene_tells_and_what_is_beyond_is_marked() {
        let points = [point("a", 16, 2000, 2.0), point("a", 64, 1000, 3.0), point("a", 8, 4000, 150.0)];
        let [joined, alone] = [true, false].map(|tells| front(&points.each_ref(), tells));
        assert_eq!((joined.matches("<polyline").count(), alone.matches("<polyline").count()), (1, 0));
        assert_eq!((joined.matches("<circle").count(), joined.matches("<path").count()), (2, 1));
        let exact = front(&[&point("a", 16, 2000, 0.3)], true);
        assert_eq!((exact.matches("<circle").count(), exact.matches("<path").count()), (0, 1), "below the plot");
    }
}
