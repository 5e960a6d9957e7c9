//! A design file to start from: commented, checked, with constants fitted to its sensor.

use std::ops::RangeInclusive;

use golden::calibrate::{CalibrateError, Settings, calibrate};
use golden::design::{DEFAULT_FULL_SCALE_PA, Design, DesignError, Estimator, Input, JointConstants, Samples, Tension};
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame};
use golden::sensor::Sensor;
use golden::solver::Solver;

const TEMPLATE: &str = include_str!("../templates/design.toml");
/// The line of the template where the joint estimator's constants go.
const CONSTANTS: &str = "@CONSTANTS@\n";
/// Depth in pitches beyond which a new design is regularised.
const DEEP: f64 = 1.5;
/// Where the comments of the template begin.
const COMMENTS: usize = 33;

/// Bits that a converter may have.
pub const COUNT_BITS: RangeInclusive<i64> = 4..=24;

/// What is known of the sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct NewDesign {
    /// Name of the design: a Verilog identifier.
    pub name: String,
    /// How friction is found.
    pub estimator: Estimator,
    /// Taxels in x.
    pub columns: usize,
    /// Taxels in y.
    pub rows: usize,
    /// Distance of neighbouring taxels in x and in y, in millimetres.
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres.
    pub depth_mm: f64,
    /// What taxels read of a pull.
    pub tension: Tension,
    /// Bits of the converter whose counts the frames hold, one of [`COUNT_BITS`]; without, they hold pascals.
    pub counts: Option<u32>,
    /// Stress at the end of the sensor's range.
    pub full_scale_pa: f64,
}

impl Default for NewDesign {
    /// The paper's first sensor, by the joint estimator.
    fn default() -> Self {
        Self {
            name: "my_sensor".to_owned(),
            estimator: Estimator::Joint,
            columns: 10,
            rows: 10,
            pitch_mm: [4.0, 2.0],
            depth_mm: 3.0,
            tension: Tension::Read,
            counts: None,
            full_scale_pa: DEFAULT_FULL_SCALE_PA,
        }
    }
}

/// Why there is no such design.
#[derive(Debug, thiserror::Error)]
pub enum NewDesignError {
    /// A value that no design can have.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A converter of too few or too many bits.
    #[error("counts of {0} bits; use {first} to {last}", first = COUNT_BITS.start(), last = COUNT_BITS.end())]
    Counts(u32),
    /// The estimator cannot be fitted to the sensor.
    #[error("{0}; or choose --estimator line, which needs no constants")]
    Calibrate(#[from] CalibrateError),
}

/// Contacts that [`errors`] tries.
pub const TRIED: u64 = 40;
/// Their friction.
const FRICTION: f64 = 0.5;
/// The first of their seeds: those of the fit's contacts are others.
const FIRST_SEED: u64 = 5000;

/// Errors along the surface, in percent of the normal force, on [`TRIED`] round contacts at random that slide with a
/// friction of 0.5 on a bonded layer (`Kind::Sliding`), which no constants were fitted to; `None` on a sensor for which there
/// are no such frames.
pub fn errors(design: &Design) -> Option<Quantiles> {
    let frames = Kind::Sliding.frames(&design.sensor, FRICTION, FIRST_SEED..FIRST_SEED + TRIED).ok()?;
    // In pascals, whatever the sensor counts and wherever its range ends.
    let tension = design.input.tension;
    let solver = Solver::new(&Design { input: Input { tension, ..Input::default() }, ..design.clone() }).ok()?;
    let error = |frame: &SceneFrame| {
        let read: Vec<f64> = frame.stress.iter().map(|&stress| tension.of(stress)).collect();
        let found = solver.solve(&read).ok()?;
        let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.force[axis]);
        Some(100.0 * x.hypot(y) / frame.force[2].abs())
    };
    Some(Quantiles::of(frames.iter().map(error).collect::<Option<_>>()?))
}

/// The integers that hold counts of so many bits: with a sign, which a tare needs, where there is room for one. None for
/// wider ones, which stay float32.
fn samples(bits: u32) -> Option<Samples> {
    match bits {
        ..=15 => Some(Samples::Int16),
        16 => Some(Samples::Uint16),
        _ => None,
    }
}

/// Pascals of a count, so that the largest one reaches the full scale, where it is flagged, and no count is beyond.
fn pa_per_count(new: &NewDesign, bits: u32) -> String {
    let largest = f64::from(bits).exp2() - 1.0;
    let step = new.full_scale_pa / largest;
    let step = if step * largest < new.full_scale_pa { step.next_up() } else { step };
    format!("{:?}", -step)
}

impl NewDesign {
    /// The design file, checked. `stage` is told of work that takes a while.
    ///
    /// # Errors
    ///
    /// [`NewDesignError`].
    pub fn text(&self, stage: &mut dyn FnMut(&'static str)) -> Result<String, NewDesignError> {
        text(self, stage)
    }
}

fn text(new: &NewDesign, stage: &mut dyn FnMut(&'static str)) -> Result<String, NewDesignError> {
    if let Some(bits) = new.counts.filter(|&bits| !COUNT_BITS.contains(&i64::from(bits))) {
        return Err(NewDesignError::Counts(bits));
    }
    // Quoted, so that whatever the name holds reaches the check of names; a JSON string is a TOML string.
    let mut text = with(TEMPLATE, "name", &serde_json::Value::from(new.name.as_str()).to_string());
    for (key, value) in [
        ("columns", new.columns.to_string()),
        ("rows", new.rows.to_string()),
        ("pitch_mm", format!("{:?}", new.pitch_mm)),
        ("depth_mm", format!("{:?}", new.depth_mm)),
        ("full_scale_pa", format!("{:?}", new.full_scale_pa)),
    ] {
        text = with(&text, key, &value);
    }
    if new.tension == Tension::Clipped {
        text = text.replace("# tension = ", "tension = ");
        text = with(&text, "tension", &format!("\"{}\"", new.tension));
    }
    if let Some(bits) = new.counts {
        text = with(&text.replace("# pa_per_count = ", "pa_per_count = "), "pa_per_count", &pa_per_count(new, bits));
        if let Some(samples) = samples(bits) {
            text = with(&text.replace("# samples = ", "samples = "), "samples", &format!("\"{samples}\""));
        }
    }
    // Where noise would become force, and no plan might be possible without.
    let [x, y] = [new.pitch_mm[0], new.pitch_mm[1]];
    if new.depth_mm > DEEP * x.min(y) {
        text = text.replace("# regularisation = ", "regularisation = ");
    }
    let NewDesign { columns, rows, pitch_mm, depth_mm, .. } = *new;
    if (Sensor { columns, rows, pitch_mm, depth_mm }).wants_cells() {
        text = with(&text, "kernel", "\"cell\"");
    }
    let bare = text.replace(CONSTANTS, "");
    if new.estimator == Estimator::Line {
        let text = with(&bare, "estimator", "\"line\"");
        Design::from_toml(&text, "sptfra new")?;
        return Ok(text);
    }
    let design = Design::from_toml(&bare, "sptfra new")?;
    stage("fitting gain and friction to contacts with known forces");
    let found = calibrate(&design, &Settings::constants(), &mut |_| ())?;
    let text = text.replace(CONSTANTS, &constants(&found));
    Design::from_toml(&text, "sptfra new")?;
    Ok(text)
}

/// The lines of the joint estimator's constants; four digits, which no processor rounds otherwise and no contact shows.
fn constants(JointConstants { gain, friction_correction: [c1, c3], calibrated_for, .. }: &JointConstants) -> String {
    let remarks = [
        "factor on all forces, fitted to the sensor above",
        "friction c1 mu + c3 mu |mu|^2, likewise; the correction, which",
        "  halves the error, is trained by sptfra calibrate",
        "what they are for: for another sensor, noise, kernel or regularisation remove",
        "  these lines, and run sptfra calibrate",
    ];
    let keys = [
        format!("gain = {gain:.4}"),
        format!("friction_correction = [{c1:.4}, {c3:.4}]"),
        String::new(),
        String::new(),
        String::new(),
    ];
    let calibrated_for = format!("calibrated_for = {:?}\n", calibrated_for.as_deref().unwrap_or_default());
    let constants: String =
        keys.iter().zip(remarks).map(|(key, remark)| format!("{key:<COMMENTS$}# {remark}\n")).collect();
    constants + &calibrated_for
}

/// The text with another value of a key, its comment where it was.
fn with(text: &str, key: &str, value: &str) -> String {
    let line = |line: &str| match (line.split_once(" = "), line.split_once(" # ")) {
        (Some((found, _)), Some((_, comment))) if found == key => {
            let pair = format!("{key} = {value} ");
            format!("{pair:<COMMENTS$}# {comment}\n")
        }
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}
