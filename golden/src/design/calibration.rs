//! Gain and offset of each taxel: the file that `[sensor] calibration` names.

use super::DesignError;
use super::curve::{Curve, is_header_of_points};
use super::files::FileSource;
use super::rows::{Row, Rows};
use crate::numbers::push_row;

/// Range of a live taxel's gain.
const GAIN: [f64; 2] = [1e-9, 16.0];
/// Largest offset of a taxel, in counts.
const MAX_OFFSET: f64 = 1e6;

/// Gain and offset of each taxel.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// What each taxel's count is multiplied by, m values from 1e-9 to 16, or 0 for a dead taxel.
    pub gain: Vec<f64>,
    /// What is added to the product, in counts, with a curve in pascals, m values.
    pub offset: Vec<f64>,
}

impl Calibration {
    /// Reads one line `gain,offset` for each of the taxels, with a header or none; or a file of `sptfra export-calibration`, whose
    /// weights of dead taxels follow from their gains of 0, and whose curve has to be the design's, since the offsets are
    /// made for it.
    pub(super) fn load(
        file: &str,
        beside: FileSource<'_>,
        taxels: usize,
        curve: Option<&Curve>,
    ) -> Result<Self, DesignError> {
        let table = Rows::read(file, beside)?;
        let header = table.rows.first().and_then(Row::header);
        let dead = header.as_ref().map(|names| dead_taxels(&table, names, taxels)).transpose()?.unwrap_or_default();
        let behind = table.rows.iter().position(is_header_of_points);
        let own = &table.rows[usize::from(header.is_some())..behind.unwrap_or(table.rows.len())];
        let (mut gain, mut offset) = (Vec::with_capacity(taxels), Vec::with_capacity(taxels));
        for row in own {
            let wrong = |problem: String, remedy: String| Err(table.wrong(row.line, problem, remedy));
            let Some(&[g, o, ..]) = row.numbers(2 + dead.len()).as_deref() else {
                let what = if dead.is_empty() { "no pair of numbers" } else { "no gain, offset and weights" };
                let more = if dead.is_empty() { "" } else { ", and a weight for each taxel of the header" };
                return wrong(
                    format!("{:?} is {what}", row.shown()),
                    format!("write gain,offset, such as 1.02,-0.5{more}"),
                );
            };
            // A NaN is in no range.
            let [low, high] = GAIN;
            if g != 0.0 && !(low..=high).contains(&g) {
                let remedy = format!("use a gain from {low:e} to {high}, or 0 for a dead taxel");
                return wrong(format!("the gain is {g}"), remedy);
            }
            if !(-MAX_OFFSET..=MAX_OFFSET).contains(&o) {
                let remedy = format!("use an offset from -{MAX_OFFSET} to {MAX_OFFSET} counts");
                return wrong(format!("the offset is {o}"), remedy);
            }
            if g != 0.0 && dead.contains(&gain.len()) {
                let problem = format!("the header has taxel {} among the dead ones, and its gain is {g}", gain.len());
                return wrong(problem, "write 0, or leave the header and the weights out".to_owned());
            }
            gain.push(g);
            offset.push(o);
        }
        if gain.len() != taxels {
            return Err(table.wrong(
                own.last().map_or(1, |row| row.line),
                format!("the file ends after {} taxels where the sensor has {taxels}", gain.len()),
                "give one line for each taxel",
            ));
        }
        if let Some(behind) = behind {
            same_curve(&table, behind, file, curve)?;
        }
        Ok(Self { gain, offset })
    }

    /// The file that reads back as the same bits.
    pub fn to_csv(&self) -> String {
        let mut text = String::new();
        let rows = self.gain.iter().zip(&self.offset);
        rows.for_each(|(&gain, &offset)| push_row(&mut text, [gain, offset].into_iter()));
        text
    }
}

/// The dead taxels that a header of `sptfra export-calibration` names, ascending; none of a plain one.
fn dead_taxels(table: &Rows, names: &[String], taxels: usize) -> Result<Vec<usize>, DesignError> {
    let wrong = |problem: &str, remedy: &str| {
        let shown = format!("{:?} {problem}", table.rows[0].shown());
        Err(table.wrong(table.rows[0].line, shown, remedy.to_owned()))
    };
    let number = |name: &String| {
        let digits = name.strip_prefix("taxel ")?.trim();
        let taxel = digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok())?;
        taxel.filter(|&taxel| taxel < taxels)
    };
    let dead: Option<Vec<usize>> = names.iter().skip(2).map(number).collect();
    match (names, dead) {
        ([gain, offset, ..], Some(dead)) if gain == "gain" && offset == "offset" => {
            match dead.windows(2).find(|pair| pair[1] <= pair[0]) {
                None => Ok(dead),
                Some(pair) => wrong(
                    &format!("has taxel {} behind taxel {}", pair[1], pair[0]),
                    "write each dead taxel once, ascending, as sptfra export-calibration does, and the weights in the same order",
                ),
            }
        }
        _ => wrong(
            "is no header of gains and offsets",
            "write gain,offset, or none; sptfra export-calibration writes behind it the numbers of dead taxels of this sensor, taxel 37",
        ),
    }
}

/// Compares the points behind the taxels with the design's curve.
fn same_curve(table: &Rows, behind: usize, file: &str, curve: Option<&Curve>) -> Result<(), DesignError> {
    let points = Curve::of_rows(table, table.rows[behind + 1..].iter())?.points;
    let problem = match curve {
        Some(curve) if curve.points == points => return Ok(()),
        Some(_) => "the curve is another than the design's, and offsets are made for it",
        None => "the file has a curve, whose offsets are in pascals, and the design none",
    };
    let remedy = format!(
        "write sensor.curve = {file:?} in place of {}, or remove the lines from here on if the offsets are the design's own",
        if curve.is_some() { "the one that is there" } else { "pa_per_count" }
    );
    Err(table.wrong(table.rows[behind].line, problem.to_owned(), remedy))
}
