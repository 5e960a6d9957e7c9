//! Taxels that read the same whatever presses around them.

use super::largest;
use crate::design::Design;
use crate::numbers::{correlation, magnitude};

/// A taxel lies within a contact where those on two opposite sides of it read this share of the frame's peak,
const WITHIN: f64 = 0.2;
/// or in several frames, a tenth of them, this share of it:
const OFTEN_WITHIN: f64 = 0.05;
const OFTEN: f64 = 0.1;
/// and is dead if it reads less than this share of either: one in the middle of a contact that stays reads the most.
const LESS: f64 = 0.5;
/// A row reads noise alone if it stays below this share of those beside it,
const SILENT: f64 = 0.1;
/// and is correlated less than this with them,
const FOLLOWS: f64 = 0.5;
/// in so many frames.
const FRAMES: usize = 10;
/// Names of taxels in a message.
const NAMED: usize = 8;

/// Taxels that lie within a contact and have one reading in all frames; those that the design knows of are left out.
///
/// `clipped` says that no frame shows a pull, whatever the design says.
pub(super) fn check(design: &Design, frames: &[Vec<f64>], loaded: &[Vec<f64>], clipped: bool) -> Option<String> {
    let columns = design.sensor.columns;
    let constant = |taxel: usize| {
        let first = frames[0][taxel];
        // Of one frame alone, or of the same one again and again, only a reading of 0 tells.
        first == 0.0 && frames.iter().all(|frame| frame[taxel] == 0.0)
            || frames.iter().any(|frame| frame != &frames[0])
                && frames.iter().all(|frame| frame[taxel].to_bits() == first.to_bits())
    };
    let within = |taxel: usize| {
        let (x, y) = (taxel % columns, taxel / columns);
        let beyond = |frame: &Vec<f64>, share: f64| {
            let least = (share * largest(frame)).max(frame[taxel].abs() / LESS);
            let pressed = |x: usize, y: usize| frame[y * columns + x] < -least;
            let along = x > 0 && x + 1 < columns && pressed(x - 1, y) && pressed(x + 1, y);
            let across = y > 0 && y + 1 < design.sensor.rows && pressed(x, y - 1) && pressed(x, y + 1);
            // Between two contacts a taxel that cannot read a pull reads 0 for good.
            if clipped { along && across } else { along || across }
        };
        loaded.iter().any(|frame| beyond(frame, WITHIN))
            || loaded.iter().filter(|frame| beyond(frame, OFTEN_WITHIN)).count() as f64
                >= (OFTEN * loaded.len() as f64).max(3.0)
    };
    if let Some(line) = dead_line(design, loaded, clipped, &constant) {
        return Some(line);
    }
    let known = |taxel: &usize| !design.input.dead.contains(taxel);
    let dead: Vec<usize> =
        (0..design.sensor.taxels()).filter(known).filter(|&taxel| constant(taxel) && within(taxel)).collect();
    (!dead.is_empty()).then(|| {
        let mut names: Vec<String> = dead.iter().take(NAMED).map(|&taxel| name(design, taxel)).collect();
        if dead.len() > NAMED {
            names.push(format!("and {} more", dead.len() - NAMED));
        }
        let (plural, verb) = if dead.len() == 1 { ("", "reads") } else { ("s", "read") };
        format!(
            "taxel{plural} {} {verb} the same in all frames, with something pressing on both sides: dead? Name up to 8 of \
             them in sensor.dead, and their neighbours stand for them",
            names.join(", ")
        )
    })
}

/// Rows or columns, one or two side by side, that read the same in all frames, or noise alone, while taxels beside them are
/// pressed; or two that read what the other does.
fn dead_line(design: &Design, loaded: &[Vec<f64>], clipped: bool, constant: &dyn Fn(usize) -> bool) -> Option<String> {
    let (columns, rows) = (design.sensor.columns, design.sensor.rows);
    let (mut lines, mut noisy) = (Vec::new(), false);
    for (what, count, length, [across, along]) in
        [("row", rows, columns, [columns, 1]), ("column", columns, rows, [1, columns])]
    {
        let place = |line: usize, index: usize| line * across + index * along;
        let taxels = |line: usize| (0..length).map(move |index| place(line, index));
        let still = |line: usize| taxels(line).all(constant);
        let is_known = |line: usize| taxels(line).all(|taxel| design.input.dead.contains(&taxel));
        let peak = |line: usize| magnitude(loaded.iter().flat_map(|frame| taxels(line).map(|taxel| frame[taxel])));
        let pressed = |taxel: usize, frame: &Vec<f64>| frame[taxel] < -WITHIN * largest(frame);
        let are_equal = |one: usize, other: usize| {
            loaded
                .iter()
                .all(|frame| taxels(one).zip(taxels(other)).all(|(a, b)| frame[a].total_cmp(&frame[b]).is_eq()))
        };
        // Of a contact in the middle between them, without noise, those on either side are equal too.
        let are_bridged = |one: usize| are_equal(one, one + 1) && !still(one) && !are_equal(one - 1, one + 2);
        if let Some(one) = (1..count.saturating_sub(2)).find(|&one| length > 1 && loaded.len() > 1 && are_bridged(one))
        {
            return Some(format!(
                "{what} {one} and {what} {} of the matrix (from 0) read the same in all frames: are their wires connected, or is \
                 one a copy of the other? Mend it, or leave out that part of the sensor",
                one + 1
            ));
        }
        for (first, run) in (0..count).flat_map(|first| [(first, 1), (first, 2)]) {
            let after = first + run;
            let sides = [first.checked_sub(1), (after < count).then_some(after)];
            let sides: Vec<usize> = sides.into_iter().flatten().collect();
            if length < 2 || after > count || sides.is_empty() || (first..after).any(is_known) {
                continue;
            }
            let is_between = |&index: &usize| {
                loaded.iter().any(|frame| sides.iter().all(|&line| pressed(place(line, index), frame)))
            };
            let between: Vec<usize> = (0..length).filter(is_between).collect();
            let goes_with = |one: usize, other: usize| {
                correlation(loaded.iter().map(|frame| (frame[one], frame[other]))).abs() >= FOLLOWS
            };
            let is_alone = |line: usize, &index: &usize| {
                !sides.iter().any(|&side| goes_with(place(line, index), place(side, index)))
            };
            let reads_noise = |line: usize| {
                loaded.len() >= FRAMES
                    && sides.iter().all(|&side| peak(line) <= SILENT * peak(side))
                    && between.iter().all(|index| is_alone(line, index))
            };
            let is_still = (first..after).all(still);
            let is_edge = sides.len() == 1;
            // Between two contacts two rows that cannot read a pull may read 0 for good, and so do others then.
            let is_gap = clipped && run > 1 && (0..count).any(|line| !(first..after).contains(&line) && still(line));
            // Beside a contact one at the edge reads nothing without a pull, and little with noise.
            let may_be = if is_edge { is_still && !clipped } else { !is_gap };
            if !between.is_empty()
                && may_be
                && (is_still || (first..after).all(|line| still(line) || reads_noise(line)))
            {
                lines.extend((first..after).map(|line| format!("{what} {line}")));
                noisy |= !is_still;
            }
        }
    }
    let read = if lines.len() > 1 { "read" } else { "reads" };
    (!lines.is_empty()).then(|| {
        format!(
            "{} of the matrix (from 0) {read} {} in all frames, with something pressing beside: is a wire broken? So many taxels \
             cannot be replaced: mend it, or leave out that part of the sensor",
            lines.join(", "),
            if noisy { "nothing but noise" } else { "the same" }
        )
    })
}

/// A taxel's number, and its place in the grid.
pub(super) fn name(design: &Design, taxel: usize) -> String {
    format!("{taxel} ({}, {})", taxel % design.sensor.columns, taxel / design.sensor.columns)
}
