//! Contacts at random, of the kinds and sizes that a sensor can tell apart.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::design::Sensor;
use crate::scene::{Contact, Shape, Traction};

/// Radii go from this many pitches (the coarser of both), below which a contact falls between the taxels,
const SMALLEST: f64 = 1.1;
/// to this many pitches,
const LARGEST: f64 = 2.75;
/// or to this share of the grid's shorter side.
const LARGEST_SHARE: f64 = 0.6;

/// The range of radii, in metres.
pub(super) fn radii(sensor: &Sensor) -> [f64; 2] {
    let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
    let smallest = SMALLEST * pitch;
    let short = sensor.extent_m().into_iter().fold(f64::INFINITY, f64::min);
    [smallest, (LARGEST * pitch).min(LARGEST_SHARE * short).max(smallest)]
}

/// Half the window of the correction in taxels: it holds the largest contact and its margin of a depth.
pub(super) fn half_window(sensor: &Sensor) -> [usize; 2] {
    let [_, largest] = radii(sensor);
    let reach = largest + sensor.depth_m();
    let sides = [sensor.columns, sensor.rows];
    [0, 1].map(|axis| {
        let pitches = reach / (1e-3 * sensor.pitch_mm[axis]);
        (pitches.ceil() as usize).clamp(1, sides[axis] - 1)
    })
}

/// `count` contacts of 1 N, the friction drawn from 0 to 1 and the direction from all around; the same for the same
/// seed.
///
/// Three in eight each are round Hertz contacts and uniform discs, the others elliptical Hertz contacts and
/// rectangles, axes within a factor of 1.4 of each other. Each lies within the grid, or as near to its middle as
/// its size allows.
pub fn random_contacts(sensor: &Sensor, seed: u64, count: usize) -> Vec<Contact> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let [smallest, largest] = radii(sensor);
    let sides = sensor.extent_m();
    (0..count)
        .map(|index| {
            let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
            let radius = between(smallest, largest);
            let ratio = 1.4_f64.powf(between(-0.5, 0.5));
            let shape = match index % 8 {
                0 | 2 | 4 => Shape::Hertz { semi_axes_m: [radius; 2] },
                1 | 3 | 5 => Shape::Disc { radius_m: radius },
                6 => Shape::Hertz { semi_axes_m: [radius * ratio, radius / ratio] },
                _ => Shape::Rectangle { sides_m: [1.8 * radius * ratio, 1.8 * radius / ratio] },
            };
            let centre_m = [0, 1].map(|axis| {
                let (side, pitch) = (sides[axis], 1e-3 * sensor.pitch_mm[axis]);
                if side > 2.0 * radius {
                    between(radius, side - radius)
                } else {
                    0.5 * side + between(-0.5, 0.5) * pitch
                }
            });
            let friction = between(0.0, 1.0);
            Contact {
                shape,
                centre_m,
                normal_force_n: 1.0,
                friction,
                traction: Traction::default(),
                direction_deg: between(-180.0, 180.0),
            }
        })
        .collect()
}
