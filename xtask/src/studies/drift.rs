//! Errors under constant load while readings creep or offsets drift, with ways to correct them.

use std::fmt::Write;
use std::ops::Range;

use golden::calibrate::recorded::creep::fit;
use golden::creep;
use golden::design::Design;
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame, normal};
use golden::solver::Solver;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::noise::noisy;
use super::{Fallible, Rows};

/// Friction of the contacts.
const FRICTION: f64 = 0.5;
/// No design trained on round sliding contacts has seen these kinds.
const KINDS: [Kind; 4] = [Kind::TiltedAlong, Kind::Held, Kind::Turned, Kind::Spinning];
/// A contact of each kind, which no calibration draws.
const SEEDS: Range<u64> = 92_000..92_040;
/// Added to a seed for the contact before.
const BEFORE: u64 = 1_000;
/// Noise of a reading in percent of the frame's largest.
const NOISE_PERCENT: f64 = 0.5;
const FRAMES_PER_SECOND: usize = 10;
/// Seconds from frame to frame.
const STEP: f64 = 1.0 / FRAMES_PER_SECOND as f64;
/// Frames of the contact before, of the pause behind it, and of the pause behind the tare.
const HELD: usize = 300;
const PAUSE: usize = 200;
const TARED: usize = 20;
/// Seconds after the touch.
const TIMES: [u32; 5] = [0, 1, 5, 15, 60];
/// A constant load raises readings by this share within so many seconds.
const RISE: f64 = 1.0 / 3.0;
const WITHIN: f64 = 15.0;
/// Relaxation time in seconds: of one process, and of two of equal strength.
const ONE: &[f64] = &[10.0];
const TWO: &[f64] = &[3.0, 60.0];
const DECADES: &[f64] = &[0.1, 1.0, 10.0, 100.0, 1000.0];
/// Standard deviation of an offset's drift in percent of the largest reading a minute, and minutes since the first tare.
const DRIFT_PERCENT: f64 = 0.2;
const DRIFTED: f64 = 10.0;
/// Seconds in which the moving baseline follows to 1 - 1/e.
const BASELINE: f64 = 60.0;
/// Seconds of the step of load from which strength and time constant are found.
const STEP_OF_LOAD: usize = 60;

/// What disturbs the readings.
struct Disturbance {
    name: &'static str,
    /// Relaxation times in seconds, of equal strength; none: the sensor does not creep.
    times: &'static [f64],
    /// Standard deviation of a taxel's strength and time, as a share of them.
    spread: f64,
    /// Creep goes with the stress to this power.
    power: f64,
    /// How many times slower than it rises creep fades.
    fading: f64,
    drifts: bool,
}

/// Readings that neither creep nor drift.
const STEADY: Disturbance =
    Disturbance { name: "steady", times: &[], spread: 0.0, power: 1.0, fading: 1.0, drifts: false };

const DISTURBANCES: [Disturbance; 10] = [
    STEADY,
    Disturbance { name: "drift", drifts: true, ..STEADY },
    Disturbance { name: "creep-0", times: ONE, ..STEADY },
    Disturbance { name: "creep-20", times: ONE, spread: 0.2, ..STEADY },
    Disturbance { name: "creep-50", times: ONE, spread: 0.5, ..STEADY },
    Disturbance { name: "creep-two-20", times: TWO, spread: 0.2, ..STEADY },
    Disturbance { name: "creep-log-20", times: DECADES, spread: 0.2, ..STEADY },
    Disturbance { name: "creep-curved-20", times: ONE, spread: 0.2, power: 0.7, ..STEADY },
    Disturbance { name: "creep-fading-20", times: ONE, spread: 0.2, fading: 3.0, ..STEADY },
    Disturbance { name: "creep-20-drift", times: ONE, spread: 0.2, drifts: true, ..STEADY },
];

/// How readings are corrected before they are solved; the last takes a tare off what the last but one leaves.
const CORRECTIONS: [&str; 5] = ["none", "tare", "baseline", "constant", "constant-tare"];

impl Disturbance {
    /// The corrections that change something.
    fn corrections(&self) -> usize {
        match (self.times, self.drifts) {
            ([], false) => 1,
            ([], true) => 3,
            _ => CORRECTIONS.len(),
        }
    }
}

/// What creep adds to a reading: it approaches `strength` times the stress, and fades `fading` times slower.
#[derive(Clone, Copy, Debug)]
struct Creep {
    strength: f64,
    seconds: f64,
    fading: f64,
    added: f64,
}

impl Creep {
    fn load(&mut self, stress: f64, seconds: f64) {
        let end = self.strength * stress;
        let slower = if end.abs() < self.added.abs() { self.fading } else { 1.0 };
        let left = (-seconds / (slower * self.seconds)).exp();
        self.added = left * self.added + (1.0 - left) * end;
    }
}

/// A taxel with creep of one or several time constants, and an offset that drifts.
#[derive(Clone, Debug)]
struct Taxel {
    creep: Vec<Creep>,
    /// Creep goes with the stress to this power; at `largest` it is the linear one.
    power: f64,
    largest: f64,
    offset: f64,
    offset_per_second: f64,
}

impl Taxel {
    fn load(&mut self, stress: f64, seconds: f64) {
        let bent = stress.signum() * self.largest * (stress.abs() / self.largest).powf(self.power);
        for creep in &mut self.creep {
            creep.load(bent, seconds);
        }
        self.offset += self.offset_per_second * seconds;
    }

    fn added(&self) -> f64 {
        self.creep.iter().map(|creep| creep.added).sum()
    }

    fn read(&self, stress: f64) -> f64 {
        stress + self.offset + self.added()
    }
}

/// Taxels of a sensor on which a contact reads `largest`; factors of strength and time are log-normal with a mean of 1.
fn taxels(of: &Disturbance, count: usize, largest: f64, random: &mut ChaCha8Rng) -> Vec<Taxel> {
    let strength = RISE / of.times.iter().map(|seconds| 1.0 - (-WITHIN / seconds).exp()).sum::<f64>();
    let deviation = of.spread.powi(2).ln_1p().sqrt();
    let mut taxel = || {
        let [strong, slow] = [(); 2].map(|()| (deviation * normal(random) - 0.5 * deviation.powi(2)).exp());
        let creep =
            |seconds| Creep { strength: strong * strength, seconds: slow * seconds, fading: of.fading, added: 0.0 };
        let per_minute = if of.drifts { 0.01 * DRIFT_PERCENT * largest * normal(random) } else { 0.0 };
        Taxel {
            creep: of.times.iter().map(|&seconds| creep(seconds)).collect(),
            power: of.power,
            largest,
            offset: DRIFTED * per_minute,
            offset_per_second: per_minute / 60.0,
        }
    };
    (0..count).map(|_| taxel()).collect()
}

/// Creep that all taxels have in common, found from a step of uniform load of half the largest reading.
fn common(taxels: &[Taxel]) -> Result<creep::Creep, String> {
    let mut all = taxels.to_vec();
    let mut sum = |share: f64| {
        let read = |taxel: &mut Taxel| {
            let stress = share * taxel.largest;
            let read = stress + taxel.added();
            taxel.load(stress, STEP);
            read
        };
        all.iter_mut().map(read).sum::<f64>()
    };
    let sums: Vec<f64> =
        (0..=FRAMES_PER_SECOND * STEP_OF_LOAD).map(|frame| sum(if frame == 0 { 0.0 } else { 0.5 })).collect();
    fit(&sums, STEP).map(|found| found.creep)
}

/// One taxel with all that corrects it.
struct Channel {
    taxel: Taxel,
    /// What removes creep, and how far it has gone.
    creep: Option<creep::Creep>,
    crept: Vec<f64>,
    baseline: f64,
    /// Offsets that the tare takes off, without and with the correction of creep.
    tare: [f64; 2],
}

impl Channel {
    fn new(taxel: Taxel, creep: Option<creep::Creep>) -> Self {
        // So far behind is a baseline that has followed the drift for long.
        let baseline = taxel.offset - BASELINE * taxel.offset_per_second;
        Self { taxel, creep, crept: vec![0.0], baseline, tare: [0.0; 2] }
    }

    fn load(&mut self, stress: f64) {
        let read = self.taxel.read(stress);
        if let Some(creep) = &self.creep {
            creep.remove(&mut self.crept, &mut [read], f64::INFINITY);
        }
        self.baseline += (1.0 - (-STEP / BASELINE).exp()) * (read - self.baseline);
        self.taxel.load(stress, STEP);
    }

    fn tare(&mut self) {
        let read = self.taxel.read(0.0);
        self.tare = [read, read - self.crept[0]];
    }

    /// The reading by each of [`CORRECTIONS`].
    fn corrected(&self, stress: f64) -> [f64; CORRECTIONS.len()] {
        let read = self.taxel.read(stress);
        let without_creep = read - self.crept[0];
        [read, read - self.tare[0], read - self.baseline, without_creep, without_creep - self.tare[1]]
    }
}

/// Errors of `F_z` and shear in percent of the normal force, and of the friction times 100.
type Errors = [f64; 3];

/// Errors of a contact by correction and time.
fn of_contact(
    (design, solver): (&Design, &Solver),
    disturbance: &Disturbance,
    [before, frame]: [&SceneFrame; 2],
    seed: u64,
) -> Fallible<Vec<Errors>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let largest = frame.stress.iter().fold(0.0_f64, |largest, stress| largest.max(stress.abs()));
    let taxels = taxels(disturbance, frame.stress.len(), largest, &mut random);
    let creep = if disturbance.times.is_empty() { None } else { Some(common(&taxels)?) };
    let mut channels: Vec<Channel> = taxels.into_iter().map(|taxel| Channel::new(taxel, creep)).collect();
    let unloaded = vec![0.0; frame.stress.len()];
    let load = |channels: &mut [Channel], stress: &[f64], frames: usize| {
        for (channel, &stress) in channels.iter_mut().zip(stress) {
            (0..frames).for_each(|_| channel.load(stress));
        }
    };
    load(&mut channels, &before.stress, HELD);
    load(&mut channels, &unloaded, PAUSE);
    for channel in &mut channels {
        channel.tare();
    }
    load(&mut channels, &unloaded, TARED);
    let mut found = Vec::new();
    let mut passed = 0;
    for seconds in TIMES {
        load(&mut channels, &frame.stress, FRAMES_PER_SECOND * (seconds - passed) as usize);
        passed = seconds;
        let readings: Vec<_> =
            channels.iter().zip(&frame.stress).map(|(channel, &stress)| channel.corrected(stress)).collect();
        for correction in 0..disturbance.corrections() {
            let stress: Vec<f64> = readings.iter().map(|by| by[correction]).collect();
            let solution = solver.solve(&noisy(design, &stress, NOISE_PERCENT, &mut random))?;
            let [x, y, z] = [0, 1, 2].map(|axis| solution.resultant[axis] - frame.force[axis]);
            let percent = 100.0 / frame.force[2].abs();
            found.push([percent * z.abs(), percent * x.hypot(y), 100.0 * (solution.mu - frame.friction).abs()]);
        }
    }
    Ok(found)
}

/// The columns of [`rows`].
pub const COLUMNS: &str = "design,readings,correction,seconds,f_z,f_z_p95,f_z_worst,shear,shear_p95,shear_worst,friction,friction_p95,friction_worst";

/// The table of some designs, which go by the names of their files.
pub fn rows(designs: &[(String, Design)]) -> Rows {
    let mut text = String::new();
    for (name, design) in designs {
        let solver = Solver::new(design)?;
        let mut frames = Vec::new();
        for kind in KINDS {
            let before = kind.frames(&design.sensor, FRICTION, SEEDS.start + BEFORE..SEEDS.end + BEFORE)?;
            frames.extend(before.into_iter().zip(kind.frames(&design.sensor, FRICTION, SEEDS)?));
        }
        for disturbance in &DISTURBANCES {
            let errors: Vec<Vec<Errors>> = frames
                .par_iter()
                .enumerate()
                .map(|(index, (before, frame))| {
                    of_contact((design, &solver), disturbance, [before, frame], SEEDS.start + index as u64)
                })
                .collect::<Result<_, _>>()?;
            let corrections = &CORRECTIONS[..disturbance.corrections()];
            for (index, correction) in corrections.iter().enumerate() {
                for (time, seconds) in TIMES.iter().enumerate() {
                    let place = time * corrections.len() + index;
                    // Writing to a String cannot fail.
                    let _ = write!(text, "{name},{},{correction},{seconds}", disturbance.name);
                    for quantity in 0..3 {
                        let Quantiles { median, most, worst } =
                            Quantiles::of(errors.iter().map(|of| of[place][quantity]).collect());
                        let _ = write!(text, ",{median:.1},{most:.1},{worst:.1}");
                    }
                    text.push('\n');
                }
            }
        }
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_taxel(name: &str, count: usize) -> Vec<Taxel> {
        let of = DISTURBANCES.iter().find(|of| of.name == name).expect("a disturbance");
        taxels(of, count, 1000.0, &mut ChaCha8Rng::seed_from_u64(3))
    }

    #[test]
    fn a_constant_load_raises_readings_by_a_third_in_15_seconds() {
        for name in ["creep-0", "creep-20", "creep-two-20"] {
            let mut taxels = one_taxel(name, 4000);
            for taxel in &mut taxels {
                (0..150).for_each(|_| taxel.load(-600.0, STEP));
            }
            let mean = taxels.iter().map(|taxel| taxel.read(-600.0)).sum::<f64>() / 4000.0;
            // A taxel's own time bends the mean a little.
            let allowed = if name == "creep-0" { 1e-9 } else { 10.0 };
            assert!((mean + 800.0).abs() < allowed, "{name}: {mean}");
        }
    }

    #[test]
    fn taxels_that_are_alike_are_corrected_whatever_the_load() {
        let taxels = one_taxel("creep-0", 7);
        let mut channel = Channel::new(taxels[0].clone(), Some(common(&taxels).unwrap()));
        for frame in 0..500 {
            let stress = if frame % 170 < 60 { -900.0 } else { 20.0 };
            let [read, _, _, without_creep, _] = channel.corrected(stress);
            assert!((without_creep - stress).abs() < 0.3, "{frame}: {without_creep}");
            assert!(frame == 0 || (read - stress).abs() > 0.5, "{frame}: {read}");
            channel.load(stress);
        }
    }

    #[test]
    fn a_tare_removes_drift_and_a_baseline_a_held_load() {
        let mut channel = Channel::new(one_taxel("drift", 1).remove(0), None);
        (0..100).for_each(|_| channel.load(0.0));
        channel.tare();
        let [read, tared, above, ..] = channel.corrected(-500.0);
        assert!((read + 500.0).abs() > 5.0 && (tared + 500.0).abs() < 1e-9, "{read} {tared}");
        assert!((above + 500.0).abs() < (read + 500.0).abs() / 5.0, "{above}");
        (0..3000).for_each(|_| channel.load(-500.0));
        assert!(channel.corrected(-500.0)[2].abs() < 10.0);
    }
}
