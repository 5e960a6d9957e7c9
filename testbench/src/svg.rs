//! Pictures as SVG text, for pages on light and on dark ground.

use std::fmt::Write;

/// Neither black nor white, so that it can be read on both.
pub const INK: &str = "#7d8590";
/// What is not ours.
pub const MARK: &str = "#d63b5c";

/// Between the lines of a dot's name.
const NAME_LINE: f64 = 14.0;

/// Text of a picture. Writing to a String cannot fail.
#[derive(Debug)]
pub struct Svg {
    text: String,
    /// Where names of dots appear.
    names_at: Option<(f64, f64)>,
}

impl Svg {
    /// An empty picture with a description for those who do not see it.
    pub fn new(width: f64, height: f64, label: &str) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
             font-size=\"13\" role=\"img\" aria-label=\"{}\">\n",
            escaped(label)
        );
        Self { text, names_at: None }
    }

    /// From here on the name of a dot that is pointed at, touched or reached by the keyboard appears at a place.
    #[must_use]
    pub fn with_names_at(self, place: (f64, f64)) -> Self {
        Self { names_at: Some(place), ..self }
    }

    /// A line of the grid.
    pub fn grid(&mut self, from: (f64, f64), to: (f64, f64)) {
        let ((x1, y1), (x2, y2)) = (from, to);
        let _ = writeln!(
            self.text,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{INK}\" \
             stroke-opacity=\"0.35\"/>"
        );
    }

    /// The powers of ten of an axis below the picture, each with its line of the grid between two heights.
    pub fn decades_below(&mut self, axis: Axis, [bottom, top]: [f64; 2]) {
        for decade in axis.decades() {
            let place = axis.place(10_f64.powi(decade));
            self.grid((place, bottom), (place, top));
            self.text((place, bottom + 18.0), "middle", INK, &power(decade));
        }
    }

    /// Those of an axis to the left of it.
    pub fn decades_beside(&mut self, axis: Axis, [left, right]: [f64; 2]) {
        for decade in axis.decades() {
            let place = axis.place(10_f64.powi(decade));
            self.grid((left, place), (right, place));
            self.text((left - 8.0, place + 4.0), "end", INK, &power(decade));
        }
    }

    /// A line through places.
    pub fn line(&mut self, places: &[(f64, f64)], colour: &str, dashes: &str) {
        let points: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.text,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" \
             stroke-dasharray=\"{dashes}\"/>",
            points.join(" ")
        );
    }

    /// A full circle.
    pub fn dot(&mut self, (x, y): (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(self.text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>");
    }

    /// A full circle that says what it is when it is pointed at, touched or reached by the keyboard; a page shows `.name` of
    /// the `.dot` that has the focus.
    pub fn named_dot(&mut self, (x, y): (f64, f64), radius: f64, colour: &str, name: &str) {
        let shape =
            format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\" fill-opacity=\"0.8\"/>");
        self.named(&shape, name);
    }

    /// The same as a triangle that points to what is beyond the picture: up, or down with a negative `radius`.
    pub fn named_triangle(&mut self, (x, y): (f64, f64), radius: f64, colour: &str, name: &str) {
        let (left, right, base) = (x - radius, x + radius, y + radius);
        let shape = format!(
            "<path d=\"M{x:.1} {:.1}L{right:.1} {base:.1}L{left:.1} {base:.1}Z\" fill=\"{colour}\" \
             fill-opacity=\"0.8\"/>",
            y - radius
        );
        self.named(&shape, name);
    }

    /// A full rectangle that says what it is.
    pub fn named_rectangle(
        &mut self,
        (x, y): (f64, f64),
        (width, height): (f64, f64),
        (colour, opacity): (&str, f64),
        name: &str,
    ) {
        let shape = format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\" \
             fill-opacity=\"{opacity:.2}\"/>"
        );
        self.named(&shape, name);
    }

    fn named(&mut self, shape: &str, name: &str) {
        let name = escaped(name);
        // What it is, and below that its figures.
        let lines = name.split_once(": ").map_or_else(|| vec![name.as_str()], |(what, figures)| vec![what, figures]);
        let spans = |(x, y): (f64, f64)| -> String {
            let line = |(index, text): (usize, &&str)| {
                let y = y + NAME_LINE * index as f64;
                format!("<tspan x=\"{x:.1}\" y=\"{y:.1}\">{text}</tspan>")
            };
            lines.iter().enumerate().map(line).collect()
        };
        let shown = self.names_at.map_or_else(String::new, |place| {
            format!("<text class=\"name\" display=\"none\" fill=\"{INK}\" font-size=\"11\">{}</text>", spans(place))
        });
        let _ = writeln!(self.text, "<g class=\"dot\" tabindex=\"0\"><title>{name}</title>{shape}{shown}</g>");
    }

    /// An empty circle.
    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"none\" \
             stroke=\"{colour}\" stroke-width=\"1.6\"/>"
        );
    }

    /// A cross, for [`MARK`]ed places.
    pub fn cross(&mut self, (x, y): (f64, f64)) {
        let _ = writeln!(
            self.text,
            "<path d=\"M{:.1} {:.1}l12 12m0 -12l-12 12\" stroke=\"{MARK}\" stroke-width=\"3\"/>",
            x - 6.0,
            y - 6.0
        );
    }

    /// A full rectangle.
    pub fn rectangle(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), colour: &str, opacity: f64) {
        let opacity = if opacity < 1.0 { format!(" fill-opacity=\"{opacity:.2}\"") } else { String::new() };
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\"{opacity}/>"
        );
    }

    /// The edge of a rectangle; what lies below it is still pointed at.
    pub fn frame(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), colour: &str) {
        let _ = writeln!(
            self.text,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"{colour}\" \
             stroke-width=\"2\" pointer-events=\"none\"/>",
            x + 1.0,
            y + 1.0,
            width - 2.0,
            height - 2.0
        );
    }

    /// A line with a head at its end.
    pub fn arrow(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), colour: &str) {
        let (dx, dy) = (x2 - x1, y2 - y1);
        let length = dx.hypot(dy);
        if length < 1.0 {
            return;
        }
        let head = (0.4 * length).min(6.0) / length;
        let wing = |side: f64| (x2 - head * (dx + side * 0.6 * dy), y2 - head * (dy - side * 0.6 * dx));
        let ((ax, ay), (bx, by)) = (wing(1.0), wing(-1.0));
        let _ = writeln!(
            self.text,
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}M{ax:.1} {ay:.1}L{x2:.1} {y2:.1}L{bx:.1} {by:.1}\" \
             fill=\"none\" \
             stroke=\"{colour}\" stroke-width=\"1.6\"/>"
        );
    }

    /// A wide one.
    pub fn bold_arrow(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), colour: &str) {
        let (dx, dy) = (x2 - x1, y2 - y1);
        let length = dx.hypot(dy);
        if length < 1.0 {
            return;
        }
        let (along, across) = ((dx / length, dy / length), (-dy / length, dx / length));
        let head = (0.4 * length).min(10.0);
        let neck = (x2 - head * along.0, y2 - head * along.1);
        let wing = |side: f64| (neck.0 + side * 0.5 * head * across.0, neck.1 + side * 0.5 * head * across.1);
        let ((ax, ay), (bx, by)) = (wing(1.0), wing(-1.0));
        let _ = writeln!(
            self.text,
            "<path d=\"M{x1:.1} {y1:.1}L{:.1} {:.1}\" stroke=\"{colour}\" stroke-width=\"3.5\"/>\
             <path d=\"M{x2:.1} {y2:.1}L{ax:.1} {ay:.1}L{bx:.1} {by:.1}Z\" fill=\"{colour}\"/>",
            neck.0, neck.1
        );
    }

    /// A piece of text; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, (x, y): (f64, f64), anchor: &str, colour: &str, text: &str) {
        self.sized_text((x, y), anchor, colour, 13, text);
    }

    /// A piece of text of another size in user units.
    pub fn sized_text(&mut self, (x, y): (f64, f64), anchor: &str, colour: &str, size: u32, text: &str) {
        let size = if size == 13 { String::new() } else { format!(" font-size=\"{size}\"") };
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\"{size}>{}</text>",
            escaped(text)
        );
    }

    /// A number above dots, on a rim of the ground's colour; the page knows that.
    pub fn haloed_text(&mut self, (x, y): (f64, f64), colour: &str, text: &str) {
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" fill=\"{colour}\" font-weight=\"600\" \
             paint-order=\"stroke\" stroke-width=\"3\" stroke-linejoin=\"round\" \
             style=\"stroke: var(--card, #ffffff)\">{}</text>",
            escaped(text)
        );
    }

    /// The picture's text.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// Text as XML has it.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A logarithmic axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Powers of ten at both ends.
    low: f64,
    high: f64,
    /// Places of both ends.
    pub from: f64,
    /// Place of the high end.
    pub to: f64,
}

impl Axis {
    /// Covers the values, from a power of ten to one or, if `tight`, to the largest; `from` and `to` are where they
    /// begin and end on the page.
    pub fn covering(values: impl Iterator<Item = f64>, tight: bool, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for value in values {
            (low, high) = (low.min(value), high.max(value));
        }
        let (low, high) = if low.is_finite() { (low.log10().floor(), high.log10()) } else { (0.0, 1.0) };
        let high = if tight { high } else { high.ceil() };
        Self { low, high: high.max(low + 1.0), from, to }
    }

    /// Where a value is.
    pub fn place(self, value: f64) -> f64 {
        self.from + (value.log10() - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// The powers of ten on the axis.
    pub fn decades(self) -> impl Iterator<Item = i32> {
        self.low as i32..=self.high.floor() as i32
    }
}

/// `1`, `10`, `1,000`, `10 M`; `0.1`, and smaller ones as `1e-3`.
fn power(decade: i32) -> String {
    match decade {
        ..-1 => format!("1e{decade}"),
        -1 => "0.1".to_owned(),
        0..3 => 10_u64.pow(decade as u32).to_string(),
        3..6 => format!("{},000", 10_u64.pow(decade as u32 - 3)),
        _ => format!("{} M", 10_u64.pow(decade as u32 - 6)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_logarithmic() {
        let axis = Axis::covering([20.0, 900.0].into_iter(), false, 0.0, 200.0);
        assert_eq!([10.0, 100.0, 1000.0].map(|value| axis.place(value).round() as i64), [0, 100, 200]);
        let tight = Axis::covering([20.0, 1000.0].into_iter(), true, 0.0, 200.0);
        assert_eq!(tight.place(1000.0).round() as i64, 200);
        assert_eq!([0, 3, 4, 6, 7].map(power), ["1", "1,000", "10,000", "1 M", "10 M"]);
        assert_eq!([-3, -1].map(power), ["1e-3", "0.1"]);
    }

    #[test]
    fn text_is_escaped() {
        let mut svg = Svg::new(1.0, 1.0, "a & b");
        svg.text((0.0, 0.0), "start", INK, "1 < 2");
        let text = svg.finish();
        assert!(text.contains("a &amp; b") && text.contains("1 &lt; 2"), "{text}");
    }
}
