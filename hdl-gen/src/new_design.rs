//! A design file to start from: commented, checked, with constants fitted to its sensor.

use std::ops::RangeInclusive;

use golden::calibrate::{CalibrateError, Settings, calibrate, state_errors};
use golden::design::{DEFAULT_FULL_SCALE_PA, DEFAULT_NOISE, Design, DesignError, Estimator, Samples, Tension};

/// Digits of fitted constants: no processor rounds four otherwise, and no contact shows more.
const DIGITS: f64 = 1e4;

/// Bits that a converter may have.
pub const COUNT_BITS: RangeInclusive<i64> = 4..=24;

/// What is known of the sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct NewDesign {
    /// Name of the design: a Verilog identifier.
    pub name: String,
    /// How friction is found.
    pub estimator: Estimator,
    /// Taxels in x.
    pub columns: usize,
    /// Taxels in y.
    pub rows: usize,
    /// Distance of neighbouring taxels in x and in y, in millimetres.
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres.
    pub depth_mm: f64,
    /// What taxels read of a pull.
    pub tension: Tension,
    /// Bits of the converter whose counts the frames hold, one of [`COUNT_BITS`]; without, they hold pascals.
    pub counts: Option<u32>,
    /// Stress at the end of the sensor's range.
    pub full_scale_pa: f64,
    /// Standard deviation of a reading's noise, as a share of the frame's largest reading.
    pub noise: f64,
}

impl NewDesign {
    /// The paper's first sensor, or its second one, by the grid search.
    pub fn paper(sensor: u8) -> Self {
        Self {
            name: "my_sensor".to_owned(),
            estimator: Estimator::Joint,
            columns: 10,
            rows: 10,
            pitch_mm: if sensor == 2 { [4.0, 4.0] } else { [4.0, 2.0] },
            depth_mm: 3.0,
            tension: Tension::Read,
            counts: None,
            full_scale_pa: DEFAULT_FULL_SCALE_PA,
            noise: DEFAULT_NOISE,
        }
    }
}

/// Why there is no such design.
#[derive(Debug, thiserror::Error)]
pub enum NewDesignError {
    /// A value that no design can have.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A converter of too few or too many bits.
    #[error("counts of {0} bits; use {first} to {last}", first = COUNT_BITS.start(), last = COUNT_BITS.end())]
    Counts(u32),
    /// The line search takes a pull that the sensor does not read for one that is not there.
    #[error("a sensor that reads no tension needs the grid search: leave --estimator line away")]
    Clipped,
    /// The estimator cannot be fitted to the sensor.
    #[error("{0}; or choose --estimator line, which needs no constants")]
    Calibrate(#[from] CalibrateError),
}

/// The integers that hold counts of so many bits: with a sign, which a tare needs, where there is room for one; float32
/// for wider ones.
fn samples(bits: u32) -> Samples {
    match bits {
        ..=15 => Samples::Int16,
        16 => Samples::Uint16,
        _ => Samples::Float32,
    }
}

/// Pascals of a count, so that the largest one reaches the full scale, where it is flagged, and no count is beyond.
fn pa_per_count(new: &NewDesign, bits: u32) -> f64 {
    let largest = f64::from(bits).exp2() - 1.0;
    let step = new.full_scale_pa / largest;
    let step = if step * largest < new.full_scale_pa { step.next_up() } else { step };
    -step
}

impl NewDesign {
    /// The design file, checked. `stage` is told of work that takes a while.
    ///
    /// # Errors
    ///
    /// [`NewDesignError`].
    pub fn text(&self, stage: &mut dyn FnMut(&'static str)) -> Result<String, NewDesignError> {
        let mut design = self.unfitted()?;
        if self.estimator == Estimator::Joint {
            stage("fitting gain and friction to contacts with known forces");
            let mut found = calibrate(&design, &Settings::constants(), &mut || ())?;
            let [gain, c1, c3] = [found.gain, found.friction_correction[0], found.friction_correction[1]]
                .map(|value| (value * DIGITS).round() / DIGITS);
            (found.gain, found.friction_correction) = (gain, [c1, c3]);
            *design.algorithm.joint = found;
        }
        stage("finding the errors of contacts of all kinds");
        state_errors(&mut design, Settings::constants().seed, &mut || ())?;
        let text = design.to_commented_toml();
        Design::from_toml(&text, "sptfra new")?;
        Ok(text)
    }

    /// The design before anything is fitted.
    fn unfitted(&self) -> Result<Design, NewDesignError> {
        if let Some(bits) = self.counts.filter(|&bits| !COUNT_BITS.contains(&i64::from(bits))) {
            return Err(NewDesignError::Counts(bits));
        }
        if (self.estimator, self.tension) == (Estimator::Line, Tension::Clipped) {
            return Err(NewDesignError::Clipped);
        }
        let Self { estimator, columns, rows, pitch_mm, depth_mm, tension, full_scale_pa, noise, .. } = self;
        // The fit's start.
        let constants = if estimator.is_calibrated() { "gain = 1\nfriction_correction = [1, 0]\n" } else { "" };
        // Quoted, so that whatever the name holds reaches the check of names; a JSON string is a TOML string.
        let name = serde_json::Value::from(self.name.as_str());
        let text = format!(
            "format = 3\nname = {name}\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = {pitch_mm:?}\n\
             depth_mm = {depth_mm:?}\ntension = \"{tension}\"\nnoise = {noise:?}\n\
             [algorithm]\nestimator = \"{estimator}\"\n{constants}\
             [hardware]\nfull_scale_pa = {full_scale_pa:?}\n"
        );
        let mut design = Design::from_toml(&text, "sptfra new")?;
        if let Some(bits) = self.counts {
            design.input.pa_per_count = Some(pa_per_count(self, bits));
            design.hardware.samples = samples(bits);
        }
        Ok(design)
    }
}
