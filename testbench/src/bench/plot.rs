//! The latency of a frame against the number of taxels, as an SVG: logarithmic axes, readable on light and dark pages.

use std::fmt::Write;

use super::cycles::{Kind, Point};
use crate::report::PUBLISHED;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 500.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 170.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 54.0;
/// Taxels of the published sensor.
const PUBLISHED_TAXELS: usize = 100;
/// Lines drawn: kind, lanes, colour, dashes. The colours have contrast with white and with black.
const LINES: [(Kind, usize, &str, &str); 4] = [
    (Kind::Reduced, 16, "#0b84d8", ""),
    (Kind::Reduced, 64, "#0b84d8", "7 4"),
    (Kind::Filtered, 16, "#d9730d", ""),
    (Kind::Filtered, 64, "#d9730d", "7 4"),
];
const MARK: &str = "#d63b5c";
/// Neither black nor white, so that it can be read on both.
const INK: &str = "#7d8590";
/// Least distance of two labels at the right.
const LABEL_STEP: f64 = 16.0;

/// A logarithmic axis from one power of ten to another.
#[derive(Clone, Copy)]
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// Covers the values, from a power of ten to one or, if `tight`, to the largest; `from` and `to` are where they begin
    /// and end on the page.
    fn covering(values: impl Iterator<Item = f64>, tight: bool, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for value in values {
            (low, high) = (low.min(value), high.max(value));
        }
        let (low, high) = if low.is_finite() { (low.log10().floor(), high.log10()) } else { (0.0, 1.0) };
        let high = if tight { high } else { high.ceil() };
        Self { low, high: high.max(low + 1.0), from, to }
    }

    fn place(self, value: f64) -> f64 {
        self.from + (value.log10() - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    fn decades(self) -> impl Iterator<Item = i32> {
        self.low as i32..=self.high.floor() as i32
    }
}

/// The picture.
pub fn render(points: &[Point]) -> String {
    let drawn = |point: &&Point| LINES.iter().any(|&(kind, lanes, ..)| (point.kind, point.lanes) == (kind, lanes));
    let taxels = |point: &Point| (point.side * point.side) as f64;
    let m = points.iter().filter(drawn).map(taxels).chain([PUBLISHED_TAXELS as f64]);
    let x = Axis::covering(m, true, LEFT, WIDTH - RIGHT);
    let cycles = points.iter().filter(drawn).map(|point| point.predicted.latency as f64);
    let y = Axis::covering(cycles.chain([PUBLISHED.latency_cycles as f64]), false, HEIGHT - BOTTOM, TOP);
    let mut svg = Svg::new();
    axes(&mut svg, x, y);
    let mut labels = Vec::new();
    for (kind, lanes, colour, dashes) in LINES {
        let series: Vec<&Point> = points.iter().filter(|point| (point.kind, point.lanes) == (kind, lanes)).collect();
        let places: Vec<(f64, f64)> =
            series.iter().map(|point| (x.place(taxels(point)), y.place(point.predicted.latency as f64))).collect();
        svg.line(&places, colour, dashes);
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
    svg.text((published.0 + 11.0, published.1 + 4.0), "start", MARK, "published, 7,335,000 cycles");
    svg.finish()
}

fn axes(svg: &mut Svg, x: Axis, y: Axis) {
    for decade in x.decades() {
        let place = x.place(10_f64.powi(decade));
        svg.grid((place, y.from), (place, y.to));
        svg.text((place, y.from + 18.0), "middle", INK, &power(decade));
    }
    for decade in y.decades() {
        let place = y.place(10_f64.powi(decade));
        svg.grid((x.from, place), (x.to, place));
        svg.text((x.from - 8.0, place + 4.0), "end", INK, &power(decade));
    }
    svg.text((f64::midpoint(x.from, x.to), HEIGHT - 14.0), "middle", INK, "taxels m");
    svg.text(
        (12.0, 22.0),
        "start",
        INK,
        "cycles from the first word in to the last word out; large dots: simulated too",
    );
}

/// `1`, `10`, `1,000`, `10 M`.
fn power(decade: i32) -> String {
    let digits = 10_u64.pow(decade.max(0) as u32);
    if decade < 3 {
        digits.to_string()
    } else if decade < 6 {
        format!("{},000", digits / 1000)
    } else {
        format!("{} M", digits / 1_000_000)
    }
}

/// Text of a picture. Writing to a String cannot fail.
struct Svg(String);

impl Svg {
    fn new() -> Self {
        Self(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
             font-size=\"13\" role=\"img\" aria-label=\"Latency of a frame against the number of taxels\">\n"
        ))
    }

    fn grid(&mut self, from: (f64, f64), to: (f64, f64)) {
        let ((x1, y1), (x2, y2)) = (from, to);
        let _ = writeln!(
            self.0,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{INK}\" stroke-opacity=\"0.35\"/>"
        );
    }

    fn line(&mut self, places: &[(f64, f64)], colour: &str, dashes: &str) {
        let points: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.0,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"{dashes}\"/>",
            points.join(" ")
        );
    }

    fn dot(&mut self, (x, y): (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(self.0, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>");
    }

    fn cross(&mut self, (x, y): (f64, f64)) {
        let _ = writeln!(
            self.0,
            "<path d=\"M{:.1} {:.1}l12 12m0 -12l-12 12\" stroke=\"{MARK}\" stroke-width=\"3\"/>",
            x - 6.0,
            y - 6.0
        );
    }

    fn text(&mut self, (x, y): (f64, f64), anchor: &str, colour: &str, text: &str) {
        let _ = writeln!(
            self.0,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{text}</text>"
        );
    }

    fn finish(mut self) -> String {
        self.0.push_str("</svg>\n");
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cycles::Cycles;

    #[test]
    fn axes_are_logarithmic() {
        let axis = Axis::covering([20.0, 900.0].into_iter(), false, 0.0, 200.0);
        assert_eq!([10.0, 100.0, 1000.0].map(|value| axis.place(value).round() as i64), [0, 100, 200]);
        let tight = Axis::covering([20.0, 1000.0].into_iter(), true, 0.0, 200.0);
        assert_eq!(tight.place(1000.0).round() as i64, 200);
        assert_eq!([0, 3, 4, 6, 7].map(power), ["1", "1,000", "10,000", "1 M", "10 M"]);
    }

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
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!render(&[]).contains("NaN"));
    }
}
