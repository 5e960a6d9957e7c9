//! The design file: what sensor, what algorithm, what hardware.
//!
//! A [`Design`] that exists has passed every check, so code that takes one need not check again.

mod algorithm;
pub(crate) mod checks;
mod error;
mod filter;
mod hardware;
mod input;
mod joint;
mod parse;
mod parse_filter;
mod parse_plan;
mod print;
mod regularisation;

use std::path::Path;

pub use crate::estimators::Estimator;
pub use crate::estimators::joint::{Correction, JointConstants};
pub use crate::kernel::Kernel;
pub use crate::sensor::{MAX_SIDE, Sensor};
pub use algorithm::{Algorithm, Outputs, PlanKind};
pub use error::DesignError;
pub use filter::{Choices, Filter, FilterKind, MatrixFilter, UnknownMatrixFilter};
pub use hardware::{Arithmetic, DEFAULT_FULL_SCALE_PA, Hardware, MAX_LANES, Optimise};
pub use input::{Calibration, Input};
pub use joint::conditions;
pub(crate) use parse::{RawSensor, syntax_position};
pub use regularisation::Regularisation;

/// Largest number of columns or rows with the paper's plan, whose matrices are four times as large.
pub const MAX_SIDE_PAPER: usize = 32;
/// Name of the calibration file beside a resolved design.
pub const CALIBRATION_FILE: &str = "calibration.csv";
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
    /// Choices that change only speed, size and rounding.
    pub hardware: Hardware,
}

impl Design {
    /// Reads and checks a design file.
    ///
    /// # Errors
    ///
    /// Every way a file can be wrong, see [`DesignError`]; the message names the file, the key and the remedy.
    pub fn load(path: &Path) -> Result<Self, DesignError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| DesignError::Read { path: path.to_path_buf(), source })?;
        parse::design(&text, &path.display().to_string(), path.parent())
    }

    /// Checks the text of a design file; `origin` is the name to use in messages, and a calibration file is looked for
    /// in its folder.
    ///
    /// # Errors
    ///
    /// As [`Design::load`], without the reading.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, DesignError> {
        parse::design(text, origin, Path::new(origin).parent())
    }

    /// The resolved design as TOML: every key, in a fixed order; parsing it gives this design back. A calibration is
    /// named [`CALIBRATION_FILE`]; write [`Design::calibration_csv`] beside the design under that name.
    pub fn to_toml(&self) -> String {
        print::to_toml(self)
    }

    /// The calibration as the CSV file that [`Design::to_toml`] names, if there is one.
    pub fn calibration_csv(&self) -> Option<String> {
        self.input.calibration.as_ref().map(Calibration::to_csv)
    }
}
