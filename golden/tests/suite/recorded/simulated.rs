//! Recordings of a sensor whose curve and gains are known: a ball, a flat disc or a block with weights on it, at random
//! places, with noise, creep and a load that never comes out twice the same. [`study`] calibrates by them.

use golden::calibrate::recorded::{Measured, Recorded, fit_forces};
use golden::design::{Design, Sensor};
use golden::scene::{Contact, Medium, Scene, SceneFrame, SensorErrors, Shape, Traction};
use golden::solver::{Solver, Status};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What is pressed onto the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indenter {
    /// Its contact grows with the load, as Hertz says.
    Ball,
    Disc,
    Block,
}

/// How a recording is made.
#[derive(Clone, Debug)]
pub struct Recipe {
    pub seed: u64,
    pub indenter: Indenter,
    pub places: usize,
    pub loads: Vec<f64>,
    /// Frames of a hold.
    pub frames: usize,
    /// Pascals are `scale * count^power`.
    pub power: f64,
    pub scale: f64,
    /// Standard deviation of the gains, of which half is smooth over the sensor.
    pub spread: f64,
    /// Counts.
    pub noise: f64,
    pub rest: f64,
    /// Rise of the readings over a hold, as a share.
    pub creep: f64,
    /// Standard deviation of what a placement reads, as a share.
    pub repeat: f64,
    /// Friction of each contact, in a random direction.
    pub friction: f64,
}

impl Recipe {
    pub fn new(seed: u64, indenter: Indenter) -> Self {
        Self {
            seed,
            indenter,
            places: 40,
            loads: vec![2.0, 3.5, 5.0, 7.0],
            frames: 6,
            power: 1.0,
            scale: 20.0,
            spread: 0.0,
            noise: 0.0,
            rest: 0.0,
            creep: 0.0,
            repeat: 0.0,
            friction: 0.0,
        }
    }
}

/// A recording and the truth about it.
pub struct Recording {
    pub frames: Vec<Vec<f64>>,
    pub measured: Measured,
    pub gains: Vec<f64>,
}

pub fn sensor() -> Sensor {
    Sensor { columns: 6, rows: 13, pitch_mm: [3.4, 3.4], depth_mm: 3.0 }
}

/// A design for the sensor, with more keys of its `[sensor]` and `[algorithm]`.
pub fn design(keys: &str, algorithm: &str) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n{keys}\n\
         [algorithm]\n{algorithm}\n"
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

/// Of mean 0 and deviation 1.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
}

/// Gains around 1, half of their variance in two slow waves.
pub fn gains(random: &mut ChaCha8Rng, spread: f64) -> Vec<f64> {
    let sensor = sensor();
    let [a, b] = [0, 1].map(|_| std::f64::consts::TAU * random.random::<f64>());
    (0..sensor.taxels())
        .map(|taxel| {
            let [x, y] = [(taxel % 6) as f64, (taxel / 6) as f64];
            let smooth = (0.5 * x + a).sin() + (0.4 * y + b).sin();
            1.0 + spread * 0.5_f64.sqrt() * (smooth + normal(random))
        })
        .map(|gain| gain.max(0.3))
        .collect()
}

pub fn record(recipe: &Recipe) -> Recording {
    record_at(recipe, recipe.seed)
}

/// In pascals, as a sensor without errors reads them.
pub fn record_pascals(recipe: &Recipe) -> Recording {
    let mut recording = Recording { frames: Vec::new(), measured: Measured::default(), gains: Vec::new() };
    for frame in contacts(recipe, recipe.seed) {
        recording.frames.extend([frame.stress, vec![0.0; sensor().taxels()]]);
        recording.measured.forces.extend([frame.force.map(Some), [Some(0.0); 3]]);
        recording.measured.pressures.extend([None; 2]);
    }
    recording
}

/// The same sensor, its contacts from another seed.
pub fn record_at(recipe: &Recipe, seed: u64) -> Recording {
    let sensor = sensor();
    let mut random = ChaCha8Rng::seed_from_u64(recipe.seed);
    let gains = gains(&mut random, recipe.spread);
    let mut recording = Recording { frames: Vec::new(), measured: Measured::default(), gains };
    let rest: Vec<f64> = gains_rest(&mut random, recipe, sensor.taxels());
    let mut push = |stress: &[f64], rise: f64, force: [f64; 3], random: &mut ChaCha8Rng| {
        let count = |(taxel, stress): (usize, &f64)| {
            let pressing = (-stress * rise).max(0.0) / recording.gains[taxel];
            let count = (pressing / recipe.scale).powf(1.0 / recipe.power);
            (count + rest[taxel] + recipe.noise * normal(random)).round().clamp(0.0, 4095.0)
        };
        let frame = stress.iter().enumerate().map(count).collect();
        recording.frames.push(frame);
        recording.measured.forces.push(force.map(Some));
        recording.measured.pressures.push(None);
    };
    let nothing = vec![0.0; sensor.taxels()];
    for frame in contacts(recipe, seed) {
        let placed = 1.0 + recipe.repeat * normal(&mut random);
        for index in 0..recipe.frames {
            // Fast at first, as creep is.
            let age = ((index + 1) as f64 / recipe.frames as f64).sqrt();
            push(&frame.stress, placed * (1.0 + recipe.creep * (age - 0.7)), frame.force, &mut random);
        }
        for _ in 0..2 {
            push(&nothing, 1.0, [0.0; 3], &mut random);
        }
    }
    recording
}

/// Every load at every place, without what the sensor makes of it.
fn contacts(recipe: &Recipe, seed: u64) -> Vec<SceneFrame> {
    let sensor = sensor();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(1);
    let mut frames = Vec::new();
    for _ in 0..recipe.places {
        // Within the sensor, the ball's contact whole on it.
        let mut along = |side: usize| {
            let length = (side - 1) as f64 * 3.4e-3;
            4e-3 + (length - 8e-3) * random.random::<f64>()
        };
        let centre_m = [along(6), along(13)];
        let direction_deg = 360.0 * random.random::<f64>();
        for &load in &recipe.loads {
            let shape = match recipe.indenter {
                Indenter::Ball => Shape::Hertz { semi_axes_m: [4.2e-3 * (load / 4.0).cbrt(); 2] },
                Indenter::Disc => Shape::Disc { radius_m: 4.5e-3 },
                Indenter::Block => Shape::Rectangle { sides_m: [7e-3, 9e-3] },
            };
            let contact = Contact {
                shape,
                centre_m,
                normal_force_n: load,
                friction: recipe.friction,
                traction: Traction::default(),
                direction_deg,
            };
            let scene = Scene {
                sensor: sensor.clone(),
                medium: Medium::BondedLayer { poisson: 0.49 },
                contacts: vec![contact],
                sweep_deg: Vec::new(),
                sensor_errors: SensorErrors::default(),
            };
            frames.push(scene.frames().unwrap().remove(0));
        }
    }
    frames
}

/// The taxels' readings without load.
fn gains_rest(random: &mut ChaCha8Rng, recipe: &Recipe, taxels: usize) -> Vec<f64> {
    (0..taxels).map(|_| (recipe.rest * (1.0 + 0.1 * normal(random))).round()).collect()
}

/// `F_z` alone is known.
pub fn weights_only(measured: &mut Measured) {
    for force in &mut measured.forces {
        (force[0], force[1]) = (None, None);
    }
}

/// Keys of a sensor of counts.
pub const COUNTS: &str = "pa_per_count = -10.0\ntension = \"clipped\"";

/// Median, 95 % and worst error of `F_z` in percent over the middle frame of a recording's holds, but for those that the
/// solver says are saturated, and the share of these.
fn errors(design: &Design, recording: &Recording, frames: usize) -> [f64; 4] {
    let solver = Solver::new(design).unwrap();
    // So many frames of load and two without.
    let middle: Vec<usize> = (0..recording.frames.len()).filter(|frame| frame % (frames + 2) == frames / 2).collect();
    let mut errors = Vec::new();
    for &frame in &middle {
        let found = solver.solve(&recording.frames[frame]).unwrap();
        if !found.status.contains(Status::SATURATED) {
            let error = found.resultant[2] / recording.measured.forces[frame][2].unwrap() - 1.0;
            errors.push(100.0 * error.abs());
        }
    }
    errors.sort_by(f64::total_cmp);
    let saturated = 100.0 * (1.0 - errors.len() as f64 / middle.len() as f64);
    [errors[errors.len() / 2], errors[errors.len() * 95 / 100], errors[errors.len() - 1], saturated]
}

/// Standard deviation of the curve found over the true one, in percent, from a tenth of the range on.
fn bends(found: &Recorded, recipe: &Recipe) -> f64 {
    deviation(found.points[6..].iter().map(|[count, pascals]| pascals / count.powf(recipe.power)))
}

/// Standard deviation of ratios, in percent of their mean.
pub fn deviation(ratios: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = ratios.clone().count() as f64;
    let mean = ratios.clone().sum::<f64>() / count;
    100.0 * (ratios.map(|ratio| (ratio / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt()
}

/// A recording of a kind: what is found, its curve's bend, the deviation of the gains, and median, 95 % and worst error on
/// other contacts, of discs unless those were recorded.
pub fn study(recipe: &Recipe) -> (Recorded, [f64; 7]) {
    let mut recording = record(recipe);
    weights_only(&mut recording.measured);
    // Some loads nobody wrote down.
    for force in recording.measured.forces.iter_mut().skip(7).step_by(11) {
        force[2] = None;
    }
    let found = fit_forces(&design(COUNTS, ""), &recording.frames, &recording.measured).unwrap();
    // The same sensor, so the same gains, under other contacts.
    let indenter = if recipe.indenter == Indenter::Disc { Indenter::Ball } else { Indenter::Disc };
    let others = Recipe { indenter, places: 16, loads: vec![2.5, 4.5, 6.0], creep: 0.0, repeat: 0.0, ..recipe.clone() };
    let others = record_at(&others, recipe.seed + 1000);
    let [median, most, worst, saturated] = errors(&found.design, &others, recipe.frames);
    let own = found
        .gains
        .iter()
        .zip(&recording.gains)
        .filter(|(gain, _)| gain.touched)
        .map(|(gain, truth)| gain.gain / truth);
    let before =
        recording.gains.iter().zip(&found.gains).filter(|(_, gain)| gain.touched).map(|(truth, _)| 1.0 / truth);
    let figures = [bends(&found, recipe), deviation(before), deviation(own), median, most, worst, saturated];
    (found, figures)
}
