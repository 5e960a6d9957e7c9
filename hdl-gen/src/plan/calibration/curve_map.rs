//! What a bank says of the curve from counts to pascals: its segments, in as many places as there is room.

use golden::design::Curve;

use crate::format::{largest, pow2, round_shift};
use crate::plan::PlanError;
use crate::plan::curve::{CurvePlan, MOST_SHIFT, Segment};
use crate::plan::curve_format::{COUNT_BITS, CurveFormat, MOST_VALUE, SEGMENT_WORDS};
use crate::plan::gain::GAIN_BITS;

/// Largest magnitude of a number, and of a count's conversion.
pub const MOST_NUMBER: i64 = largest(COUNT_BITS);
/// A slope leads to the next segment's value within the way's 2^-16 and a step.
const SLOPE_SHARE: u32 = 16;

/// A curve as a bank holds it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveMap {
    /// See [`CurveFormat`].
    pub format: CurveFormat,
    /// The segments, no more than there is room for, and the number with which the last one ends.
    pub curve: CurvePlan,
    /// The value there.
    pub end: i64,
}

impl CurveMap {
    /// A curve in numbers of a format.
    ///
    /// # Errors
    /// [`PlanError::Key`] where it rises too steeply, or where its numbers have no room.
    pub fn new(format: CurveFormat, curve: &Curve) -> Result<Self, PlanError> {
        let plan = CurvePlan::in_steps(curve, -format.exponent, format.lsb)?;
        let end = curve.points.last().map_or(0.0, |point| point[1]);
        let end = (end * pow2(-format.lsb)).round() as i64;
        let map = Self { format, curve: plan, end };
        if map.fits() {
            return Ok(map);
        }
        Err(PlanError::Key(format!(
            "[sensor] curve: with [hardware] calibration = \"ram\" its values have room up to {:.0} Pa, eight full scales, its \
             counts up to {:.0}, and it may have {} parts; leave out the points beyond, state a full_scale_pa that fits the \
             sensor, or write calibration = \"rom\"",
            MOST_VALUE as f64 * pow2(format.lsb),
            MOST_NUMBER as f64 * pow2(-format.exponent),
            format.room
        )))
    }

    /// The words of a place: number, value, slope and shift; of one behind the last segment's what a bank takes.
    pub fn segment(&self, place: usize) -> [u32; SEGMENT_WORDS] {
        let Segment { first, value, slope, shift } =
            self.curve.segments.get(place).copied().unwrap_or(Segment { first: 0, value: 0, slope: 0, shift: 1 });
        [first as u32, value as u32, slope.cast_unsigned(), shift]
    }

    /// The words in their order: segments, their count, then where the last one ends.
    pub fn words(&self) -> Vec<u32> {
        let segments = (0..self.format.room).flat_map(|place| self.segment(place));
        segments.chain([self.curve.segments.len() as u32, self.curve.last as u32, self.end as u32]).collect()
    }

    /// Whether a bank takes it: numbers that ascend, values that only rise or only fall, slopes that lead from one to
    /// the next, all within their widths.
    pub fn fits(&self) -> bool {
        let Self { format, curve: CurvePlan { segments, last, .. }, end } = self;
        let within = |number: i64, most: i64| number.abs() <= most;
        let alone = |of: &Segment| {
            within(of.first, MOST_NUMBER)
                && within(of.value, MOST_VALUE)
                && within(of.slope.into(), largest(GAIN_BITS))
                && (1..=MOST_SHIFT as u32).contains(&of.shift)
        };
        let ends = segments.iter().skip(1).map(|next| (next.first, next.value)).chain([(*last, *end)]);
        let ways: Vec<i64> = segments.iter().zip(ends.clone()).map(|(of, (_, value))| value - of.value).collect();
        let leads = |(of, (last, value)): (&Segment, (i64, i64))| {
            let rise = round_shift(i64::from(of.slope).abs() * (last - of.first).max(0), of.shift);
            let way = value - of.value;
            last > of.first && (rise * i64::from(of.slope.signum()) - way).abs() <= (way.abs() >> SLOPE_SHARE) + 1
        };
        (1..=format.room).contains(&segments.len())
            && within(*last, MOST_NUMBER)
            && within(*end, MOST_VALUE)
            && segments.iter().all(alone)
            && segments.iter().zip(ends).all(leads)
            && (ways.iter().all(|&way| way >= 0) || ways.iter().all(|&way| way <= 0))
    }
}

#[cfg(test)]
mod tests {
    use super::{CurveFormat, CurveMap, SLOPE_SHARE};
    use crate::cores::float_to_fixed::Converted;
    use crate::format::pow2;
    use golden::design::{Curve, Design};

    const DESIGN: &str = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
        name = \"tiny\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
        curve = { power = 1.5, scale = -0.5 }\n[hardware]\ncontrol = true\ncalibration = \"ram\"\n";

    fn format() -> (Curve, CurveFormat) {
        let design = Design::from_toml(DESIGN, "tiny.toml").unwrap();
        let curve = design.input.curve.clone().unwrap();
        let format = CurveFormat::new(&design, &curve);
        (curve, format)
    }

    #[test]
    fn values_are_those_of_the_curve() {
        let (curve, format) = format();
        let map = CurveMap::new(format, &curve).unwrap();
        assert_eq!((format.room, map.words().len()), (64, 259));
        for step in 1..400 {
            let count = f64::from(step) * curve.largest_count() / 400.5;
            let value = f64::from(map.curve.value_of((count as f32).to_bits()).fixed) * pow2(format.lsb);
            assert!((value / curve.at(count) - 1.0).abs() < 1e-4, "{count}: {value}");
        }
        let beyond = |count: f64| map.curve.value_of((count as f32).to_bits());
        let end = beyond(curve.largest_count() * 1.01);
        assert!(end.saturated && (i64::from(end.fixed) - map.end).abs() <= 1 + (map.end.abs() >> SLOPE_SHARE));
        assert!(beyond(f64::NAN).not_finite);
        assert_eq!(beyond(-3.0), Converted { fixed: 0, saturated: false, not_finite: false });
    }

    type Change = fn(&mut CurveMap);

    #[test]
    fn what_does_not_go_together_is_refused() {
        let (curve, format) = format();
        let right = CurveMap::new(format, &curve).unwrap();
        let cases: [(&str, Change); 9] = [
            ("numbers that do not ascend", |map| map.curve.segments[9].first = map.curve.segments[8].first),
            ("a value of another way", |map| map.curve.segments[40].value /= 2),
            ("a slope that leads elsewhere", |map| map.curve.segments[50].slope += 9),
            ("a shift too many", |map| map.curve.segments[50].shift += 1),
            ("no shift", |map| map.curve.segments[50].shift = 0),
            ("no segment", |map| map.curve.segments.clear()),
            ("an end before the last segment", |map| map.curve.last = map.curve.segments[63].first),
            ("another value at the end", |map| map.end += map.end / 100),
            ("a segment too many", |map| map.format.room = 32),
        ];
        for (what, change) in cases {
            let mut map = right.clone();
            change(&mut map);
            assert!(!map.fits(), "{what}");
        }
    }
}
