//! The error that a design is said to have, against that of contacts which no calibration draws.

use golden::calibrate::{Settings, calibrate, state_errors};
use golden::design::Design;
use golden::scene::{Kind, SceneFrame};
use golden::solver::Solver;

use super::{Judged, design, judge, noisy, share};

/// A fifth.
const WITHIN: f64 = 0.2;

/// Says the errors of a design, and compares them with those of so many contacts of each kind and friction.
fn compare(design: &mut Design, count: u64) {
    state_errors(design, 1, &mut || ()).unwrap();
    let expected = design.algorithm.expected_error.clone().unwrap();
    let solver = Solver::new(design).unwrap();
    let kinds = Kind::all().filter(|kind| !matches!(kind, Kind::Noisy | Kind::Border | Kind::Mixed));
    let cases = kinds.flat_map(|kind| [0.3, 0.5, 0.7].map(|friction| (kind, friction)));
    // Each case has seeds of its own: equal seeds are equal places.
    let seeds = (8000..).step_by(1000).map(|first| first..first + count);
    let frames: Vec<SceneFrame> = cases
        .zip(seeds)
        .flat_map(|((kind, friction), seeds)| kind.frames(&design.sensor, friction, seeds).unwrap())
        .collect();
    let mut wrong = Vec::new();
    for noise in [0.0, 0.003, 0.008, 0.02] {
        let mut frames = frames.clone();
        noisy(&mut frames, noise);
        for SceneFrame { stress, .. } in &mut frames {
            for stress in stress {
                *stress = design.input.tension.of(*stress);
            }
        }
        let Judged { errors, .. } = judge(&solver, &frames);
        let said = expected.at(noise);
        let found = [0.5, 0.95].map(|part| share(&errors, part));
        println!("{} {noise}: said {said:.2?}, found {found:.2?}", design.name);
        if (0..2).any(|at| (found[at] / said[at] - 1.0).abs() > WITHIN) {
            wrong.push((noise, said, found));
        }
    }
    assert!(wrong.is_empty(), "{}: noise, said, found: {wrong:.2?}", design.name);
}

#[test]
fn the_expected_error_holds_within_a_fifth() {
    let mut design = design("sensor1-fast");
    let stated = design.algorithm.standard_error.unwrap();
    compare(&mut design, 20);
    // The standard error is found as the file states it, with its part for the border.
    let found = design.algorithm.standard_error.unwrap();
    for (found, stated) in [(found.model, stated.model), (found.noise, stated.noise), (found.border, stated.border)] {
        assert!((found / stated - 1.0).abs() < 0.1, "{found} {stated}");
    }
    let sentence = design.expected_error_at(0.008).unwrap().to_string();
    let [median, most] = design.algorithm.expected_error.as_ref().unwrap().at(0.008);
    assert!(
        sentence.starts_with(&format!("At a noise of 0.8 % expect the shear within {median:.1} % of F_z")),
        "{sentence}"
    );
    assert!(sentence.contains(&format!("95 %: {most:.0}); smoothing = 4 would bring ")), "{sentence}");
    let alone = design.expected_error_at(0.008).unwrap().of_single_frames().to_string();
    assert_eq!(Some(alone.trim_end_matches('.')), sentence.split("; smoothing").next());
    design.input.smoothing = 4;
    let smoothed = design.expected_error_at(0.008).unwrap().to_string();
    assert!(smoothed.starts_with("At a noise of 0.8 % and smoothing = 4 expect the shear within "), "{smoothed}");
    let brought = sentence.split("would bring ").nth(1).unwrap().trim_end_matches('.');
    assert!(smoothed.contains(&format!("within {brought} % of F_z")) && !smoothed.contains("bring"), "{smoothed}");
    design.input.smoothing = 0;
    assert!(design.expected_error_at(0.05).unwrap().to_string().contains("no better than"));
    design.algorithm.expected_error = None;
    assert_eq!(design.expected_error(), None);
}

#[test]
#[ignore = "minutes: part of `make test-long`"]
fn the_expected_error_holds_for_six_geometries() {
    for (sensor, tension) in [
        ("columns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0", "read"),
        ("columns = 10\nrows = 10\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0", "read"),
        ("columns = 10\nrows = 10\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0", "clipped"),
        ("columns = 16\nrows = 8\npitch_mm = [3.0, 3.0]\ndepth_mm = 2.5", "read"),
        ("columns = 8\nrows = 8\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0", "read"),
        ("columns = 12\nrows = 8\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0", "clipped"),
    ] {
        let text = format!(
            "format = 3\nname = \"pad\"\n[sensor]\n{sensor}\ntension = \"{tension}\"\n[algorithm]\n\
             estimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\n"
        );
        let mut design = Design::from_toml(&text, "pad.toml").unwrap();
        *design.algorithm.joint = calibrate(&design, &Settings::constants(), &mut || ()).unwrap();
        compare(&mut design, 20);
    }
}
