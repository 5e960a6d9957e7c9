//! The keys of a design file, each with its meaning, unit, range and default.
//!
//! A key stands here alone: parser, printer, range checks, JSON schema, the file that `new` writes and the reference page
//! are made from these structs. `[hardware]` is [`Hardware`], which needs no other form. Doc comments are what users read.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FilterKind, Hardware, MAX_SIDE, Outputs, PlanKind, Regularisation, Slip, Tension};
use crate::bodies;
use crate::estimators::Estimator;
use crate::estimators::joint::Family;
use crate::kernel::Kernel;

/// The version of the format that this file describes.
pub(super) const FORMAT: i64 = 3;
/// Least and largest length in millimetres.
pub(super) const LENGTH_MM: [f64; 2] = [0.01, 1000.0];
/// Least number of columns or rows.
pub(super) const MIN_SIDE: usize = 2;

/// A design: one sensor, one algorithm, one piece of hardware.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DesignKeys {
    /// Version of the format of this file.
    #[schemars(range(min = FORMAT, max = FORMAT), extend("examples" = [3]))]
    pub format: i64,
    /// Another design file, by its path from this one: its keys hold wherever this file has none. A base has no base.
    #[schemars(extend("examples" = ["sensor1.toml"]))]
    pub base: Option<String>,
    /// Name of the top module and of the output folder, a Verilog identifier of at most 64 characters.
    #[schemars(extend("examples" = ["my_sensor"]))]
    pub name: String,
    pub sensor: SensorKeys,
    #[serde(default)]
    pub algorithm: AlgorithmKeys,
    #[serde(default)]
    pub hardware: Hardware,
}

/// The sensor: its geometry, and what the values of a frame are.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorKeys {
    /// Taxels along x; with the paper's plan at most 32.
    #[schemars(range(min = MIN_SIDE, max = MAX_SIDE))]
    pub columns: usize,
    /// Taxels along y; with the paper's plan at most 32.
    #[schemars(range(min = MIN_SIDE, max = MAX_SIDE))]
    pub rows: usize,
    /// Distance of neighbouring taxels along x and y, in millimetres.
    #[schemars(inner(range(min = LENGTH_MM[0], max = LENGTH_MM[1])))]
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres. Beyond 1.5 pitches it needs `regularisation`.
    #[schemars(range(min = LENGTH_MM[0], max = LENGTH_MM[1]))]
    pub depth_mm: f64,
    /// What taxels read of a surface that is pulled.
    #[serde(default)]
    pub tension: Tension,
    /// Pascals of one count, negative where larger counts press. Without this key or `curve`, frames hold pascals.
    #[schemars(extend("examples" = [-12.5]))]
    pub pa_per_count: Option<f64>,
    /// From counts to pascals where the sensor is not linear: a file of lines count,pascals (2 to 65 points), or the power
    /// law `scale * count^power`. In place of `pa_per_count`.
    #[schemars(extend("examples" = ["curve.csv"]))]
    pub curve: Option<CurveKey>,
    /// File with a line gain,offset for each taxel; needs `pa_per_count` or `curve`. A gain of 0 is a dead taxel.
    #[schemars(extend("examples" = ["gains.csv"]))]
    pub calibration: Option<String>,
    /// Taxels whose readings mean nothing: neighbours replace them. As a table with `room`, a calibration in RAM can replace
    /// so many others later.
    #[schemars(extend("examples" = [[44]]))]
    pub dead: Option<DeadKey>,
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
    /// A file of points.
    File(String),
    /// A power law.
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
    /// Those that the first bank has, and how many a bank can have.
    Room {
        /// Dead taxels.
        #[serde(default)]
        taxels: Vec<i64>,
        /// Dead taxels for which a bank has room; needs `hardware.calibration = "ram"`.
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
    /// Load model behind the matrices C31, C32 and C33.
    pub kernel: Kernel,
    /// What C33 is made better conditioned by: a share of its largest singular value, or the noise of the sensor as a share
    /// of the largest stress. For layers deeper than 1.5 pitches.
    #[schemars(extend("examples" = [{"noise": 0.002}]))]
    pub regularisation: Option<Regularisation>,
    /// Which matrix entries are kept.
    #[schemars(extend("examples" = [{"kind": "f1", "l": 40}]))]
    pub filter: FilterKeys,
    /// How friction is found.
    pub estimator: Estimator,
    /// Points along an axis of the joint estimator's grid.
    #[schemars(extend("examples" = [21]))]
    pub grid: Option<i64>,
    /// Contacts that the joint estimator's constants are fitted to.
    #[schemars(extend("examples" = ["sliding"]))]
    pub training_set: Option<Family>,
    /// Standard error of the tangential force, as a share of the normal force, above which a frame has `low_confidence`.
    /// Only with `training_set = "general"`.
    #[schemars(range(min = 0.001, max = 3.9), extend("examples" = [0.1]))]
    pub max_standard_error: Option<f64>,
    /// What the constants are fitted to; a design of another sensor is refused. The command `calibrate` writes it.
    #[schemars(extend("examples" = ["10 x 10 taxels of 4 x 2 mm, 3 mm deep, point, 0"]))]
    pub calibrated_for: Option<String>,
    /// Factor on all forces, fitted by `calibrate`.
    #[schemars(range(min = 0.1, max = 10.0), extend("examples" = [1.1]))]
    pub gain: Option<f64>,
    /// The numbers c1 and c3 of the friction `c1 mu + c3 mu |mu|^2`, fitted by `calibrate`: 0.1 to 10, and -3.9 to 3.9.
    #[schemars(extend("examples" = [[1.0, 0.0]]))]
    pub friction_correction: Option<[f64; 2]>,
    /// Most contacts that software separates; with 1 a frame is solved as that of one contact.
    #[schemars(range(min = 1, max = bodies::MOST))]
    pub contacts: usize,
    /// Whether frames of several contacts that are solved as one say so, in a status bit.
    pub count_contacts: bool,
    /// What a frame yields.
    pub outputs: Outputs,
    /// Stress in pascals below which a taxel counts as unloaded; without the key, `full_scale_pa` / 65536.
    #[schemars(extend("exclusiveMinimum" = 0.0, "examples" = [1.5]))]
    pub noise_floor_pa: Option<f64>,
    /// Friction coefficient at which a held contact counts as slipping, in a status bit.
    #[schemars(extend("examples" = [{"limit": 0.4, "hysteresis": 0.05}]))]
    pub slip: Option<SlipKeys>,
    /// The joint estimator's correction network, trained by `calibrate`.
    #[schemars(extend("examples" = [{"half_window": [4, 4], "file": "weights.csv", "sha256": "..."}]))]
    pub correction: Option<CorrectionKeys>,
}

impl Default for AlgorithmKeys {
    fn default() -> Self {
        Self {
            plan: PlanKind::default(),
            kernel: Kernel::default(),
            regularisation: None,
            filter: FilterKeys::default(),
            estimator: Estimator::default(),
            grid: None,
            training_set: None,
            max_standard_error: None,
            calibrated_for: None,
            gain: None,
            friction_correction: None,
            contacts: 1,
            count_contacts: false,
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
    /// The filter of each of the 13 matrices, which `tune-filter` writes.
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
    /// The bit is lowered this far below the limit; a tenth of it without the key.
    #[schemars(extend("examples" = [0.05]))]
    pub hysteresis: Option<f64>,
}

/// Key `correction`: the weights in a file with its hash, or in the table itself.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CorrectionKeys {
    /// Taxels on either side of the contact's centre that the network sees, along x and y.
    pub half_window: [i64; 2],
    /// File of the weights.
    #[schemars(extend("examples" = ["weights.csv"]))]
    pub file: Option<String>,
    /// SHA-256 sum of the file.
    #[schemars(extend("examples" = ["..."]))]
    pub sha256: Option<String>,
    /// Logarithm of the standard error without any unit, in steps of the weights, of a network that estimates it.
    #[schemars(extend("examples" = [-8000]))]
    pub error_base: Option<i64>,
    /// Weights of each hidden unit, in place of a file.
    #[schemars(extend("examples" = [[[1, 2, 3, 4, 5, 6]]]))]
    pub hidden: Option<Vec<Vec<i64>>>,
    /// Weights of each output, in place of a file.
    #[schemars(extend("examples" = [[[1], [2]]]))]
    pub output: Option<Vec<Vec<i64>>>,
}
