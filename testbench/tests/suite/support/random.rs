//! Random designs, the same in every run. `SPTFRA_TEST_SEED` sets another seed than the usual one.

use std::env;

use golden::creep::Creep;
use golden::design::{
    Calibration, CalibrationIn, Correction, Curve, Design, JointConstants, Kernel, MeasuredNoise, Optimise, Outputs,
    Overrun, Regularisation, Samples, Scaling, Sensor, Slip, StandardError, Tension,
};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

const DEFAULT_SEED: u64 = 20_240_001;
/// Draws that have no plan (too narrow for the geometry, or singular) before the test gives up on the generator.
const MOST_REFUSED: u32 = 20;

/// The seed of all random designs and frames.
pub fn seed() -> u64 {
    match env::var("SPTFRA_TEST_SEED") {
        Ok(text) => text.parse().expect("SPTFRA_TEST_SEED is a whole number"),
        Err(_) => DEFAULT_SEED,
    }
}

/// What only one of the plans has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Paper,
    Field {
        latency: bool,
    },
    Resultants,
    /// The grid search, with or without a correction.
    Joint {
        field: bool,
        correction: bool,
    },
}

impl Kind {
    /// The keys of `[algorithm]`, then those of `[hardware]`.
    fn keys(self) -> [&'static str; 2] {
        match self {
            Self::Paper => ["plan = \"paper\"", ""],
            Self::Field { latency: true } => ["plan = \"reduced\"", "optimise = \"latency\""],
            Self::Field { latency: false } => ["plan = \"reduced\"", "optimise = \"throughput\""],
            Self::Resultants => ["plan = \"reduced\"\noutputs = \"resultants\"", ""],
            Self::Joint { field: true, .. } => {
                ["plan = \"reduced\"\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]", ""]
            }
            Self::Joint { field: false, .. } => [
                "plan = \"reduced\"\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\noutputs = \"resultants\"",
                "",
            ],
        }
    }
}

/// What makes designs differ.
#[derive(Clone)]
pub struct Shape {
    pub kind: Kind,
    pub columns: usize,
    pub rows: usize,
    pub pitch_mm: [f64; 2],
    pub depth_mm: f64,
    pub filter: String,
    pub lanes: usize,
    pub coefficient_bits: u32,
    pub data_bits: u32,
    pub full_scale_pa: f64,
}

impl Shape {
    fn random(random: &mut ChaCha8Rng) -> Self {
        let mut side =
            || if random.random_bool(0.8) { random.random_range(2..=8) } else { random.random_range(9..=12) };
        let (columns, mut rows) = (side(), side());
        let mut pitch_mm = [0, 1].map(|_| (random.random_range(1.0..6.0_f64) * 100.0).round() / 100.0);
        let kind = match random.random_range(0..10) {
            0..3 => Kind::Paper,
            3 | 4 => Kind::Field { latency: false },
            5 => Kind::Field { latency: true },
            6 => Kind::Resultants,
            joint => Kind::Joint { field: joint != 8, correction: joint != 7 },
        };
        // Where everything is square, a matrix serves both directions.
        if kind != Kind::Paper && random.random_bool(0.4) {
            (rows, pitch_mm[1]) = (columns, pitch_mm[0]);
        }
        let taxels = columns * rows;
        let spacing = (pitch_mm[0] * pitch_mm[1]).sqrt();
        let filter = match random.random_range(0..3) {
            0 => "{ kind = \"none\" }".to_owned(),
            1 => format!("{{ kind = \"f1\", l = {} }}", random.random_range(1..=taxels - 2)),
            _ => format!("{{ kind = \"f2\", p = {:.4} }}", 10_f64.powf(random.random_range(-2.0..2.0))),
        };
        // Compiling takes longer the more lanes there are.
        let lanes = if random.random_bool(0.7) { random.random_range(1..=16) } else { random.random_range(17..=64) };
        let (mut coefficient_bits, mut data_bits) = (random.random_range(8..=18), random.random_range(16..=27));
        // Sometimes words of two multipliers a lane.
        if kind != Kind::Paper && random.random_bool(0.2) {
            (coefficient_bits, data_bits) = (random.random_range(8..=27), random.random_range(29..=35));
        }
        Self {
            kind,
            columns,
            rows,
            pitch_mm,
            depth_mm: (spacing * random.random_range(0.3..1.5) * 1000.0).round() / 1000.0,
            filter,
            lanes: if kind == Kind::Paper { lanes } else { 4 * usize::div_ceil(lanes, 4) },
            coefficient_bits,
            data_bits,
            full_scale_pa: 10_f64.powi(random.random_range(3..=6)) * random.random_range(1.0..9.0_f64).round(),
        }
    }

    pub fn design(&self, name: &str) -> Design {
        let Self { columns, rows, pitch_mm: [x, y], depth_mm, filter, lanes, .. } = self;
        let Self { coefficient_bits, data_bits, full_scale_pa, .. } = self;
        let [algorithm, hardware] = self.kind.keys();
        let text = format!(
            "format = 3\nbase = \"../golden/tests/plain.toml\"\nname = \"{name}\"
[sensor]
columns = {columns}
rows = {rows}
pitch_mm = [{x:?}, {y:?}]
depth_mm = {depth_mm:?}
[algorithm]
filter = {filter}
{algorithm}
[hardware]
{hardware}
coefficient_bits = {coefficient_bits}
data_bits = {data_bits}
full_scale_pa = {full_scale_pa:?}
lanes = {lanes}
"
        );
        let mut design = Design::from_toml(&text, name).unwrap_or_else(|error| panic!("{error}\n{text}"));
        design.algorithm.count_contacts = (columns + lanes) % 2 == 0;
        design.hardware.scaling = if (rows + lanes) % 3 == 0 { Scaling::PerFrame } else { Scaling::Fixed };
        if (columns + rows) % 2 == 0 {
            design.algorithm.standard_error = Some(standard_error((columns + lanes) as u64));
        }
        if let Kind::Joint { correction, .. } = self.kind {
            *design.algorithm.joint = constants(&design.sensor, correction);
        }
        design
    }
}

/// Numbers of a standard error from nothing to the largest.
fn standard_error(seed: u64) -> StandardError {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    StandardError {
        model: random.random_range(0.001..3.9),
        noise: 10_f64.powf(random.random_range(0.0..4.0)),
        border: random.random_range(0.0..15.9),
    }
}

/// Constants of the grid search as no calibration finds them: a window from nothing to the whole grid, few units or
/// a number that does not fill the last pass, weights from nothing to the largest.
fn constants(sensor: &Sensor, correction: bool) -> JointConstants {
    let mut random = ChaCha8Rng::seed_from_u64((64 * sensor.columns + sensor.rows) as u64);
    let mut constants = JointConstants {
        gain: random.random_range(0.5..2.0),
        friction_correction: [random.random_range(0.5..1.5), random.random_range(-0.3..0.3)],
        ..JointConstants::default()
    };
    if correction {
        let half_window = [sensor.columns, sensor.rows].map(|side| random.random_range(0..side.min(6)));
        let largest = 1 << random.random_range(6..17);
        let units = random.random_range(1..11);
        let mut row =
            |length: usize, largest: i32| (0..length).map(|_| random.random_range(-largest..=largest)).collect();
        let inputs = Correction::inputs(half_window);
        let hidden = (0..units).map(|_| row(inputs, largest)).collect();
        let output = [row(units, 4096), row(units, 131_071)];
        constants.correction = Some(Correction { half_window, hidden, output });
    }
    constants
}

/// The design with every other key drawn: load model, samples, calibration, streams, what becomes of frames without room.
///
/// # Errors
/// Why the keys do not go together.
fn with_every_key(mut design: Design, random: &mut ChaCha8Rng) -> Result<Design, String> {
    let taxels = design.sensor.taxels();
    let (algorithm, input, hardware) = (&mut design.algorithm, &mut design.input, &mut design.hardware);
    if random.random_bool(0.3) {
        algorithm.kernel = Kernel::Cell;
    }
    if random.random_bool(0.3) {
        algorithm.regularisation = Regularisation::Noise { noise: random.random_range(0.0005..0.01) };
    }
    if random.random_bool(0.3) {
        let limit = random.random_range(0.1..0.9);
        algorithm.slip = Some(Slip { limit, hysteresis: random.random_range(0.0..limit) });
    }
    if random.random_bool(0.3) {
        algorithm.noise_floor_pa = hardware.full_scale_pa * 10_f64.powf(random.random_range(-5.0..-2.0));
    }
    if random.random_bool(0.3) {
        input.tension = Tension::Clipped;
    }
    if random.random_bool(0.2) {
        hardware.optimise = [Optimise::Area, Optimise::Latency][usize::from(algorithm.outputs == Outputs::Field)];
    }
    hardware.stream_bits = [32, 64, 128][random.random_range(0..3)];
    if random.random_bool(0.5) {
        hardware.overrun = Overrun::Drop;
    }
    hardware.control = random.random_bool(0.4);
    // Counts reach somewhat beyond the full scale.
    let largest = f64::from(random.random_range(1500..30_000_u32));
    let pascals = -1.3 * hardware.full_scale_pa;
    match random.random_range(0..4) {
        0 | 1 => {}
        2 => input.pa_per_count = Some(pascals / largest),
        _ => {
            let knots = random.random_range(1..12_u32);
            let point = |knot: u32| [f64::from(knot), f64::from(knot).powf(1.3)];
            let end = point(knots);
            let points = (0..=knots).map(point).map(|[x, y]| [x / end[0] * largest, y / end[1] * pascals]);
            input.curve = Some(Curve { points: points.collect(), law: None });
        }
    }
    if input.counts() {
        hardware.samples = [Samples::Float32, Samples::Int16, Samples::Uint16][random.random_range(0..3)];
        if random.random_bool(0.5) {
            let offsets = if input.curve.is_some() { 0.01 * hardware.full_scale_pa } else { 0.01 * largest };
            input.calibration = Some(Calibration {
                gain: (0..taxels).map(|_| random.random_range(0.6..1.5)).collect(),
                offset: (0..taxels).map(|_| random.random_range(-offsets..offsets)).collect(),
            });
        }
        if hardware.control && random.random_bool(0.6) {
            hardware.calibration = CalibrationIn::Ram;
            input.room = [0, 1, 2, 4][random.random_range(0..4)];
        }
    }
    if random.random_bool(0.25) {
        let most = if input.room > 0 { input.room } else { 3 };
        let mut dead: Vec<usize> = (0..most.min(taxels / 4)).map(|_| random.random_range(0..taxels)).collect();
        dead.sort_unstable();
        dead.dedup();
        input.dead = dead;
    }
    if random.random_bool(0.25) {
        input.crosstalk = random.random_range(0.0005..0.1);
    }
    if random.random_bool(0.25) {
        let [strength, seconds] = [random.random_range(0.01..1.0), random.random_range(0.02..0.5)];
        input.creep = Some(Creep { strength, seconds, frames_per_second: 100.0 });
    }
    if random.random_bool(0.3) {
        (input.smoothing, input.noise) = (random.random_range(1..=8), 0.1);
    }
    if input.curve.is_none() && design.sensor.columns % 2 == 1 {
        let largest = 0.3 * hardware.full_scale_pa / input.pa_per_count.unwrap_or(1.0).abs();
        input.measured_noise = Some(MeasuredNoise { deviation: input.noise * largest, largest });
    }
    let files = design.files();
    let files: Vec<(&str, String)> = files.iter().map(|(name, text)| (*name, text.clone())).collect();
    Design::from_parts(&design.to_toml(), &design.name, &files).map_err(|error| error.to_string())
}

/// As [`plan`], with every key drawn.
///
/// # Errors
/// Why all of too many draws had no plan.
pub fn plan_of_every_key(number: u64) -> Result<(Plan, ChaCha8Rng), String> {
    // Other draws than those of `plan`.
    draw(number, 1 << 32, |shape, name, random| with_every_key(shape.design(name), random))
}

/// The design with this number among those of the seed, and the generator as its draws left it.
///
/// # Errors
/// Why all of too many draws had no plan.
pub fn plan(number: u64) -> Result<(Plan, ChaCha8Rng), String> {
    draw(number, 0, |shape, name, _| Ok(shape.design(name)))
}

fn draw(
    number: u64,
    first_stream: u64,
    design: impl Fn(&Shape, &str, &mut ChaCha8Rng) -> Result<Design, String>,
) -> Result<(Plan, ChaCha8Rng), String> {
    let mut random = ChaCha8Rng::seed_from_u64(seed());
    random.set_stream(first_stream + number);
    let name = format!("random_{number:02}");
    let mut refused = Vec::new();
    for _ in 0..MOST_REFUSED {
        let shape = Shape::random(&mut random);
        let plan =
            design(&shape, &name, &mut random).and_then(|design| Plan::new(&design).map_err(|error| error.to_string()));
        match plan {
            Ok(plan) => return Ok((plan, random)),
            Err(error) => refused.push(error),
        }
    }
    Err(format!("no plan after {MOST_REFUSED} draws:\n{}", refused.join("\n")))
}
