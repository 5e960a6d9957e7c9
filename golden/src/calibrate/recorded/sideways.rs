//! The constants of friction from tangential forces alone, where the design gives the normal force.
//!
//! Friction is a share of the normal force, and the constants say what share the estimator's finding stands for. They take
//! an `F_z`, and no more of it: where none was measured, the design's own stands for it, as its curve, gains and offsets
//! have it. These cannot be told by tangential forces and stay. What that `F_z` errs by, the constants err by.

use super::folds::{Folds, levels};
use super::readings::Readings;
use super::report::{Recorded, TaxelGain};
use super::table::Measured;
use super::{RecordedError, friction, holds};
use crate::design::Design;
use crate::solver::{Solver, Status};

/// Frames of less than this share of the largest load that the design finds are rest: noise, or a touch.
const REST: f64 = 0.02;

/// Whether tangential forces are known, and no normal one but that of unloaded frames.
pub(super) fn is_all(measured: &Measured) -> bool {
    measured.forces.iter().all(|force| force[2].is_none_or(|normal| normal == 0.0))
        && measured.forces.iter().any(|force| force[0].is_some() || force[1].is_some())
}

/// Forces that the design finds in frames.
///
/// # Errors
///
/// [`RecordedError::Wrong`] for frames in which, by the design, nothing presses.
pub(super) fn found(design: &Design, frames: &[Vec<f64>]) -> Result<Vec<[f64; 3]>, RecordedError> {
    let solver = Solver::new(design)?;
    let of = |frame: &Vec<f64>| -> Result<[f64; 3], RecordedError> {
        let solution = solver.solve(frame)?;
        Ok(if solution.status.contains(Status::NO_CONTACT) { [0.0; 3] } else { solution.resultant })
    };
    let found = frames.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    let largest = found.iter().fold(0.0_f64, |most, [.., z]| most.max(z.abs()));
    let loaded = found.iter().filter(|[.., z]| z.abs() > REST * largest).count();
    let pulls = found.iter().filter(|[.., z]| *z > REST * largest).count();
    if 2 * pulls >= loaded {
        let problem = if loaded == 0 {
            "no F_z is known, and by the design nothing presses".to_owned()
        } else {
            format!("no F_z is known, and by the design {pulls} of {loaded} frames pull")
        };
        return Err(RecordedError::of(
            &design.name,
            (
                problem,
                "calibrate the design with F_z first, weights do; `sptfra check` says what is wrong with the frames"
                    .to_owned(),
            ),
        ));
    }
    Ok(found)
}

/// Fits the constants of friction; all else stays as the design has it. `found` are the forces that the design finds.
pub(super) fn fit(
    design: &Design,
    (frames, found): (&[Vec<f64>], &[[f64; 3]]),
    mut measured: Measured,
    mut remarks: Vec<String>,
) -> Result<Recorded, RecordedError> {
    let wrong = |wrong| RecordedError::of(&design.name, wrong);
    let normal = |k: usize| found[k][2];
    let known = |k: &usize| measured.forces[*k][0].is_some() || measured.forces[*k][1].is_some();
    let known: Vec<usize> = (0..frames.len()).filter(known).collect();
    let largest = known.iter().fold(0.0_f64, |most, &k| most.max(normal(k).abs()));
    for &k in &known {
        measured.forces[k][2] = Some(if normal(k).abs() > REST * largest { normal(k) } else { 0.0 });
    }
    let mut holds = holds::part(design, frames, &measured).map_err(wrong)?;
    remarks.append(&mut holds.remarks);
    remarks.push(
        "friction is a share of the F_z that the design finds: errors of its curve and gains become errors of the constants. \
         Measure F_z too, or check it with a weight"
            .to_owned(),
    );
    let taxels = design.sensor.taxels();
    let stress = |hold: &holds::Hold| -> Vec<f64> {
        let of = |taxel: usize| hold.frames.clone().map(|k| design.input.to_pa(taxel, frames[k][taxel])).sum::<f64>();
        (0..taxels).map(|taxel| -of(taxel) / hold.frames.len() as f64).collect()
    };
    let stresses: Vec<Vec<f64>> = holds.all.iter().map(stress).collect();
    let folds = Folds::new(&holds.all);
    let mut calibrated = design.clone();
    let verdict = friction::fit(&mut calibrated, &holds.all, &stresses, folds.as_ref())?;
    let mut undetermined =
        vec!["F_z, curve and gains: no normal force is known; they stay as the design has them".to_owned()];
    let mut determined = Vec::new();
    verdict.map_or_else(|words| undetermined.push(words), |words| determined.push(words));
    let steps = levels(holds.all.iter().map(|hold| hold.load));
    let gain = |taxel: usize| design.input.of_taxel(taxel).0;
    Ok(Recorded {
        contacts: holds.contacts,
        places: holds.places,
        loads: [steps.first().map_or(0.0, |first| first[0]), steps.last().map_or(0.0, |last| last[1])],
        errors: None,
        errors_as_designed: None,
        errors_fitted: None,
        determined,
        undetermined,
        remarks,
        // None was measured.
        holds: Vec::new(),
        gains: (0..taxels).map(|taxel| TaxelGain { gain: gain(taxel), touched: false, told: false }).collect(),
        points: Readings::new(&holds, &design.input).points(&design.input),
        design: calibrated,
    })
}
