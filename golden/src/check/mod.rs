//! What is wrong with frames, as far as they tell: readings that no contact on this sensor makes.
//!
//! Each check knows one usual mistake of those who connect a sensor. A frame that passes may still be wrong: a square
//! grid that is transposed looks like another contact.

mod beyond;
mod broken;
mod contacts;
mod crosstalk;
mod dead;
pub(crate) mod ends;
mod order;
mod print;
mod quiet;
mod rest;
mod restarts;
mod scaled;
mod unit;

use std::fmt;

use serde::Serialize;

pub use beyond::{Beyond, beyond};
pub(crate) use quiet::together;

use crate::crosstalk::Crosstalk;
use crate::design::{Design, Input, NOISE_FLOOR_DIVISOR, Tension};
use crate::matrices::Matrices;
use crate::numbers::{counted, magnitude, mean};
use crate::words::print_as_words;

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Every reading is zero.
    Empty,
    /// Readings that stay as they are but for noise, as where nothing presses.
    Unloaded,
    /// Readings far below or above the full scale.
    Range,
    /// The stresses add up to a pull.
    Sign,
    /// No reading is positive.
    NoTension,
    /// Readings are positive where the design says that none is.
    Tension,
    /// Every taxel is loaded, or pulls, those beside the contact too.
    Tare,
    /// Taxels that read the same whatever presses around them, or much where nothing does.
    Dead,
    /// Taxels read a share of their rows and columns.
    Crosstalk,
    /// The taxels stand in another order.
    Order,
    /// Readings at the end of the converter's range, below the full scale.
    Stuck,
    /// Each frame is divided by a norm of its own, such as its largest reading.
    Scaled,
    /// Noise above the stated one restarts the average.
    Noise,
    /// More contacts press than one, in a design that counts them and solves one.
    Contacts,
}

print_as_words!(Kind);

/// One thing that is suspicious, with its likely cause and what to change, on one line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What it is about.
    pub kind: Kind,
    message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

/// Whole numbers with a peak this many times below it are counts of a converter of 12 bits or so, not pascals.
const WHOLE: f64 = 16.0;
/// A frame counts as loaded if its peak is this share of the largest.
const LOADED: f64 = 0.1;
/// What a finding holds for: this share of the loaded frames.
const MOST: f64 = 0.9;
/// A pull of this share of a frame's peak is one, and no noise.
const PULL: f64 = 0.01;
/// Neighbours that pull beside a contact have this much in common.
const PULLS_TOGETHER: f64 = 0.25;
/// Stresses that add up to less than this share of their magnitudes press as much as they pull: a contact that is dragged with
/// a friction of 1 has twice as much.
const PRESSES: f64 = 0.2;
/// Noise that is this share of the full scale is none.
const LOUD: f64 = 0.01;
/// A floor above the noise is this many times its mean.
const ABOVE_NOISE: f64 = 1.5;
/// All readings of an unloaded sensor have at most this share of a noise floor of three deviations as their root mean square,
const OF_FLOOR: f64 = 0.5;
/// and none lies above the floor by more than this factor.
const FAR_ABOVE: f64 = 3.0;
/// Readings below this share of a frame's peak are as good as zero.
const FAINT: f64 = 2e-3;

/// Looks for what is wrong with frames of a design, values as they are in the file, each of m finite numbers.
///
/// `matrices` are those of the design; without them the order of the taxels is not looked at.
pub fn check(design: &Design, frames: &[Vec<f64>], matrices: Option<&Matrices>) -> Vec<Finding> {
    // Noise looks like one fault or another by chance. The floor that a design has by itself is nobody's measurement.
    let usual = design.hardware.full_scale_pa / NOISE_FLOOR_DIVISOR;
    if design.algorithm.noise_floor_pa > usual
        && is_unloaded(design, frames)
        && quiet::check(design, &in_pascals(design, frames)).is_some()
        && scaled::check(frames).is_none()
    {
        return Vec::new();
    }
    if let Some(message) = order::swapped(&design.sensor, frames) {
        return vec![Finding { kind: Kind::Order, message }];
    }
    let Some(([row, column], message)) = crosstalk::check(design, frames) else {
        return check_mended(design, frames, matrices);
    };
    // What else is wrong shows without it.
    let mut corrected = design.clone();
    let mut findings = if row.to_bits() == column.to_bits() {
        corrected.input.crosstalk = row;
        check_mended(&corrected, frames, matrices)
    } else {
        // Taxels in another order seem to have it on rows or columns alone.
        corrected.input = Input { dead: design.input.dead.clone(), tension: design.input.tension, ..Input::default() };
        let crosstalk = Crosstalk::of(&design.sensor, [row, column]);
        let pascals = |frame: &Vec<f64>| {
            let mut stress =
                frame.iter().enumerate().map(|(taxel, &value)| design.input.to_pa(taxel, value)).collect::<Vec<f64>>();
            crosstalk.remove(&mut stress);
            stress
        };
        let undone: Vec<Vec<f64>> = frames.iter().map(pascals).collect();
        let is_order = |finding: &Finding| finding.kind == Kind::Order;
        let mut findings = check_mended(design, frames, matrices);
        if matrices.is_none() || check_mended(&corrected, &undone, matrices).iter().any(is_order) {
            return findings;
        }
        findings.retain(|finding| !matches!(finding.kind, Kind::Tare | Kind::Order | Kind::Contacts));
        findings
    };
    findings.insert(0, Finding { kind: Kind::Crosstalk, message });
    findings
}

fn check_mended(design: &Design, frames: &[Vec<f64>], matrices: Option<&Matrices>) -> Vec<Finding> {
    // One taxel that is broken would pass for another order, unit or tare.
    let stress = in_pascals(design, frames);
    let Some((message, mended)) = broken::check(design, frames, &stress) else {
        return check_whole(design, frames, matrices);
    };
    let mut findings = check_whole(design, &mended, matrices);
    findings.retain(|finding| finding.kind != Kind::Order);
    findings.insert(0, Finding { kind: Kind::Dead, message });
    findings
}

/// Whether frames are those of an unloaded sensor, tared, with a noise floor above its noise.
pub fn is_unloaded(design: &Design, frames: &[Vec<f64>]) -> bool {
    let floor = design.algorithm.noise_floor_pa;
    let stress = in_pascals(design, frames);
    let rms = |values: &mut dyn Iterator<Item = f64>| mean(values.map(|stress| stress * stress)).sqrt();
    // A taxel that is stuck above the floor is one of many.
    let each = |taxel: usize| rms(&mut stress.iter().map(|frame| frame[taxel])) <= floor;
    rms(&mut stress.iter().flatten().copied()) <= OF_FLOOR * floor
        && stress.iter().all(|frame| largest(frame) <= FAR_ABOVE * floor)
        && (0..design.sensor.taxels()).all(each)
}

fn in_pascals(design: &Design, frames: &[Vec<f64>]) -> Vec<Vec<f64>> {
    frames.iter().map(|frame| design.stress_of(frame)).collect()
}

#[allow(clippy::too_many_lines, reason = "one check after the other, and what each knows of those before")]
fn check_whole(design: &Design, frames: &[Vec<f64>], matrices: Option<&Matrices>) -> Vec<Finding> {
    let stress = in_pascals(design, frames);
    let peak = stress.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let mut findings = Vec::new();
    let mut found = |kind, message| findings.push(Finding { kind, message });
    if peak <= 0.0 {
        let (kind, message) = unit::nothing(design, frames);
        found(kind, message);
        return findings;
    }
    let live: Vec<Vec<f64>> = frames.iter().map(|frame| without(frame, &design.input.dead)).collect();
    if let Some(message) = scaled::check(&live) {
        found(Kind::Scaled, message);
        return findings;
    }
    let is_loaded: Vec<bool> = stress.iter().map(|frame| largest(frame) >= LOADED * peak).collect();
    let full_scale = design.hardware.full_scale_pa;
    if let Some(message) = quiet::check(design, &stress) {
        if !is_unloaded(design, frames) {
            found(Kind::Unloaded, message);
        }
        return findings;
    }
    if let Some(message) = print::check(design, &stress) {
        found(Kind::Tare, message);
        return findings;
    }
    let counts = design.input.counts();
    let whole = !counts && WHOLE * peak <= full_scale && frames.iter().flatten().all(|value| value.fract() == 0.0);
    // Where the largest reading presses, the sum pulls for an offset.
    let pulls = |frame: &&Vec<f64>| frame.iter().sum::<f64>() > 0.0 && farthest(frame) > 0.0;
    let reads_nothing = |frame: &[f64]| frame.iter().sum::<f64>().abs() <= FAINT * peak * frame.len() as f64;
    let is_tared = stress.iter().zip(&is_loaded).any(|(frame, &loaded)| !loaded && reads_nothing(frame));
    let with_load = |(stress, &loaded): (Vec<f64>, &bool)| loaded.then_some(stress);
    let mut loaded: Vec<Vec<f64>> = stress.into_iter().zip(&is_loaded).filter_map(with_load).collect();
    let pulling = loaded.iter().filter(pulls).count();
    let is_pull = holds(pulling, loaded.len());
    // Pascals press below 0: taken for counts of a scale that is negative, they pull.
    let fractions = frames.iter().flatten().any(|value| value.fract() != 0.0);
    let pascals = counts && is_pull && (fractions || peak >= unit::TOO_LARGE * full_scale);
    let scale = unit::Scale::of(design);
    if pascals {
        found(
            Kind::Range,
            format!(
                "the stresses add up to a pull (F_z > 0) in {pulling} of {}, {}: are the frames in pascals already? Remove \
                 {}; if they are counts that fall under load, change {}",
                count(loaded.len()),
                if fractions {
                    "and readings have fractions, which counts have not".to_owned()
                } else {
                    format!("the largest {:.0} times above hardware.full_scale_pa", peak / full_scale)
                },
                scale.key,
                scale.sign
            ),
        );
    } else if let Some(message) = unit::range(design, peak) {
        found(Kind::Range, message);
    } else if whole {
        found(
            Kind::Range,
            format!(
                "all readings are whole numbers, the largest {peak:.0}, {:.0} times below hardware.full_scale_pa: counts of a \
                 converter? Say what one is worth in sensor.pa_per_count, negative where larger counts press",
                full_scale / peak
            ),
        );
    }
    if is_pull && !pascals {
        let remedy = match (counts, whole) {
            (true, _) => format!("change {}", scale.sign),
            (false, true) => "write sensor.pa_per_count, what a count is worth, with a minus".to_owned(),
            (false, false) => {
                "write sensor.pa_per_count = -1.0; where a header names a unit, its pascals with a minus".to_owned()
            }
        };
        found(
            Kind::Sign,
            format!(
                "the stresses add up to a pull (F_z > 0) in {pulling} of {}: compression must be negative; {remedy}",
                count(loaded.len())
            ),
        );
    }
    if is_pull {
        // What else is wrong shows with the right sign.
        loaded.iter_mut().flatten().for_each(|stress| *stress = -*stress);
    }
    let clipped = design.input.tension == Tension::Clipped
        || loaded.iter().all(|frame| frame.iter().all(|&stress| stress <= FAINT * largest(frame)));
    if let Some(message) = rest::check(design, &loaded, is_tared) {
        found(Kind::Tare, message);
    } else if design.input.tension == Tension::Read && clipped {
        found(
            Kind::NoTension,
            format!(
                "no reading of {} is a pull: where the sensor cannot read tension, or a converter clips it, the force \
                 along the surface comes out too small; let the converter's range reach below 0, or write \
                 sensor.tension = \"clipped\" with estimator = \"joint\" and run `sptfra calibrate`",
                count(loaded.len())
            ),
        );
    }
    // What pulls beside a contact does so on neighbours; noise about the tare does on taxels here and there.
    let pulled = |frame: &Vec<f64>| {
        let pulls: Vec<f64> = frame.iter().map(|&stress| stress.max(0.0)).collect();
        largest(&pulls) >= PULL * largest(frame) && together(&design.sensor, &pulls) >= PULLS_TOGETHER
    };
    let pulled = loaded.iter().filter(|frame| pulled(frame)).count();
    if design.input.tension == Tension::Clipped && holds(pulled, loaded.len()) {
        found(
            Kind::Tension,
            format!(
                "readings pull in {pulled} of {}, and the design says that the sensor reads none: if it does, remove \
                 sensor.tension and calibrate for it, the forces are more exact then",
                count(loaded.len())
            ),
        );
    }
    if let Some(message) = dead::check(design, frames, &loaded, clipped) {
        found(Kind::Dead, message);
    } else if let Some(message) = order::axes(&design.sensor, frames) {
        found(Kind::Order, message);
    } else if let Some(message) = matrices.and_then(|matrices| order::check(design, matrices, &loaded)) {
        found(Kind::Order, message);
    }
    let mut found = |kind, message| findings.push(Finding { kind, message });
    for message in ends::check(design, frames, loaded.len(), peak) {
        found(Kind::Stuck, message);
    }
    if let Some(message) = restarts::check(design, &loaded) {
        found(Kind::Noise, message);
    }
    // Frames that are wrong in these ways seem to have contacts that nobody pressed.
    let misread = pascals
        || findings.iter().any(|finding| matches!(finding.kind, Kind::Sign | Kind::Tare | Kind::Dead | Kind::Order));
    let frames: Vec<&Vec<f64>> =
        frames.iter().zip(&is_loaded).filter_map(|(frame, &loaded)| loaded.then_some(frame)).collect();
    if let Some(message) = matrices.filter(|_| !misread).and_then(|matrices| contacts::check(design, &frames, matrices))
    {
        findings.push(Finding { kind: Kind::Contacts, message });
    }
    findings
}

/// A frame with nothing in the place of dead taxels.
fn without(frame: &[f64], dead: &[usize]) -> Vec<f64> {
    let value = |(taxel, &value): (usize, &f64)| if dead.contains(&taxel) { 0.0 } else { value };
    frame.iter().enumerate().map(value).collect()
}

fn largest(frame: &[f64]) -> f64 {
    magnitude(frame)
}

/// The value that is farthest from 0.
fn farthest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |far: f64, &value| if value.abs() > far.abs() { value } else { far })
}

pub(crate) fn holds(frames: usize, of: usize) -> bool {
    frames > 0 && frames as f64 >= MOST * of as f64
}

fn count(frames: usize) -> String {
    counted(frames, "frame")
}
