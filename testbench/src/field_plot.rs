//! Pictures of one frame: the stress at the taxels, the forces found from it and what they are off; in
//! millimetres, with scales.

use golden::sensor::Sensor;
use golden::solver::Solution;

use crate::svg::{INK, Svg};

/// Width of one picture; two or three stand side by side.
const WIDTH: f64 = 410.0;
/// Room left of the grid for the axis, right of it for the colour bar, above it for the title, below it for axis and
/// scale.
const LEFT: f64 = 38.0;
const RIGHT: f64 = 84.0;
const TOP: f64 = 26.0;
const FOOT: f64 = 66.0;
/// The highest that a grid may be, in user units.
const HIGHEST: f64 = 420.0;
/// The longest arrow of a taxel, in its cell's sides.
const ARROW: f64 = 1.1;
/// The sum of all forces, beside the longest arrow of a taxel.
const SUM_ARROW: f64 = 64.0;
const PRESS: [u8; 3] = [11, 110, 190];
const PULL: [u8; 3] = [214, 59, 92];
const ZERO: [u8; 3] = [236, 238, 241];
/// Arrows on coloured cells, found and true.
const FOUND: &str = "#1d2733";
const TRUE: &str = "#e08a00";
/// Found and true arrows of a taxel stand apart by so much of its cell, at either side of the middle.
const APART: f64 = 0.1;
/// Steps of the colour bar.
const BAR_STEPS: usize = 24;

/// Where a sensor's taxels are in a picture that begins at `x`.
struct Grid<'a> {
    sensor: &'a Sensor,
    x: f64,
    /// User units a millimetre.
    scale: f64,
}

impl<'a> Grid<'a> {
    fn new(sensor: &'a Sensor, x: f64) -> Self {
        let [width, height] = size_mm(sensor);
        Self { sensor, x, scale: ((WIDTH - LEFT - RIGHT) / width).min(HIGHEST / height) }
    }

    fn cell(&self) -> (f64, f64) {
        let [x, y] = self.sensor.pitch_mm;
        (x * self.scale, y * self.scale)
    }

    /// Left and right, upper and lower edge.
    fn edges(&self) -> [f64; 4] {
        let [width, height] = size_mm(self.sensor).map(|side| side * self.scale);
        [self.x + LEFT, self.x + LEFT + width, TOP, TOP + height]
    }

    /// Where a taxel's cell begins, at its upper left corner; y points up, as in the sensor's plane.
    fn corner(&self, taxel: usize) -> (f64, f64) {
        let (column, row) = (taxel % self.sensor.columns, taxel / self.sensor.columns);
        let ((width, height), [left, _, top, _]) = (self.cell(), self.edges());
        (left + width * column as f64, top + height * (self.sensor.rows - 1 - row) as f64)
    }

    fn middle(&self, taxel: usize) -> (f64, f64) {
        let ((x, y), (width, height)) = (self.corner(taxel), self.cell());
        (x + width / 2.0, y + height / 2.0)
    }

    /// Title and both axes, in mm from the first taxel.
    fn frame(&self, svg: &mut Svg, title: &str) {
        let [left, right, top, bottom] = self.edges();
        svg.text((left, top - 10.0), "start", INK, title);
        let [width, height] = size_mm(self.sensor);
        for mm in ticks(width - self.sensor.pitch_mm[0]) {
            let x = left + (mm + self.sensor.pitch_mm[0] / 2.0) * self.scale;
            svg.grid((x, bottom), (x, bottom + 4.0));
            svg.sized_text((x, bottom + 16.0), "middle", INK, 11, &short(mm));
        }
        for mm in ticks(height - self.sensor.pitch_mm[1]) {
            let y = bottom - (mm + self.sensor.pitch_mm[1] / 2.0) * self.scale;
            svg.grid((left - 4.0, y), (left, y));
            svg.sized_text((left - 7.0, y + 4.0), "end", INK, 11, &short(mm));
        }
        svg.sized_text((right, bottom + 16.0), "start", INK, 11, " mm");
    }

    /// A colour for each taxel's value and the bar that says what colours mean.
    fn colours(&self, svg: &mut Svg, values: &[f64], unit: &str, worth: f64) {
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let (width, height) = self.cell();
        for (taxel, &value) in values.iter().enumerate() {
            let share = if largest > 0.0 { value / largest } else { 0.0 };
            svg.rectangle(self.corner(taxel), (width - 1.0, height - 1.0), &colour(share));
        }
        let [_, right, top, bottom] = self.edges();
        // From what presses, below, to zero or to what pulls.
        let (low, high) = values.iter().fold((0.0_f64, 0.0_f64), |(low, high), &b| (low.min(b), high.max(b)));
        if largest == 0.0 {
            return;
        }
        let (from, to) = (root(low / largest), root(high / largest));
        let step = (bottom - top) / BAR_STEPS as f64;
        for index in 0..BAR_STEPS {
            let place = to + (from - to) * (index as f64 + 0.5) / BAR_STEPS as f64;
            let at = (right + 10.0, top + step * index as f64);
            svg.rectangle(at, (10.0, step + 0.3), &colour(place * place.abs()));
        }
        let mut label = |value: f64, y: f64| {
            svg.sized_text((right + 24.0, y + 4.0), "start", INK, 11, &format!("{} {unit}", short(value * worth)));
        };
        label(low, bottom);
        if low < 0.0 {
            label(0.0, top + (bottom - top) * to / (to - from));
        }
        // A faint pull would stand upon the zero.
        if high > 0.0 && (bottom - top) * to / (to - from) > 14.0 {
            label(high, top);
        }
    }
}

/// The grid's sides, a pitch for each taxel.
fn size_mm(sensor: &Sensor) -> [f64; 2] {
    let [x, y] = sensor.pitch_mm;
    [x * sensor.columns as f64, y * sensor.rows as f64]
}

/// Three to six places up to `length`, 0 the first.
fn ticks(length: f64) -> Vec<f64> {
    let step = nice(length / 4.0);
    let last = (length / step + 1e-9) as u32;
    (0..=last).map(|index| f64::from(index) * step).collect()
}

/// The next of 1, 2 and 5 times a power of ten, downwards.
fn nice(value: f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    decade * [5.0, 2.0, 1.0].into_iter().find(|factor| factor * decade <= value).unwrap_or(1.0)
}

/// Three digits.
fn short(value: f64) -> String {
    let decimals = if value == 0.0 { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 4) };
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The root shows what is small beside the peak.
fn root(share: f64) -> f64 {
    share.signum() * share.abs().min(1.0).sqrt()
}

/// From -1, pressing, to 1, pulling.
fn colour(share: f64) -> String {
    let end = if share < 0.0 { PRESS } else { PULL };
    let weight = root(share).abs();
    let mix = |zero: u8, end: u8| (f64::from(zero) + weight * (f64::from(end) - f64::from(zero))).round() as u8;
    let [r, g, b] = [0, 1, 2].map(|channel| mix(ZERO[channel], end[channel]));
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn height(sensor: &Sensor) -> f64 {
    Grid::new(sensor, 0.0).edges()[3] + FOOT
}

fn draw_stress(svg: &mut Svg, sensor: &Sensor, stress: &[f64]) {
    let grid = Grid::new(sensor, 0.0);
    grid.frame(svg, "stress at the taxels");
    grid.colours(svg, stress, "kPa", 1e-3);
}

/// What is known of the forces that a frame was made with.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Their sum, in newtons.
    pub force: [f64; 3],
    /// `[f_x, f_y, f_z]` of each taxel, where that is known.
    pub field: Option<[Vec<f64>; 3]>,
}

fn tangential([fx, fy, _]: &[Vec<f64>; 3]) -> impl Iterator<Item = (f64, f64)> {
    fx.iter().copied().zip(fy.iter().copied())
}

/// An arrow for each taxel of each field, all to one scale, and a sample of it; of two fields those of a taxel stand beside
/// each other.
fn arrows(svg: &mut Svg, grid: &Grid, fields: &[(&[Vec<f64>; 3], &str)]) {
    let lengths = fields.iter().flat_map(|(field, _)| tangential(field)).map(|(x, y)| x.hypot(y));
    let longest = lengths.fold(0.0, f64::max);
    if longest == 0.0 {
        return;
    }
    let (width, height) = grid.cell();
    let scale = ARROW * width.min(height).max(0.6 * width.max(height)) / longest;
    for (number, (field, colour)) in fields.iter().enumerate() {
        // Half of the distance to the left of where the arrow points, or to the right.
        let aside = if fields.len() > 1 { APART * width.min(height) * (number as f64 - 0.5) } else { 0.0 };
        for (taxel, (x, y)) in tangential(field).enumerate() {
            let (middle, length) = (grid.middle(taxel), x.hypot(y).max(f64::MIN_POSITIVE));
            let from = (middle.0 + aside * y / length, middle.1 + aside * x / length);
            svg.arrow(from, (from.0 + scale * x, from.1 - scale * y), colour);
        }
    }
    let [_, right, _, bottom] = grid.edges();
    let (sample, place) = (nice(longest), bottom + 34.0);
    svg.arrow((right + 10.0, place), (right + 10.0 + scale * sample, place), INK);
    svg.sized_text((right + 16.0 + scale * sample, place + 4.0), "start", INK, 11, &format!("{} N", short(sample)));
}

fn draw_forces(svg: &mut Svg, sensor: &Sensor, x: f64, answer: &Solution, truth: Option<&Truth>) {
    let grid = Grid::new(sensor, x);
    let [_, _, fz] = &answer.field;
    grid.frame(svg, "forces found: f_z as colour, f_x and f_y as arrows");
    grid.colours(svg, fz, "N", 1.0);
    let known = truth.and_then(|truth| truth.field.as_ref()).map(|field| (field, TRUE));
    arrows(svg, &grid, &known.into_iter().chain([(&answer.field, FOUND)]).collect::<Vec<_>>());
    let [left, _, _, bottom] = grid.edges();
    let place = bottom + 34.0;
    let sum = |force: [f64; 3]| format!("({:.2}, {:.2}, {:.2}) N", force[0], force[1], force[2]);
    svg.text((left, place + 4.0), "start", INK, &format!("F found {}", sum(answer.resultant)));
    let Some(&Truth { force: truth, .. }) = truth else { return };
    svg.text((left, place + 22.0), "start", TRUE, &format!("F true   {}", sum(truth)));
    // Both sums from where the contact is.
    let pressed: f64 = fz.iter().sum();
    let weighted = |of: fn((f64, f64)) -> f64| {
        fz.iter().enumerate().map(|(taxel, force)| force * of(grid.middle(taxel))).sum::<f64>() / pressed
    };
    let largest = answer.resultant[0].hypot(answer.resultant[1]).max(truth[0].hypot(truth[1]));
    if pressed == 0.0 || largest == 0.0 {
        return;
    }
    let from = (weighted(|(x, _)| x), weighted(|(_, y)| y));
    for (force, colour) in [(truth, TRUE), (answer.resultant, FOUND)] {
        let scale = SUM_ARROW / largest;
        svg.bold_arrow(from, (from.0 + scale * force[0], from.1 - scale * force[1]), colour);
    }
}

fn draw_errors(svg: &mut Svg, sensor: &Sensor, x: f64, answer: &Solution, field: &[Vec<f64>; 3]) {
    let grid = Grid::new(sensor, x);
    let off = [0, 1, 2].map(|axis| {
        let pairs = answer.field[axis].iter().zip(&field[axis]);
        pairs.map(|(found, exact)| found - exact).collect::<Vec<f64>>()
    });
    grid.frame(svg, "errors: found less true");
    grid.colours(svg, &off[2], "N", 1.0);
    arrows(svg, &grid, &[(&off, FOUND)]);
    let [left, _, _, bottom] = grid.edges();
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let share = 100.0 * off.iter().map(|values| largest(values)).fold(0.0, f64::max) / largest(&field[2]);
    if share.is_finite() {
        let text = format!("largest: {} % of the largest f_z", short(share));
        svg.text((left, bottom + 38.0), "start", INK, &text);
    }
}

/// Stress and forces beside each other, and the errors where each taxel's true force is known.
pub fn frame(sensor: &Sensor, stress: &[f64], answer: &Solution, truth: Option<&Truth>) -> String {
    let field = truth.and_then(|truth| truth.field.as_ref());
    let width = if field.is_some() { 3.0 * WIDTH } else { 2.0 * WIDTH };
    let mut svg = Svg::new(width, height(sensor), "Stress at the taxels, and the forces found from it");
    draw_stress(&mut svg, sensor, stress);
    draw_forces(&mut svg, sensor, WIDTH, answer, truth);
    if let Some(field) = field {
        draw_errors(&mut svg, sensor, 2.0 * WIDTH, answer, field);
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use golden::solver::Status;

    use super::*;

    #[test]
    fn pressing_is_blue_and_pulling_red() {
        assert_eq!([-1.0, 0.0, 1.0].map(colour), ["#0b6ebe", "#eceef1", "#d63b5c"]);
    }

    #[test]
    fn numbers_are_short_and_steps_are_nice() {
        assert_eq!([0.0, -45.31, 0.1234, 1234.6, 0.5].map(short), ["0", "-45.3", "0.123", "1235", "0.5"]);
        assert_eq!([9.9, 4.0, 1.3, 0.07].map(|value| (nice(value) * 100.0).round() as i64), [500, 200, 100, 5]);
        assert_eq!(ticks(36.0), [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0]);
    }

    #[test]
    fn nothing_pressed_has_a_picture_too() {
        let sensor = Sensor { columns: 3, rows: 2, pitch_mm: [4.0, 2.0], depth_mm: 3.0 };
        let answer = Solution::zeros(Status::default(), 6);
        let truth = Truth { force: [0.0; 3], field: Some(answer.field.clone()) };
        let text = frame(&sensor, &[0.0; 6], &answer, Some(&truth));
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert_eq!(text.matches("<rect").count(), 18, "a cell a taxel in each, and no bar");
    }

    #[test]
    fn errors_are_what_is_found_less_what_is_true() {
        let sensor = Sensor { columns: 2, rows: 2, pitch_mm: [4.0; 2], depth_mm: 3.0 };
        let field = [vec![0.0; 4], vec![0.0; 4], vec![-2.0, 0.0, 0.0, 0.0]];
        let mut answer = Solution { field: field.clone(), ..Solution::zeros(Status::default(), 4) };
        let truth = Truth { force: [0.0, 0.0, -2.0], field: Some(field) };
        let drawn = |answer: &Solution| frame(&sensor, &[0.0; 4], answer, Some(&truth));
        assert!(drawn(&answer).contains("largest: 0 %"));
        answer.field[2][3] = 0.1;
        let text = drawn(&answer);
        let (_, errors) = text.split_once("errors: found less true").expect("the errors");
        assert!(errors.contains("largest: 5 %") && errors.contains("0.1 N") && !errors.contains("2 N"), "{text}");
        assert!(!frame(&sensor, &[0.0; 4], &answer, None).contains("errors:"));
    }
}
