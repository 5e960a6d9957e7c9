//! The keys of a design file, each with its meaning, unit, range and default.
//!
//! A key stands here alone: parser, printer, range checks, JSON schema, the file that `new` writes and the reference page
//! are made from these structs. `[hardware]` is [`Hardware`], which needs no other form. Doc comments are what users read.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::readings::{DEFAULT_NOISE, MAX_NOISE, MeasuredNoise, Tension};
use super::{ExpectedError, FilterKind, Hardware, MAX_SIDE, Outputs, PlanKind, Regularisation, Slip, TrainingSet};
use crate::contacts;
use crate::creep::Creep;
use crate::estimators::{Estimator, StandardError};
use crate::kernel::Kernel;

/// The version of the format that this file describes.
pub(super) const FORMAT: i64 = 3;

/// A design: one sensor, one algorithm, one piece of hardware.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DesignKeys {
    /// Version of the format of this file.
    #[schemars(range(min = FORMAT, max = FORMAT), extend("examples" = [3]))]
    pub format: i64,
    /// Another design file, by its path from this one. Its keys hold where this file has none. A base has no base.
    #[schemars(extend("examples" = ["sensor1.toml"]))]
    pub base: Option<String>,
    /// Name of the top module and of the output folder: a Verilog identifier of at most 64 characters.
    #[schemars(extend("examples" = ["my_sensor"]))]
    pub name: String,
    pub sensor: SensorKeys,
    #[serde(default)]
    pub algorithm: AlgorithmKeys,
    #[serde(default)]
    pub hardware: Hardware,
}

/// The sensor: its geometry, and the values of a frame.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorKeys {
    /// Taxels along x. The paper's plan takes at most 32.
    #[schemars(range(min = 2, max = MAX_SIDE))]
    pub columns: usize,
    /// Taxels along y. The paper's plan takes at most 32.
    #[schemars(range(min = 2, max = MAX_SIDE))]
    pub rows: usize,
    /// Distance of neighbouring taxels along x and y, in millimetres.
    #[schemars(inner(range(min = 0.01, max = 1000.0)))]
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub depth_mm: f64,
    /// What taxels read of a surface under tension.
    #[serde(default)]
    pub tension: Tension,
    /// Standard deviation of a reading's noise, as a share of the frame's largest reading. `sptfra calibrate` trains at up to
    /// 1.5 times this noise, or of what `smoothing` leaves of it.
    #[serde(default)]
    pub noise: NoiseKey,
    /// Crosstalk of a row-column array: each taxel reads its stress plus this share of the sum of its row and of its column, the
    /// taxel among them. The solver removes it exactly, in pascals, after gains and dead taxels.
    #[schemars(range(min = 0.0001, max = 0.1), extend("examples" = [0.02]))]
    pub crosstalk: Option<f64>,
    /// Creep: readings that rise under constant load. Each taxel's own past corrects it, by one strength and one time constant
    /// for all, which `sptfra calibrate --constant-load` finds. `seconds` times `frames_per_second` is 2 to 131,072.
    #[schemars(extend("examples" = [{ "strength" : 0.4, "seconds" : 10.0, "frames_per_second" : 100.0 }]))]
    pub creep: Option<Creep>,
    /// The k of an exponential moving average of each taxel over the frames, with the weight 2^-k. A step of any taxel by more
    /// than 6 standard deviations of the `noise` restarts it. A frame that is short, not finite or dropped leaves it as it was.
    /// With `scaling = "per_frame"` the core answers 4 cycles later. With `"fixed"` it answers at most a cycle an orbit (up to
    /// four taxels; one of the paper's plan) and 3 later, since the last reading may restart all. With `control = true` a register changes k.
    #[schemars(range(min = 1, max = 8), extend("examples" = [4]))]
    pub smoothing: Option<u32>,
    /// Pascals of one count, negative where larger counts press. Without this key or `curve`, frames hold pascals.
    #[schemars(extend("examples" = [-12.5]))]
    pub pa_per_count: Option<f64>,
    /// From counts to pascals where the sensor is not linear, in place of `pa_per_count`.
    #[schemars(extend("examples" = ["curve.csv"]))]
    pub curve: Option<CurveKey>,
    /// File with a line gain,offset for each taxel. It needs `pa_per_count` or `curve`. A gain of 0 is a dead taxel.
    #[schemars(extend("examples" = ["gains.csv"]))]
    pub calibration: Option<String>,
    /// Taxels whose readings mean nothing: the hardware replaces them by a weighted sum of their neighbours.
    #[schemars(extend("examples" = [[44]]))]
    pub dead: Option<DeadKey>,
}

/// Key `noise`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "sensor.noise is a share of the frame's largest reading, noise = 0.01, or a standard deviation and what \
                 contacts read at most, both in the units of frames, noise = { deviation = 12.0, largest = 4000.0 }"
)]
pub(super) enum NoiseKey {
    /// A share of the frame's largest reading.
    Share(#[schemars(range(min = 0.0, max = MAX_NOISE))] f64),
    /// Pascals or counts, as the frames are, alike in every frame, so that light contacts have a larger error. With a curve
    /// write the share that `sptfra check --unloaded --loaded` prints.
    Measured(MeasuredNoise),
}

impl NoiseKey {
    /// The share of the frame's largest reading.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Share(share) => share,
            Self::Measured(noise) => noise.share(),
        }
    }

    /// What was measured.
    pub(super) fn measured(self) -> Option<MeasuredNoise> {
        match self {
            Self::Share(_) => None,
            Self::Measured(noise) => Some(noise),
        }
    }
}

impl Default for NoiseKey {
    fn default() -> Self {
        Self::Share(DEFAULT_NOISE)
    }
}

/// Key `curve`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "sensor.curve is the name of a file, curve = \"curve.csv\", or a power law with two numbers and no other \
                 key, curve = { power = 1.25, scale = -0.0066 }"
)]
pub(super) enum CurveKey {
    /// A file of lines count,pascals: 2 to 65 points.
    File(String),
    /// The power law `scale * count^power`.
    Law {
        /// The exponent.
        #[schemars(range(min = 0.25, max = 4.0))]
        power: f64,
        /// Pascals at one count, negative where larger counts press.
        scale: f64,
    },
}

/// Key `dead`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "sensor.dead is a list of taxels, dead = [44], or a table, dead = { taxels = [44], room = 4 }, for a bank \
                 with room for 1, 2, 4 or 8 dead taxels"
)]
pub(super) enum DeadKey {
    /// Those of the design, for good.
    Taxels(Vec<i64>),
    /// Those of the first bank, and the most that a later bank may have.
    Room {
        /// Dead taxels.
        #[serde(default)]
        taxels: Vec<i64>,
        /// Dead taxels for which a bank has room. It needs `hardware.calibration = "ram"`.
        #[schemars(extend("enum" = [1, 2, 4, 8]))]
        room: usize,
    },
}

/// The algorithm: choices that change the result.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct AlgorithmKeys {
    /// How the mathematics is put into products.
    pub plan: PlanKind,
    /// Load model behind the matrices C31, C32 and C33. Without the key `cell` for layers of less than half a pitch, else
    /// `point`.
    #[schemars(extend("examples" = ["point"]))]
    pub kernel: Option<Kernel>,
    /// Tikhonov regularisation of C33. Without the key, layers deeper than 1.5 pitches have that of the sensor's `noise`, or
    /// of 0.002 if it is less; others have none.
    #[schemars(extend("examples" = [{"noise": 0.002}]))]
    pub regularisation: Option<Regularisation>,
    /// Which matrix entries are kept.
    #[schemars(extend("examples" = [{"kind": "f1", "l": 40}]))]
    pub filter: FilterKeys,
    /// How friction is found.
    pub estimator: Estimator,
    /// Contacts that the grid search's constants are trained on.
    #[schemars(extend("examples" = ["sliding"]))]
    pub training_set: Option<TrainingSet>,
    /// Standard error of the tangential force. `sptfra calibrate` fits its three numbers to contacts of all kinds. Without
    /// the key a design states no standard error.
    #[schemars(extend("examples" = [{"model": 0.03, "noise": 120.0, "border": 1.5}]))]
    pub standard_error: Option<StandardError>,
    /// Standard error, as a share of the normal force, above which a frame has `low_confidence`; 0.1 without the key.
    #[schemars(range(min = 0.001, max = 3.9), extend("examples" = [0.1]))]
    pub max_standard_error: Option<f64>,
    /// Error of the tangential force by noise, on contacts inside the grid that nothing was fitted to. `sptfra calibrate`
    /// finds it. Without the key a design states none.
    #[schemars(extend("examples" = [{"noise": [0.0, 0.01], "median": [1.5, 6.0], "p95": [4.0, 13.0]}]))]
    pub expected_error: Option<ExpectedError>,
    /// Sensor and method that the constants were fitted for. `sptfra calibrate` writes it; any other design is refused.
    #[schemars(extend("examples" = ["10 x 10 taxels of 4 x 2 mm, 3 mm deep, point, 0, noise 0.005, sliding"]))]
    pub calibrated_for: Option<String>,
    /// Factor on all forces, which the grid search needs. `sptfra calibrate` fits it.
    #[schemars(range(min = 0.1, max = 10.0), extend("examples" = [1.1]))]
    pub gain: Option<f64>,
    /// The numbers c1 (0.1 to 10) and c3 (-3.9 to 3.9) of the friction `c1 mu + c3 mu |mu|^2`, which the grid search
    /// needs. `sptfra calibrate` fits them.
    #[schemars(extend("examples" = [[1.0, 0.0]]))]
    pub friction_correction: Option<[f64; 2]>,
    /// Most contacts that software separates. With 1 a frame is solved as that of one contact.
    #[schemars(range(min = 1, max = contacts::MOST))]
    pub contacts: usize,
    /// Whether contacts are counted, so that a status bit marks a frame of several. In hardware this takes 3 to 4 % more LUTs.
    pub count_contacts: bool,
    /// What a frame yields.
    pub outputs: Outputs,
    /// Stress in pascals below which a taxel counts as unloaded; `full_scale_pa` / 65536 without the key.
    #[schemars(extend("exclusiveMinimum" = 0.0, "examples" = [1.5]))]
    pub noise_floor_pa: Option<f64>,
    /// Friction coefficient at which a held contact counts as slipping, in a status bit.
    #[schemars(extend("examples" = [{"limit": 0.4, "hysteresis": 0.05}]))]
    pub slip: Option<SlipKeys>,
    /// The grid search's correction network. `sptfra calibrate` trains it.
    #[schemars(extend("examples" = [{"half_window": [4, 4], "file": "weights.csv", "sha256": "..."}]))]
    pub correction: Option<CorrectionKeys>,
}

impl Default for AlgorithmKeys {
    fn default() -> Self {
        Self {
            plan: PlanKind::default(),
            kernel: None,
            regularisation: None,
            filter: FilterKeys::default(),
            estimator: Estimator::default(),
            training_set: None,
            standard_error: None,
            max_standard_error: None,
            expected_error: None,
            calibrated_for: None,
            gain: None,
            friction_correction: None,
            contacts: 1,
            count_contacts: true,
            outputs: Outputs::default(),
            noise_floor_pa: None,
            slip: None,
            correction: None,
        }
    }
}

/// Key `filter`. Not a tagged enum: those lose the position of an error and cannot say which key belongs to which kind.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FilterKeys {
    /// The rule.
    pub kind: FilterKind,
    /// Diagonals that f1 removes on either side: 1 to taxels - 2.
    #[schemars(extend("examples" = [40]))]
    pub l: Option<i64>,
    /// f2 removes what is below `1 / (1000 p)` of its row's maximum.
    #[schemars(extend("exclusiveMinimum" = 0.0, "examples" = [30.0]))]
    pub p: Option<f64>,
    /// Scene files by which f3 chooses.
    #[schemars(extend("examples" = [["scene.toml"]]))]
    pub scenes: Option<Vec<String>>,
    /// The filter of each of the 13 matrices. `sptfra tune-filter` writes them.
    #[schemars(extend("examples" = [{"A2": "f2 p=30"}]))]
    pub choices: Option<BTreeMap<String, String>>,
}

/// Key `slip`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SlipKeys {
    /// The bit is raised at this coefficient.
    #[schemars(range(min = 0.01, max = Slip::LARGEST))]
    pub limit: f64,
    /// The bit is lowered this far below the limit; a tenth of the limit without the key.
    #[schemars(extend("examples" = [0.05]))]
    pub hysteresis: Option<f64>,
}

/// Key `correction`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CorrectionKeys {
    /// Taxels on either side of the contact's centre in the network's window, along x and y.
    pub half_window: [i64; 2],
    /// File of the weights.
    #[schemars(extend("examples" = ["weights.csv"]))]
    pub file: String,
    /// SHA-256 sum of the file.
    #[schemars(extend("examples" = ["..."]))]
    pub sha256: String,
}
