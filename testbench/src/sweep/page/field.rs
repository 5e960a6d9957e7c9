//! One frame: the stress that the sensor feels and the forces that the hardware finds.

use crate::stream_words::Answer;
use crate::svg::{INK, Svg};
use crate::sweep::point::Geometry;

const WIDTH: f64 = 370.0;
const MARGIN: f64 = 12.0;
const FOOT: f64 = 24.0;
/// The longest arrow, in the smaller pitch.
const ARROW: f64 = 1.1;
const PRESS: [u8; 3] = [11, 110, 190];
const PULL: [u8; 3] = [214, 59, 92];
const ZERO: [u8; 3] = [236, 238, 241];

/// Where the taxels are on the page.
struct Grid<'a> {
    sensor: &'a Geometry,
    scale: f64,
}

impl<'a> Grid<'a> {
    fn new(sensor: &'a Geometry) -> Self {
        let [x, y] = sensor.pitch_mm;
        let longest = (sensor.columns as f64 * x).max(sensor.rows as f64 * y);
        Self { sensor, scale: (WIDTH - 2.0 * MARGIN) / longest }
    }

    fn cell(&self) -> (f64, f64) {
        let [x, y] = self.sensor.pitch_mm;
        (x * self.scale, y * self.scale)
    }

    fn height(&self) -> f64 {
        2.0 * MARGIN + FOOT + self.cell().1 * self.sensor.rows as f64
    }

    /// The upper left corner of a taxel's cell; y points up, as in the sensor's plane.
    fn corner(&self, taxel: usize) -> (f64, f64) {
        let (column, row) = (taxel % self.sensor.columns, taxel / self.sensor.columns);
        let (width, height) = self.cell();
        let left = (WIDTH - width * self.sensor.columns as f64) / 2.0;
        (left + width * column as f64, MARGIN + height * (self.sensor.rows - 1 - row) as f64)
    }

    fn colours(&self, svg: &mut Svg, values: &[f64]) {
        let largest = values.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
        let (width, height) = self.cell();
        for (taxel, &value) in values.iter().enumerate() {
            let share = if largest > 0.0 { value / largest } else { 0.0 };
            svg.rectangle(self.corner(taxel), (width - 1.0, height - 1.0), &colour(share), 1.0);
        }
    }

    fn foot(&self, svg: &mut Svg, text: &str) {
        svg.text((WIDTH / 2.0, self.height() - 8.0), "middle", INK, text);
    }
}

/// From -1, pressing, to 1, pulling.
fn colour(share: f64) -> String {
    let end = if share < 0.0 { PRESS } else { PULL };
    // The root shows what is small beside the peak.
    let weight = share.abs().min(1.0).sqrt();
    let mix = |zero: u8, end: u8| (f64::from(zero) + weight * (f64::from(end) - f64::from(zero))).round() as u8;
    let [r, g, b] = [0, 1, 2].map(|channel| mix(ZERO[channel], end[channel]));
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The stress of a frame in Pa.
pub fn stress(sensor: &Geometry, stress: &[f64]) -> String {
    let grid = Grid::new(sensor);
    let mut svg = Svg::new(WIDTH, grid.height(), "Stress that the taxels feel");
    grid.colours(&mut svg, stress);
    let (low, high) = stress.iter().fold((0.0_f64, 0.0_f64), |(low, high), &b| (low.min(b), high.max(b)));
    grid.foot(&mut svg, &format!("stress b: {:.1} kPa (blue) to {:+.2} kPa (red)", low / 1000.0, high / 1000.0));
    svg.finish()
}

/// The field of an answer: colour for `f_z`, arrows for the tangential forces.
pub fn forces(sensor: &Geometry, answer: &Answer) -> String {
    let grid = Grid::new(sensor);
    let [fx, fy, fz] = &answer.field;
    let mut svg = Svg::new(WIDTH, grid.height(), "Forces that the hardware finds");
    grid.colours(&mut svg, fz);
    let longest = fx.iter().zip(fy).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
    let (width, height) = grid.cell();
    if longest > 0.0 {
        let scale = ARROW * width.min(height).max(0.6 * width.max(height)) / longest;
        for (taxel, (x, y)) in fx.iter().zip(fy).enumerate() {
            let corner = grid.corner(taxel);
            let middle = (corner.0 + width / 2.0, corner.1 + height / 2.0);
            svg.arrow(middle, (middle.0 + scale * x, middle.1 - scale * y), "#1d2733");
        }
    }
    let least = fz.iter().copied().fold(0.0, f64::min);
    grid.foot(&mut svg, &format!("f_z to {least:.2} N (blue), arrows to {longest:.2} N"));
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::colour;

    #[test]
    fn pressing_is_blue_and_pulling_red() {
        assert_eq!([-1.0, 0.0, 1.0].map(colour), ["#0b6ebe", "#eceef1", "#d63b5c"]);
    }
}
