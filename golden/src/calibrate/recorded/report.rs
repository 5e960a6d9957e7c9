//! What a recording could tell, in plain words.

use serde::Serialize;

use super::fit::{Constants, Fitter};
use super::folds::Folds;
use super::friction::Verdict;
use super::shape::Shape;
use super::table::{Measured, Pairing};
use crate::design::{Curve, Design};
use crate::numbers::{counted, middle, sorted};

/// Median and worst error of loads, in percent, above which frames without times may be missing.
const MISSING: [f64; 2] = [15.0, 100.0];

/// Constants from a recording, and how good they are.
#[derive(Clone, Debug, Serialize)]
pub struct Recorded {
    /// The design with them.
    #[serde(skip)]
    pub design: Design,
    /// Contacts, each from touch to release at one place.
    pub contacts: usize,
    /// Places that the contacts were at.
    pub places: usize,
    /// Smallest and largest load in newtons.
    pub loads: [f64; 2],
    /// Errors at places (or loads) that were left out; nothing if there are too few to leave any out.
    pub errors: Option<Errors>,
    /// The same with the design's own curve, or a straight line, and one gain for all taxels.
    pub errors_as_designed: Option<Errors>,
    /// Errors of the loads at what it was fitted to; nothing if no load is known.
    pub errors_fitted: Option<Errors>,
    /// What the recording could tell.
    pub determined: Vec<String>,
    /// What it could not, and what would.
    pub undetermined: Vec<String>,
    /// What else is to be known.
    pub remarks: Vec<String>,
    /// Each hold, its load as found when it was left out.
    pub holds: Vec<Hold>,
    /// Each taxel's gain.
    pub gains: Vec<TaxelGain>,
    /// Counts above rest and the pascals that they mean.
    pub points: Vec<[f64; 2]>,
}

impl Recorded {
    /// Refuses large errors of what was paired line by line.
    ///
    /// # Errors
    ///
    /// How large they are, and what may be wrong.
    pub fn refuse_missing(&self, measured: &Measured) -> Result<(), String> {
        let Some(errors) = self.errors.as_ref().or(self.errors_fitted.as_ref()) else { return Ok(()) };
        let [median, worst] = MISSING;
        if measured.pairing != Pairing::Lines || errors.median <= median && errors.worst <= worst {
            return Ok(());
        }
        let is_pressure = measured.forces.iter().flatten().all(Option::is_none);
        Err(format!(
            "{} errs by {:.0} % in the median, {:.0} % at worst; frames may be missing: give a column of times in both \
             files, or cut them so that they begin together",
            if is_pressure { "the pressure" } else { "F_z" },
            errors.median,
            errors.worst
        ))
    }
}

/// A stretch of frames with one load.
#[derive(Clone, Debug, Serialize)]
pub struct Hold {
    /// First and last frame, from 0.
    pub frames: [usize; 2],
    /// Number of its place.
    pub place: usize,
    /// Load in newtons, or pressure in pascals.
    pub measured_n: f64,
    /// The same as found.
    pub found_n: f64,
}

/// The gain of a taxel.
#[derive(Clone, Debug, Serialize)]
pub struct TaxelGain {
    /// Factor on its stress.
    pub gain: f64,
    /// Whether a contact was on it.
    pub touched: bool,
    /// Whether the recording says more of it than was assumed.
    pub told: bool,
}

/// Errors of the load in percent of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Of how many holds.
    pub holds: usize,
    /// Half of them err by less.
    pub median: f64,
    /// 95 % of them err by less.
    pub most: f64,
    /// The largest.
    pub worst: f64,
}

impl Errors {
    /// Of shares.
    pub fn of(errors: impl Iterator<Item = f64>) -> Self {
        let sorted = sorted(errors.map(|error| 100.0 * error.abs()));
        let at = |share: f64| {
            sorted.get((share * (sorted.len().max(1) - 1) as f64).round() as usize).copied().unwrap_or(0.0)
        };
        Self { holds: sorted.len(), median: at(0.5), most: at(0.95), worst: at(1.0) }
    }

    pub(super) fn words(&self) -> String {
        format!("{:.1} % in the median, {:.1} % in 95 of 100, {:.1} % at worst", self.median, self.most, self.worst)
    }
}

/// Puts everything into words.
pub(super) fn say(recorded: &mut Recorded, fitter: &Fitter<'_>, found: &Constants, friction: Verdict) {
    force(recorded, fitter, found);
    curve(recorded, fitter, found);
    gains(recorded, fitter, found);
    friction.map_or_else(|words| recorded.undetermined.push(words), |words| recorded.determined.push(words));
    spread(recorded, fitter);
}

fn force(recorded: &mut Recorded, fitter: &Fitter<'_>, found: &Constants) {
    if let (Some(errors), Some(folds)) = (&recorded.errors, &fitter.folds) {
        let before = recorded.errors_as_designed.as_ref().map_or(0.0, |errors| errors.median);
        let plain = fitter.kinds()[0];
        let better = if found.kind == plain && found.prior.is_none() {
            String::new()
        } else {
            format!("; with {} and one gain the median is {before:.1} %", plain.name())
        };
        let Folds { what, groups, .. } = folds;
        let words = errors.words();
        recorded.determined.push(format!("F_z: error {words}, at {what} left out ({groups} in turn){better}"));
    } else {
        recorded.determined.push("common gain: one factor for all taxels, from the mean of the loads".to_owned());
        recorded.undetermined.push(
            "errors: not checked, because too few places and loads are there to leave any out; record at least four places"
                .to_owned(),
        );
    }
    if recorded.places < 4 && fitter.folds.is_some() {
        recorded.undetermined.push(format!(
            "other places: all contacts are at {}; taxels elsewhere were not measured",
            if recorded.places == 1 { "one place".to_owned() } else { format!("{} places", recorded.places) }
        ));
    }
}

fn curve(recorded: &mut Recorded, fitter: &Fitter<'_>, found: &Constants) {
    let loads = {
        let [low, high] = recorded.loads;
        if fitter.levels.len() == 1 {
            format!("one load ({} N)", short(low))
        } else {
            format!("{} loads from {} to {} N", fitter.levels.len(), short(low), short(high))
        }
    };
    let top = fitter.readings.counts.largest();
    if fitter.kinds().len() == 1 {
        let why = if fitter.folds.is_none() { "nothing could check it" } else { "they are too close to each other" };
        let why = if fitter.levels.len() == 1 { "a curve takes at least two, better five" } else { why };
        recorded.undetermined.push(format!(
            "curve: {loads}: {why}; it stays {}. Record loads of which the largest is five times the smallest",
            found.kind.name()
        ));
        return;
    }
    let line = match &found.shape {
        Shape::Own(factor) => {
            format!("curve: the design's own, times {:.3}; no other shape has a smaller error", factor.abs())
        }
        Shape::Line(slope) => {
            format!("curve: a straight line, {slope:.4} Pa a count; no bent curve has a smaller error")
        }
        Shape::Power { power, scale, .. } => {
            // Before a gain of their own, and but for noise.
            let count = match (fitter.readings.sign * fitter.readings.counts.base).round() {
                0.0 => "count".to_owned(),
                rest => format!("|count - {rest}|"),
            };
            format!("curve: pascals = {scale:.4} {count}^{power:.3}, from {loads}")
        }
        Shape::Pieces { slopes, .. } => format!("curve: {} straight pieces, from {loads}", slopes.len()),
    };
    recorded.determined.push(line);
    match (&found.shape, &recorded.design.input.curve) {
        (Shape::Own(_) | Shape::Line(_), _) => {}
        (_, Some(Curve { law: Some(_), .. })) => {
            recorded.remarks.push(format!(
                "the power law goes on beyond the {top:.0} counts above the unloaded reading that were recorded"
            ));
        }
        _ => recorded.undetermined.push(format!(
            "curve: counts of more than {top:.0} above rest were not recorded: there it ends, and such frames are \
             \"saturated\". Record heavier loads if there are any"
        )),
    }
    if fitter.span() < 3.0 {
        recorded.remarks.push(format!(
            "the largest load is {:.1} times the smallest: the curve is known there only",
            fitter.span()
        ));
    }
}

/// Three digits behind the point, without zeros at the end.
fn short(value: f64) -> String {
    format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn gains(recorded: &mut Recorded, fitter: &Fitter<'_>, found: &Constants) {
    let count = recorded.gains.len();
    let untouched: Vec<usize> = (0..count).filter(|&taxel| !recorded.gains[taxel].touched).collect();
    let told = recorded.gains.iter().filter(|gain| gain.told).count();
    let list = |taxels: &[usize]| {
        let shown: Vec<String> = taxels.iter().take(12).map(usize::to_string).collect();
        format!("{}{}", shown.join(", "), if taxels.len() > 12 { ", …" } else { "" })
    };
    let Some(prior) = found.prior else {
        let why = if fitter.tells_gains() {
            "taxels' own gains do not reduce the error at other places".to_owned()
        } else {
            format!("contacts at {} do not determine single taxels", counted(recorded.places, "place"))
        };
        recorded.undetermined.push(format!(
            "gains: {why}; they stay as they are. Record contacts on every second taxel, or a bladder (--uniform)"
        ));
        return;
    };
    let smooth = if prior.range > 0.0 {
        format!("neighbours alike within {} pitches", prior.range)
    } else {
        "each for itself".to_owned()
    };
    let [differ, apart] = fitter.halves(found, prior);
    let trend = if apart > 0.7 * differ { ": a trend rather than each taxel's own gain" } else { "" };
    recorded.determined.push(format!(
        "gains: {told} of {count} taxels, {smooth}; they differ by {:.1} %, gains from the two halves of the recording by \
         {:.1} %{trend}",
        100.0 * differ,
        100.0 * apart
    ));
    let hardly = count - told - untouched.len();
    if hardly > 0 {
        recorded.undetermined.push(format!("gains: {hardly} of {count} taxels had too little load to determine theirs; they are drawn towards the others"));
    }
    if !untouched.is_empty() {
        recorded.undetermined.push(format!(
            "gains: no contact was on {} of {count} taxels ({}): their gains are unchanged",
            untouched.len(),
            list(&untouched)
        ));
    }
}

/// How well the sensor repeats, and how it creeps.
fn spread(recorded: &mut Recorded, fitter: &Fitter<'_>) {
    let holds = &fitter.holds.all;
    let creeps: Vec<f64> = holds.iter().filter_map(|hold| hold.creep).collect();
    let creep = middle(&creeps);
    if creep.abs() > 0.03 {
        recorded.remarks.push(format!(
            "under a constant load the readings {} by {:.0} % (median of {} holds): the sensor creeps. The constants are right for the mean of a hold; with --constant-load they are for readings without creep",
            if creep > 0.0 { "rise" } else { "fall" }, 100.0 * creep.abs(), creeps.len()
        ));
    }
    // The same load at the same place, another time.
    let (mut squares, mut count) = (0.0, 0);
    for (index, (hold, shown)) in holds.iter().zip(&recorded.holds).enumerate() {
        let again = holds.iter().zip(&recorded.holds).skip(index + 1).find(|(other, _)| {
            other.place == hold.place && other.contact != hold.contact && (other.load / hold.load - 1.0).abs() < 0.03
        });
        if let Some((other, later)) = again {
            squares += 0.5 * (shown.found_n / hold.load - later.found_n / other.load).powi(2);
            count += 1;
        }
    }
    if count > 2 {
        let repeats = 100.0 * (squares / f64::from(count)).sqrt();
        recorded.remarks.push(format!("the same load at the same place again differs by {repeats:.1} % ({count} pairs): no constants do better than that"));
    }
    if let Some(worst) = recorded
        .holds
        .iter()
        .max_by(|a, b| (a.found_n / a.measured_n - 1.0).abs().total_cmp(&(b.found_n / b.measured_n - 1.0).abs()))
    {
        let error = worst.found_n / worst.measured_n - 1.0;
        let errors = recorded.errors.as_ref().or(recorded.errors_fitted.as_ref());
        let typical = errors.map_or(0.0, |errors| errors.median / 100.0);
        if error.abs() > 0.15 && error.abs() > 5.0 * typical {
            recorded.remarks.push(format!(
                "frames {} to {} look wrong: {:.3} N for {:.3}; a contact over the edge, or a slip of the pen?",
                worst.frames[0], worst.frames[1], worst.found_n, worst.measured_n
            ));
        }
    }
}
