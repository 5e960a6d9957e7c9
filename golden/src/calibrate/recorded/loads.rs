//! What pressed in each frame, what the taxels read without load, and where the converter ends.

use std::ops::Range;

use super::lag::{self, Lags, Parts, Unclear};
use super::table::{Measured, Pairing};
use crate::design::Design;
use crate::numbers::{counted, magnitude, mean, middle, sorted};

/// Loads below this share of the largest are rest.
pub(super) const REST: f64 = 0.01;
/// Lines of the forces may be so much more or fewer than the frames.
const LENGTHS: f64 = 0.1;
/// A lag is worse than the best if it leaves so many times its variance, and clearly worse with the second.
const APART: [f64; 2] = [2.0, 16.0];
/// What is wrong with a recording, and what to do.
pub(super) type Wrong = (String, String);

/// Which frames have a counterpart, what was measured with each, and what is to be known of it.
pub(super) type Pairs = (Range<usize>, Measured, Vec<String>);

/// What the frames are compared with to pair them.
pub(super) enum Follow {
    /// Their sum with `F_z`.
    Forces,
    /// Their sum with the pressures.
    Pressures,
    /// The forces that the design finds along x and y, with those that were measured.
    Sideways(Vec<[f64; 3]>),
}

impl Follow {
    /// What the frames read, and what was measured.
    fn logs(&self, design: &Design, frames: &[Vec<f64>], measured: &Measured) -> (Vec<f64>, Vec<Option<f64>>) {
        let is_alive = |(taxel, _): &(usize, &f64)| !design.input.dead.contains(taxel);
        let sum = |frame: &Vec<f64>| frame.iter().enumerate().filter(is_alive).map(|(_, value)| value).sum();
        let along = |axis: usize| measured.forces.iter().map(|force| force[axis]).collect::<Vec<_>>();
        let largest = |axis: usize| magnitude(along(axis).iter().flatten());
        match self {
            Self::Forces => (frames.iter().map(sum).collect(), along(2)),
            Self::Pressures => (frames.iter().map(sum).collect(), measured.pressures.clone()),
            Self::Sideways(found) => {
                let axis = usize::from(largest(1) > largest(0));
                (found.iter().map(|found| found[axis]).collect(), along(axis))
            }
        }
    }

    /// The sign of their correlation by the design and the file's own sign of what presses; nothing if none can be told.
    fn sign(&self, design: &Design, loads: &[Option<f64>]) -> Option<f64> {
        if let Self::Sideways(_) = self {
            return Some(1.0);
        }
        let input = &design.input;
        let alive = (0..design.sensor.taxels()).filter(|taxel| !input.dead.contains(taxel));
        // Both ends: a curve of the wrong sign has none of what presses.
        let largest = design.hardware.full_scale_pa;
        let rise = alive.map(|taxel| input.from_pa(taxel, -largest) - input.from_pa(taxel, largest));
        let sign = rise.filter(|rise| rise.is_finite()).sum::<f64>() * presses(loads.iter().flatten());
        (sign != 0.0).then(|| sign.signum())
    }
}

/// The sign that a file gives to what presses.
fn presses<'a>(known: impl Iterator<Item = &'a f64>) -> f64 {
    known.sum::<f64>().signum()
}

/// By how many frames the loads come late, and the sign of their correlation with the readings, `sign` being expected.
///
/// # Errors
///
/// Why none can be told.
fn lag_of(
    readings: &[f64],
    loads: &[Option<f64>],
    pairing: Pairing,
    is_sideways: bool,
    sign: Option<f64>,
) -> Result<(isize, Option<f64>), String> {
    // One clock says what belongs together, whatever the sign.
    let sign = sign.filter(|_| pairing != Pairing::Clock);
    let Some(lags) = Lags::of(readings, loads, APART, sign) else {
        return match pairing {
            Pairing::Apart => Err("their clocks differ, and no lag explains what the frames read".to_owned()),
            // Frames that are too few tell nothing.
            Pairing::Lines if is_sideways && readings.len() >= lag::FRAMES => {
                Err("no F_z is known, and the F_x and F_y that the design finds do not follow them".to_owned())
            }
            _ => Ok((0, sign)),
        };
    };
    // Unless it does not fit at all.
    if pairing == Pairing::Clock {
        return lags.far_better().map_or(Ok((0, None)), |lag| {
            Err(format!("by their times they do not fit, and {} would: do their clocks differ?", together(lag)))
        });
    }
    // Files of one length hardly begin far apart.
    let is_near = readings.len() == loads.len() && pairing != Pairing::Apart;
    let around_zero = if is_near { lags.best_around_zero() } else { None };
    let best = lags.best().or_else(|Unclear { best, other, is_turned }| {
        let [best, other] = [best, other].map(together);
        around_zero.ok_or_else(|| {
            if is_turned {
                format!("{best} fits the loads nearly as well as {other} with the sign turned")
            } else {
                format!("{other} fits the loads nearly as well as {best}")
            }
        })
    })?;
    Ok((best, lags.sign))
}

/// Frames and lines of the forces, or of a bladder's pressures, one for one. Where they do not begin together, the lag is
/// found.
pub(super) fn pair(design: &Design, frames: &[Vec<f64>], measured: &Measured, follow: &Follow) -> Result<Pairs, Wrong> {
    let what = if matches!(follow, Follow::Pressures) { "pressures" } else { "forces" };
    let (count, lines) = (frames.len(), measured.forces.len());
    let apart = count.abs_diff(lines);
    if apart as f64 > LENGTHS * count as f64 {
        return Err((
            format!("{count} frames and {lines} lines of {what}"),
            "give one line for each frame; leave blank what is unknown".to_owned(),
        ));
    }
    let (readings, loads) = follow.logs(design, frames, measured);
    let (clock, remedy) = match measured.pairing {
        Pairing::Lines => {
            (false, "give both files a column of times, or cut them so that both begin with the same touch")
        }
        _ => (true, "give both files the same clock"),
    };
    let unclear = |why: String| {
        (format!("frames and loads do not begin together, or frames are missing: {why}"), remedy.to_owned())
    };
    let is_sideways = matches!(follow, Follow::Sideways(_));
    let sign = follow.sign(design, &loads);
    let (lag, sign) = lag_of(&readings, &loads, measured.pairing, is_sideways, sign).map_err(unclear)?;
    let lost = |place: usize, count: isize| {
        let lost = match count {
            1 => "1 frame is".to_owned(),
            -1 => format!("1 line of {what} is"),
            2.. => format!("{count} frames are"),
            _ => format!("{} lines of {what} are", -count),
        };
        let problem = format!("about frame {place}, {lost} missing");
        Err((problem, "give both files a column of times, or cut them there".to_owned()))
    };
    if apart > 0
        && (lag == 0 || lag.unsigned_abs() == apart)
        && let Some(place) = lag::lost(&readings, &loads)
    {
        return lost(place + 1, lines as isize - count as isize);
    }
    let skip = |frames: isize| usize::try_from(frames).unwrap_or(0);
    let (first, from) = (skip(-lag), skip(lag));
    let both = (count - first).min(lines - from);
    let parts = Parts::of(&readings[first..][..both], &loads[from..][..both], sign);
    if let Some((place, count)) = parts.missing().filter(|_| !clock) {
        return lost(first + place + 1, count);
    }
    if lag != 0 && parts.most_differ() {
        return Err(unclear(format!("{} fits best, but not most parts of the recording", together(lag))));
    }
    let mut remarks = Vec::new();
    if lag != 0 {
        remarks.push(format!(
            "frames and loads do not begin together: they are paired by what fits best, {}; {} and {} have no counterpart",
            together(lag),
            counted(count - both, "frame"),
            counted(lines - both, "line")
        ));
    } else if apart > 0 {
        remarks.push(format!(
            "{count} frames and {lines} lines of {what}: paired from the first on, the last {apart} left out; check that the \
             first belong together"
        ));
    }
    let mut measured = measured.clone();
    measured.forces = measured.forces.iter().skip(from).take(both).copied().collect();
    measured.pressures = measured.pressures.iter().skip(from).take(both).copied().collect();
    measured.contacts = measured.contacts.map(|names| names.into_iter().skip(from).take(both).collect());
    Ok((first..first + both, measured, remarks))
}

/// Which frame and line belong together.
fn together(lag: isize) -> String {
    let first = lag.unsigned_abs() + 1;
    if lag < 0 { format!("line 1 to frame {first}") } else { format!("line {first} to frame 1") }
}

/// What presses in each frame, whatever the sign of the file.
pub(super) fn loads(measured: &Measured, remarks: &mut Vec<String>) -> Result<Vec<Option<f64>>, Wrong> {
    let known: Vec<f64> = measured.forces.iter().filter_map(|force| force[2]).collect();
    let largest = magnitude(&known);
    if largest <= 0.0 {
        return Err((
            "no normal force other than 0 is known".to_owned(),
            "give F_z of some frames: weights do, in newtons or grams".to_owned(),
        ));
    }
    let sign = presses(known.iter());
    if sign > 0.0 {
        remarks.push("F_z is positive in the file: taken for what presses".to_owned());
    }
    let against = known.iter().filter(|&&force| -sign * force > REST * largest).count();
    if against > 0 {
        remarks.push(format!("{} with an F_z that pulls left out", counted(against, "frame")));
    }
    Ok(measured
        .forces
        .iter()
        .map(|force| force[2].map(|force| sign * force).filter(|&load| load > -REST * largest))
        .collect())
}

/// The readings without load, of a dead taxel the middle one, and their noise.
pub(super) fn rest(
    design: &Design,
    frames: &[Vec<f64>],
    at_rest: &[usize],
    remarks: &mut Vec<String>,
) -> (Vec<f64>, Option<f64>) {
    let taxels = design.sensor.taxels();
    let is_alive = |taxel: &usize| !design.input.dead.contains(taxel);
    let alive: Vec<usize> = (0..taxels).filter(is_alive).collect();
    if at_rest.is_empty() {
        let rest: Vec<f64> = (0..taxels).map(|taxel| design.input.from_pa(taxel, 0.0)).collect();
        // What a taxel reads at its least loaded is its rest, if every taxel was unloaded once.
        let least =
            |taxel: usize| frames.iter().map(|frame| (frame[taxel] - rest[taxel]).abs()).fold(f64::INFINITY, f64::min);
        let counts = frames.iter().flat_map(|frame| alive.iter().map(|&taxel| frame[taxel]));
        let middle = middle(alive.iter().map(|&taxel| least(taxel)));
        if middle > 0.02 * magnitude(counts) {
            remarks.push(format!(
                "no frame has a force of 0, and half of the taxels never read less than {middle:.0} counts: is the tare \
                 missing? Record some frames without load and give them the force 0"
            ));
        } else {
            remarks.push("no frame has a force of 0: the offsets stay as the design has them".to_owned());
        }
        return (of_all(&rest, &alive), None);
    }
    let middles: Vec<f64> = (0..taxels)
        .map(|taxel| {
            let counts = sorted(at_rest.iter().map(|&k| frames[k][taxel]));
            // Of whole counts a median loses what the mean of the middle half keeps.
            let middle = &counts[counts.len() / 4..counts.len() - counts.len() / 4];
            mean(middle)
        })
        .collect();
    let noise = (at_rest.len() >= 5).then(|| {
        let of = |taxel: usize| mean(at_rest.iter().map(|&k| (frames[k][taxel] - middles[taxel]).abs()));
        1.25 * alive.iter().map(|&taxel| of(taxel)).sum::<f64>() / alive.len() as f64
    });
    (of_all(&middles, &alive), noise)
}

/// The readings of those that are alive, and the middle one in the place of others.
fn of_all(rest: &[f64], alive: &[usize]) -> Vec<f64> {
    let mut all = vec![middle(alive.iter().map(|&taxel| rest[taxel])); rest.len()];
    for &taxel in alive {
        all[taxel] = rest[taxel];
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(loads: &[f64]) -> Measured {
        Measured::of_forces(loads.iter().map(|&load| [None, None, Some(-load)]).collect())
    }

    /// What pairing says of frames that read `reading` of a load each, if these were measured.
    fn paired(readings: &[f64], loads: &[f64]) -> Result<Vec<String>, Wrong> {
        pair_all(readings, &measured(loads))
    }

    /// The same of what was measured.
    fn pair_all(readings: &[f64], measured: &Measured) -> Result<Vec<String>, Wrong> {
        let text = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 2\nrows = 2\n\
                    pitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\npa_per_count = -2.0\n";
        let design = Design::from_toml(text, "pad.toml").unwrap();
        let frames: Vec<Vec<f64>> = readings.iter().map(|&reading| vec![reading; 4]).collect();
        pair(&design, &frames, measured, &Follow::Forces).map(|(_, _, remarks)| remarks)
    }

    /// Between -1 and 1.
    fn random(n: usize) -> f64 {
        let bits = (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        ((bits ^ (bits >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) as f64 / f64::from(1 << 23) - 1.0
    }

    /// Touches of 4 to 13 frames, and as many of rest.
    fn touches(count: usize) -> Vec<f64> {
        let mut loads = Vec::new();
        while loads.len() < count {
            let [load, held, rest] = [0, 1, 2].map(|k| 1.0 + random(3 * loads.len() + k));
            loads.extend(vec![2.0 + load; 4 + (5.0 * held) as usize]);
            loads.extend(vec![0.0; 4 + (5.0 * rest) as usize]);
        }
        loads
    }

    /// Whichever file lacks what, wherever, and also if the files do not begin together.
    #[test]
    fn what_is_missing_is_told_by_file_number_and_frame() {
        for (place, lost, begin) in [
            (0.5, 10, 0),
            (0.3, 3, 0),
            (0.7, 10, 0),
            (0.7, 1, 0),
            (0.7, 5, 20),
            (0.15, 10, 0),
            (0.85, 10, 0),
            (0.85, 3, 20),
        ] {
            let all = touches(1600);
            let at = (place * all.len() as f64) as usize;
            let mut some = all.clone();
            some.drain(at..at + lost);
            for of_frames in [true, false] {
                let cut = |values: &[f64]| values[begin..].to_vec();
                let (readings, loads) = if of_frames { (cut(&some), all.clone()) } else { (all.clone(), cut(&some)) };
                let (problem, remedy) = paired(&readings, &loads).unwrap_err();
                let what = match (of_frames, lost) {
                    (true, 1) => "1 frame is missing",
                    (true, _) => &format!("{lost} frames are missing"),
                    (false, 1) => "1 line of forces is missing",
                    (false, _) => &format!("{lost} lines of forces are missing"),
                };
                assert!(problem.contains(what) && remedy.contains("column of times"), "{lost} {begin}: {problem}");
                let said: f64 = problem.split(' ').nth(2).unwrap().trim_end_matches(',').parse().unwrap();
                let expected = (at - if of_frames { begin } else { 0 }) as f64;
                assert!((said - expected).abs() < 1600.0 / 8.0, "{lost} {begin}: {problem}, not {expected}");
            }
        }
    }

    /// Such as that of the air.
    #[test]
    fn a_column_of_pressures_beside_forces_is_not_the_load() {
        let loads = touches(1600);
        let mut measured = measured(&loads);
        measured.pressures = vec![Some(101_325.0); loads.len()];
        let remarks = pair_all(&loads[20..], &measured).unwrap();
        assert!(remarks.iter().any(|remark| remark.contains("line 21 to frame 1")), "{remarks:?}");
    }

    /// Touches that are alike, with a strength of their own, `period` frames apart.
    fn periodic(count: usize, period: usize) -> Vec<f64> {
        let load = |n: usize| {
            let [touch, at] = [n / period, n % period];
            let turn = (at as f64 / (0.4 * period as f64) - 0.625) * std::f64::consts::PI;
            if turn > 0.0 && turn < std::f64::consts::PI { (1.25 + 0.25 * random(touch)) * turn.sin() } else { 0.0 }
        };
        (0..count).map(load).collect()
    }

    /// Of periodic touches a whole period off fits well, and most of all where frames are missing.
    #[test]
    fn periodic_touches_are_paired_by_a_clock_or_refused() {
        let loads = periodic(1600, 200);
        let noise = |n: usize| 0.02 * random(n + 5000);
        let mut lossy: Vec<f64> = (0..1600).map(|n| 5.0 * loads[n] + noise(n)).collect();
        assert_eq!(paired(&lossy, &loads).unwrap(), [""; 0]);
        lossy.drain(320..350);
        let (problem, remedy) = paired(&lossy, &loads).unwrap_err();
        assert!(problem.contains("nearly as well as") && remedy.contains("column of times"), "{problem}");
        // Creep delays the readings: what fits best is not what one clock says.
        let mut creep = 0.0;
        let creeping: Vec<f64> = (0..800)
            .map(|n| {
                let load = periodic(800, 160)[n];
                let reading = load + creep;
                creep += (0.4 * load - creep) / 60.0;
                5.0 * reading + noise(n)
            })
            .collect();
        let loads = periodic(800, 160);
        let times: Vec<f64> = (0..800).map(|n| 0.01 * f64::from(n)).collect();
        for (begin, late) in [(1e9, 0), (0.0, 25)] {
            let clock = |n: usize| begin + times[n];
            let measured = Measured { times: Some((0..800 - late).map(clock).collect()), ..measured(&loads[late..]) };
            let frames: Vec<f64> = (0..800).map(clock).collect();
            let found = pair_all(&creeping, &measured.at(&frames).unwrap());
            match late {
                0 => assert_eq!(found.unwrap(), [""; 0]),
                _ => assert!(found.unwrap_err().1.contains("the same clock")),
            }
        }
    }

    /// Half a period late a sine looks as if the sign were turned, which the design knows.
    #[test]
    fn a_sign_is_turned_only_where_no_lag_has_the_right_one() {
        let noise = |n: usize| 0.05 * random(n + 5000);
        let sine = |n: usize| 1.0 - (n as f64 * std::f64::consts::TAU / 60.0).cos();
        let loads: Vec<f64> = (0..600).map(sine).collect();
        let read = |factor: f64, loads: &[f64], late: usize| -> Vec<f64> {
            (0..600).map(|n| factor * loads[(n + late) % loads.len()] + noise(n)).collect()
        };
        assert_eq!(paired(&read(5.0, &loads, 0), &loads).unwrap(), [""; 0]);
        for (factor, late) in [(5.0, 30), (-5.0, 0)] {
            let (problem, remedy) = paired(&read(factor, &loads, late), &loads).unwrap_err();
            let turned = "fits the loads nearly as well as line 1 to frame 1 with the sign turned";
            assert!(problem.contains(turned), "{problem}");
            assert!(remedy.contains("column of times"), "{remedy}");
        }
        // One clock, or loads that do not repeat, leave the sign to the readings.
        let clock = Measured { pairing: Pairing::Clock, ..measured(&loads) };
        assert_eq!(pair_all(&read(-5.0, &loads, 0), &clock).unwrap(), [""; 0]);
        let loads = touches(600)[..600].to_vec();
        assert_eq!(paired(&read(-5.0, &loads, 0), &loads).unwrap(), [""; 0]);
        let remarks = paired(&read(-5.0, &loads, 20)[..580], &loads).unwrap();
        assert!(remarks.iter().any(|remark| remark.contains("line 21 to frame 1")), "{remarks:?}");
    }

    /// A logger that is a little late all the time, as one part alone tells that is faster than the others.
    #[test]
    fn a_constant_delay_is_none_that_are_missing() {
        let load = |n: usize| {
            let turns = if n < 700 { n as f64 / 100.0 } else { n as f64 / 20.0 };
            let swing = if n < 700 { 1.0 } else { 0.55 };
            5.0 * (1.0 - swing * (turns * std::f64::consts::TAU).cos())
        };
        let loads: Vec<f64> = (0..800).map(load).collect();
        let readings: Vec<f64> = (0..800).map(|n| 100.0 * (load(n + 2) + random(n))).collect();
        paired(&readings, &loads).unwrap();
    }

    /// The square of a load looks late where a part ends within the only touch that it has.
    #[test]
    fn a_curve_is_none_that_are_missing() {
        let mut loads = touches(1600);
        loads[600..770].fill(0.0);
        (770..850).for_each(|n| loads[n] = 0.1 * (n - 770) as f64);
        let readings: Vec<f64> = loads.iter().map(|load| load * load).collect();
        paired(&readings, &loads).unwrap();
    }
}
