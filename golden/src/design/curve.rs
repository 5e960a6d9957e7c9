//! The curve from counts to pascals of a sensor that is not linear.

use super::DesignError;
use super::checks::Check;
use super::files::FileSource;
use super::hardware::{Hardware, Samples};
use super::keys::CurveKey;
use super::rows::{Row, Rows};
use crate::numbers::push_row;

/// Most segments of a curve.
pub const MOST_SEGMENTS: usize = 64;
/// Segments of a power law in an octave of counts.
const PER_OCTAVE: f64 = 6.0;
/// A power law reaches this many times the full scale, for taxels of small gains.
const REACH: f64 = 4.0;
/// Points closer than this share of the largest count are one.
const CLOSEST: f64 = 1e-6;
/// What to write for a point.
const REMEDY: &str = "write count,pascals, such as 120,-950.5";

/// Whether a row is the header of points that stand behind taxels.
pub(super) fn is_header_of_points(row: &Row) -> bool {
    row.header().is_some_and(|names| names == ["count", "pascals"])
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
    /// From the key; a file is one of those `beside` the design.
    pub(super) fn new(
        check: &Check,
        key: CurveKey,
        beside: FileSource<'_>,
        hardware: &Hardware,
    ) -> Result<Self, DesignError> {
        match key {
            CurveKey::File(file) => Self::load(&file, beside),
            CurveKey::Law { power, scale } => {
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

    /// Reads one line `count,pascals` for each point, or those behind the taxels of a file of `sptfra export-calibration`.
    fn load(file: &str, beside: FileSource<'_>) -> Result<Self, DesignError> {
        let table = Rows::read(file, beside)?;
        let header = table.rows.first().and_then(Row::header).unwrap_or_default();
        let name = |place: usize| header.get(place).map_or("", String::as_str);
        let mut rows = table.rows.iter().skip(usize::from(!header.is_empty()));
        if name(0) == "gain" {
            rows.find(|row| is_header_of_points(row)).ok_or_else(|| {
                let problem = "the file has gains and offsets, and no curve".to_owned();
                table.wrong(table.end(), problem, format!("{REMEDY}, or name it as sensor.calibration"))
            })?;
        } else if name(0) == "pascals" && name(1) == "count" {
            let line = table.rows[0].line;
            return Err(table.wrong(line, "pascals stand before counts".to_owned(), REMEDY));
        }
        Self::of_rows(&table, rows)
    }

    /// The points of rows.
    pub(super) fn of_rows<'a>(table: &Rows, rows: impl Iterator<Item = &'a Row>) -> Result<Self, DesignError> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for row in rows {
            let wrong = |problem: String, remedy: &str| Err(table.wrong(row.line, problem, remedy));
            let Some(&[count, pascals]) = row.numbers(2).as_deref() else {
                return wrong(format!("{:?} is no pair of numbers", row.shown()), REMEDY);
            };
            // A NaN is in no range.
            if !(-1e9..=1e9).contains(&count) || !(-1e12..=1e12).contains(&pascals) {
                return wrong(
                    format!("{count},{pascals} is beyond any sensor"),
                    "use counts up to 1e9, pascals up to 1e12",
                );
            }
            points.push([count, pascals]);
            let [.., [a, p], [b, q]] = points[..] else { continue };
            let falls = points[1][1] < points[0][1];
            if b <= a || p.total_cmp(&q).is_eq() || (q < p) != falls {
                return wrong(
                    format!("{b},{q} after {a},{p}"),
                    "sort the points by counts; pascals only rise, or only fall",
                );
            }
        }
        let wrong = |problem: String, remedy: String| Err(table.wrong(table.end(), problem, remedy));
        let most = points.iter().fold(0.0_f64, |most, point| most.max(point[0].abs()));
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] - pair[0][0] < CLOSEST * most) {
            return wrong(
                format!("the counts {} and {} are all but equal", pair[0][0], pair[1][0]),
                "leave one out".to_owned(),
            );
        }
        if !(2..=MOST_SEGMENTS + 1).contains(&points.len()) {
            return wrong(
                format!("the curve has {} points", points.len()),
                format!("give 2 to {} points", MOST_SEGMENTS + 1),
            );
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
    pub(crate) fn to_csv(&self) -> String {
        let mut text = String::new();
        for point in &self.points {
            push_row(&mut text, point.iter().copied());
        }
        text
    }
}
