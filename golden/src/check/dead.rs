//! Taxels that read the same whatever presses around them.

use super::largest;
use crate::design::Design;

/// A taxel lies within a contact where those on two opposite sides of it read this share of the frame's peak,
const WITHIN: f64 = 0.2;
/// or in several frames, a tenth of them, this share of it:
const OFTEN_WITHIN: f64 = 0.05;
const OFTEN: f64 = 0.1;
/// and is dead if it reads less than this share of either: one in the middle of a contact that stays reads the most.
const LESS: f64 = 0.5;
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
    if let Some(line) = dead_line(design, loaded, &constant) {
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

/// A row or a column within the grid that reads the same in all frames while taxels on both sides of it are pressed.
fn dead_line(design: &Design, loaded: &[Vec<f64>], constant: &dyn Fn(usize) -> bool) -> Option<String> {
    let (columns, rows) = (design.sensor.columns, design.sensor.rows);
    let pressed = |taxel: usize, frame: &Vec<f64>| frame[taxel] < -WITHIN * largest(frame);
    let mut lines = Vec::new();
    for (what, count, length, steps) in [("row", rows, columns, [columns, 1]), ("column", columns, rows, [1, columns])]
    {
        for line in 1..count.saturating_sub(1) {
            let taxel = |index: usize| line * steps[0] + index * steps[1];
            let between = |index: usize| {
                let [before, after] = [taxel(index) - steps[0], taxel(index) + steps[0]];
                loaded.iter().any(|frame| pressed(before, frame) && pressed(after, frame))
            };
            if length > 1 && (0..length).all(|index| constant(taxel(index))) && (0..length).any(between) {
                lines.push(format!("{what} {line}"));
            }
        }
    }
    (!lines.is_empty()).then(|| {
        format!(
            "{} of the matrix (from 0) reads the same in all frames, with something pressing on both sides: is its wire \
             broken? So many taxels cannot be replaced: mend it, or leave out that part of the sensor",
            lines.join(", ")
        )
    })
}

/// A taxel's number, and its place in the grid.
pub(super) fn name(design: &Design, taxel: usize) -> String {
    format!("{taxel} ({}, {})", taxel % design.sensor.columns, taxel / design.sensor.columns)
}
