//! A contact in the middle as sensors with errors read it: noise, taxels that are broken or saturated, offsets, coarse steps.

use golden::scene::{Converter, Scene, SensorErrors};

use super::{Case, Cases, CornerCasesError, SEED, all_directions, contact, noise, scene, sensor_1};

/// Largest offset of a taxel, as a share of the largest stress.
const OFFSET: f64 = 0.02;
/// Frames of a tare, and the noise of each of them.
const TARE: (u64, f64) = (16, 0.002);

pub(super) fn errors(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let swept = |errors| swept(all_directions(), errors);
    for percent in [0.05, 0.1, 0.2, 0.5, 1.0, 2.0] {
        cases.scene("sensor", format!("noise {percent} %"), "", &swept(noise(percent / 100.0)))?;
    }
    let with = |dead: Vec<usize>, stuck: Vec<(usize, f64)>| SensorErrors { dead, stuck, ..SensorErrors::default() };
    for (name, dead) in [("a dead taxel in the middle", vec![44]), ("five dead taxels", vec![0, 33, 44, 55, 67])] {
        cases.scene("sensor", name, "", &swept(with(dead.clone(), vec![])))?;
        let named = cases.scene("sensor", format!("{name}, named"), "", &swept(with(dead.clone(), vec![])))?;
        named.design.input.dead = dead;
    }
    offsets(cases)?;
    cases.scene("sensor", "a saturated taxel in the contact", "", &swept(with(vec![], vec![(44, -1e5)])))?;
    cases.scene("sensor", "a saturated taxel far away", "", &swept(with(vec![], vec![(9, -1e5)])))?;
    cases.scene("sensor", "a taxel beyond the full scale", "", &swept(with(vec![], vec![(44, -3e5)])))?;
    let coarse = SensorErrors { converter: Some(Converter { bits: 8, full_scale_pa: 1e5 }), ..SensorErrors::default() };
    cases.scene("sensor", "converter of 8 bits", "", &swept(coarse))?;
    Ok(())
}

fn swept(sweep_deg: Vec<f64>, errors: SensorErrors) -> Scene {
    let sensor = sensor_1();
    scene(&sensor, vec![contact(&sensor, 7.0)], sweep_deg, errors)
}

/// Offsets of the taxels as they are, and what a tare leaves of them: the mean of the noise of its frames.
fn offsets(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let still = || swept(all_directions(), SensorErrors::default());
    let case = cases.scene("sensor", format!("offsets of up to {} %, no tare", 100.0 * OFFSET), "", &still())?;
    let peak = case.frames.iter().flatten().fold(0.0_f64, |most, stress| most.max(stress.abs()));
    // No order in them: the angle between neighbours is a part of a turn that no number of taxels makes up for.
    case.add(|taxel| OFFSET * peak * (2.4 * taxel as f64).cos());

    let (frames, noise) = TARE;
    let rest = |errors| swept(vec![0.0], errors).frames();
    let without = &rest(SensorErrors::default())?[0].stress;
    let mut left = vec![0.0; without.len()];
    for frame in 0..frames {
        let with = &rest(SensorErrors { seed: SEED + frame, noise, ..SensorErrors::default() })?[0].stress;
        left.iter_mut().zip(with.iter().zip(without)).for_each(|(left, (with, without))| *left += with - without);
    }
    let name = format!("the same, tared by {frames} frames with {} % of noise", 100.0 * noise);
    cases.scene("sensor", name, "", &still())?.add(|taxel| left[taxel] / frames as f64);
    Ok(())
}

impl Case {
    /// Adds something of each taxel's own to all frames, in pascals.
    fn add(&mut self, of: impl Fn(usize) -> f64) {
        for frame in &mut self.frames {
            frame.iter_mut().enumerate().for_each(|(taxel, stress)| *stress += of(taxel));
        }
    }
}
