//! The keys of a scene file, each with its range. Ranges are checked by the JSON schema that these structs give.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::design::Tension;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneKeys {
    pub(super) sensor: SensorKeys,
    pub(super) medium: MediumKeys,
    #[serde(default)]
    pub(super) contact: Vec<ContactKeys>,
    pub(super) sweep: Option<SweepKeys>,
    #[serde(default)]
    pub(super) sensor_errors: SensorErrorsKeys,
}

/// The sensor of a design, in the ranges of that, and how large its taxels are.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorKeys {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) pitch_mm: [f64; 2],
    pub(super) depth_mm: f64,
    pub(super) taxel_mm: Option<[f64; 2]>,
    #[serde(default)]
    pub(super) tension: Tension,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MediumKeys {
    pub(super) kind: MediumKind,
    #[schemars(range(min = 0.0, max = 0.5))]
    pub(super) poisson: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum MediumKind {
    BondedLayer,
    HalfSpace,
}

/// A contact: its shape, and how its load is spread.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactKeys {
    pub(super) shape: ShapeKind,
    #[schemars(inner(range(min = 0.01, max = 1000.0)))]
    pub(super) semi_axes_mm: Option<[f64; 2]>,
    #[schemars(inner(range(min = 0.01, max = 1000.0)))]
    pub(super) sides_mm: Option<[f64; 2]>,
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub(super) radius_mm: Option<f64>,
    #[schemars(inner(range(min = -100_000.0, max = 100_000.0)))]
    pub(super) centre_mm: [f64; 2],
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0.0))]
    pub(super) normal_force_n: f64,
    #[schemars(range(min = 0.0, max = 10.0))]
    pub(super) friction: f64,
    #[schemars(range(min = -3600.0, max = 3600.0))]
    pub(super) direction_deg: Option<f64>,
    #[serde(default)]
    #[schemars(range(min = -3600.0, max = 3600.0))]
    pub(super) turn_deg: f64,
    #[schemars(range(min = -0.5, max = 4.0))]
    pub(super) edge: Option<f64>,
    #[schemars(inner(range(min = -1.0, max = 1.0)))]
    pub(super) tilt: Option<[f64; 2]>,
    #[serde(default)]
    pub(super) shear: ShearKind,
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(super) held: Option<f64>,
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub(super) spin: Option<f64>,
}

#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ShapeKind {
    Hertz,
    Rectangle,
    Disc,
    Punch,
}

#[derive(Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ShearKind {
    #[default]
    Sliding,
    Held,
    Even,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepKeys {
    pub(super) direction_deg: RangeKeys,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RangeKeys {
    #[schemars(range(min = -3600.0, max = 3600.0))]
    pub(super) from: f64,
    #[schemars(range(min = -3600.0, max = 3600.0))]
    pub(super) to: f64,
    #[schemars(range(max = 3600.0), extend("exclusiveMinimum" = 0.0))]
    pub(super) step: f64,
}

/// Errors as shares: 0.002 is 0.2 %.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct SensorErrorsKeys {
    #[schemars(range(min = 0, max = i64::MAX))]
    pub(super) seed: u64,
    #[schemars(range(min = -0.5, max = 0.5))]
    pub(super) depth: f64,
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(super) gain_spread: f64,
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(super) noise: f64,
    #[schemars(range(min = 2, max = 32))]
    pub(super) quantisation_bits: Option<u32>,
    #[schemars(range(max = 1e9), extend("exclusiveMinimum" = 0.0))]
    pub(super) full_scale_pa: Option<f64>,
    pub(super) dead: Vec<i64>,
    pub(super) saturated: Vec<i64>,
}
