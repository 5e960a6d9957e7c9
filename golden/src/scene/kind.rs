//! Kinds of contacts, one differing from the first in one thing: what an estimator is judged by beyond the contacts that
//! it was made for.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Contact, Medium, Scene, SceneError, SceneFrame, SensorErrors, Shape, Shear, Traction};
use crate::sensor::Sensor;
use crate::words::print_as_words;

/// Normal force of a contact of any kind, in newtons.
const FORCE_N: f64 = 3.0;
/// Poisson's ratio of the layer where the kind has none of its own.
const POISSON: f64 = 0.49;

/// A kind of contact. One contact, of 1.25 to 2.5 pitches in radius, anywhere within the grid and pushed in any direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Round, Hertz's pressure or an even one, sliding.
    Sliding,
    /// The pressure is tilted along the push.
    TiltedAlong,
    /// The pressure is tilted across the push.
    TiltedAcross,
    /// Held by half of the largest force (Mindlin's partial slip).
    Held,
    /// Even shear under Hertz's pressure.
    EvenShear,
    /// Ellipses and rectangles, turned.
    Turned,
    /// A soft edge.
    SoftEdge,
    /// A hard edge.
    HardEdge,
    /// The contact turns while it slides.
    Spinning,
    /// Centred on the grid's edge.
    Border,
    /// Taxels that average over 0.8 of their pitch.
    LargeTaxels,
    /// The layer is deeper than the design says.
    Deeper,
    /// The layer is less deep than the design says.
    Shallower,
    /// The layer gives more than an incompressible one.
    LowerPoisson,
    /// Gains of the taxels spread.
    GainSpread,
    /// Noise.
    Noisy,
    /// Any of the above together, but within the grid, and of any friction.
    MixedInside,
    /// The same anywhere over the grid.
    Mixed,
}

/// All kinds in the order of their declaration, and what each is called for people, in a line.
const TITLES: [(Kind, &str); 18] = [
    (Kind::Sliding, "round, sliding"),
    (Kind::TiltedAlong, "pressure tilted along the push, 0.6"),
    (Kind::TiltedAcross, "pressure tilted across the push, 0.5"),
    (Kind::Held, "held, half of the largest force (Mindlin)"),
    (Kind::EvenShear, "even shear under Hertz's pressure"),
    (Kind::Turned, "ellipses and rectangles, 2 : 1, turned"),
    (Kind::SoftEdge, "soft edge, (1 - ρ²)²"),
    (Kind::HardEdge, "hard edge, (1 - ρ²)^-0.4"),
    (Kind::Spinning, "turns while it slides, at its edge as fast"),
    (Kind::Border, "half beyond the grid's edge"),
    (Kind::LargeTaxels, "taxels of 0.8 pitches"),
    (Kind::Deeper, "layer 5 % deeper"),
    (Kind::Shallower, "layer 5 % less deep"),
    (Kind::LowerPoisson, "ν 5 % less, 0.4655"),
    (Kind::GainSpread, "gains spread by 2 %"),
    (Kind::Noisy, "noise 1 %"),
    (Kind::MixedInside, "all of it, at random, µ 0.1 to 1, within the grid"),
    (Kind::Mixed, "all of it, at random, µ 0.1 to 1, anywhere"),
];

impl Kind {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        TITLES.into_iter().map(|(kind, _)| kind)
    }

    /// For people, in a line.
    pub fn title(self) -> &'static str {
        TITLES[self as usize].1
    }

    /// Frames of this kind, one for each seed, with what pulls in them.
    ///
    /// # Errors
    ///
    /// [`SceneError::TooFine`] on a sensor whose grid is very wide for its depth.
    pub fn frames(
        self,
        sensor: &Sensor,
        friction: f64,
        seeds: impl IntoParallelIterator<Item = u64>,
    ) -> Result<Vec<SceneFrame>, SceneError> {
        seeds.into_par_iter().map(|seed| self.frame(sensor, friction, seed)).collect()
    }

    /// The frame of a seed.
    ///
    /// # Errors
    ///
    /// As [`Kind::frames`].
    pub fn frame(self, sensor: &Sensor, friction: f64, seed: u64) -> Result<SceneFrame, SceneError> {
        Ok(self.scene(sensor, friction, seed).frames()?.remove(0))
    }

    /// The scene of a seed: one contact, and what is wrong with the sensor.
    pub fn scene(self, sensor: &Sensor, friction: f64, seed: u64) -> Scene {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let last = sensor.extent_m();
        let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
        let radius = between(1.25 * pitch, (2.5 * pitch).min(0.45 * last[0].min(last[1])));
        let margin = radius + sensor.depth_m() / 3.0;
        let mut centre_m = last.map(|far| between(margin.min(0.5 * far), (far - margin).max(0.5 * far)));
        let round = Shape::Hertz { semi_axes_m: [radius; 2] };
        let mut shape = if seed.is_multiple_of(2) { round } else { Shape::Disc { radius_m: radius } };
        let mut traction = Traction::default();
        let mut friction = friction;
        let mut poisson = POISSON;
        let mut errors = SensorErrors { seed, ..SensorErrors::default() };
        let taxel = |share: f64| sensor.pitch_mm.map(|pitch| share * pitch * 1e-3);
        let long = |ratio: f64| [radius * ratio.sqrt(), radius / ratio.sqrt()];
        match self {
            Self::Sliding => {}
            Self::TiltedAlong => traction.tilt = [0.6, 0.0],
            Self::TiltedAcross => traction.tilt = [0.0, 0.5],
            Self::Held => (shape, traction.shear) = (round, Shear::Held { share: 0.5 }),
            Self::EvenShear => (shape, traction.shear) = (round, Shear::Even),
            Self::Turned => {
                traction.turn_deg = between(0.0, 180.0);
                shape = match seed % 2 {
                    0 => Shape::Hertz { semi_axes_m: long(2.0) },
                    _ => Shape::Rectangle { sides_m: long(2.0).map(|half| 1.8 * half) },
                };
            }
            Self::SoftEdge => traction.edge = Some(2.0),
            Self::HardEdge => traction.edge = Some(-0.4),
            Self::Spinning => traction.shear = Shear::Sliding { spin: 1.0 },
            Self::Border => {
                let side = seed as usize % 2;
                centre_m[side] = if seed % 4 < 2 { 0.0 } else { last[side] };
            }
            Self::LargeTaxels => errors.taxel_m = Some(taxel(0.8)),
            Self::Deeper => errors.depth = 0.05,
            Self::Shallower => errors.depth = -0.05,
            Self::LowerPoisson => poisson = 0.95 * POISSON,
            Self::GainSpread => errors.gain_spread = 0.02,
            Self::Noisy => errors.noise = 0.01,
            Self::MixedInside | Self::Mixed => {
                friction = between(0.1, 1.0);
                poisson = [0.4655, 0.475, 0.485, 0.49, 0.495][seed as usize % 5];
                errors.depth = between(-0.05, 0.05);
                errors.gain_spread = between(0.0, 0.02);
                errors.noise = between(0.0, 0.003);
                errors.taxel_m = Some(taxel(between(0.0, 0.8)));
                traction.turn_deg = between(0.0, 180.0);
                let anywhere = last.map(|far| between(0.0, far));
                if self == Self::Mixed {
                    centre_m = anywhere;
                }
                let sides = long(between(1.0, 2.0));
                shape = match seed % 4 {
                    0 | 1 => Shape::Hertz { semi_axes_m: sides },
                    2 => Shape::Rectangle { sides_m: sides.map(|half| 1.8 * half) },
                    _ => Shape::Disc { radius_m: radius },
                };
                if seed.is_multiple_of(4) {
                    traction.shear = Shear::Held { share: between(0.2, 0.95) };
                } else {
                    traction.edge = Some(between(-0.4, 2.0));
                    traction.tilt = [between(-0.5, 0.5), between(-0.5, 0.5)];
                    traction.shear = match seed % 3 {
                        0 => Shear::Even,
                        1 => Shear::Sliding { spin: 0.0 },
                        _ => Shear::Sliding { spin: between(-1.0, 1.0) },
                    };
                }
            }
        }
        let direction_deg = between(-180.0, 180.0);
        let contact = Contact { shape, centre_m, normal_force_n: FORCE_N, friction, traction, direction_deg };
        Scene {
            sensor: sensor.clone(),
            medium: Medium::BondedLayer { poisson },
            contacts: vec![contact],
            sweep_deg: Vec::new(),
            sensor_errors: errors,
        }
    }
}

print_as_words!(Kind);
