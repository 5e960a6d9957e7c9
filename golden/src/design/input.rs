//! What the values of a frame are: pascals, or the counts of a real sensor.

use std::fmt::Write;

use super::DesignError;
use super::checks::Check;
use super::files::Beside;

/// Largest gain of a taxel.
const MAX_GAIN: f64 = 16.0;
/// Largest offset of a taxel, in counts.
const MAX_OFFSET: f64 = 1e6;
/// Range of the magnitude of pascals per count.
const PA_PER_COUNT: [f64; 2] = [1e-9, 1e9];

/// From the values of a frame to stress: `Pa = (gain_i * count + offset_i) * pa_per_count`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Input {
    /// Pascals of one count, with the sign that makes compression negative; `None` where frames are in pascals.
    pub pa_per_count: Option<f64>,
    /// Gain and offset of each taxel; only with counts.
    pub calibration: Option<Calibration>,
}

/// Gain and offset of each taxel.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// What each taxel's count is multiplied by, m values greater than 0 and at most 16.
    pub gain: Vec<f64>,
    /// What is added to the product, in counts, m values.
    pub offset: Vec<f64>,
}

impl Input {
    /// Stress in pascals of a taxel whose value in the frame is `value`.
    pub fn to_pa(&self, taxel: usize, value: f64) -> f64 {
        let Some(pa_per_count) = self.pa_per_count else { return value };
        match &self.calibration {
            Some(Calibration { gain, offset }) => (gain[taxel] * value + offset[taxel]) * pa_per_count,
            None => value * pa_per_count,
        }
    }

    /// The value in a frame, not rounded, of a taxel under a stress in pascals: undoes [`Input::to_pa`].
    pub fn from_pa(&self, taxel: usize, stress: f64) -> f64 {
        let Some(pa_per_count) = self.pa_per_count else { return stress };
        match &self.calibration {
            Some(Calibration { gain, offset }) => (stress / pa_per_count - offset[taxel]) / gain[taxel],
            None => stress / pa_per_count,
        }
    }

    /// A frame of stress in pascals as the sensor delivers it: in whole counts, if it counts.
    pub fn deliver(&self, frame: &mut [f64]) {
        if self.pa_per_count.is_some() {
            for (taxel, value) in frame.iter_mut().enumerate() {
                *value = self.from_pa(taxel, *value).round();
            }
        }
    }

    /// Checks the keys of `[sensor]`; a calibration is one of the files `beside` the design.
    pub(super) fn new(
        check: &Check,
        pa_per_count: Option<f64>,
        calibration: Option<&str>,
        beside: Beside<'_>,
        taxels: usize,
    ) -> Result<Self, DesignError> {
        let [low, high] = PA_PER_COUNT;
        if let Some(value) = pa_per_count
            && !(low..=high).contains(&value.abs())
        {
            return Err(check.value(
                "sensor.pa_per_count",
                format!("is {value}"),
                format!("use a number from {low:e} to {high:e} or from -{high:e} to -{low:e}, negative if larger counts press"),
            ));
        }
        if calibration.is_some() && pa_per_count.is_none() {
            return Err(check.value(
                "sensor.calibration",
                "is given, but pa_per_count is not".to_owned(),
                "add pa_per_count, the pascals of one count: gains and offsets are those of counts".to_owned(),
            ));
        }
        let calibration = calibration.map(|file| Calibration::load(file, beside, taxels)).transpose()?;
        Ok(Self { pa_per_count, calibration })
    }
}

impl Calibration {
    /// Reads one line `gain,offset` for each of the taxels. Blank lines and a byte order mark are skipped.
    fn load(file: &str, beside: Beside<'_>, taxels: usize) -> Result<Self, DesignError> {
        let path = beside.path(file);
        let text = beside.read(file).map_err(|source| DesignError::Read { path: path.clone(), source })?;
        let wrong = |line, problem, remedy: String| DesignError::Table { path: path.clone(), line, problem, remedy };
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let (mut gain, mut offset) = (Vec::with_capacity(taxels), Vec::with_capacity(taxels));
        let mut last = 1;
        for (line, content) in (1..).zip(text.lines()).filter(|(_, content)| !content.trim().is_empty()) {
            last = line;
            let values: Vec<Option<f64>> = content.split(',').map(|field| field.trim().parse().ok()).collect();
            let [Some(g), Some(o)] = values[..] else {
                let shown: String = content.trim().chars().take(40).collect();
                let remedy = "write gain,offset, such as 1.02,-0.5, and no header line".to_owned();
                return Err(wrong(line, format!("{shown:?} is no pair of numbers"), remedy));
            };
            // A NaN is in no range.
            if !(g > 0.0 && g <= MAX_GAIN) {
                let remedy = format!("use a gain greater than 0 and at most {MAX_GAIN}");
                return Err(wrong(line, format!("the gain is {g}"), remedy));
            }
            if !(-MAX_OFFSET..=MAX_OFFSET).contains(&o) {
                let remedy = format!("use an offset from -{MAX_OFFSET} to {MAX_OFFSET} counts");
                return Err(wrong(line, format!("the offset is {o}"), remedy));
            }
            gain.push(g);
            offset.push(o);
        }
        if gain.len() != taxels {
            return Err(wrong(
                last,
                format!("the file ends after {} taxels where the sensor has {taxels}", gain.len()),
                "give one line for each taxel".to_owned(),
            ));
        }
        Ok(Self { gain, offset })
    }

    /// The file that reads back as the same bits.
    pub(super) fn to_csv(&self) -> String {
        let mut text = String::new();
        for (gain, offset) in self.gain.iter().zip(&self.offset) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{gain:?},{offset:?}");
        }
        text
    }
}
