//! From readings to the design: what a sensor reads unloaded, and the keys that say what its counts mean.

use super::holds::Holds;
use super::shape::{self, Counts, Shape};
use crate::design::{Calibration, Curve, Design, Hardware, Input, NOISE_FLOOR_DIVISOR};
use crate::numbers::middle;

/// The full scale is this many times the largest stress seen, and is kept up to so many times that.
const HEADROOM: [f64; 2] = [1.25, 32.0];
/// A noise floor of so many deviations.
const QUIET: f64 = 3.0;
/// Unloaded readings below this share of the largest are 0.
const TARED: f64 = 0.005;
/// A count that is worth so many times what the design says is in another unit, or the force is.
const FAR: f64 = 300.0;
/// Pieces that a power law of another base becomes.
const LAW_PIECES: i32 = 32;

/// What a sensor reads unloaded.
pub(super) struct Readings {
    /// 1 where pressing raises the readings, else -1.
    pub(super) sign: f64,
    pub(super) counts: Counts,
    noise: Option<f64>,
    /// Least and largest reading above rest.
    range: [f64; 2],
}

impl Readings {
    /// Of what the holds of a recording read, and with the curve that a design has.
    pub(super) fn new(holds: &Holds, input: &Input) -> Self {
        let Holds { sign, noise, .. } = *holds;
        let rest: Vec<f64> = holds.rest.iter().map(|rest| sign * rest).collect();
        let x: Vec<&[f64]> = holds.all.iter().map(|hold| hold.x.as_slice()).collect();
        let range = [f64::min, f64::max].map(|pick| x.iter().copied().flatten().copied().fold(0.0, pick));
        let (input, own_rest) = (input.clone(), rest.clone());
        let own = move |taxel: usize, x: f64| {
            let pascals = |oriented: f64| plain(&input, sign * oriented);
            pascals(own_rest[taxel]) - pascals(own_rest[taxel] + x)
        };
        let (base, knots) = (middle(&rest), shape::knots(&x, noise.unwrap_or(0.0)));
        Self { sign, counts: Counts { rest, base, own: Box::new(own), knots }, noise, range }
    }

    /// Counts above rest and what they mean, of a taxel of gain 1.
    pub(super) fn points(&self, input: &Input) -> Vec<[f64; 2]> {
        let at = |x: f64| plain(input, self.sign * self.counts.base) - plain(input, self.sign * (self.counts.base + x));
        (0..=60).map(|step| self.range[1] * f64::from(step) / 60.0).map(|x| [x, at(x)]).collect()
    }

    /// What is to be known where a design said something else of a count altogether: its sign, or a thousandth.
    pub(super) fn far_from(&self, design: &Design, calibrated: &Design) -> Option<String> {
        let largest = |input: &Input| self.points(input).last().map_or(0.0, |point| point[1]);
        let [was, now] = [largest(&design.input), largest(&calibrated.input)];
        let key = match (&design.input.curve, design.input.pa_per_count) {
            (Some(_), _) => "sensor.curve",
            (None, Some(_)) => "sensor.pa_per_count",
            (None, None) => "frames in pascals, without sensor.pa_per_count",
        };
        let sign = was < 0.0;
        let times = now / was.abs();
        let unit = !(1.0 / FAR..=FAR).contains(&times) && times.is_finite();
        let size =
            if times < 1.0 { format!("{:.0} times less", 1.0 / times) } else { format!("{times:.0} times more") };
        let turned = "pressing changes the readings the other way than the design had it";
        match (sign, unit) {
            (false, false) => None,
            (true, false) => Some(format!("sign: {turned} ({key}); it is turned")),
            (true, true) => Some(format!(
                "sign: {turned} ({key}), and a count is worth {size}; both are changed. Are the forces in the unit of their header?"
            )),
            (false, true) => Some(format!(
                "unit: a count is worth {size} than the design had it ({key}); that is changed. Are the forces in the unit of \
                 their header, and the frames in counts?"
            )),
        }
    }

    /// The design with a curve and gains, for stress as large as was seen, the least and the largest of loaded frames.
    pub(super) fn calibrated(
        &self,
        design: &Design,
        shape: &Shape,
        gains: &[f64],
        [least, largest]: [f64; 2],
        remarks: &mut Vec<String>,
    ) -> Design {
        let mut calibrated = design.clone();
        let full_scale = full_scale(design, largest, remarks);
        let hardware = Hardware { full_scale_pa: full_scale, ..design.hardware.clone() };
        let mut input = Input { pa_per_count: None, curve: None, calibration: None, ..design.input.clone() };
        match shape {
            // Pascals are negative where something presses.
            Shape::Line(slope) => input.pa_per_count = Some(-self.sign * slope),
            Shape::Own(factor) => match &design.input.curve {
                Some(Curve { law: Some([power, scale]), .. }) => {
                    input.curve = Some(Curve::power_law(*power, factor * scale, &hardware));
                }
                Some(Curve { points, .. }) => {
                    let points = points.iter().map(|&[count, pascals]| [count, factor * pascals]).collect();
                    input.curve = Some(Curve { points, law: None });
                }
                None => input.pa_per_count = Some(factor * design.input.pa_per_count.unwrap_or(1.0)),
            },
            &Shape::Power { power, scale, straight } => {
                let tared = self.counts.rest.iter().all(|rest| rest.abs() < TARED * self.range[1]);
                // Below 1 a law is infinitely steep at zero load.
                input.curve = Some(if tared && self.sign > 0.0 && power >= 1.0 {
                    Curve::power_law(power, -scale, &hardware)
                } else {
                    let ratio = self.range[1] / straight;
                    let knot = |index: i32| straight * ratio.powf(f64::from(index) / f64::from(LAW_PIECES));
                    let knots: Vec<f64> = std::iter::once(0.0).chain((0..=LAW_PIECES).map(knot)).collect();
                    self.curve(knots.iter().map(|&x| [x, scale * shape::powered(x, power, straight)]).collect())
                });
            }
            Shape::Pieces { knots, slopes } => {
                let mut points = vec![[0.0, 0.0]];
                for (pair, slope) in knots.windows(2).zip(slopes) {
                    let [_, pascals] = points[points.len() - 1];
                    points.push([pair[1], pascals + slope * (pair[1] - pair[0])]);
                }
                input.curve = Some(self.curve(points));
            }
        }
        let offset: Vec<f64> = (0..gains.len())
            .map(|taxel| {
                let rest = self.sign * self.counts.rest[taxel];
                gains[taxel] * if input.curve.is_some() { -plain(&input, rest) } else { -rest }
            })
            .collect();
        let is_plain =
            gains.iter().all(|gain| gain.to_bits() == 1_f64.to_bits()) && offset.iter().all(|&offset| offset == 0.0);
        let was_dead = |taxel: usize| design.input.calibration.as_ref().is_some_and(|before| before.gain[taxel] == 0.0);
        if !is_plain || design.input.calibration.is_some() {
            let gain =
                gains.iter().enumerate().map(|(taxel, &gain)| if was_dead(taxel) { 0.0 } else { gain }).collect();
            // A negative zero would be written as one.
            input.calibration = Some(Calibration { gain, offset: offset.iter().map(|offset| offset + 0.0).collect() });
        }
        let floor = self.noise.map(|noise| {
            let of = |taxel: usize| {
                let rest = self.sign * self.counts.rest[taxel];
                (input.to_pa(taxel, rest + self.sign * noise) - input.to_pa(taxel, rest)).abs()
            };
            QUIET * (0..gains.len()).map(of).sum::<f64>() / gains.len() as f64
        });
        calibrated.input = input;
        if calibrated.hardware.full_scale_pa.to_bits() != full_scale.to_bits() {
            calibrated.hardware.full_scale_pa = full_scale;
            calibrated.algorithm.noise_floor_pa = full_scale / NOISE_FLOOR_DIVISOR;
        }
        let was = calibrated.algorithm.noise_floor_pa;
        if let Some(floor) = floor.filter(|&floor| floor >= least) {
            remarks.push(format!(
                "algorithm.noise_floor_pa stays {was:.1}: the frames without load vary by up to {floor:.1}, and loaded ones read \
                 no more than {least:.1}"
            ));
        } else if let Some(floor) = floor.filter(|&floor| floor > was && floor < 0.1 * full_scale) {
            remarks.push(format!(
                "algorithm.noise_floor_pa is set from {was:.1} to {floor:.1}: {QUIET} standard deviations of the frames without load"
            ));
            calibrated.algorithm.noise_floor_pa = floor;
        }
        calibrated
    }

    /// A curve through points of readings above the base and pascals that press. A sensor that reads less than that, a
    /// pull or another rest, goes on below with the first slope.
    fn curve(&self, mut points: Vec<[f64; 2]>) -> Curve {
        let lowest = self.counts.rest.iter().map(|rest| rest - self.counts.base).fold(self.range[0], f64::min);
        if lowest < 0.0 {
            let [count, pascals] = points[1];
            points.insert(0, [1.5 * lowest, 1.5 * lowest * pascals / count]);
        }
        let mut points: Vec<[f64; 2]> =
            points.iter().map(|[x, pascals]| [self.sign * (x + self.counts.base), 0.0 - pascals]).collect();
        if self.sign < 0.0 {
            points.reverse();
        }
        Curve { points, law: None }
    }
}

/// Pascals of a count before the taxel's gain and offset.
fn plain(input: &Input, count: f64) -> f64 {
    match &input.curve {
        Some(curve) => curve.at(count),
        None => input.pa_per_count.unwrap_or(1.0) * count,
    }
}

/// The full scale that the largest stress asks for: the design's, unless that is too small, or far too large.
fn full_scale(design: &Design, largest: f64, remarks: &mut Vec<String>) -> f64 {
    let (was, needed) = (design.hardware.full_scale_pa, HEADROOM[0] * largest);
    if was >= needed && was <= HEADROOM[1] * needed {
        return was;
    }
    let digits = 10_f64.powf(needed.log10().floor() - 1.0);
    let now = ((needed / digits).ceil() * digits).clamp(1e-3, 1e9);
    remarks.push(format!(
        "hardware.full_scale_pa is set from {was:.0} to {now:.0}: the largest stress recorded is {largest:.0} Pa"
    ));
    now
}
