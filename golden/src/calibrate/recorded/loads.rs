//! What pressed in each frame, what the taxels read without load, and where the converter ends.

use super::lag;
use super::table::Measured;
use crate::design::Design;
use crate::numbers::{magnitude, middle, sorted};

/// Loads below this share of the largest are rest.
pub(super) const REST: f64 = 0.01;
/// Lines of the forces may be so much more or fewer than the frames.
const LENGTHS: f64 = 0.1;
/// Parts of a recording that are looked at for missing frames,
const PARTS: usize = 8;
/// and what another lag must leave no more of there: creep and curves let a wrong one look a little better.
const LOSES_STEP: f64 = 4.0;

/// What is wrong with a recording, and what to do.
pub(super) type Wrong = (String, String);

/// Frames, what was measured with each, and what is to be known of it.
pub(super) type Pairs<'a> = (&'a [Vec<f64>], Measured, Vec<String>);

/// Frames and lines of the forces, one for one. Where they do not begin together, the lag is found.
pub(super) fn pair<'a>(design: &Design, frames: &'a [Vec<f64>], measured: &Measured) -> Result<Pairs<'a>, Wrong> {
    let (count, lines) = (frames.len(), measured.forces.len());
    let apart = count.abs_diff(lines);
    if apart as f64 > LENGTHS * count as f64 {
        return Err((
            format!("{count} frames and {lines} lines of forces"),
            "give one line for each frame; leave blank what is unknown".to_owned(),
        ));
    }
    let is_alive = |(taxel, _): &(usize, &f64)| !design.input.dead.contains(taxel);
    let sum = |frame: &Vec<f64>| frame.iter().enumerate().filter(is_alive).map(|(_, value)| value).sum();
    let readings: Vec<f64> = frames.iter().map(sum).collect();
    // Pressures of a bladder rise in steps, which any lag fits.
    let loads: Vec<Option<f64>> = measured.forces.iter().map(|force| force[2]).collect();
    let lag = lag::find(&readings, &loads, lag::APART).map_err(|[one, other]| {
        (
            format!(
                "frames and loads do not begin together: {} fits the loads as well as {}",
                together(one),
                together(other)
            ),
            "give both files a column of times, or cut them so that both begin with the same touch".to_owned(),
        )
    })?;
    let skip = |frames: isize| usize::try_from(frames).unwrap_or(0);
    let (frames, from) = (&frames[skip(-lag)..], skip(lag));
    let both = frames.len().min(lines - from);
    let readings = &readings[skip(-lag)..][..both];
    for begin in (0..PARTS).map(|part| part * both / PARTS) {
        let part = begin..(begin + both / PARTS);
        if let Err([late, _]) | Ok(late @ (..=-1 | 1..)) =
            lag::find(&readings[part.clone()], &loads[from..][part], LOSES_STEP)
        {
            return Err((
                format!(
                    "frames and loads lose step: about frame {begin} they belong together when {} frames are left out",
                    late.unsigned_abs()
                ),
                "frames or lines are missing: give both files a column of times, or cut them where it happens"
                    .to_owned(),
            ));
        }
    }
    let mut remarks = Vec::new();
    if lag != 0 {
        remarks.push(format!(
            "frames and loads do not begin together: they are paired by what fits best, {}",
            together(lag)
        ));
    } else if apart > 0 {
        remarks.push(format!(
            "{count} frames and {lines} lines of forces: paired from the first on, the last {apart} left out; check that the \
             first belong together"
        ));
    }
    let mut measured = measured.clone();
    measured.forces = measured.forces.iter().skip(from).take(both).copied().collect();
    measured.pressures = measured.pressures.iter().skip(from).take(both).copied().collect();
    measured.contacts = measured.contacts.map(|names| names.into_iter().skip(from).take(both).collect());
    Ok((&frames[..both], measured, remarks))
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
    let sign = known.iter().sum::<f64>().signum();
    if sign > 0.0 {
        remarks.push("F_z is positive in the file: taken for what presses".to_owned());
    }
    let against = known.iter().filter(|&&force| -sign * force > REST * largest).count();
    if against > 0 {
        remarks.push(format!("{} with an F_z that pulls are left out", frames_of(against)));
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
            middle.iter().sum::<f64>() / middle.len() as f64
        })
        .collect();
    let noise = (at_rest.len() >= 5).then(|| {
        let of = |taxel: usize| {
            at_rest.iter().map(|&k| (frames[k][taxel] - middles[taxel]).abs()).sum::<f64>() / at_rest.len() as f64
        };
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

pub(super) fn frames_of(count: usize) -> String {
    if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") }
}
