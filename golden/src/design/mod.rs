//! The design file: what sensor, what algorithm, what hardware.
//!
//! A key stands once, in `keys.rs` or, of `[hardware]`, in [`Hardware`]; rules that bind several keys stand in `rules.rs`.
//! A [`Design`] that exists has passed every check, so code that takes one need not check again.

mod algorithm;
mod base;
mod calibration;
pub(crate) mod checks;
mod commented;
mod curve;
mod error;
mod expected_error;
mod files;
mod filter;
mod filter_keys;
mod hardware;
mod input;
mod joint;
mod keys;
mod old_format;
mod read;
mod readings;
mod regularisation;
mod resolve;
mod rows;
mod rules;
pub(crate) mod schema;
mod thin;

use std::path::{Path, PathBuf};

use crate::crosstalk::Crosstalk;
pub use crate::estimators::Estimator;
pub use crate::estimators::StandardError;
pub use crate::estimators::joint::{Correction, Grid, JointConstants, TrainingSet};
pub use crate::kernel::Kernel;
pub use crate::sensor::{MAX_SIDE, Sensor};
use crate::smoothing::Smoothing;
pub use algorithm::{Algorithm, DEFAULT_MAX_STANDARD_ERROR, Outputs, PlanKind, Slip};
pub use calibration::Calibration;
pub use checks::is_name;
pub use curve::{Curve, MOST_SEGMENTS};
pub use error::DesignError;
pub use expected_error::{Expected, ExpectedError};
pub(crate) use files::FileSource;
pub use files::{CALIBRATION_FILE, CURVE_FILE, WEIGHTS_FILE};
pub use filter::{Choices, Filter, FilterKind, MatrixFilter};
pub use hardware::{
    CalibrationIn, DEFAULT_FULL_SCALE_PA, Hardware, MAX_LANES, Optimise, Overrun, STREAM_BITS, Samples, Scaling,
};
pub use input::Input;
pub use joint::{Reads, conditions};
pub use read::syntax_position;
pub use readings::{DEFAULT_NOISE, MAX_NOISE, MeasuredNoise, Tension};
pub use regularisation::Regularisation;
pub use schema::design_schema;

/// Largest number of columns or rows with the paper's plan, whose matrices are four times as large.
pub const MAX_SIDE_PAPER: usize = 32;
/// Key `algorithm.noise_floor_pa`, when absent, is the full scale divided by this.
pub const NOISE_FLOOR_DIVISOR: f64 = 65536.0;

/// A checked design: everything needed to compute matrices and to plan hardware.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Module and folder name, a Verilog identifier.
    pub name: String,
    /// Geometry of the sensor.
    pub sensor: Sensor,
    /// What the values of a frame are; keys of `[sensor]` too, but not of a scene's sensor.
    pub input: Input,
    /// Choices that change the result.
    pub algorithm: Algorithm,
    /// Speed, size, rounding, range and interfaces of the core.
    pub hardware: Hardware,
}

impl Design {
    /// A frame of stress in pascals as the design's sensor delivers it: without what pulls, if it does not read that, with
    /// crosstalk, and in whole counts, if it counts, as far as its samples reach.
    pub fn deliver(&self, frame: &mut [f64]) {
        for value in &mut *frame {
            *value = self.input.tension.of(*value);
        }
        self.read_stress(frame);
        for value in frame {
            // No count is -0.
            *value = if self.input.counts() { value.round() + 0.0 } else { *value };
            *value = self.hardware.samples.clip(*value);
        }
    }

    /// As [`Design::deliver`] for frames that follow each other, with creep.
    pub fn deliver_in_order<'a>(&self, frames: impl IntoIterator<Item = &'a mut Vec<f64>>) {
        let mut past = Vec::new();
        for frame in frames {
            if let Some(creep) = &self.input.creep {
                for stress in frame.iter_mut() {
                    *stress = self.input.tension.of(*stress);
                }
                creep.add(&mut past, frame);
            }
            self.deliver(frame);
        }
    }

    /// Values of a frame, not rounded, of taxels under these stresses in pascals. A dead taxel reads 0.
    pub fn read_stress(&self, frame: &mut [f64]) {
        if let Some(crosstalk) = self.crosstalk() {
            crosstalk.add(frame);
        }
        for (taxel, value) in frame.iter_mut().enumerate() {
            *value = self.input.from_pa(taxel, *value);
        }
    }

    /// Stresses in pascals of a frame's values. A dead taxel counts as one without load.
    pub fn stress_of(&self, frame: &[f64]) -> Vec<f64> {
        let mut stress: Vec<f64> =
            frame.iter().enumerate().map(|(taxel, &value)| self.input.to_pa(taxel, value)).collect();
        if let Some(crosstalk) = self.crosstalk() {
            crosstalk.remove(&mut stress);
        }
        stress
    }

    /// How frames are averaged, if they are.
    pub fn smoothing(&self) -> Option<Smoothing> {
        let Input { smoothing, noise, .. } = self.input;
        (smoothing > 0).then(|| Smoothing::new(smoothing, noise, self.input.typical_pa()))
    }

    /// Crosstalk of the sensor, if it has any.
    pub fn crosstalk(&self) -> Option<Crosstalk> {
        let share = self.input.crosstalk;
        (share > 0.0).then(|| Crosstalk::new(&self.sensor, share))
    }

    /// The design with which every frame is solved as one contact, as by its hardware, which counts contacts alone.
    #[must_use]
    pub fn solved_as_one(&self) -> Self {
        let mut design = self.clone();
        design.algorithm.contacts = 1;
        design
    }

    /// Reads and checks a design file.
    ///
    /// # Errors
    ///
    /// Every way a file can be wrong, see [`DesignError`]; the message names the file, the key and the remedy.
    pub fn load(path: &Path) -> Result<Self, DesignError> {
        from_text(&text_of(path)?, &path.display().to_string(), FileSource::folder_of(path))
    }

    /// As [`Design::load`], without the constants that were fitted to the sensor, be they those of another one.
    ///
    /// # Errors
    ///
    /// As [`Design::load`], but for what is wrong with these constants.
    pub fn load_unfitted(path: &Path) -> Result<Self, DesignError> {
        let (origin, beside) = (path.display().to_string(), FileSource::folder_of(path));
        let keys = resolve::unfitted(read::keys(&text_of(path)?, &origin, beside)?);
        resolve::design(keys, &origin, beside)
    }

    /// Checks the text of a design file; `origin` is the name to use in messages, and files that the design names are
    /// looked for in its folder.
    ///
    /// # Errors
    ///
    /// As [`Design::load`], without the reading.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, DesignError> {
        from_text(text, origin, FileSource::folder_of(Path::new(origin)))
    }

    /// As [`Design::from_toml`], with the files that the design names as pairs of name and content, as
    /// [`Design::files`] has them.
    ///
    /// # Errors
    ///
    /// As [`Design::from_toml`]; a file that is not among them is one that cannot be read.
    pub fn from_parts(text: &str, origin: &str, files: &[(&str, String)]) -> Result<Self, DesignError> {
        from_text(text, origin, FileSource::Memory(files))
    }

    /// The files of a design: those that its file names, none of which is read, and that file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or is no TOML.
    pub fn inputs_at(path: &Path) -> Result<Vec<PathBuf>, DesignError> {
        let mut files =
            read::files_named_in(&text_of(path)?, &path.display().to_string(), FileSource::folder_of(path))?;
        files.push(path.to_path_buf());
        Ok(files)
    }

    /// The resolved design as TOML: every key that has a value, in a fixed order; parsing it gives this design back. The
    /// files that it names are [`Design::files`]; write them beside it.
    pub fn to_toml(&self) -> String {
        self.to_toml_with(str::to_owned)
    }

    /// As [`Design::to_toml`], with other names for the files beside it, each from that in [`Design::files`].
    pub fn to_toml_with(&self, named: impl Fn(&str) -> String) -> String {
        toml::to_string(&resolve::keys(self, named)).unwrap_or_default()
    }

    /// As [`Design::to_toml`], as a file to edit: each key with its meaning, and those without a value as remarks.
    pub fn to_commented_toml(&self) -> String {
        let mut keys = resolve::keys(self, str::to_owned);
        // Follows the full scale that is edited.
        let usual = self.hardware.full_scale_pa / NOISE_FLOOR_DIVISOR;
        keys.algorithm.noise_floor_pa =
            keys.algorithm.noise_floor_pa.filter(|floor| floor.to_bits() != usual.to_bits());
        // Follows the noise.
        let usual = Regularisation::usual(&self.sensor, self.input.noise);
        keys.algorithm.regularisation = keys.algorithm.regularisation.filter(|written| *written != usual);
        commented::commented(&self.name, &toml::Table::try_from(keys).unwrap_or_default())
    }
}

fn from_text(text: &str, origin: &str, beside: FileSource<'_>) -> Result<Design, DesignError> {
    resolve::design(read::keys(text, origin, beside)?, origin, beside)
}

/// The text of a design or scene file.
///
/// # Errors
///
/// [`DesignError`] with the file that is meant if there is none.
pub fn text_of(path: &Path) -> Result<String, DesignError> {
    std::fs::read_to_string(path).map_err(|source| DesignError::read(path, &source))
}
