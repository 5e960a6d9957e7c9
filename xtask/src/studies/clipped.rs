//! Sensors that read no tension: what a calibration on clipped frames reaches, on contacts that it has not seen.

use std::fmt::Write;

use golden::metrics::Quantiles;
use golden::scene::{Kind, Medium};
use golden::solver::Solver;

use super::contacts::{FRICTIONS, Pressed, SEED, Truth, errors_of, frames, inside};
use super::{Rows, cells, contact_kinds, design, shear_errors, without_tension};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,training_set,poisson,noise,friction,median,p95,worst,normal_p95";
/// The designs of the table.
pub const DESIGNS: [&str; 4] = ["sensor1-fast", "sensor1-clipped-wide", "sensor2-fast", "sensor2-clipped-wide"];
/// The columns of [`kinds_rows`].
pub const KINDS_COLUMNS: &str = "sensor,kind,training_set,median,p95,worst";
/// The designs of that table.
pub const KINDS_DESIGNS: [&str; 2] = ["sensor1-clipped-wide", "sensor2-clipped-wide"];

/// Frames as a sensor reads them that knows no pull.
fn clipped(set: &[Pressed], friction: f64, noise: f64) -> Vec<Truth> {
    let mut frames = frames(set, friction, noise);
    without_tension(frames.iter_mut().map(|truth| &mut truth.frame));
    frames
}

/// The table, errors in percent of the normal force.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for name in DESIGNS {
        let training_set = if name.ends_with("-fast") { "\"sliding, for tension\"" } else { "general" };
        let design = design(name);
        let solver = Solver::new(&design)?;
        for (poisson, noise) in [(0.49, 0.0), (0.49, 0.002), (0.47, 0.0)] {
            let set = inside(&design.sensor, Medium::BondedLayer { poisson }, SEED, 200);
            for friction in FRICTIONS {
                let (errors, _) = errors_of(&solver, &clipped(&set, friction, noise));
                let [tangential, normal] = errors.map(Quantiles::of);
                let Quantiles { median, most, worst } = tangential;
                let (sensor, noise, normal) = (&name[6..7], 100.0 * noise, normal.most);
                // Writing to a String cannot fail.
                let _ = writeln!(
                    rows,
                    "{sensor},{training_set},{poisson},{noise},{friction},{median:.1},{most:.1},{worst:.1},{normal:.1}"
                );
            }
        }
    }
    Ok(rows)
}

/// The table by kind of contact, errors of the tangential force in percent of the normal force.
pub fn kinds_rows() -> Rows {
    let mut rows = String::new();
    for name in KINDS_DESIGNS {
        let design = design(name);
        let solver = Solver::new(&design)?;
        for kind in Kind::all() {
            let mut frames = contact_kinds::frames(&design.sensor, kind, 0.5)?;
            without_tension(frames.iter_mut().map(|frame| &mut frame.stress));
            // Writing to a String cannot fail.
            let _ = writeln!(rows, "{},{kind},general,{}", &name[6..7], cells(shear_errors(&solver, &frames)?));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studies::contacts::LAYER;

    /// What 95 % of 200 contacts keep to at each friction, in percent: of the tangential force, and of the normal one. Trained
    /// at a noise of 1 %, on contacts of any kind. What a calibration for sensors that read tension makes of the same frames is
    /// beyond any of it.
    #[test]
    fn one_contact_keeps_to_the_figures() {
        for (sensor, limits) in [("sensor1", [4.2, 8.4, 9.8]), ("sensor2", [4.3, 9.7, 11.0])] {
            let [clipped_one, reads] = ["clipped-wide", "fast"].map(|kind| design(&format!("{sensor}-{kind}")));
            let set = inside(&clipped_one.sensor, LAYER, SEED, 200);
            let [solver, other] = [&clipped_one, &reads].map(|design| Solver::new(design).expect("matrices"));
            for (friction, limit) in FRICTIONS.into_iter().zip(limits) {
                let frames = clipped(&set, friction, 0.0);
                let ([tangential, normal], _) = errors_of(&solver, &frames);
                let [most, of_normal] = [tangential, normal].map(|errors| Quantiles::of(errors).most);
                assert!(most <= limit && of_normal <= 4.6, "{sensor}, µ = {friction}: {most:.2} {of_normal:.2}");
                let ([elsewhere, _], warned) = errors_of(&other, &frames);
                if friction > 0.3 {
                    let median = Quantiles::of(elsewhere).median;
                    assert!(median > 10.0, "{sensor}, µ = {friction}: {median:.1}");
                    assert!(warned >= 195, "{sensor}, µ = {friction}: {warned} frames say that there is no tension");
                }
            }
        }
    }
}
