//! Constants from recordings with measured forces.

mod bladder;
mod friction;
mod rates;
mod simulated;
mod table;

use golden::calibrate::recorded::{Measured, Recorded, fit_forces};
use golden::design::Curve;
use simulated::{COUNTS, Indenter, Recipe, design, record, study, weights_only};

fn says(lines: &[String], parts: &[&str]) -> bool {
    lines.iter().any(|line| parts.iter().all(|part| line.contains(part)))
}

/// What a recording of a kind must reach: bend of the curve, and median, 95 % and worst error on other contacts.
fn check(what: &str, recipe: &Recipe, limits: [f64; 4]) -> Recorded {
    let (found, [bend, _, _, median, most, worst, _]) = study(recipe);
    for (found, limit) in [bend, median, most, worst].into_iter().zip(limits) {
        assert!(found <= limit, "{what}: {found} above {limit}");
    }
    found
}

/// The same weights at each place, so that they repeat: a place earlier or later they fit nearly as well.
#[test]
fn weights_that_repeat_lack_no_frames() {
    let recipe = Recipe { noise: 2.0, scale: 40.0, spread: 0.1, ..Recipe::new(200, Indenter::Ball) };
    assert!(study(&recipe).1[3] < 2.0);
}

fn straight(seed: u64) -> Recipe {
    Recipe { scale: 40.0, spread: 0.1, noise: 2.0, ..Recipe::new(seed, Indenter::Block) }
}

#[test]
fn a_straight_line_and_gains() {
    let found = check("straight, gains 10 %", &straight(71), [0.5, 4.0, 12.0, 20.0]);
    assert!(found.design.input.curve.is_none() && found.design.input.pa_per_count.unwrap() < 0.0);
}

#[test]
fn a_power_law_above_one() {
    let recipe = Recipe { power: 1.25, scale: 5.0, noise: 2.0, ..Recipe::new(72, Indenter::Disc) };
    let found = check("power 1.25", &recipe, [3.0, 3.0, 6.0, 8.0]);
    let curve = found.design.input.curve.unwrap();
    let [power, scale] = curve.law.unwrap();
    assert!((power - 1.25).abs() < 0.04 && scale < 0.0, "{power} {scale}");
}

#[test]
fn a_root_with_noise_creep_and_offsets() {
    let recipe = Recipe {
        power: 0.57,
        scale: 1200.0,
        spread: 0.1,
        noise: 3.0,
        rest: 60.0,
        creep: 0.33,
        repeat: 0.1,
        frames: 10,
        ..Recipe::new(73, Indenter::Ball)
    };
    let found = check("power 0.57, offsets, creep", &recipe, [14.0, 9.0, 30.0, 40.0]);
    assert!(
        says(&found.remarks, &["creeps", "constant load"]) && says(&found.remarks, &["differs by", "pairs"]),
        "{:?}",
        found.remarks
    );
    assert!(matches!(found.design.input.curve, Some(Curve { law: None, .. })), "offsets are no part of a law");
}

#[test]
fn a_ramp_is_no_constant_load() {
    let plain = Recipe { scale: 40.0, places: 12, loads: vec![6.0], frames: 1, ..Recipe::new(78, Indenter::Disc) };
    let recording = record(&plain);
    let (mut frames, mut forces) = (Vec::new(), Vec::new());
    for (frame, force) in recording.frames.iter().zip(&recording.measured.forces) {
        // Slowly released, so that a hold of nearly the same load has many frames.
        for step in 0..if force[2] == Some(0.0) { 1 } else { 300 } {
            let share = 1.0 - f64::from(step) / 400.0;
            frames.push(frame.iter().map(|count| (share * count).round()).collect());
            forces.push(force.map(|force| Some(share * force?)));
        }
    }
    let found = fit_forces(&design(COUNTS, ""), &frames, &Measured::of_forces(forces)).unwrap();
    assert!(!says(&found.remarks, &["creeps"]), "{:?}", found.remarks);
}

#[test]
fn a_falling_sensor_and_the_end_of_the_converter() {
    let mut recording = record(&Recipe { scale: 22.0, noise: 1.0, places: 16, ..Recipe::new(74, Indenter::Disc) });
    recording.frames.iter_mut().flatten().for_each(|count| *count = 4095.0 - *count);
    let found = fit_forces(&design(COUNTS, ""), &recording.frames, &recording.measured).unwrap();
    assert!(found.design.input.pa_per_count.unwrap() > 0.0);
    assert!(says(&found.remarks, &["readings at 0", "end of the converter"]), "{:?}", found.remarks);
    assert!(found.errors.unwrap().median < 3.0);
}

#[test]
fn a_taxel_stuck_at_the_end_of_the_converter() {
    let recipe = Recipe { scale: 40.0, noise: 1.0, places: 12, frames: 3, ..Recipe::new(79, Indenter::Disc) };
    for end in [0.0, 4095.0] {
        let mut recording = record(&recipe);
        if end == 0.0 {
            recording.frames.iter_mut().flatten().for_each(|count| *count = 4095.0 - *count);
        }
        recording.frames.iter_mut().for_each(|frame| frame[20] = end);
        let fit =
            |keys: &str| fit_forces(&design(&format!("{COUNTS}{keys}"), ""), &recording.frames, &recording.measured);
        let said = fit("\ndead = [70]").map(|_| ()).unwrap_err().to_string();
        for part in [&format!("taxel 20 reads {end}, the end of the converter"), "nearly every", "dead = [20, 70]"] {
            assert!(said.contains(part), "no {part:?} in {said}");
        }
        let found = fit("\ndead = [20]").unwrap();
        assert!(!says(&found.remarks, &["the end of the converter"]), "{:?}", found.remarks);
        let median = found.errors.unwrap().median;
        assert!(median < 5.0, "{median}");
    }
}

#[test]
fn what_a_recording_cannot_tell_is_not_fitted() {
    let fit = |recipe: &Recipe| {
        let mut recording = record(recipe);
        weights_only(&mut recording.measured);
        fit_forces(&design(COUNTS, ""), &recording.frames, &recording.measured).unwrap()
    };
    let curved =
        Recipe { power: 1.25, scale: 5.0, noise: 2.0, places: 8, frames: 3, ..Recipe::new(75, Indenter::Ball) };
    // One weight.
    let found = fit(&Recipe { loads: vec![5.0], ..curved.clone() });
    assert!(found.design.input.curve.is_none() && found.loads.iter().all(|load| (load - 5.0).abs() < 1e-9));
    assert!(
        says(&found.undetermined, &["curve: one load (5 N)", "at least two", "stays a straight line"]),
        "{:?}",
        found.undetermined
    );
    // Two that are all but one.
    let found = fit(&Recipe { loads: vec![5.0, 6.0], ..curved.clone() });
    assert!(
        found.design.input.curve.is_none() && says(&found.undetermined, &["too close to each other"]),
        "{:?}",
        found.undetermined
    );
    // One place, one weight: nothing to check against.
    let found = fit(&Recipe { loads: vec![5.0], places: 1, ..curved.clone() });
    assert!(
        found.errors.is_none() && says(&found.undetermined, &["errors: not checked", "four places"]),
        "{:?}",
        found.undetermined
    );
    assert!(says(&found.undetermined, &["gains: contacts at 1 place do not determine"]));
    // Six loads at one place, none of which comes out twice the same: a curve would be the slips' own.
    let loads = vec![2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    let found = fit(&Recipe { loads, places: 1, power: 1.0, scale: 40.0, repeat: 0.18, ..curved.clone() });
    assert!(found.design.input.curve.is_none(), "{:?}", found.determined);
    // Taxels that nothing touched keep their gains to the bit.
    let few = Recipe { places: 9, spread: 0.3, ..curved };
    let found = fit(&few);
    let untouched = found.gains.iter().filter(|gain| !gain.touched).count();
    assert!(untouched > 5 && found.gains.iter().all(|gain| gain.touched || gain.gain.to_bits() == 1_f64.to_bits()));
    assert!(says(&found.undetermined, &["friction: no tangential forces"]));
}

#[test]
fn forces_of_other_frames_are_refused() {
    let recording = record(&Recipe { places: 6, frames: 2, scale: 40.0, ..Recipe::new(76, Indenter::Ball) });
    let fit = |measured: &Measured| fit_forces(&design(COUNTS, ""), &recording.frames, measured);
    let refused = |change: &dyn Fn(&mut Measured), parts: &[&str]| {
        let mut measured = recording.measured.clone();
        change(&mut measured);
        let said = fit(&measured).map(|_| ()).unwrap_err().to_string();
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    };
    refused(&|measured| measured.forces.truncate(20), &["pad: 96 frames and 20 lines", "one line for each frame"]);
    refused(&|measured| measured.forces.fill([None; 3]), &["no normal force", "weights"]);
    refused(&|measured| measured.forces.reverse(), &["pad: ", "; "]);
    refused(
        &|measured| {
            let loaded: Vec<usize> =
                (0..measured.forces.len()).filter(|k| measured.forces[*k][2] != Some(0.0)).collect();
            let mut shuffled: Vec<_> = loaded.iter().map(|&k| measured.forces[k]).collect();
            shuffled.rotate_left(5);
            shuffled.reverse();
            loaded.iter().zip(shuffled).for_each(|(&k, force)| measured.forces[k] = force);
        },
        &["does not go with the forces", "correlation", "same number"],
    );
    let mut measured = recording.measured.clone();
    measured.forces.truncate(94);
    let found = fit(&measured).unwrap();
    assert!(says(&found.remarks, &["96 frames and 94 lines", "paired from the first"]), "{:?}", found.remarks);
    // Signs of scales: what presses is positive.
    measured.forces.iter_mut().flatten().flatten().for_each(|force| *force = -*force);
    let turned = fit(&measured).unwrap();
    assert!(says(&turned.remarks, &["F_z is positive"]) && turned.design.input == found.design.input);
}

/// What the design said of a count is changed by far only with a remark: its sign, its unit, or that of the forces.
#[test]
fn another_sign_and_another_unit_are_told() {
    let recording = record(&Recipe { places: 6, frames: 2, scale: 40.0, ..Recipe::new(76, Indenter::Ball) });
    let remarks = |keys: &str| {
        let design = design(&format!("{keys}\ntension = \"clipped\""), "");
        let found = fit_forces(&design, &recording.frames, &recording.measured).unwrap();
        found
            .remarks
            .into_iter()
            .filter(|line| line.starts_with("sign") || line.starts_with("unit"))
            .collect::<Vec<_>>()
    };
    for keys in ["pa_per_count = -40.0", "pa_per_count = -1.0", "pa_per_count = -4000.0"] {
        assert_eq!(remarks(keys), [] as [String; 0], "{keys}");
    }
    for (keys, parts) in [
        (
            "pa_per_count = 40.0",
            ["sign: pressing changes the readings the other way", "(sensor.pa_per_count); it is turned"],
        ),
        ("", ["sign: pressing changes", "(frames in pascals, without sensor.pa_per_count)"]),
        (
            "pa_per_count = -0.04",
            ["unit: a count is worth 1", "times more than the design had it (sensor.pa_per_count)"],
        ),
        ("pa_per_count = -40000.0", ["unit: a count is worth ", "times less than the design had it"]),
        ("curve = { power = 1.0, scale = -0.04 }", ["unit: a count", "(sensor.curve); that is changed"]),
        ("pa_per_count = 0.04", ["sign: pressing", "times more; both are changed"]),
    ] {
        let said = remarks(keys);
        assert!(said.len() == 1 && parts.iter().all(|part| said[0].contains(part)), "{keys}: {said:?}");
    }
}

/// What all gains have in common is the curve's, so that taxels which nothing touched have the mean of the others.
#[test]
fn the_mean_gain_is_one_and_gains_that_do_no_better_are_not_taken() {
    let few = Recipe { scale: 40.0, noise: 2.0, places: 14, frames: 2, ..Recipe::new(80, Indenter::Block) };
    let of = |seed: u64, spread: f64, indenter: Indenter| {
        let mut recording = record(&Recipe { seed, indenter, spread, ..few.clone() });
        weights_only(&mut recording.measured);
        let found = fit_forces(&design(COUNTS, ""), &recording.frames, &recording.measured).unwrap();
        let touched: Vec<f64> = found.gains.iter().filter(|gain| gain.touched).map(|gain| gain.gain).collect();
        let told = found.gains.iter().filter(|gain| gain.told).count();
        (touched.iter().sum::<f64>() / touched.len() as f64, told)
    };
    for (seed, indenter) in [(81, Indenter::Block), (82, Indenter::Ball)] {
        let (mean, told) = of(seed, 0.1, indenter);
        assert!((mean - 1.0).abs() < 0.03 && told > 0, "{seed}: mean {mean}, {told} told");
    }
    for (seed, indenter) in [(83, Indenter::Block), (84, Indenter::Disc), (85, Indenter::Ball)] {
        assert_eq!(of(seed, 0.0, indenter), (1.0, 0), "{seed}");
    }
}
