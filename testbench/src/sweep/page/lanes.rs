//! What lanes buy: time over multipliers, a pair of lines for each plan, filter and estimator that was varied.

use super::front::{DASHES, style};
use crate::svg::{Axis, INK, Svg};
use crate::sweep::point::{Hardware, Point};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 410.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 36.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 84.0;
/// Height of a line's name, above the plot.
const NAME: f64 = 15.0;
/// Radius of a dot; one that others lie on is larger by so much for each, so that it shows below them.
const DOT: f64 = 4.0;
const LARGER: f64 = 2.0;
/// Dashes of the interval beside those of the latency.
const INTERVAL: &str = DASHES[2];

/// One variant over its lanes.
struct Series<'a> {
    name: String,
    colour: &'static str,
    points: Vec<(&'a Point, &'a Hardware)>,
}

/// Latency and interval in µs over DSP, all logarithmic; nothing if no variant has more than one number of lanes.
pub fn plot(points: &[&Point]) -> Option<String> {
    let series = series(points);
    let all = || series.iter().flat_map(|series| series.points.iter().map(|&(_, hardware)| hardware));
    all().next()?;
    let x = Axis::covering(all().map(|hardware| hardware.dsp as f64), false, LEFT, WIDTH - RIGHT);
    let times = all().flat_map(|hardware| [hardware.latency_us, hardware.interval_us]);
    let top = TOP + NAME * series.len() as f64;
    let height = HEIGHT + top - TOP;
    let y = Axis::covering(times, false, height - BOTTOM, top);
    let mut svg = Svg::new(WIDTH, height, "Latency and interval over multipliers").with_names_at((LEFT, height - 20.0));
    svg.decades_below(x, [y.from, y.to]);
    svg.decades_beside(y, [x.from, x.to]);
    svg.text((6.0, 14.0), "start", INK, "µs a frame: latency, and dotted the interval");
    svg.text((f64::midpoint(x.from, x.to), height - 42.0), "middle", INK, "DSP (logarithmic)");
    let places = |series: &Series, time: fn(&Hardware) -> f64| -> Vec<(f64, f64)> {
        series.points.iter().map(|(_, hardware)| (x.place(hardware.dsp as f64), y.place(time(hardware)))).collect()
    };
    let latencies: Vec<Vec<(f64, f64)>> =
        series.iter().map(|series| places(series, |hardware| hardware.latency_us)).collect();
    for (number, one) in series.iter().enumerate() {
        let Series { name, colour, points } = one;
        let latency = &latencies[number];
        svg.line(latency, colour, "");
        svg.line(&places(one, |hardware| hardware.interval_us), colour, INTERVAL);
        for (&place, (point, hardware)) in latency.iter().zip(points) {
            let name = format!(
                "{name}, {} lanes: {:.1} µs, a frame every {:.1} µs, {} DSP, {:.1} RAMB36",
                point.lanes, hardware.latency_us, hardware.interval_us, hardware.dsp, hardware.bram36
            );
            let covers = |other: &&(f64, f64)| (other.0 - place.0).hypot(other.1 - place.1) < DOT;
            let above = latencies[number + 1..].iter().filter(|later| later.iter().any(|other| covers(&other))).count();
            svg.named_dot(place, DOT + LARGER * above as f64, colour, &name);
        }
        svg.sized_text((WIDTH - RIGHT, TOP + NAME * number as f64), "end", colour, 11, name);
    }
    Some(svg.finish())
}

/// The variants with more than one number of lanes, by the widest words that were swept.
fn series<'a>(points: &[&'a Point]) -> Vec<Series<'a>> {
    let widest = points.iter().map(|point| (point.coefficient_bits, point.data_bits)).max();
    let mut series: Vec<Series<'a>> = Vec::new();
    for &point in points.iter().filter(|point| Some((point.coefficient_bits, point.data_bits)) == widest) {
        let Some(hardware) = &point.hardware else { continue };
        let name = format!("{} plan, {}, {}", point.plan, point.filter_title(), point.estimator_title());
        match series.iter_mut().find(|known| known.name == name) {
            Some(known) => known.points.push((point, hardware)),
            None => series.push(Series { name, colour: style(point).1, points: vec![(point, hardware)] }),
        }
    }
    for series in &mut series {
        series.points.sort_by_key(|(point, _)| point.lanes);
        series.points.dedup_by_key(|(point, _)| point.lanes);
    }
    series.retain(|series| series.points.len() > 1);
    series
}

#[cfg(test)]
mod tests {
    use super::super::conclusion::tests::point;
    use super::plot;

    #[test]
    fn a_variant_of_one_number_of_lanes_is_no_line() {
        let points = [point("a", 16, 2000, 2.0), point("a", 64, 1000, 2.0)];
        assert_eq!(plot(&[&points[0]]), None);
        let both = plot(&[&points[1], &points[0]]).expect("a plot");
        assert_eq!((both.matches("<polyline").count(), both.matches("<circle").count()), (2, 2));
    }

    /// A dot below others shows as a rim, and one that nothing lies on is as small as all.
    #[test]
    fn only_a_dot_that_others_lie_on_is_larger() {
        let mut points =
            [point("a", 16, 2000, 2.0), point("a", 64, 1000, 2.0), point("a", 16, 2000, 2.0), point("a", 64, 500, 2.0)];
        for filtered in &mut points[2..] {
            "f2 p=50".clone_into(&mut filtered.filter);
        }
        let svg = plot(&points.each_ref()).expect("a plot");
        assert_eq!((svg.matches("r=\"6\"").count(), svg.matches("r=\"4\"").count()), (1, 3), "{svg}");
    }
}
