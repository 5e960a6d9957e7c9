//! The latency of a frame against the number of taxels, as an SVG: logarithmic axes, readable on light and dark pages.

use super::cycles::{Kind, Point};
use testbench::run::report::PUBLISHED;
use testbench::svg::{Axis, INK, MARK, Svg};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 500.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 170.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 54.0;
/// Of the lines of the work alone.
const WORK_DASHES: &str = "1 4";
/// Taxels of the published sensor.
const PUBLISHED_TAXELS: usize = 100;
/// Lines drawn: kind, lanes, colour, dashes. The colours have contrast with white and with black.
const LINES: [(Kind, usize, &str, &str); 4] = [
    (Kind::Reduced, 16, "#0b84d8", ""),
    (Kind::Reduced, 64, "#0b84d8", "7 4"),
    (Kind::Filtered, 16, "#d9730d", ""),
    (Kind::Filtered, 64, "#d9730d", "7 4"),
];
/// The line of the work alone is drawn from where it is this share of the latency.
const WORK_SHARE: f64 = 0.4;
/// Least distance of two labels at the right.
const LABEL_STEP: f64 = 16.0;

/// The picture.
pub fn render(points: &[Point]) -> String {
    let drawn = |point: &&Point| LINES.iter().any(|&(kind, lanes, ..)| (point.kind, point.lanes) == (kind, lanes));
    let taxels = |point: &Point| (point.side * point.side) as f64;
    let m = points.iter().filter(drawn).map(taxels).chain([PUBLISHED_TAXELS as f64]);
    let x = Axis::covering(m, true, LEFT, WIDTH - RIGHT);
    let cycles = points.iter().filter(drawn).map(|point| point.predicted.latency as f64);
    let y = Axis::covering(cycles.chain([PUBLISHED.latency_cycles as f64]), false, HEIGHT - BOTTOM, TOP);
    let mut svg = Svg::new(WIDTH, HEIGHT, "Latency of a frame against the number of taxels");
    axes(&mut svg, x, y);
    let mut labels = Vec::new();
    for (kind, lanes, colour, dashes) in LINES {
        let series: Vec<&Point> = points.iter().filter(|point| (point.kind, point.lanes) == (kind, lanes)).collect();
        let places: Vec<(f64, f64)> =
            series.iter().map(|point| (x.place(taxels(point)), y.place(point.predicted.latency as f64))).collect();
        svg.line(&places, colour, dashes);
        // What the latency of a large sensor tends to: its multiply-accumulates over the lanes.
        let work = series.iter().map(|point| (point, point.macs as f64 / point.lanes as f64));
        let dominant = work.filter(|(point, work)| *work > WORK_SHARE * point.predicted.latency as f64);
        let work: Vec<(f64, f64)> = dominant.map(|(point, work)| (x.place(taxels(point)), y.place(work))).collect();
        if work.len() > 1 {
            svg.line(&work, colour, WORK_DASHES);
        }
        for (point, &place) in series.iter().zip(&places) {
            svg.dot(place, if point.simulated.is_some() { 4.5 } else { 2.5 }, colour);
        }
        if let Some(&(_, end)) = places.last() {
            let what = if kind == Kind::Filtered { "F2, p = 1" } else { "no filter" };
            labels.push((end, format!("{what}, {lanes} lanes"), colour));
        }
    }
    labels.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = f64::NEG_INFINITY;
    for (end, text, colour) in labels {
        let height = end.max(free);
        free = height + LABEL_STEP;
        svg.text((WIDTH - RIGHT + 10.0, height + 4.0), "start", colour, &text);
    }
    let published = (x.place(PUBLISHED_TAXELS as f64), y.place(PUBLISHED.latency_cycles as f64));
    svg.cross(published);
    svg.text((published.0 + 11.0, published.1 + 4.0), "start", MARK, "the paper's sparse designs, 7,335,000 cycles");
    svg.finish()
}

fn axes(svg: &mut Svg, x: Axis, y: Axis) {
    svg.decades_below(x, [y.from, y.to]);
    svg.decades_beside(y, [x.from, x.to]);
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 14.0), "middle", INK, "taxels m");
    svg.text(
        (12.0, 22.0),
        "start",
        INK,
        "cycles from the first word in to the last word out; large dots: simulated too; dotted: MACs / lanes",
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use testbench::simulate::Cycles;

    #[test]
    fn every_line_has_its_points_and_its_label() {
        let point = |side, latency| Point {
            kind: Kind::Reduced,
            side,
            lanes: 16,
            macs: 0,
            predicted: Cycles { latency, interval: latency },
            simulated: None,
        };
        let svg = render(&[point(4, 900), point(10, 2400)]);
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("no filter, 16 lanes") && !svg.contains("F2"), "{svg}");
        assert!(!svg.contains(WORK_DASHES), "no work");
        let busy = |side, latency| Point { macs: 16 * latency / 2, ..point(side, latency) };
        assert!(render(&[busy(4, 900), busy(10, 2400)]).contains(WORK_DASHES));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!render(&[]).contains("NaN"));
    }
}
