//! Constants from frames with measured forces.

use super::fit::{Fitter, Validated};
use super::loads::Follow;
use super::report::{Errors, Hold, Recorded, TaxelGain};
use super::rows::Rows;
use super::shape::Kind;
use super::table::Measured;
use super::{RecordedError, friction, report, sideways};
use super::{holds, loads};
use crate::design::Design;
use crate::numbers::{counted, magnitude, middle};
use crate::solver::{Solver, Status};

/// A correlation of loads found and measured below this means that they do not belong together.
const FOLLOWS: f64 = 0.5;
/// Loads of this share of the largest are solved again with what was found,
const HEAVY: f64 = 0.1;
/// of about so many frames,
const SOLVED: usize = 400;
/// of which this share at most may be no contact.
const NOTHING: f64 = 0.25;
/// An error that is this much larger than twice the fitted one is another.
const APART: f64 = 0.03;

/// Fits curve, common gain, gains of the taxels and constants of friction to frames (values as they are in the file, one
/// a taxel) and the forces measured with them, and says what they could tell. Where `F_x` and `F_y` are known and no `F_z`,
/// the constants of friction alone, with the `F_z` that the design finds.
///
/// # Errors
///
/// [`RecordedError::Wrong`] for frames and forces that do not belong together or tell nothing at all.
pub fn fit_forces(design: &Design, frames: &[Vec<f64>], measured: &Measured) -> Result<Recorded, RecordedError> {
    let wrong = |wrong| RecordedError::of(&design.name, wrong);
    let is_sideways = sideways::is_all(measured);
    let follow = if is_sideways { Follow::Sideways(sideways::found(design, frames)?) } else { Follow::Forces };
    let (paired, measured, mut remarks) = loads::pair(design, frames, measured, &follow).map_err(wrong)?;
    let frames = &frames[paired.clone()];
    remarks.splice(0..0, measured.remarks.iter().cloned());
    if let Follow::Sideways(found) = follow {
        return sideways::fit(design, (frames, &found[paired]), measured, remarks);
    }
    let mut holds = holds::part(design, frames, &measured).map_err(wrong)?;
    remarks.append(&mut holds.remarks);
    let mut solver = Rows::new(design)?;
    let (mut fitter, lost) = Fitter::new(design, &mut holds, &mut solver);
    if lost > 0 {
        remarks
            .push(format!("{} left out, whose readings no contact makes: see `sptfra check`", counted(lost, "hold")));
    }
    if fitter.loads.is_empty() {
        return Err(wrong(("no hold has an answer".to_owned(), "run `sptfra check` on the frames".to_owned())));
    }
    let found = fitter.find(&mut solver);
    let follows = fitter.follows(&found);
    if fitter.levels.len() > 1 && fitter.span() > 1.3 && follows < FOLLOWS {
        return Err(wrong((
            format!("what the frames read does not go with the forces (correlation {follows:.2})"),
            "check that each line of the forces belongs to the frame of the same number".to_owned(),
        )));
    }
    let told = fitter.told(&found);
    let fitted = fitter.fitted(&found);
    let left_out = fitter.folds.is_some().then(|| fitter.validate(found.kind, found.prior));
    let plain = fitter.folds.is_some().then(|| fitter.validate(fitter.kinds()[0], None));
    let stresses: Vec<Vec<f64>> = fitter.holds.all.iter().map(|hold| fitter.stress(&found, &hold.x)).collect();
    let largest = stresses.iter().map(magnitude).fold(0.0, f64::max);
    let gains: Vec<f64> =
        found.delta.iter().zip(&fitter.before).map(|(delta, before)| before * (1.0 + delta)).collect();
    let pressed = stresses.iter().zip(&fitter.loads).filter(|(_, load)| **load >= HEAVY * fitter.range()[1]);
    let range = [pressed.map(|(stress, _)| magnitude(stress)).fold(f64::INFINITY, f64::min), largest];
    let mut calibrated = fitter.readings.calibrated(design, &found.shape, &gains, range, &mut remarks);
    remarks.extend(fitter.readings.far_from(design, &calibrated));
    let friction = friction::fit(&mut calibrated, &fitter.holds.all, &stresses, fitter.folds.as_ref())?;
    remarks.extend(verify(&calibrated, frames, &fitter, &fitted)?);
    let validated = left_out.as_ref().unwrap_or(&fitted);
    let shown = fitter.holds.all.iter().zip(&validated.errors).map(|(hold, error)| Hold {
        frames: [hold.frames.start, hold.frames.end - 1],
        place: hold.place,
        measured_n: hold.load,
        found_n: hold.load * (1.0 + error),
    });
    let gains = gains.iter().zip(&told).map(|(&gain, told)| TaxelGain {
        gain,
        touched: told.is_some(),
        told: *told == Some(true) && found.prior.is_some(),
    });
    let mut recorded = Recorded {
        holds: shown.collect(),
        gains: gains.collect(),
        errors: left_out.as_ref().map(|left| Errors::of(left.errors.iter().copied())),
        errors_as_designed: plain.as_ref().map(|plain| Errors::of(plain.errors.iter().copied())),
        errors_fitted: Some(Errors::of(fitted.errors.iter().copied())),
        points: fitter.readings.points(&calibrated.input),
        contacts: fitter.holds.contacts,
        places: fitter.holds.places,
        loads: fitter.range(),
        determined: Vec::new(),
        undetermined: Vec::new(),
        remarks,
        design: calibrated,
    };
    report::say(&mut recorded, &fitter, &found, friction);
    Ok(recorded)
}

/// Solves the recording with what was found: loaded frames are contacts, with the loads that the fit has. What is to be said
/// of those that are none.
fn verify(
    design: &Design,
    frames: &[Vec<f64>],
    fitter: &Fitter<'_>,
    fitted: &Validated,
) -> Result<Option<String>, RecordedError> {
    let wrong = |problem| {
        let remedy = "do frames and forces belong together? Give both a column of times, or cut them so that both begin with \
                      the same touch";
        RecordedError::of(&design.name, (problem, remedy.to_owned()))
    };
    let solver = Solver::new(design)?;
    let [_, largest] = fitter.range();
    let step = frames.len().div_ceil(SOLVED);
    let (mut errors, mut fits, mut counts) = (Vec::new(), Vec::new(), [0; 2]);
    for (index, hold) in fitter.holds.all.iter().enumerate().filter(|(_, hold)| hold.load >= HEAVY * largest) {
        for frame in hold.frames.clone().step_by(step) {
            counts[0] += 1;
            counts[1] += usize::from(solver.solve(&frames[frame])?.status.contains(Status::NO_CONTACT));
        }
        let mean: Vec<f64> =
            hold.x.iter().zip(&fitter.holds.rest).map(|(x, rest)| fitter.holds.sign * x + rest).collect();
        errors.push((solver.solve(&mean)?.resultant[2].abs() / hold.load - 1.0).abs());
        fits.push(fitted.errors[index].abs());
    }
    let [loaded, nothing] = counts;
    if nothing as f64 > NOTHING * loaded as f64 {
        return Err(wrong(format!(
            "with the constants found, {nothing} of {loaded} loaded frames are \"no contact\": frames without load vary as much \
             as those"
        )));
    }
    let [error, fit] = [errors, fits].map(middle);
    if error > 2.0 * fit + APART {
        return Err(wrong(format!(
            "solved with the constants found, the recording's loads have a median error of {:.1} %, and they were fitted to \
             {:.1} %",
            100.0 * error,
            100.0 * fit
        )));
    }
    Ok((nothing > 0).then(|| {
        format!("{nothing} of {loaded} loaded frames are \"no contact\" by algorithm.noise_floor_pa: light loads lie within the noise")
    }))
}

impl Kind {
    /// What a report calls it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Own => "the design's own curve",
            Self::Line => "a straight line",
            Self::Power => "a power law",
            Self::Pieces(_) => "straight pieces",
        }
    }
}
