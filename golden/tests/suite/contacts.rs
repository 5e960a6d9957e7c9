//! Contacts with known forces for every friction and direction, computed once.

use golden::calibrate::random_contacts;
use golden::design::Sensor;
use golden::metrics::{Outcome, errors};
use golden::scene::{Contact, Medium, Scene, SensorErrors, Shape, Traction};
use golden::solver::{Solver, Status};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Normal force of all contacts in newtons.
const FORCE_N: f64 = 6.0;

pub const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };
pub const SOFTER: Medium = Medium::BondedLayer { poisson: 0.45 };
pub const HERTZ: Shape = Shape::Hertz { semi_axes_m: [7e-3; 2] };
pub const DISC: Shape = Shape::Disc { radius_m: 10e-3 };
/// Of contacts; the calibration of the designs has seed 1 and another way to draw.
pub const SEED: u64 = 0x5eed_0ff0;
/// Of contacts that nothing was tried on before the calibration was settled.
pub const OTHER_SEED: u64 = 0x00c0_ffee;
pub const FRICTIONS: [f64; 3] = [0.2, 0.5, 0.8];

/// The sets of contacts.
pub const SETS: [&str; 10] = [
    "Hertz 7 mm",
    "Hertz 7 mm, ν 0.45",
    "disc 10 mm",
    "disc 10 mm, ν 0.45",
    "punch 6 mm",
    "200 inside",
    "200 inside, ν 0.45",
    "1000 more inside",
    "200 anywhere",
    "100 pairs",
];

/// A contact's stress for the normal force, and for a tangential force as large along x and along y, in pascals; and
/// the directions in which it is pushed, in radians.
pub struct Pressed {
    pub loads: [Vec<f64>; 3],
    pub directions: Vec<f64>,
}

/// The largest errors over a set of contacts in percent of the normal force.
pub struct Worst {
    /// Along x, y, z.
    pub error: [f64; 3],
    /// Median of the larger of both tangential errors.
    pub median: f64,
    /// Frames with a status other than good and low confidence, which contacts that reach the border have.
    pub flagged: usize,
}

fn pressed(sensor: &Sensor, medium: Medium, shape: Shape, centre_m: [f64; 2], directions: Vec<f64>) -> Pressed {
    let contact = Contact {
        shape,
        centre_m,
        normal_force_n: FORCE_N,
        friction: 1.0,
        traction: Traction::default(),
        direction_deg: 0.0,
    };
    let scene = Scene {
        sensor: sensor.clone(),
        medium,
        contacts: vec![contact],
        sweep_deg: vec![0.0, 90.0, 180.0],
        sensor_errors: SensorErrors::default(),
    };
    let frames = scene.frames().unwrap();
    let [ahead, aside, behind] = [0, 1, 2].map(|frame: usize| &frames[frame].stress);
    let normal: Vec<f64> = ahead.iter().zip(behind).map(|(ahead, behind)| 0.5 * (ahead + behind)).collect();
    let less = |stress: &[f64]| stress.iter().zip(&normal).map(|(all, normal)| all - normal).collect();
    Pressed { loads: [normal.clone(), less(ahead), less(aside)], directions }
}

/// A contact in the middle of the grid, pushed every 10 degrees.
pub fn centred(sensor: &Sensor, medium: Medium, shape: Shape) -> Vec<Pressed> {
    let last = sensor.position_m(sensor.taxels() - 1);
    let directions = (0..36).map(|step| f64::from(10 * step).to_radians()).collect();
    vec![pressed(sensor, medium, shape, last.map(|far| 0.5 * far), directions)]
}

/// Round contacts, Hertz and disc in turn, that lie within the grid by a third of the depth: radius 1.25 to 2.5 of the
/// coarser pitch, but no more than 0.45 of the shorter side; anywhere, pushed anywhere.
pub fn inside(sensor: &Sensor, medium: Medium, seed: u64, count: usize) -> Vec<Pressed> {
    let pressed = |(index, (radius, centre, direction)): (usize, (f64, [f64; 2], f64))| {
        let shape = match index % 2 {
            0 => Shape::Hertz { semi_axes_m: [radius; 2] },
            _ => Shape::Disc { radius_m: radius },
        };
        pressed(sensor, medium, shape, centre, vec![direction])
    };
    places_inside(sensor, seed, count).into_iter().enumerate().map(pressed).collect()
}

/// Radius and centre in metres and direction in radians of the contacts of [`inside`].
pub fn places_inside(sensor: &Sensor, seed: u64, count: usize) -> Vec<(f64, [f64; 2], f64)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let last = sensor.position_m(sensor.taxels() - 1);
    let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
    (0..count)
        .map(|_| {
            let radius = between(1.25 * pitch, (2.5 * pitch).min(0.45 * last[0].min(last[1])));
            let margin = radius + sensor.depth_m() / 3.0;
            let centre = last.map(|far| between(margin.min(0.5 * far), (far - margin).max(0.5 * far)));
            (radius, centre, between(-std::f64::consts::PI, std::f64::consts::PI))
        })
        .collect()
}

/// The contacts of a set.
pub fn set(taxels: &Sensor, contacts: &str) -> Vec<Pressed> {
    match contacts {
        "Hertz 7 mm" => centred(taxels, LAYER, HERTZ),
        "Hertz 7 mm, ν 0.45" => centred(taxels, SOFTER, HERTZ),
        "disc 10 mm" => centred(taxels, LAYER, DISC),
        "disc 10 mm, ν 0.45" => centred(taxels, SOFTER, DISC),
        "punch 6 mm" => centred(taxels, LAYER, Shape::Punch { radius_m: 6e-3 }),
        "200 inside" => inside(taxels, LAYER, SEED, 200),
        "200 inside, ν 0.45" => inside(taxels, SOFTER, SEED, 200),
        "1000 more inside" => inside(taxels, LAYER, OTHER_SEED, 1000),
        "200 anywhere" => anywhere(taxels, LAYER, 200),
        "100 pairs" => pairs(taxels, LAYER, SEED, 100),
        other => panic!("no contacts are called {other}"),
    }
}

/// Contacts of the kinds, sizes and places that the calibration is made of, but not the same ones.
pub fn anywhere(sensor: &Sensor, medium: Medium, count: usize) -> Vec<Pressed> {
    random_contacts(sensor, 0xdead_beef, count)
        .into_iter()
        .map(|contact| {
            let direction = contact.direction_deg.to_radians();
            pressed(sensor, medium, contact.shape, contact.centre_m, vec![direction])
        })
        .collect()
}

/// Pairs of round contacts of equal force anywhere inside, pushed the same way, neither knowing of the other.
pub fn pairs(sensor: &Sensor, medium: Medium, seed: u64, count: usize) -> Vec<Pressed> {
    let half = |one: f64, other: f64| 0.5 * (one + other);
    inside(sensor, medium, seed, 2 * count)
        .chunks_exact(2)
        .map(|pair| Pressed {
            loads: [0, 1, 2].map(|load: usize| {
                let [one, other] = [&pair[0].loads[load], &pair[1].loads[load]];
                one.iter().zip(other).map(|(&one, &other)| half(one, other)).collect()
            }),
            directions: pair[0].directions.clone(),
        })
        .collect()
}

/// A frame in pascals and the forces that are in it.
pub struct Truth {
    pub frame: Vec<f64>,
    pub outcome: Outcome,
}

/// The frames of every contact in each of its directions, with noise as a share of the largest stress.
pub fn frames(set: &[Pressed], friction: f64, noise: f64) -> Vec<Truth> {
    let mut random = ChaCha8Rng::seed_from_u64(0x0015_e000);
    let mut frames = Vec::new();
    for Pressed { loads: [normal, along_x, along_y], directions } in set {
        for direction in directions {
            let (sin, cos) = direction.sin_cos();
            let [x, y] = [friction * cos, friction * sin];
            let mut frame: Vec<f64> = (0..normal.len()).map(|i| normal[i] + x * along_x[i] + y * along_y[i]).collect();
            let deviation = noise * frame.iter().fold(0.0_f64, |peak, stress| peak.max(stress.abs()));
            for stress in &mut frame {
                // Twelve uniform numbers make a normal one, near enough.
                let sum: f64 = (0..12).map(|_| random.random::<f64>()).sum();
                *stress += deviation * (sum - 6.0);
            }
            let outcome = Outcome { force: [FORCE_N * x, FORCE_N * y, -FORCE_N], friction, direction: *direction };
            frames.push(Truth { frame, outcome });
        }
    }
    frames
}

/// Solves every contact in each of its directions, with noise as a share of the largest stress.
pub fn worst(solver: &Solver, set: &[Pressed], friction: f64, noise: f64) -> Worst {
    let frames = frames(set, friction, noise);
    let solutions = frames.iter().map(|truth| solver.solve(&truth.frame).unwrap());
    judged(&frames, solutions.map(|solution| (solution.status.0, Outcome::from(&solution))))
}

/// Judges answers to frames by the truth: a status and what was found.
pub fn judged(frames: &[Truth], answers: impl Iterator<Item = (u32, Outcome)>) -> Worst {
    let (mut error, mut larger, mut flagged) = ([0.0_f64; 3], Vec::new(), 0);
    for (truth, (status, found)) in frames.iter().zip(answers) {
        flagged += usize::from(status & !Status::LOW_CONFIDENCE.0 != 0);
        let [x, y, z, ..] = errors(&truth.outcome, &found);
        larger.push(x.max(y));
        for (worst, found) in error.iter_mut().zip([x, y, z]) {
            *worst = worst.max(found);
        }
    }
    larger.sort_by(f64::total_cmp);
    Worst { error, median: larger[larger.len() / 2], flagged }
}

/// Lengths of the errors of the tangential force and errors of the normal one, in percent of the normal force, each in
/// rising order; and the frames with a status other than good.
pub fn errors_of(solver: &Solver, frames: &[Truth]) -> ([Vec<f64>; 2], usize) {
    let mut flagged = 0;
    let mut errors = [Vec::new(), Vec::new()];
    for Truth { frame, outcome: Outcome { force, .. } } in frames {
        let found = solver.solve(frame).unwrap();
        flagged += usize::from(found.status.0 != 0);
        let [x, y, z] = [0, 1, 2].map(|axis| 100.0 * (found.resultant[axis] - force[axis]) / force[2].abs());
        errors[0].push(x.hypot(y));
        errors[1].push(z.abs());
    }
    for errors in &mut errors {
        errors.sort_by(f64::total_cmp);
    }
    (errors, flagged)
}
