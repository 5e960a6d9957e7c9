//! The design file: what sensor, what algorithm, what hardware.
//!
//! A [`Design`] that exists has passed every check, so code that takes one need not check again.

pub(crate) mod checks;
mod filter;
mod input;
mod joint;
mod parse;
mod parse_filter;
mod parse_plan;
mod print;
mod regularisation;

use std::path::{Path, PathBuf};

pub use filter::{Choices, Filter, MatrixFilter, UnknownMatrixFilter};
pub use input::{Calibration, Input};
pub use joint::{Correction, EXTRA_INPUTS, JointConstants, MAX_HIDDEN, WEIGHT_BITS, WEIGHT_FRACTION, conditions};
pub(crate) use parse::{RawSensor, syntax_position};
pub use regularisation::Regularisation;

/// Largest number of columns or rows of a sensor.
pub const MAX_SIDE: usize = 64;
/// Largest number of columns or rows with the paper's plan, whose matrices are four times as large.
pub const MAX_SIDE_PAPER: usize = 32;
/// Largest number of `SpMV` lanes.
pub const MAX_LANES: usize = 64;
/// Name of the calibration file beside a resolved design.
pub const CALIBRATION_FILE: &str = "calibration.csv";
/// Key `hardware.full_scale_pa` when absent.
pub const DEFAULT_FULL_SCALE_PA: f64 = 100_000.0;
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

/// Geometry of a rectangular grid of taxels under an elastic layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    /// Taxels along x, 2 to [`MAX_SIDE`].
    pub columns: usize,
    /// Taxels along y, 2 to [`MAX_SIDE`].
    pub rows: usize,
    /// Distance between neighbours along x and y, in millimetres.
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres.
    pub depth_mm: f64,
}

impl Sensor {
    /// Number of taxels, `columns * rows`.
    pub fn taxels(&self) -> usize {
        self.columns * self.rows
    }

    /// Position of taxel `index = iy * columns + ix` in metres; the first taxel is the origin.
    pub fn position_m(&self, index: usize) -> [f64; 2] {
        let (ix, iy) = (index % self.columns, index / self.columns);
        [ix as f64 * self.pitch_mm[0] * 1e-3, iy as f64 * self.pitch_mm[1] * 1e-3]
    }

    /// Depth of the taxels below the surface in metres.
    pub fn depth_m(&self) -> f64 {
        self.depth_mm * 1e-3
    }
}

/// How a force on one surface point loads a taxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Point force on an elastic half-space, as in the paper (Eq. 4).
    Point,
    /// The same force spread evenly over a cell of one pitch by one pitch around its place (Love's closed form).
    ///
    /// Forces stay in newtons for each place. To choose where the normal force matters: the coarser the pitch for the
    /// depth, the more a point force overstates the stress straight below it, so that `F_z` falls short, by 10 and
    /// 20 % on the sensors of the paper; with cells it is right to 1 %. The line estimator's tangential forces fall
    /// short with either kernel, so that friction, their quotient, is better with the point kernel.
    Cell,
}

/// How the friction components are found once the optimisation problem is set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// Along the line that the direction of push fixes in the plane of the friction components.
    Line,
    /// Over the whole plane of the friction components at once, without a direction: the centroid of a level set of
    /// Condition 1, calibrated on scenes.
    Joint,
}

/// What a frame yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outputs {
    /// The summary and three force components for each taxel.
    Field,
    /// The summary only; with the reduced plan.
    Resultants,
}

/// How the mathematics is put into products.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanKind {
    /// As in the paper: thirteen matrices of m by m, then three products with C33.
    Paper,
    /// The same result from ten matrices in four mirror-symmetric blocks of m/4 by m/4, see [`crate::reduced`].
    Reduced,
}

/// The `[algorithm]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Algorithm {
    /// Products behind the result; [`PlanKind::Reduced`] unless there is a filter or the lanes are no multiple of 4.
    pub plan: PlanKind,
    /// Load model behind C31, C32 and C33.
    pub kernel: Kernel,
    /// What C33 is made better conditioned by.
    pub regularisation: Regularisation,
    /// Sparsity of the matrices.
    pub filter: Filter,
    /// Friction estimator.
    pub estimator: Estimator,
    /// Constants of the joint estimator; the line estimator has none and leaves them at their default.
    pub joint: Box<JointConstants>,
    /// Contents of the output.
    pub outputs: Outputs,
    /// Stress in pascals below which a taxel tells nothing; full scale / 65536 unless given.
    pub noise_floor_pa: f64,
}

/// Number system of the hardware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Two's complement with one power-of-two scale for each matrix and vector.
    Fixed,
}

/// What the hardware spends its area on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Optimise {
    /// Frames a second.
    Interval,
    /// Time from the last value of a frame to its result; with the reduced plan.
    Latency,
}

/// The `[hardware]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardware {
    /// Number system.
    pub arithmetic: Arithmetic,
    /// Width of matrix entries, 8 to 18 bits.
    pub coefficient_bits: u32,
    /// Width of vector entries, 16 to 27 bits.
    pub data_bits: u32,
    /// Largest stress magnitude in pascals; input of that and more is reported, and clamped.
    pub full_scale_pa: f64,
    /// `SpMV` lanes, 1 to [`MAX_LANES`]; with the reduced plan a multiple of 4. With a target time the generator
    /// chooses, and this is the default until then.
    pub lanes: usize,
    /// Time in microseconds a frame may take; with the reduced plan, in place of the lanes.
    pub target_us: Option<f64>,
    /// What the area is spent on.
    pub optimise: Optimise,
    /// Whether zeros of |w| are skipped; with the reduced plan and no filter.
    pub skip_zeros: bool,
    /// Whether the core has a register bank on AXI4-Lite.
    pub control: bool,
    /// Clock in megahertz, 1 to 1000.
    pub clock_mhz: f64,
    /// FPGA part name.
    pub part: String,
}

impl Hardware {
    /// The largest float32 that is no more than the full scale, in pascals: a frame cannot bring more of it. From here
    /// on a stress counts as saturated.
    pub fn full_scale_in_frames(&self) -> f64 {
        let nearest = self.full_scale_pa as f32;
        f64::from(if f64::from(nearest) > self.full_scale_pa { nearest.next_down() } else { nearest })
    }
}

/// What is wrong with a design or scene file.
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// The file could not be read.
    #[error("{}: cannot read the file: {source}; check the path and the permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is no TOML, a key is unknown or missing, or a value has the wrong type.
    #[error("{origin}, line {line}, column {column}{}: {message}", near(context))]
    Syntax {
        /// File name.
        origin: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line's text.
        context: String,
        /// What is wrong.
        message: String,
    },
    /// A value has the right type but is out of range or contradicts another.
    #[error("{origin}: {key} {problem}; {remedy}")]
    Value {
        /// File name.
        origin: String,
        /// Dotted key, e.g. `sensor.columns`.
        key: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A calibration file that does not fit the sensor.
    #[error("{}, line {line}: {problem}; {remedy}", path.display())]
    Calibration {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A word that is not among the allowed ones.
    #[error("{origin}: {key} is \"{found}\"; choose one of: {}", allowed.join(", "))]
    Choice {
        /// File name.
        origin: String,
        /// Dotted key.
        key: String,
        /// The word found.
        found: String,
        /// The words allowed.
        allowed: &'static [&'static str],
    },
}

fn near(context: &str) -> String {
    if context.is_empty() { String::new() } else { format!(", in `{context}`") }
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
