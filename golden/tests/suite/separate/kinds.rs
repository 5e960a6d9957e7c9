//! Frames with several contacts, of every kind, and how they are judged.

use std::ops::Range;

use golden::design::Sensor;
use golden::metrics::{ContactErrors, Quantiles};
use golden::scene::{Contact, Medium, Scene, SceneFrame, SensorErrors, Shape, Shear, Traction};
use golden::solver::{Solution, Solver};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How contacts lie and what they do.
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
    /// One to three of any shape, edge, tilt, shear, friction and direction, on a layer and read by taxels that are not quite as
    /// the design says.
    Wide,
}

/// Least distance of two contacts, edge to edge, in metres.
const GAP: f64 = 4e-3;

/// Between the seeds of two attempts.
const ATTEMPT: u64 = 1_000_000;

/// One frame of a kind, of the first contacts that found room.
pub fn frame(sensor: &Sensor, kind: Kind, seed: u64) -> SceneFrame {
    frame_and_scene(sensor, kind, seed).0
}

/// The same, and the scene that it is of.
pub fn frame_and_scene(sensor: &Sensor, kind: Kind, seed: u64) -> (SceneFrame, Scene) {
    (0..).find_map(|attempt| try_frame(sensor, kind, seed + ATTEMPT * attempt)).unwrap()
}

/// Frames of a kind as a sensor reads them that knows no pull.
pub fn clipped(sensor: &Sensor, kind: Kind, seeds: Range<u64>) -> Vec<SceneFrame> {
    let mut frames: Vec<SceneFrame> = seeds.map(|seed| frame(sensor, kind, seed)).collect();
    for stress in frames.iter_mut().flat_map(|frame| &mut frame.stress) {
        *stress = stress.min(0.0);
    }
    frames
}

fn try_frame(sensor: &Sensor, kind: Kind, seed: u64) -> Option<(SceneFrame, Scene)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let last = sensor.position_m(sensor.taxels() - 1);
    let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
    let count = match kind {
        Kind::One => 1,
        // Another attempt has as many.
        Kind::Wide => 1 + (seed % ATTEMPT) as usize % 3,
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
        Kind::Wide => friction.iter_mut().for_each(|friction| *friction = between(0.1, 1.0)),
        _ => {}
    }
    let mut centres: Vec<[f64; 2]> = Vec::new();
    match kind {
        Kind::Row => {
            // Along the longer side, in the middle of it.
            let along = usize::from(last[1] > last[0]);
            radii = vec![between(0.9, 1.1) * pitch; 3];
            let step = 0.5 * (last[along] - 2.0 * radii[0]);
            for contact in 0..3 {
                let mut centre = last.map(|far| 0.5 * far + between(-0.5, 0.5) * pitch);
                centre[along] = radii[0] + f64::from(contact) * step;
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
    let mut sensor_errors = SensorErrors::default();
    let mut poisson = 0.49;
    let mut wide = Vec::new();
    if kind == Kind::Wide {
        poisson = [0.4655, 0.475, 0.485, 0.49, 0.495][seed as usize % 5];
        let sides = between(0.0, 0.8);
        let taxel_m = Some(sensor.pitch_mm.map(|pitch| sides * pitch * 1e-3));
        let (depth, gain_spread, noise) = (between(-0.05, 0.05), between(0.0, 0.02), between(0.0, 0.003));
        sensor_errors = SensorErrors { seed, taxel_m, depth, gain_spread, noise, ..sensor_errors };
        // The radius is the longer half.
        wide.extend(radii.iter().map(|&radius| any(radius, [(); 9].map(|()| between(0.0, 1.0)))));
    }
    let contacts = (0..count).map(|contact| {
        let round = Shape::Hertz { semi_axes_m: [radii[contact]; 2] };
        let held = kind == Kind::Held && contact == 1;
        let even = Shape::Disc { radius_m: radii[contact] };
        let shape = if held || (seed + contact as u64).is_multiple_of(2) { round } else { even };
        let shear = if held { Shear::Held { share: 0.5 } } else { Traction::default().shear };
        let traction = Traction { shear, ..Traction::default() };
        let (shape, traction) = wide.get(contact).copied().unwrap_or((shape, traction));
        let (normal_force_n, friction, direction_deg) = (normal[contact], friction[contact], directions[contact]);
        Contact { shape, centre_m: centres[contact], normal_force_n, friction, traction, direction_deg }
    });
    let scene = Scene {
        sensor: sensor.clone(),
        medium: Medium::BondedLayer { poisson },
        contacts: contacts.collect(),
        sweep_deg: Vec::new(),
        sensor_errors,
    };
    let frame = scene.frames().ok()?.remove(0);
    Some((frame, scene))
}

/// A contact of any shape and traction, from numbers of 0 to 1: half as wide as long at least, as the calibration's wide family
/// and `sptfra scene --kind mixed-inside` have them.
fn any(radius: f64, [kind, push, ratio, turn, edge, along, across, share, spin]: [f64; 9]) -> (Shape, Traction) {
    let half = [radius, radius / (1.0 + ratio)];
    let mut shape = match kind {
        ..0.5 => Shape::Hertz { semi_axes_m: half },
        0.5..0.75 => Shape::Rectangle { sides_m: half.map(|half| 1.8 * half) },
        _ => Shape::Disc { radius_m: radius },
    };
    let mut traction = Traction { turn_deg: 180.0 * turn, ..Traction::default() };
    if push < 0.25 {
        shape = Shape::Hertz { semi_axes_m: half };
        traction.shear = Shear::Held { share: 0.2 + 0.75 * share };
    } else {
        traction.edge = Some(2.4 * edge - 0.4);
        traction.tilt = [along, across].map(|tilt| tilt - 0.5);
        traction.shear = match push {
            ..0.5 => Shear::Even,
            0.5..0.75 => Shear::Sliding { spin: 0.0 },
            _ => Shear::Sliding { spin: 2.0 * spin - 1.0 },
        };
    }
    (shape, traction)
}

/// What a solver makes of frames: errors in percent of the normal force.
pub struct Judged {
    /// Of the sum of all contacts, along the surface.
    pub total: Quantiles,
    /// Of each contact.
    pub contacts: ContactErrors,
}

pub fn judge(solver: &Solver, frames: &[SceneFrame]) -> Judged {
    let solutions: Vec<Solution> = frames.iter().map(|frame| solver.solve(&frame.stress).unwrap()).collect();
    let error = |(found, frame): (&Solution, &SceneFrame)| {
        let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.force[axis]);
        100.0 * x.hypot(y) / frame.force[2].abs()
    };
    let total = Quantiles::of(solutions.iter().zip(frames).map(error).collect());
    let contacts = ContactErrors::new(frames.iter().map(|frame| &frame.contacts).zip(&solutions));
    Judged { total, contacts }
}
