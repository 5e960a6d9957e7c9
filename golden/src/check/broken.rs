//! Taxels that read what no load on the layer makes: much, where those around them read next to nothing.

use super::dead;
use crate::design::Design;
use crate::numbers::{magnitude, mean};

/// From so many frames on.
const FRAMES: usize = 10;
/// A reading of this share of the largest of all other taxels is one that those around it must see.
const LARGE: f64 = 0.2;
/// In this share of the frames.
const OFTEN: f64 = 0.1;
/// Of what the layer hands on to the next taxel from a force on a point, the sharpest load there is, this share.
const HANDED: f64 = 0.3;
/// More broken taxels than one of so many are another kind of sensor than the design says.
const ONE_OF: usize = 20;

/// Finds broken taxels. Returns a message, and the frames with the mean of the neighbours in their place. `frames` are as in
/// the file, `stress` is in pascals.
pub(super) fn check(design: &Design, frames: &[Vec<f64>], stress: &[Vec<f64>]) -> Option<(String, Vec<Vec<f64>>)> {
    let taxels = design.sensor.taxels();
    if frames.len() < FRAMES {
        return None;
    }
    let most: Vec<f64> = (0..taxels).map(|taxel| magnitude(stress.iter().map(|frame| frame[taxel]))).collect();
    let lonely = |taxel: &usize| !design.input.dead.contains(taxel) && is_lonely(design, stress, &most, *taxel);
    let broken: Vec<usize> = (0..taxels).filter(lonely).collect();
    if broken.is_empty() || broken.len() > (taxels / ONE_OF).max(1) {
        return None;
    }
    let mut mended = frames.to_vec();
    for &taxel in &broken {
        let around: Vec<usize> = around(design, taxel).into_iter().filter(|taxel| !broken.contains(taxel)).collect();
        for frame in &mut mended {
            frame[taxel] = mean(around.iter().map(|&taxel| frame[taxel]));
            // Counts stay counts.
            if design.input.counts() || frames.iter().flatten().all(|value| value.fract() == 0.0) {
                frame[taxel] = frame[taxel].round();
            }
        }
    }
    let is_stuck = |&taxel: &usize| frames.iter().all(|frame| frame[taxel].to_bits() == frames[0][taxel].to_bits());
    let how = |taxel: &usize| {
        if is_stuck(taxel) { format!("is stuck at {}", frames[0][*taxel]) } else { "jumps on its own".to_owned() }
    };
    let each: Vec<String> =
        broken.iter().map(|taxel| format!("{} {}", dead::name(design, *taxel), how(taxel))).collect();
    let mut named = [&broken[..], &design.input.dead].concat();
    named.sort_unstable();
    let message = format!(
        "taxel {}, while those around read next to nothing, which no load on this layer does: broken? Write sensor.dead = \
         {named:?}, and their neighbours stand for them",
        each.join(", taxel ")
    );
    Some((message, mended))
}

/// Whether a taxel's readings are large, and those around it do not go with them.
fn is_lonely(design: &Design, stress: &[Vec<f64>], most: &[f64], taxel: usize) -> bool {
    let others = magnitude(most.iter().enumerate().filter(|(other, _)| *other != taxel).map(|(_, most)| *most));
    let around = around(design, taxel);
    if others <= 0.0 || around.is_empty() || most[taxel] < LARGE * others {
        return false;
    }
    let handed = HANDED * handed_on(design);
    let enough = (OFTEN * stress.len() as f64).max(3.0);
    // What it reads, and what those around read with it.
    let large: Vec<&Vec<f64>> = stress.iter().filter(|frame| frame[taxel].abs() >= LARGE * others).collect();
    let alone = large
        .iter()
        .filter(|frame| magnitude(around.iter().map(|&next| frame[next])) < handed * frame[taxel].abs())
        .count();
    if alone as f64 >= enough {
        return true;
    }
    // How it varies, and how those around vary with it.
    let frames = stress.len() as f64;
    let mean = |taxel: usize| mean(stress.iter().map(|frame| frame[taxel]));
    let own = mean(taxel);
    let variance = stress.iter().map(|frame| (frame[taxel] - own).powi(2)).sum::<f64>();
    let goes_with = |next: usize| {
        let its = mean(next);
        stress.iter().map(|frame| (frame[taxel] - own) * (frame[next] - its)).sum::<f64>().abs() / variance
    };
    (variance / frames).sqrt() >= LARGE * others && around.iter().all(|&next| goes_with(next) < handed)
}

/// The share of the stress right below a force on the surface that is a pitch aside of it, by Boussinesq.
fn handed_on(design: &Design) -> f64 {
    let [x, y] = design.sensor.pitch_mm;
    let pitches = x.min(y) / design.sensor.depth_mm;
    (1.0 + pitches * pitches).powf(-2.5)
}

/// The taxels beside one and across its corners, that are not known to be dead.
fn around(design: &Design, taxel: usize) -> Vec<usize> {
    let (columns, rows) = (design.sensor.columns, design.sensor.rows);
    let (x, y) = (taxel % columns, taxel / columns);
    let next = (y.saturating_sub(1)..(y + 2).min(rows))
        .flat_map(|row| (x.saturating_sub(1)..(x + 2).min(columns)).map(move |column| row * columns + column));
    next.filter(|next| *next != taxel && !design.input.dead.contains(next)).collect()
}
