//! Pictures as SVG text, for pages on light and on dark ground.

use std::fmt::Write;

/// Neither black nor white, so that it can be read on both.
pub const INK: &str = "#7d8590";

/// Between the lines of a dot's name.
const NAME_LINE: f64 = 14.0;

/// Text of a picture. Writing to a String cannot fail.
#[derive(Debug)]
pub struct Svg {
    text: String,
}

impl Svg {
    /// An empty picture with a description for those who do not see it.
    pub fn new(width: f64, height: f64, label: &str) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
             font-size=\"13\" role=\"img\" aria-label=\"{}\">\n",
            escaped(label)
        );
        Self { text }
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

    /// A full circle that says what it is, at `names_at`, when it is pointed at, touched or reached by the keyboard: a page
    /// shows `.name` of the `.dot` that has the focus.
    pub fn named_dot(&mut self, (x, y): (f64, f64), radius: f64, colour: &str, name: &str, names_at: (f64, f64)) {
        let shape =
            format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\" fill-opacity=\"0.8\"/>");
        self.named(&shape, name, names_at);
    }

    /// The same as a triangle that points to what is beyond the picture: up, or down with a negative `radius`.
    pub fn named_triangle(&mut self, (x, y): (f64, f64), radius: f64, colour: &str, name: &str, names_at: (f64, f64)) {
        let (left, right, base) = (x - radius, x + radius, y + radius);
        let shape = format!(
            "<path d=\"M{x:.1} {:.1}L{right:.1} {base:.1}L{left:.1} {base:.1}Z\" fill=\"{colour}\" \
             fill-opacity=\"0.8\"/>",
            y - radius
        );
        self.named(&shape, name, names_at);
    }

    fn named(&mut self, shape: &str, name: &str, (x, y): (f64, f64)) {
        let name = escaped(name);
        // What it is, and below that its figures.
        let lines = name.split_once(": ").map_or_else(|| vec![name.as_str()], |(what, figures)| vec![what, figures]);
        let span = |(index, text): (usize, &&str)| {
            format!("<tspan x=\"{x:.1}\" y=\"{:.1}\">{text}</tspan>", y + NAME_LINE * index as f64)
        };
        let spans: String = lines.iter().enumerate().map(span).collect();
        let _ = writeln!(
            self.text,
            "<g class=\"dot\" tabindex=\"0\"><title>{name}</title>{shape}<text class=\"name\" display=\"none\" \
             fill=\"{INK}\" font-size=\"11\">{spans}</text></g>"
        );
    }

    /// An empty circle.
    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"none\" \
             stroke=\"{colour}\" stroke-width=\"1.6\"/>"
        );
    }

    /// A full rectangle.
    pub fn rectangle(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), colour: &str) {
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\"/>"
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

    /// The picture's text.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// Text as XML has it.
pub(crate) fn escaped(text: &str) -> String {
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
    /// Covers the values, from a power of ten to one; `from` and `to` are where they begin and end on the page.
    pub fn covering(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low.is_finite() { (low.log10().floor(), high.log10().ceil()) } else { (0.0, 1.0) };
        Self { low, high: high.max(low + 1.0), from, to }
    }

    /// Where a value is.
    pub fn place(self, value: f64) -> f64 {
        self.from + (value.log10() - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// The values on the axis that are one of `steps` times a power of ten.
    pub fn marks(self, steps: &[f64]) -> impl Iterator<Item = f64> {
        let decades = (self.low as i32..=self.high as i32).map(|decade| 10_f64.powi(decade));
        let end = 10_f64.powf(self.high) * (1.0 + 1e-9);
        decades.flat_map(move |decade| steps.iter().map(move |step| step * decade)).filter(move |&value| value <= end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_logarithmic() {
        let axis = Axis::covering([20.0, 900.0].into_iter(), 0.0, 200.0);
        assert_eq!([10.0, 100.0, 1000.0].map(|value| axis.place(value).round() as i64), [0, 100, 200]);
        assert_eq!(axis.marks(&[1.0, 5.0]).collect::<Vec<_>>(), [10.0, 50.0, 100.0, 500.0, 1000.0]);
    }

    #[test]
    fn text_is_escaped() {
        let mut svg = Svg::new(1.0, 1.0, "a & b");
        svg.text((0.0, 0.0), "start", INK, "1 < 2");
        let text = svg.finish();
        assert!(text.contains("a &amp; b") && text.contains("1 &lt; 2"), "{text}");
    }
}
