//! What of a recording can be fitted to: stretches of equal load, by contact and by place.
//!
//! A *contact* lasts while something presses at one place. A *hold* is a stretch of a contact with one load: its frames
//! are averaged, since they tell the same thing again. Contacts at one *place* are left out together in cross-validation.

use std::ops::Range;

use super::loads::{REST, Wrong, loads, rest};
use super::table::Measured;
use crate::check::ends::end_of_range;
use crate::dead_taxels::MOST_DEAD;
use crate::design::Design;
use crate::numbers::{self, counted, mean};

/// A contact ends where the centre of pressure has moved by this many pitches.
const MOVED: f64 = 0.5;
/// Taxels below this share of a frame's largest reading do not count for its centre.
const BESIDE: f64 = 0.1;
/// A hold ends where the force differs by this share of it; doubled until there are few enough holds.
const STEP: f64 = 0.05;
/// Most holds.
const MOST: usize = 400;
/// A taxel at the converter's end in this share of all frames, with load and without, is stuck there.
const STUCK: f64 = 0.95;
/// From this many frames on a hold tells how its reading creeps.
const CREEPS: usize = 10;
/// A load is constant if no fifth of its frames differs from the first by more than this share; a ramp's do.
const CONSTANT: f64 = 0.02;

/// A stretch of frames with one load at one place.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    /// Its frames, from the first to the one after the last.
    pub(super) frames: Range<usize>,
    /// Mean readings above rest, with the sign that makes pressing positive; one a taxel, 0 of dead ones.
    pub(super) x: Vec<f64>,
    /// Mean of what is known of `[F_x, F_y, F_z]`, in newtons.
    pub(super) force: [Option<f64>; 3],
    /// What presses, in newtons.
    pub(super) load: f64,
    /// Which contact.
    pub(super) contact: usize,
    /// Where it is.
    pub(super) place: usize,
    /// How far the sum of the readings rises from the first fifth to the last, as a share of its mean; of a constant load alone.
    pub(super) creep: Option<f64>,
}

/// A recording in holds.
#[derive(Clone, Debug)]
pub(super) struct Holds {
    pub(super) all: Vec<Hold>,
    pub(super) contacts: usize,
    pub(super) places: usize,
    /// Readings without load, one a taxel.
    pub(super) rest: Vec<f64>,
    /// Mean over the taxels of the deviation without load, in counts.
    pub(super) noise: Option<f64>,
    /// 1 where pressing raises the readings, else -1.
    pub(super) sign: f64,
    pub(super) remarks: Vec<String>,
}

/// Parts a recording into holds.
pub(super) fn part(design: &Design, frames: &[Vec<f64>], measured: &Measured) -> Result<Holds, Wrong> {
    let mut remarks = Vec::new();
    let loads = loads(measured, &mut remarks)?;
    let largest = loads.iter().flatten().fold(0.0_f64, |most, &load| most.max(load));
    let at_rest: Vec<usize> =
        (0..frames.len()).filter(|&k| loads[k].is_some_and(|load| load.abs() < REST * largest)).collect();
    let (rest, noise) = rest(design, frames, &at_rest, &mut remarks);
    let known = |k: &usize| loads[*k].is_some_and(|load| load >= REST * largest);
    let loaded: Vec<usize> = (0..frames.len()).filter(known).collect();
    // What a dead taxel reads is nothing, if it is the converter's end.
    let is_alive = |taxel: usize| !design.input.dead.contains(&taxel);
    let alive: Vec<usize> = (0..rest.len()).filter(|&taxel| is_alive(taxel)).collect();
    let mut sum = 0.0;
    for &k in &loaded {
        sum += alive.iter().map(|&taxel| frames[k][taxel] - rest[taxel]).sum::<f64>();
    }
    if sum == 0.0 {
        return Err((
            "the readings under load are those without".to_owned(),
            "check that the sensor is connected, and that the forces belong to these frames".to_owned(),
        ));
    }
    let sign = sum.signum();
    let above = |k: usize| -> Vec<f64> {
        let mut x = vec![0.0; rest.len()];
        for &taxel in &alive {
            x[taxel] = sign * (frames[k][taxel] - rest[taxel]);
        }
        x
    };
    let middle = mean(alive.iter().map(|&taxel| rest[taxel]));
    let under_load = loaded.iter().map(|&k| alive.iter().map(move |&taxel| sign * frames[k][taxel]));
    let end = end_of_range(&under_load, sign * middle).map(|(end, _)| end);
    if let Some(end) = end {
        refuse_stuck(design, frames, &alive, sign * end)?;
    }
    let is_clipped = |k: usize| end.is_some_and(|end| alive.iter().any(|&taxel| sign * frames[k][taxel] >= end));
    let clipped = loaded.iter().filter(|&&k| is_clipped(k)).count();
    if let Some(end) = end {
        remarks.push(format!(
            "{} under load have readings at {}, the end of the converter's range, and are left out: what presses harder \
             cannot be told", counted(clipped, "frame"), sign * end + 0.0
        ));
    }
    // A reading that noise alone explains is none.
    let least = noise.map_or(0.0, |noise| 5.0 * noise);
    let mut silent = 0;
    let mut stretches: Vec<Stretch> = Vec::new();
    for &k in loaded.iter().filter(|&&k| !is_clipped(k)) {
        let x = above(k);
        let peak = x.iter().fold(0.0_f64, |peak, &x| peak.max(x));
        if peak <= least {
            silent += 1;
            continue;
        }
        let centre = centre(design, &x, peak);
        let label = measured.contacts.as_ref().map(|labels| labels[k].as_str());
        match stretches.last_mut() {
            Some(last) if last.frames.end == k && last.label == label && near(last.centre, centre) => {
                last.frames.end = k + 1;
            }
            _ => stretches.push(Stretch { frames: k..k + 1, centre, label }),
        }
    }
    if silent > 0 {
        remarks.push(format!(
            "{} under load read nothing and are left out: the contact missed the taxels, or fell between them",
            counted(silent, "frame")
        ));
    }
    if stretches.is_empty() {
        return Err((
            "no frame has a known load and readings within the range".to_owned(),
            "give the forces of some frames in which something presses".to_owned(),
        ));
    }
    let (places, of) = places(&stretches);
    let mut step = STEP;
    let holds = loop {
        let holds = holds(&stretches, &of, (&loads, measured), step, &above);
        if holds.len() <= MOST || step > 4.0 {
            break holds;
        }
        step *= 2.0;
    };
    Ok(Holds { all: holds, contacts: stretches.len(), places, rest, noise, sign, remarks })
}

/// Taxels that read `end`, the end of the converter, in nearly all frames leave no frame to fit to.
fn refuse_stuck(design: &Design, frames: &[Vec<f64>], alive: &[usize], end: f64) -> Result<(), Wrong> {
    let reads = |taxel: usize| frames.iter().filter(|frame| frame[taxel].total_cmp(&end).is_eq()).count();
    let is_stuck = |taxel: usize| reads(taxel) as f64 >= STUCK * frames.len() as f64;
    let stuck: Vec<usize> = alive.iter().copied().filter(|&taxel| is_stuck(taxel)).collect();
    let mut dead = [design.input.dead.clone(), stuck.clone()].concat();
    dead.sort_unstable();
    // With more of them it is the sensor that is wrong.
    if stuck.is_empty() || dead.len() > MOST_DEAD.min(design.sensor.taxels() / 2) {
        return Ok(());
    }
    let names = stuck.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    let [taxels, they] = if stuck.len() == 1 { ["taxel", "reads"] } else { ["taxels", "read"] };
    Err((
        format!("{taxels} {names} {they} {end}, the end of the converter's range, in nearly every frame"),
        format!("mend the sensor, or write dead = {dead:?} under [sensor]: the neighbours then take the place"),
    ))
}

struct Stretch<'a> {
    frames: Range<usize>,
    /// In pitches.
    centre: [f64; 2],
    label: Option<&'a str>,
}

/// Centre of pressure in pitches.
fn centre(design: &Design, x: &[f64], peak: f64) -> [f64; 2] {
    let columns = design.sensor.columns;
    let places = x.iter().enumerate().map(|(taxel, &x)| (x, [taxel % columns, taxel / columns].map(|at| at as f64)));
    numbers::centre(places.filter(|(x, _)| *x >= BESIDE * peak)).unwrap_or_default()
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) <= MOVED
}

/// The number of places, and the place of each stretch.
fn places(stretches: &[Stretch<'_>]) -> (usize, Vec<usize>) {
    let mut found: Vec<([f64; 2], Option<&str>)> = Vec::new();
    let of = stretches.iter().map(|stretch| {
        let known = found.iter().position(|&(centre, label)| match stretch.label {
            Some(_) => label == stretch.label,
            None => near(centre, stretch.centre),
        });
        known.unwrap_or_else(|| {
            found.push((stretch.centre, stretch.label));
            found.len() - 1
        })
    });
    let of: Vec<usize> = of.collect();
    (found.len(), of)
}

fn holds(
    stretches: &[Stretch<'_>],
    places: &[usize],
    (loads, measured): (&[Option<f64>], &Measured),
    step: f64,
    above: &dyn Fn(usize) -> Vec<f64>,
) -> Vec<Hold> {
    let load = |k: usize| loads[k].unwrap_or_default();
    let differs = |a: usize, b: usize| {
        let apart = (0..2).map(|axis| match (measured.forces[a][axis], measured.forces[b][axis]) {
            (Some(a), Some(b)) => (a - b).powi(2),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        });
        (apart.sum::<f64>() + (load(a) - load(b)).powi(2)).sqrt() > step * load(a)
    };
    let mut holds = Vec::new();
    for (contact, stretch) in stretches.iter().enumerate() {
        let mut first = stretch.frames.start;
        while first < stretch.frames.end {
            let end = (first + 1..stretch.frames.end).find(|&k| differs(first, k)).unwrap_or(stretch.frames.end);
            let frames = first..end;
            let count = frames.len() as f64;
            let readings: Vec<Vec<f64>> = frames.clone().map(above).collect();
            let x = (0..readings[0].len()).map(|taxel| mean(readings.iter().map(|x| x[taxel]))).collect();
            let force = |axis: usize| {
                frames.clone().map(|k| measured.forces[k][axis]).sum::<Option<f64>>().map(|sum| sum / count)
            };
            let fifths = |values: Vec<f64>| {
                let (fifth, sum) = (values.len() / 5, values.iter().sum::<f64>());
                let share = |part: &[f64]| part.iter().sum::<f64>() * count / (fifth as f64 * sum);
                [0, 1, 2, 3, 4].map(|number| share(&values[number * fifth..][..fifth]))
            };
            let is_constant = || {
                let loads = fifths(frames.clone().map(load).collect());
                loads.iter().all(|share| (share - loads[0]).abs() <= CONSTANT)
            };
            let creep = (frames.len() >= CREEPS && is_constant()).then(|| {
                let [first, .., last] = fifths(readings.iter().map(|x| x.iter().sum()).collect());
                last - first
            });
            holds.push(Hold {
                x,
                force: [0, 1, 2].map(force),
                load: mean(frames.clone().map(load)),
                contact,
                place: places[contact],
                creep,
                frames,
            });
            first = end;
        }
    }
    holds
}
