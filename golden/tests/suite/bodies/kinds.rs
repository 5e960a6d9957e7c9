//! Frames with several bodies, of every kind.

use golden::design::Sensor;
use golden::scene::{Contact, Medium, Scene, SceneFrame, SensorErrors, Shape, Shear, Traction};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How bodies lie and what they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Two, pushed the same way.
    Same,
    /// Two, pushed against each other's direction.
    Opposed,
    /// Two, of any friction and direction.
    Anyhow,
    /// Two, one four times as heavy and twice as wide as the other.
    Small,
    /// Two, one that slides and one that is held with half of its largest force.
    Held,
    /// Three of any friction and direction, anywhere.
    Three,
    /// Three side by side.
    Row,
    /// Two of any kind, this many micrometres apart, edge to edge.
    Apart(u32),
    /// As [`Kind::Anyhow`], one this many times as heavy as the other.
    Heavier(u32),
    /// One alone.
    One,
}

/// Least distance of two bodies, edge to edge, in metres.
const GAP: f64 = 4e-3;

/// One frame of a kind; nothing if the bodies found no room.
pub fn frame(sensor: &Sensor, kind: Kind, seed: u64) -> SceneFrame {
    (0..).find_map(|attempt| try_frame(sensor, kind, seed + 1_000_000 * attempt)).unwrap()
}

fn try_frame(sensor: &Sensor, kind: Kind, seed: u64) -> Option<SceneFrame> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let last = sensor.position_m(sensor.taxels() - 1);
    let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
    let count = match kind {
        Kind::One => 1,
        Kind::Three | Kind::Row => 3,
        _ => 2,
    };
    let gap = match kind {
        Kind::Apart(micrometres) => 1e-6 * f64::from(micrometres),
        _ => GAP,
    };
    let mut radii: Vec<f64> = (0..count).map(|_| between(1.0, 1.6) * pitch).collect();
    let mut normal: Vec<f64> = (0..count).map(|_| between(1.5, 3.0)).collect();
    let mut friction: Vec<f64> = (0..count).map(|_| between(0.2, 0.8)).collect();
    let mut directions: Vec<f64> = (0..count).map(|_| between(-180.0, 180.0)).collect();
    match kind {
        Kind::Same => (friction, directions) = (vec![0.5; 2], vec![directions[0]; 2]),
        Kind::Opposed => (friction, directions) = (vec![0.5; 2], vec![directions[0], directions[0] + 180.0]),
        Kind::Small => (radii, normal) = (vec![1.8 * pitch, 0.9 * pitch], vec![4.0, 1.0]),
        Kind::Heavier(times) => normal = vec![f64::from(times), 1.0],
        Kind::Held => friction = vec![0.5; 2],
        _ => {}
    }
    let mut centres: Vec<[f64; 2]> = Vec::new();
    match kind {
        Kind::Row => {
            // Along the longer side, in the middle of it.
            let along = usize::from(last[1] > last[0]);
            radii = vec![between(0.9, 1.1) * pitch; 3];
            let step = 0.5 * (last[along] - 2.0 * radii[0]);
            for body in 0..3 {
                let mut centre = last.map(|far| 0.5 * far + between(-0.5, 0.5) * pitch);
                centre[along] = radii[0] + f64::from(body) * step;
                centres.push(centre);
            }
        }
        Kind::Apart(_) => {
            let first = [0, 1].map(|axis| between(radii[0], last[axis] - radii[0]));
            let (sin, cos) = between(0.0, 6.3).sin_cos();
            let distance = radii[0] + radii[1] + gap;
            centres = vec![first, [first[0] + distance * cos, first[1] + distance * sin]];
        }
        _ => centres.extend(radii.iter().map(|radius| [0, 1].map(|axis| between(*radius, last[axis] - radius)))),
    }
    let inside = |(centre, radius): (&[f64; 2], &f64)| {
        (0..2).all(|axis| (0.9 * radius..=last[axis] - 0.9 * radius).contains(&centre[axis]))
    };
    let apart = |a: usize, b: usize| {
        let [x, y] = [0, 1].map(|axis| centres[a][axis] - centres[b][axis]);
        x.hypot(y) - radii[a] - radii[b] > gap - 1e-9
    };
    if !centres.iter().zip(&radii).all(inside) || (0..count).any(|a| (0..a).any(|b| !apart(a, b))) {
        return None;
    }
    let contacts = (0..count).map(|body| {
        let round = Shape::Hertz { semi_axes_m: [radii[body]; 2] };
        let held = kind == Kind::Held && body == 1;
        let even = Shape::Disc { radius_m: radii[body] };
        let shape = if held || (seed + body as u64).is_multiple_of(2) { round } else { even };
        let shear = if held { Shear::Held { share: 0.5 } } else { Traction::default().shear };
        let traction = Traction { shear, ..Traction::default() };
        let (normal_force_n, friction, direction_deg) = (normal[body], friction[body], directions[body]);
        Contact { shape, centre_m: centres[body], normal_force_n, friction, traction, direction_deg }
    });
    let scene = Scene {
        sensor: sensor.clone(),
        medium: Medium::BondedLayer { poisson: 0.49 },
        contacts: contacts.collect(),
        sweep_deg: Vec::new(),
        sensor_errors: SensorErrors::default(),
    };
    scene.frames().ok().map(|mut frames| frames.remove(0))
}
