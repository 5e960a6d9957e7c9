//! The constants of friction, from forces along the surface.

use golden::calibrate::recorded::fit_forces;
use golden::solver::Solver;

use super::says;
use super::simulated::{self, Indenter, Recipe, design};

#[test]
fn tangential_forces_tell_the_constants_of_friction() {
    let recipe = Recipe {
        friction: 0.5,
        places: 12,
        frames: 1,
        loads: vec![3.0, 6.0],
        scale: 1.0,
        ..Recipe::new(78, Indenter::Disc)
    };
    let recording = simulated::record_pascals(&recipe);
    let joint = "estimator = \"joint\"\ngain = 1.1\n";
    let fit = |keys: &str| {
        fit_forces(&design("", &format!("{joint}{keys}")), &recording.frames, &recording.measured).unwrap()
    };
    let found = fit("friction_correction = [2.0, 0.0]");
    assert!(
        says(&found.determined, &["friction: friction_correction = ["]),
        "{:?} {:?}",
        found.determined,
        found.undetermined
    );
    let [c1, c3] = found.design.algorithm.joint.friction_correction;
    let again = fit(&format!("friction_correction = [{c1:?}, {c3:?}]"));
    assert!(says(&again.undetermined, &["friction: other constants do no better"]), "{:?}", again.undetermined);
    let solver = Solver::new(&found.design).unwrap();
    let mut off: Vec<f64> = recording
        .frames
        .iter()
        .zip(&recording.measured.forces)
        .filter(|(_, force)| force[2] != Some(0.0))
        .map(|(frame, force)| {
            let [x, y, z] = solver.solve(frame).unwrap().resultant;
            100.0 * (x - force[0].unwrap()).hypot(y - force[1].unwrap()) / z.abs()
        })
        .collect();
    off.sort_by(f64::total_cmp);
    assert!(off[off.len() / 2] < 8.0, "{off:?}");
    // Without F_z the design's own stands for it, and all but friction stays.
    let mut sideways = recording.measured.clone();
    sideways.forces.iter_mut().for_each(|force| force[2] = None);
    let before = design("", &format!("{joint}friction_correction = [2.0, 0.0]"));
    let alone = fit_forces(&before, &recording.frames, &sideways).unwrap();
    assert!(
        says(&alone.determined, &["friction: friction_correction = ["]),
        "{:?} {:?}",
        alone.determined,
        alone.undetermined
    );
    assert!(says(&alone.undetermined, &["F_z, curve and gains: no normal force is known"]), "{:?}", alone.undetermined);
    assert!(says(&alone.remarks, &["friction is a share of the F_z", "check it with a weight"]), "{:?}", alone.remarks);
    let mut unchanged = alone.design.clone();
    unchanged.algorithm.joint.friction_correction = [2.0, 0.0];
    assert_eq!(unchanged, before);
    assert!(alone.holds.is_empty() && alone.errors.is_none() && alone.errors_fitted.is_none());
    assert!(found.errors_fitted.is_some());
    // Frames at rest may state that nothing presses.
    let mut rested = recording.measured.clone();
    rested.forces.iter_mut().for_each(|force| force[2] = force[2].filter(|&normal| normal == 0.0));
    assert!(rested.forces.iter().any(|force| force[2].is_some()));
    assert_eq!(fit_forces(&before, &recording.frames, &rested).unwrap().design, alone.design);
    // As from all components: the design's F_z errs by little here.
    let ratio = alone.design.algorithm.joint.friction_correction[0] / c1;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    let pulled: Vec<Vec<f64>> = recording.frames.iter().map(|frame| frame.iter().map(|pa| -pa).collect()).collect();
    let said = fit_forces(&before, &pulled, &sideways).map(drop).unwrap_err().to_string();
    assert!(said.contains("no F_z is known, and by the design ") && said.contains("with F_z first"), "{said}");
    let said = fit_forces(&before, &vec![vec![0.0; 78]; sideways.forces.len()], &sideways).map(drop).unwrap_err();
    assert!(said.to_string().contains("by the design nothing presses"), "{said}");
    // Forces of other frames.
    let mut other = sideways.clone();
    other.forces.sort_by(|a, b| a[0].unwrap_or(0.0).abs().total_cmp(&b[0].unwrap_or(0.0).abs()));
    let said = fit_forces(&before, &recording.frames, &other).map(drop).unwrap_err().to_string();
    assert!(said.contains("the F_x and F_y that the design finds do not follow them"), "{said}");
    let line = fit_forces(&design("", ""), &recording.frames, &sideways).unwrap();
    assert!(says(&line.undetermined, &["friction: the line search has no constants"]), "{:?}", line.undetermined);
    // Forces the wrong way round are no friction.
    let mut turned = recording.measured.clone();
    turned.forces.iter_mut().for_each(|force| (force[0], force[1]) = (force[0].map(|x| -x), force[1].map(|y| -y)));
    let found =
        fit_forces(&design("", &format!("{joint}friction_correction = [1, 0]")), &recording.frames, &turned).unwrap();
    assert!(says(&found.undetermined, &["friction: F_x and F_y point against"]), "{:?}", found.undetermined);
}
