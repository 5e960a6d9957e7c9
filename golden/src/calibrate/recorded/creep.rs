//! Creep of a sensor, from a recording of a constant load.

use serde::Serialize;

use crate::creep::{Creep, FRAMES};
use crate::design::Design;
use crate::frames::Frames;
use crate::numbers::{counted, magnitude, mean, middle, rounded};

/// Time constants that a fit tries, a ratio apart.
const TRIED: i32 = 1000;
/// Seconds in which the weight is put down, at most.
const SETTLES: f64 = 1.0;
/// Share of the largest reading at which this begins: creep may be several times the load.
const BEGINS: f64 = 0.1;
/// Seconds within which readings rise by less than a tenth once the weight lies; half of them are waited for.
const WINDOW: f64 = 0.2;
/// Fewest frames of constant load.
const FEWEST: usize = 20;
/// Without load readings change by less than this share of the load.
const RESTS: f64 = 0.02;
/// Rise of readings below which there is nothing to correct.
const LEAST_RISE: f64 = 0.01;
/// Frames or seconds, whichever is more, by which times may differ from even ones.
const UNEVEN: [f64; 2] = [3.0, 0.1];
/// Seconds from frame to frame from which on times without a unit may be milliseconds.
const LONG: f64 = 0.5;
/// Significant digits that are written.
const DIGITS: i32 = 4;

/// Takes creep off the values of a recording, so that they are those of a design without it. What the first frame reads
/// counts as long there.
pub fn remove_creep(creep: &Creep, design: &Design, frames: &mut [Vec<f64>]) {
    let Some(first) = frames.first().cloned() else { return };
    let mut past = Vec::new();
    for frame in frames {
        let stress = |taxel: usize, frame: &[f64]| design.input.to_pa(taxel, frame[taxel]);
        let mut change: Vec<f64> = (0..frame.len()).map(|taxel| stress(taxel, frame) - stress(taxel, &first)).collect();
        creep.remove(&mut past, &mut change, f64::INFINITY);
        for taxel in (0..frame.len()).filter(|taxel| !design.input.dead.contains(taxel)) {
            frame[taxel] = design.input.from_pa(taxel, change[taxel] + stress(taxel, &first));
        }
    }
}

/// Creep found in a recording.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fitted {
    /// What was found.
    pub creep: Creep,
    /// Seconds of constant load.
    pub held_s: f64,
    /// Share by which the readings rose in that time.
    pub rise: f64,
    /// Standard deviation of the corrected readings under the load, as a share of their mean.
    pub residual_share: f64,
    /// Shortest time constant that the recording can determine.
    #[serde(skip)]
    shortest_s: f64,
}

impl Fitted {
    /// Refuses creep that cannot be corrected. A fit between others may find such with a curve that is not yet right.
    ///
    /// # Errors
    ///
    /// Strength or time constant beyond their limits.
    pub fn check(&self) -> Result<(), String> {
        let Self { creep: Creep { strength, seconds, frames_per_second }, rise, shortest_s, .. } = *self;
        let most = FRAMES[1] / frames_per_second;
        if seconds > shortest_s && strength <= 1.0 && seconds <= most {
            return Ok(());
        }
        Err(format!(
            "the readings rise by {:.0} % with a time constant of {seconds:.2} s: what can be corrected is 100 %, and \
             {shortest_s:.2} to {most:.0} s",
            100.0 * rise
        ))
    }
}

/// Mean seconds from frame to frame of a recording.
///
/// # Errors
///
/// As [`interval`]. No times, times that cannot be read, and long ones without a unit.
pub fn interval_of(recording: &Frames) -> Result<f64, String> {
    let Frames { times, clock, .. } = recording;
    match (times, clock) {
        (None, None) => {
            Err("no column of times: name one before the values in the header, `time (s)` or `t (ms)`".to_owned())
        }
        (None, Some(clock)) => Err(format!(
            "column {}, {}, holds no time that is understood: give numbers and name their unit, `time (s)` or `t (ms)`, or \
             2026-03-01T12:00:00.5",
            clock.column, clock.name
        )),
        (Some(times), clock) => match (interval(times)?, clock) {
            (long, Some(clock)) if long >= LONG && !clock.has_unit => Err(format!(
                "column {}, {}, without a unit would be {} s from frame to frame: name the unit, `time (ms)` or `time (s)`",
                clock.column,
                clock.name,
                rounded(long, DIGITS)
            )),
            (interval, _) => Ok(interval),
        },
    }
}

/// Mean seconds from frame to frame, from their times in seconds. Clocks may be coarse, and single frames may be missing.
///
/// # Errors
///
/// A gap, another rate, times that fall, or fewer than two: what is wrong and what to do.
pub fn interval(times: &[f64]) -> Result<f64, String> {
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let interval = steps().sum::<f64>() / steps().len() as f64;
    if !(interval > 0.0 && interval.is_finite()) {
        return Err("its times do not rise from frame to frame".to_owned());
    }
    let allowed = (UNEVEN[0] * middle(steps())).max(UNEVEN[1]);
    let uneven = times.iter().enumerate().any(|(n, time)| (time - times[0] - interval * n as f64).abs() > allowed);
    let back = steps().enumerate().find(|(_, step)| *step < 0.0);
    let gap = || steps().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| uneven);
    match back.or_else(gap) {
        Some((before, step)) => Err(format!(
            "{step:.3} s pass after frame {}, where the mean is {interval:.3} s: record at one rate, without gaps",
            before + 1
        )),
        None => Ok(interval),
    }
}

/// Finds strength and time constant from a step of load. `sums` are those of each frame's stresses in any unit, `seconds`
/// apart; the first frames have no load.
///
/// # Errors
///
/// What the recording lacks and what to do.
pub fn fit(sums: &[f64], seconds: f64) -> Result<Fitted, String> {
    let first = sums.first().copied().unwrap_or(0.0);
    let [window, margin, most] = [WINDOW, 0.5 * WINDOW, SETTLES].map(|time| (time / seconds).ceil() as usize);
    let loads = || sums.iter().map(|sum| (sum - first).abs());
    let largest = magnitude(loads());
    // The load itself is what readings reach before they creep.
    let half = 0.5 * magnitude(loads().skip_while(|load| *load < BEGINS * largest).take(most + 1));
    let loaded = |sum: &f64| (sum - first).abs() > half;
    let begin = sums.iter().position(loaded).unwrap_or(sums.len());
    let end = begin + sums[begin..].iter().position(|sum| !loaded(sum)).unwrap_or(sums.len() - begin);
    // The weight's way down is neither unloaded nor constant.
    let unloaded = &sums[..begin.div_ceil(2)];
    let level = mean(unloaded);
    let steady = |pair: &[f64]| (pair[window] - level).abs() < 1.1 * (pair[0] - level).abs();
    let steady_from = sums[begin..end].windows(window + 1).position(steady).unwrap_or(end - begin);
    let settled = end.min(begin + steady_from + margin);
    let held: Vec<f64> = sums[settled..end].iter().map(|sum| (sum - level).abs()).collect();
    if begin == 0 || held.len() < FEWEST {
        return Err(format!(
            "{} without load, then {} of constant load: begin without, put a weight down within {SETTLES} s, \
             and leave it for a minute",
            counted(begin, "frame"),
            held.len()
        ));
    }
    let (early, late) = unloaded.split_at(unloaded.len() / 2);
    if !early.is_empty() && (mean(early) - mean(late)).abs() > RESTS * mean(&held) {
        return Err(
            "the readings change before the load: begin when nothing has touched for five time constants".to_owned()
        );
    }
    if steady_from > most {
        return Err(format!(
            "the readings rise for more than {SETTLES} s before they creep: put the weight down faster"
        ));
    }
    let (held_s, waited) = (seconds * held.len() as f64, settled - begin);
    let shortest = FRAMES[0].max(waited as f64);
    let ratio = (3.0 * held.len() as f64 / shortest).max(1.0).powf(1.0 / f64::from(TRIED));
    let tried = (0..=TRIED).map(|step| strength(&held, waited, shortest * ratio.powi(step)));
    let (_, frames, strength) = tried.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, shortest, 0.0));
    let creep = Creep {
        strength: rounded(strength, DIGITS),
        seconds: rounded(seconds * frames, DIGITS),
        frames_per_second: rounded(1.0 / seconds, DIGITS),
    };
    let rise = strength * (1.0 - (-(held.len() as f64) / frames).exp());
    let percent = 100.0 * rise.abs();
    if rise < LEAST_RISE {
        let way = if rise < 0.0 { "fall" } else { "rise" };
        return Err(format!("the readings {way} by {percent:.1} % in {held_s:.1} s: there is no creep to correct"));
    }
    if frames > held.len() as f64 {
        return Err(format!("the readings still rise after {held_s:.1} s: leave the load for three times as long"));
    }
    let shape = |n: usize| creep.strength * (1.0 - (-(n as f64) / frames).exp());
    let corrected: Vec<f64> = held.iter().zip(waited..).map(|(sum, n)| sum / (1.0 + shape(n))).collect();
    let residual_share = spread(&corrected);
    if 2.0 * residual_share > spread(&held) {
        return Err(format!(
            "one time constant leaves {:.1} % of a change by {:.1} %: this sensor's creep is of another kind, or the load moved",
            100.0 * residual_share,
            100.0 * spread(&held)
        ));
    }
    Ok(Fitted { creep, held_s, rise, residual_share, shortest_s: rounded(seconds * shortest, DIGITS) })
}

/// Squared error, time constant and strength: least squares of the strength for a time constant in frames. The first of
/// the sums has crept for `waited` frames.
fn strength(sums: &[f64], waited: usize, frames: f64) -> (f64, f64, f64) {
    let shape = |n: usize| -(-(n as f64) / frames).exp_m1();
    // A frame alone is noisy.
    let some = waited.clamp(1, sums.len());
    let first = mean(&sums[..some]);
    let of_first = (0..some).map(|n| shape(waited + n)).sum::<f64>() / some as f64;
    let points = || sums.iter().zip(waited..).map(|(sum, n)| (sum / first - 1.0, shape(n) - of_first * sum / first));
    let [cross, square] = points().fold([0.0; 2], |[cross, square], (y, x)| [cross + x * y, square + x * x]);
    let strength = cross / square;
    (points().map(|(y, x)| (y - strength * x).powi(2)).sum(), frames, strength)
}

/// Standard deviation over the mean.
fn spread(values: &[f64]) -> f64 {
    let middle = mean(values);
    (values.iter().map(|value| (value - middle).powi(2)).sum::<f64>() / values.len() as f64).sqrt() / middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creep::tests::{CREEP, readings};

    /// So many frames, from the tenth second on under a load that is put down within so many frames.
    fn step(frames: usize, ramp: usize) -> Vec<f64> {
        let load = |n: usize| if n < 200 { 0.0 } else { -700.0 * ((n - 199) as f64 / ramp as f64).min(1.0) };
        (0..frames).map(load).collect()
    }

    /// However the weight is put down, whatever is read without it, with noise.
    #[test]
    fn a_step_of_load_tells_strength_and_time() {
        for (ramp, level, noise) in
            [(1, 0.0, 0.0), (2, 0.0, 0.0), (10, 0.0, 0.0), (20, 0.0, 0.0), (1, -80.0, 0.0), (1, 0.0, 2.0)]
        {
            let mut read = readings(&CREEP, &step(1500, ramp));
            for (n, read) in read.iter_mut().enumerate() {
                *read += level + noise * ((n * 7919 % 101) as f64 / 50.0 - 1.0);
            }
            let found = fit(&read, 0.05).unwrap();
            assert!((found.creep.strength - 0.4).abs() < 0.02, "{ramp} {level} {noise}: {found:?}");
            assert!((found.creep.seconds - 10.0).abs() < 0.5, "{ramp} {level} {noise}: {found:?}");
            assert!((found.creep.frames_per_second - 20.0).abs() < 1e-9, "{found:?}");
            assert!(found.residual_share < 0.01, "{found:?}");
        }
    }

    #[test]
    fn a_recording_that_does_not_tell_is_refused() {
        let creep = readings(&CREEP, &step(1500, 1));
        let with = |strength: f64, seconds: f64| readings(&Creep { strength, seconds, ..CREEP }, &step(1500, 1));
        // The weight is moved; it takes half a minute to come down.
        let moved: Vec<f64> = creep.iter().enumerate().map(|(n, sum)| if n > 700 { 0.7 * sum } else { *sum }).collect();
        for (sums, said) in [
            (creep[200..].to_vec(), "change before the load"),
            (readings(&CREEP, &step(1500, 50)), "put the weight down faster"),
            (readings(&CREEP, &step(1500, 120)), "put the weight down faster"),
            (creep[..220].to_vec(), "of constant load"),
            (creep[..270].to_vec(), "still rise after"),
            (step(1500, 1), "no creep to correct"),
            (step(1500, 1).iter().enumerate().map(|(n, sum)| sum * (1.0 - 1e-4 * n as f64)).collect(), "fall by"),
            (with(1.2, 10.0), "can be corrected"),
            (with(3.0, 10.0), "can be corrected"),
            (with(0.4, 0.1), "can be corrected"),
            (moved, "the load moved"),
            (Vec::new(), "0 frames without load"),
        ] {
            let refusal = fit(&sums, 0.05).and_then(|found| found.check()).unwrap_err();
            assert!(refusal.contains(said), "{said}: {refusal}");
        }
        // What rounds of fits begin with may be more than what they end with.
        assert!(fit(&with(3.0, 10.0), 0.05).unwrap().creep.strength > 1.0);
    }

    #[test]
    fn frames_come_evenly_or_are_refused() {
        for (times, said) in [
            (&[0.0, 0.1, 0.2, 10.3, 10.4][..], "after frame 3"),
            (&[0.0, 0.1, 0.05, 0.2, 0.3], "after frame 2"),
            (&[3.0, 2.0, 1.0], "do not rise"),
            (&[0.0, f64::NAN, 0.2], "do not rise"),
            (&[1.0], "do not rise"),
        ] {
            let refusal = interval(times).unwrap_err();
            assert!(refusal.contains(said), "{refusal}");
        }
        let late = |rate: f64, from: usize, frames: f64| -> Vec<f64> {
            (0..2000).map(|n| (n as f64 + if n < from { 0.0 } else { frames }) / rate).collect()
        };
        for (rate, frames) in [(10.0, 2.0), (1000.0, 90.0)] {
            interval(&late(rate, 1999, frames)).unwrap();
            for from in [500, 1000, 1999] {
                let refusal = interval(&late(rate, from, 4.0 * frames)).unwrap_err();
                assert!(refusal.contains(&format!("after frame {from},")), "{refusal}");
            }
        }
        // Half of the time at twice the rate.
        let faster: Vec<f64> =
            (0..2000).map(|n| 0.01 * if n < 1000 { f64::from(n) } else { 500.0 + 0.5 * f64::from(n) }).collect();
        assert!(interval(&faster).unwrap_err().contains("at one rate"));
    }

    /// Clocks of whole milliseconds, frames that come in batches, and one that was left out.
    #[test]
    fn times_tell_the_rate_however_coarse_they_are() {
        let milliseconds = |rate: f64| (0..3000).map(|n| (1e3 * f64::from(n) / rate).round() / 1e3).collect();
        let batches = (0..3000).map(|n| f64::from(n / 8 * 8) / 250.0).collect();
        let left_out = (0..3000).filter(|n| *n != 700).map(|n| f64::from(n) / 20.0).collect();
        for (rate, times) in
            [(300.0, milliseconds(300.0)), (900.0, milliseconds(900.0)), (250.0, batches), (20.0, left_out)]
        {
            let times: Vec<f64> = times;
            let found = 1.0 / interval(&times).unwrap();
            assert!((found / rate - 1.0).abs() < 0.003, "{found} {rate}");
        }
    }

    /// Counts with offsets, of a load that comes and goes.
    #[test]
    fn a_recording_is_freed_of_creep() {
        let text = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 2\nrows = 2\n\
                    pitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\npa_per_count = -2.0\ndead = [1]\n";
        let design = Design::from_toml(text, "pad.toml").unwrap();
        let loads: Vec<f64> = (0..400).map(|n| if n % 150 < 50 { 0.0 } else { 300.0 }).collect();
        let read = readings(&CREEP, &loads);
        let mut frames: Vec<Vec<f64>> = read.iter().map(|read| vec![40.0 + read, f64::NAN, 50.0 - read, 7.0]).collect();
        remove_creep(&CREEP, &design, &mut frames);
        for (frame, load) in frames.iter().zip(loads) {
            let expected = [40.0 + load, f64::NAN, 50.0 - load, 7.0];
            for taxel in [0, 2, 3] {
                assert!((frame[taxel] - expected[taxel]).abs() < 1e-9, "{frame:?} {expected:?}");
            }
            assert!(frame[1].is_nan(), "a dead taxel reads what it reads");
        }
    }
}
