//! The curve from counts to pascals of a sensor that is not linear.

use std::fmt::Write;

use serde::Deserialize;

use super::DesignError;
use super::checks::Check;
use super::files::Beside;
use super::hardware::{Hardware, Samples};

/// Most segments of a curve.
pub const MOST_SEGMENTS: usize = 64;
/// Segments of a power law in an octave of counts.
const PER_OCTAVE: f64 = 6.0;
/// A power law reaches this many times the full scale, for taxels of small gains.
const REACH: f64 = 4.0;
/// Points closer than this share of the largest count are one.
const CLOSEST: f64 = 1e-6;

/// Key `curve` as it stands in the file.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a curve is the name of a file, curve = \"curve.csv\", or a power law with two numbers and no other key, \
                 curve = { power = 1.25, scale = -0.0066 }"
)]
pub(super) enum RawCurve {
    File(String),
    Law(RawLaw),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLaw {
    power: f64,
    scale: f64,
}

/// From counts to pascals, monotone: straight between points, and as at its ends beyond them.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Count and pascals, 2 points to [`MOST_SEGMENTS`] and one, counts ascending, pascals ascending or descending.
    pub points: Vec<[f64; 2]>,
    /// `pascals = scale * count^power`, where the points are of that.
    pub law: Option<[f64; 2]>,
}

impl Curve {
    /// Checks the key; a file is one of those `beside` the design.
    pub(super) fn new(
        check: &Check,
        raw: RawCurve,
        beside: Beside<'_>,
        hardware: &Hardware,
    ) -> Result<Self, DesignError> {
        match raw {
            RawCurve::File(file) => Self::load(&file, beside),
            RawCurve::Law(RawLaw { power, scale }) => {
                check.real("sensor.curve.power", power, 0.25, 4.0, "")?;
                check.real(
                    "sensor.curve.scale",
                    scale.abs(),
                    1e-12,
                    1e12,
                    "or the negative of one, if larger counts press",
                )?;
                Ok(Self::power_law(power, scale, hardware))
            }
        }
    }

    /// A power law as straight pieces, each as wide for its counts as the others: none is off by more than
    /// `power (power - 1) / 600` of what it should be, from [`Curve::exact_from`] on. They end where samples do.
    pub(crate) fn power_law(power: f64, scale: f64, hardware: &Hardware) -> Self {
        let most = match hardware.samples {
            Samples::Float32 => f64::INFINITY,
            Samples::Int16 => -f64::from(i16::MIN),
            Samples::Uint16 => f64::from(u16::MAX) + 1.0,
        };
        let largest = (REACH * hardware.full_scale_pa / scale.abs()).powf(1.0 / power).min(most);
        let knot = |index: usize| match index {
            0 => 0.0,
            _ => largest * ((index as f64 - MOST_SEGMENTS as f64) / PER_OCTAVE).exp2(),
        };
        let points = (0..=MOST_SEGMENTS).map(knot).map(|count| [count, scale * count.powf(power)]).collect();
        Self { points, law: Some([power, scale]) }
    }

    /// Reads one line `count,pascals` for each point. Blank lines, a byte order mark and a header are skipped.
    fn load(file: &str, beside: Beside<'_>) -> Result<Self, DesignError> {
        let path = beside.path(file);
        let text = beside.read(file).map_err(|source| DesignError::Read { path: path.clone(), source })?;
        let wrong = |line, problem, remedy: &str| {
            Err(DesignError::Table { path: path.clone(), line, problem, remedy: remedy.to_owned() })
        };
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut points: Vec<[f64; 2]> = Vec::new();
        let (mut last, mut first) = (1, true);
        for (line, content) in (1..).zip(text.lines()).filter(|(_, content)| !content.trim().is_empty()) {
            last = line;
            let values: Vec<Option<f64>> = content.split(',').map(|field| field.trim().parse().ok()).collect();
            if std::mem::take(&mut first) && values.iter().all(Option::is_none) {
                continue;
            }
            let [Some(count), Some(pascals)] = values[..] else {
                let shown: String = content.trim().chars().take(40).collect();
                return wrong(
                    line,
                    format!("{shown:?} is no pair of numbers"),
                    "write count,pascals, such as 120,-950.5",
                );
            };
            // A NaN is in no range.
            if !(-1e9..=1e9).contains(&count) || !(-1e12..=1e12).contains(&pascals) {
                return wrong(
                    line,
                    format!("{count},{pascals} is beyond any sensor"),
                    "use counts up to 1e9, pascals up to 1e12",
                );
            }
            points.push([count, pascals]);
            let [.., [a, p], [b, q]] = points[..] else { continue };
            let falls = points[1][1] < points[0][1];
            if b <= a || p.total_cmp(&q).is_eq() || (q < p) != falls {
                return wrong(
                    line,
                    format!("{b},{q} after {a},{p}"),
                    "sort the points by counts; pascals only rise, or only fall",
                );
            }
        }
        let most = points.iter().fold(0.0_f64, |most, point| most.max(point[0].abs()));
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] - pair[0][0] < CLOSEST * most) {
            return wrong(
                last,
                format!("the counts {} and {} are all but equal", pair[0][0], pair[1][0]),
                "leave one out",
            );
        }
        if !(2..=MOST_SEGMENTS + 1).contains(&points.len()) {
            let remedy = format!("give 2 to {} points", MOST_SEGMENTS + 1);
            return wrong(last, format!("the curve has {} points", points.len()), &remedy);
        }
        Ok(Self { points, law: None })
    }

    /// The pascals of a count.
    pub fn at(&self, count: f64) -> f64 {
        let segment = self.points.partition_point(|point| point[0] <= count).clamp(1, self.points.len() - 1);
        let [[a, p], [b, q]] = [self.points[segment - 1], self.points[segment]];
        p + (q - p) * ((count - a) / (b - a)).clamp(0.0, 1.0)
    }

    /// The count of pascals, or that of the nearer end.
    pub fn count(&self, pascals: f64) -> f64 {
        let falls = self.points[1][1] < self.points[0][1];
        let before = |point: &[f64; 2]| if falls { point[1] >= pascals } else { point[1] <= pascals };
        let segment = self.points.partition_point(before).clamp(1, self.points.len() - 1);
        let [[a, p], [b, q]] = [self.points[segment - 1], self.points[segment]];
        a + (b - a) * ((pascals - p) / (q - p)).clamp(0.0, 1.0)
    }

    /// From this count on a power law's pieces are as short as they should be: below is one straight piece. `None` of
    /// points.
    pub fn exact_from(&self) -> Option<f64> {
        self.law.map(|_| self.points[1][0])
    }

    /// From this magnitude on a count is at the curve's end: what it means is not known.
    pub fn largest_count(&self) -> f64 {
        self.points.iter().fold(0.0, |most, point| most.max(point[0].abs()))
    }

    /// The file that reads back as the same points.
    pub(super) fn to_csv(&self) -> String {
        let mut text = String::new();
        for [count, pascals] in &self.points {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{count:?},{pascals:?}");
        }
        text
    }
}
