//! Constants from frames under uniform pressure: a bladder over all taxels.
//!
//! Every taxel feels the same pressure, so that each has an equation of its own, `gain_i curve(count_i) = p`: the curve is
//! what the taxels have in common, each gain what is left.

use super::RecordedError;
use super::fit::{ALIKE, AS_GOOD};
use super::folds::{Folds, levels};
use super::holds::{self, Hold as Step, Holds};
use super::loads;
use super::readings::Readings;
use super::report::{Errors, Hold, Recorded, TaxelGain};
use super::shape::{self, Kind, Shape, Terms};
use super::table::Measured;
use crate::dead_taxels::MOST_DEAD;
use crate::design::Design;
use crate::numbers::{magnitude, mean, middle};

/// A taxel that reads less than this share of what the others do is dead.
const DEAD: f64 = 0.1;
/// Pressures of which the largest is less than so many times the smallest tell no curve.
const SPAN: f64 = 2.0;
/// Rounds of curve and gains in turns.
const ROUNDS: usize = 6;
/// Penalties on the slopes of pieces that are tried.
const SMOOTH: [f64; 2] = [0.01, 1e-4];
/// Taxels at the border that read so much less than the others: does the bladder reach far enough?
const BORDER: f64 = 0.1;

/// Fits gains of the taxels, and the curve where the pressures tell it, to frames under known uniform pressures.
///
/// # Errors
///
/// [`RecordedError::Wrong`] for pressures that do not belong to the frames, or too many taxels that read nothing.
pub fn fit_uniform(design: &Design, frames: &[Vec<f64>], measured: &Measured) -> Result<Recorded, RecordedError> {
    let wrong = |wrong| RecordedError::of(&design.name, wrong);
    let (paired, measured, mut remarks) =
        loads::pair(design, frames, measured, &loads::Follow::Pressures).map_err(wrong)?;
    let frames = &frames[paired];
    remarks.splice(0..0, measured.remarks.iter().cloned());
    // With crosstalk a taxel under the pressure of all reads so many times that.
    let reads = design.crosstalk().map_or(1.0, |crosstalk| crosstalk.under_uniform_pressure());
    // A pressure is a load at one place.
    let as_loads = Measured {
        forces: measured
            .pressures
            .iter()
            .map(|pressure| [None, None, pressure.map(|pressure| -reads * pressure.abs())])
            .collect(),
        contacts: Some(vec![String::new(); measured.pressures.len()]),
        ..Measured::default()
    };
    let mut parted = holds::part(design, frames, &as_loads).map_err(wrong)?;
    remarks.append(&mut parted.remarks);
    let mut work = Uniform::new(design, &parted);
    let mut design = design.clone();
    let dead = work.dead(&design);
    let most = match design.input.room {
        0 => MOST_DEAD.min(design.sensor.taxels() / 2),
        room => room,
    };
    if dead.len() > most {
        return Err(wrong((
            format!("{} of {} taxels read next to nothing under pressure", dead.len(), design.sensor.taxels()),
            format!("cover all taxels with the bladder; at most {most} dead ones can be replaced"),
        )));
    }
    let news: Vec<usize> = dead.iter().copied().filter(|taxel| !design.input.dead.contains(taxel)).collect();
    if !news.is_empty() {
        let listed: Vec<String> = news.iter().map(usize::to_string).collect();
        remarks.push(format!(
            "dead: taxels {} read next to nothing under pressure; sensor.dead names them now",
            listed.join(", ")
        ));
        design.input.dead.extend(news);
        design.input.dead.sort_unstable();
    }
    work.alive = (0..design.sensor.taxels()).map(|taxel| !design.input.dead.contains(&taxel)).collect();
    let steps = levels(parted.all.iter().map(|hold| hold.load));
    let span = steps.last().map_or(1.0, |last| last[1]) / steps[0][0];
    let folds = Folds::new(&parted.all);
    let mut kinds = if design.input.curve.is_some() { vec![Kind::Own, Kind::Line] } else { vec![Kind::Line] };
    if folds.is_none() || span < SPAN {
        kinds.truncate(1);
    } else {
        kinds.push(Kind::Power);
        kinds.extend(SMOOTH.map(Kind::Pieces));
    }
    let scores: Vec<(Kind, Vec<f64>)> =
        folds.iter().flat_map(|folds| kinds.iter().map(|&kind| (kind, work.validate(kind, folds)))).collect();
    let rms = |errors: &[f64]| mean(errors.iter().map(|error| error * error)).sqrt();
    let best = scores.iter().map(|(_, errors)| rms(errors)).fold(f64::INFINITY, f64::min);
    let chosen = scores.iter().find(|(_, errors)| rms(errors) <= AS_GOOD * best + ALIKE);
    let kind = chosen.map_or(kinds[0], |(kind, _)| *kind);
    let all: Vec<usize> = (0..parted.all.len()).collect();
    let (shape, gains) = work.fit(kind, &all);
    let fitted = work.errors(&shape, &gains, &all);
    let peaks = work.peaks(&shape, &gains);
    let range = [peaks.iter().copied().fold(f64::INFINITY, f64::min), magnitude(&peaks)];
    let calibrated = work.readings.calibrated(&design, &shape, &gains, range, &mut remarks);
    let pressure = |holds: &Step| {
        let of = |taxel: usize| gains[taxel] * shape.at(taxel, holds.x[taxel], &work.readings.counts);
        mean(work.living().map(of))
    };
    let shown = parted.all.iter().map(|hold| Hold {
        frames: [hold.frames.start, hold.frames.end - 1],
        place: 0,
        measured_n: hold.load / reads,
        found_n: pressure(hold) / reads,
    });
    let mut recorded = Recorded {
        holds: shown.collect(),
        gains: gains
            .iter()
            .zip(&work.alive)
            .map(|(&gain, &alive)| TaxelGain { gain, touched: alive, told: alive })
            .collect(),
        errors: chosen.map(|(_, errors)| Errors::of(errors.iter().copied())),
        errors_as_designed: scores.first().map(|(_, errors)| Errors::of(errors.iter().copied())),
        errors_fitted: Some(Errors::of(fitted.into_iter())),
        points: work.readings.points(&calibrated.input),
        contacts: parted.contacts,
        places: 0,
        loads: [steps[0][0], steps.last().map_or(0.0, |last| last[1])].map(|load| load / reads),
        determined: Vec::new(),
        undetermined: Vec::new(),
        remarks,
        design: calibrated,
    };
    say(&mut recorded, (&kinds, kind, &shape), steps.len(), span);
    Ok(recorded)
}

struct Uniform<'a> {
    holds: &'a Holds,
    readings: Readings,
    trust: Vec<f64>,
    alive: Vec<bool>,
}

impl<'a> Uniform<'a> {
    fn new(design: &Design, holds: &'a Holds) -> Self {
        let readings = Readings::new(holds, &design.input);
        let trust = holds.all.iter().map(|hold| 1.0 / hold.load).collect();
        Self { holds, readings, trust, alive: vec![true; design.sensor.taxels()] }
    }

    fn living(&self) -> impl Iterator<Item = usize> {
        (0..self.alive.len()).filter(|&taxel| self.alive[taxel])
    }

    /// Taxels that read next to nothing where the others do, and those that the design says are dead.
    fn dead(&self, design: &Design) -> Vec<usize> {
        let reads = |taxel: usize| self.holds.all.iter().map(|hold| hold.x[taxel]).fold(f64::NEG_INFINITY, f64::max);
        let middle = middle((0..self.alive.len()).map(reads));
        (0..self.alive.len())
            .filter(|&taxel| reads(taxel) < DEAD * middle || design.input.dead.contains(&taxel))
            .collect()
    }

    fn terms<'b>(&'b self, weights: &'b [Vec<f64>], x: &'b [&'b [f64]], loads: &'b [f64]) -> Terms<'b> {
        Terms { weights, x, loads, trust: &self.trust, counts: &self.readings.counts }
    }

    /// Curve and gains, of mean 1, from some of the pressures.
    fn fit(&self, kind: Kind, holds: &[usize]) -> (Shape, Vec<f64>) {
        let x: Vec<&[f64]> = self.holds.all.iter().map(|hold| hold.x.as_slice()).collect();
        let loads: Vec<f64> = self.holds.all.iter().map(|hold| hold.load).collect();
        let count = self.living().count() as f64;
        let weights = |gains: &[f64]| {
            let share = |(gain, &alive): (&f64, &bool)| if alive { gain / count } else { 0.0 };
            vec![gains.iter().zip(&self.alive).map(share).collect::<Vec<f64>>(); x.len()]
        };
        let mut gains = vec![1.0; self.alive.len()];
        for _ in 0..ROUNDS {
            let weights = weights(&gains);
            let terms = self.terms(&weights, &x, &loads);
            let shape = shape::fit(kind, &terms, holds);
            for taxel in self.living() {
                let (mut reads, mut squares) = (0.0, 0.0);
                for &hold in holds {
                    let z = shape.at(taxel, x[hold][taxel], terms.counts) / loads[hold];
                    (reads, squares) = (reads + z, squares + z * z);
                }
                gains[taxel] = if squares > 0.0 { (reads / squares).clamp(1e-2, 16.0) } else { 1.0 };
            }
            let mean = mean(self.living().map(|taxel| gains[taxel]));
            self.living().for_each(|taxel| gains[taxel] /= mean);
        }
        // The curve belongs to the last gains.
        (shape::fit(kind, &self.terms(&weights(&gains), &x, &loads), holds), gains)
    }

    /// Relative errors of every taxel's pressure.
    fn errors(&self, shape: &Shape, gains: &[f64], holds: &[usize]) -> Vec<f64> {
        let of = |&hold: &usize| {
            let Step { x, load, .. } = &self.holds.all[hold];
            let error = |taxel: usize| gains[taxel] * shape.at(taxel, x[taxel], &self.readings.counts) / load - 1.0;
            self.living().map(error).collect::<Vec<_>>()
        };
        holds.iter().flat_map(of).collect()
    }

    /// The same where pressures are left out in turn.
    fn validate(&self, kind: Kind, folds: &Folds) -> Vec<f64> {
        let errors = folds.parts().flat_map(|[kept, left]| {
            let (shape, gains) = self.fit(kind, &kept);
            self.errors(&shape, &gains, &left)
        });
        errors.collect()
    }

    /// The largest stress of each hold.
    fn peaks(&self, shape: &Shape, gains: &[f64]) -> Vec<f64> {
        let peak = |hold: &Step| {
            let stress =
                self.living().map(|taxel| gains[taxel] * shape.at(taxel, hold.x[taxel], &self.readings.counts));
            stress.fold(0.0, f64::max)
        };
        self.holds.all.iter().map(peak).collect()
    }
}

fn say(recorded: &mut Recorded, (kinds, kind, shape): (&[Kind], Kind, &Shape), levels: usize, span: f64) {
    let living = recorded.gains.iter().filter(|gain| gain.told).count();
    let spread = {
        let squares: f64 = recorded.gains.iter().filter(|gain| gain.told).map(|gain| (gain.gain - 1.0).powi(2)).sum();
        100.0 * (squares / living as f64).sqrt()
    };
    recorded.determined.push(format!(
        "gains: all {living} taxels that are not dead; they differ by {spread:.1} % (standard deviation)"
    ));
    match &recorded.errors {
        Some(errors) => recorded.determined.push(format!("pressure: error of a taxel {}, at pressures left out in turn", errors.words())),
        None => recorded.undetermined.push(format!("errors: {levels} pressures are too few to leave any out, so nothing is checked; record at least three, better ten")),
    }
    if kinds.len() == 1 {
        recorded.undetermined.push(format!(
            "curve: {levels} pressure{}, the largest {span:.1} times the smallest; it stays {}. Record five or more over a factor of ten",
            if levels == 1 { "" } else { "s" }, kind.name()
        ));
    } else {
        let what = match shape {
            Shape::Own(factor) => format!("the design's own, times {factor:.3}"),
            Shape::Line(slope) => format!("a straight line, {slope:.4} Pa a count"),
            Shape::Power { power, .. } => format!("a power of {power:.3}"),
            Shape::Pieces { slopes, .. } => format!("{} straight pieces", slopes.len()),
        };
        recorded.determined.push(format!("curve: {what}, from {levels} pressures"));
    }
    let border = border(recorded);
    if border > BORDER {
        recorded.remarks.push(format!(
            "the taxels at the border read {:.0} % less than the others: does the bladder reach a layer's depth beyond them? If it does not, their gains are too large",
            100.0 * border
        ));
    }
    recorded
        .undetermined
        .push("forces: uniform pressure does not check forces; check with a weight (--frames and --forces)".to_owned());
}

/// By how much the taxels at the border read less.
fn border(recorded: &Recorded) -> f64 {
    let sensor = &recorded.design.sensor;
    let (mut inside, mut outside) = (Vec::new(), Vec::new());
    for (taxel, gain) in recorded.gains.iter().enumerate().filter(|(_, gain)| gain.told) {
        let [x, y] = [taxel % sensor.columns, taxel / sensor.columns];
        let at_border = x == 0 || y == 0 || x + 1 == sensor.columns || y + 1 == sensor.rows;
        if at_border { &mut outside } else { &mut inside }.push(1.0 / gain.gain);
    }
    if inside.is_empty() || outside.is_empty() { 0.0 } else { 1.0 - mean(&outside) / mean(&inside) }
}
