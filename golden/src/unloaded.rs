//! An unloaded sensor: what each taxel reads, how it varies, and which keys of a design follow.

use serde::Serialize;

use crate::check::{holds, together};
use crate::dead_taxels::MOST_DEAD;
use crate::design::{Calibration, Design, MeasuredNoise};
use crate::numbers::{counted, magnitude, mean, middle as median};

/// Fewer frames give no standard deviation.
const FRAMES: usize = 10;
/// A taxel that varies this many times as much as the median one is noisy.
const NOISY: f64 = 4.0;
/// What rounding to whole steps adds to a reading, as a deviation: the root of 1/12.
const ROUNDING: f64 = 0.289;
/// Where taxels vary by half a step, none reads the same in many frames by chance: by less than that in each frame.
const SAME: f64 = 0.7;
/// A chance that is none.
const NO_CHANCE: f64 = 1e-3;
/// A constant reading so many times the median distance from the median is stuck: no unloaded taxel reads that.
const FAR: f64 = 10.0;
/// This share of the readings at the least of all is a converter that clips there.
const CLIPPED: f64 = 0.05;
/// This share of them halves the noise, unless that is of a step or less.
const CUT: f64 = 0.2;
/// The noise floor in deviations, as `sptfra calibrate` has it.
const QUIET: f64 = 3.0;
/// A deviation, or a step, of this share of the full scale is no noise.
const LOUD: f64 = 0.01;
/// Noise that goes on from frame to frame by more than this is not averaged as white noise is.
const GOES_ON: f64 = 0.3;
/// Unloaded neighbours correlate by less than this.
const TOGETHER: f64 = 0.5;
/// Frames whose largest reading is this share of the largest of all have load.
const LOADED: f64 = 0.1;

/// What one taxel reads unloaded, in the units of the file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UnloadedTaxel {
    /// Its number.
    pub taxel: usize,
    /// Mean of its readings.
    pub offset: f64,
    /// Standard deviation about a straight line through them.
    pub noise: f64,
    /// Mean of the last third of the frames less that of the first third.
    pub drift: f64,
    /// Correlation of its noise with that of the next frame.
    pub correlation: f64,
}

/// What frames of an unloaded sensor measure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unloaded {
    /// A line for each taxel.
    pub taxels: Vec<UnloadedTaxel>,
    /// Taxels that never change while the others do, and those that the design says are dead.
    pub dead: Vec<usize>,
    /// Taxels that never change and read what no unloaded taxel does.
    pub stuck: Vec<usize>,
    /// Taxels that vary several times as much as the median one.
    pub noisy: Vec<usize>,
    /// Median deviation of the taxels that work, in the units of the file.
    pub noise: f64,
    /// The same in pascals, with what rounding adds at least.
    pub noise_pa: f64,
    /// For `algorithm.noise_floor_pa`: three deviations.
    pub noise_floor_pa: f64,
    /// The deviation over `hardware.full_scale_pa`: the noise of contacts that reach it.
    pub noise_of_full_scale: f64,
    /// Median of the taxels' drift, in the units of the file.
    pub drift: f64,
    /// Median correlation of the noise with that of the next frame.
    pub correlation: f64,
    /// Signs that something pressed, or that the recording does not suit.
    pub warnings: Vec<String>,
    /// Whether one of them says that something lay on the sensor or touched it.
    #[serde(skip)]
    pub touched: bool,
}

impl Unloaded {
    /// Measures frames of the design's unloaded sensor, with values as they are in the file.
    ///
    /// # Errors
    ///
    /// Too few frames, in words.
    pub fn of(design: &Design, frames: &[Vec<f64>]) -> Result<Self, String> {
        if frames.len() < FRAMES {
            let found = counted(frames.len(), "frame");
            return Err(format!(
                "{found} without load: too few to measure noise: record {FRAMES} at least, better 200"
            ));
        }
        let all: Vec<UnloadedTaxel> = (0..design.sensor.taxels()).map(|taxel| unloaded_taxel(frames, taxel)).collect();
        let known = |taxel: usize| design.input.dead.contains(&taxel);
        // Numbers with fractions have no known steps.
        let step = if frames.iter().flatten().all(|value| value.fract() == 0.0) { 1.0 } else { 0.0 };
        let middle = median(all.iter().filter(|each| !known(each.taxel)).map(|each| each.noise));
        let (dead, stuck, silent) = constant(design, frames, &all, middle, step);
        let works = |taxel: usize| !dead.contains(&taxel) && !stuck.contains(&taxel);
        let live: Vec<UnloadedTaxel> = all.iter().filter(|each| works(each.taxel)).copied().collect();
        let noise = median(live.iter().map(|each| each.noise));
        let usual = noise.max(ROUNDING * step);
        let noisy: Vec<usize> =
            live.iter().filter(|each| usual > 0.0 && each.noise > NOISY * usual).map(|each| each.taxel).collect();
        let pascals = |each: &UnloadedTaxel| {
            let of = |sign: f64| design.input.to_pa(each.taxel, each.offset + sign * each.noise.max(ROUNDING * step));
            0.5 * (of(1.0) - of(-1.0)).abs()
        };
        let noise_pa = median(live.iter().map(pascals));
        let drift = median(live.iter().map(|each| each.drift));
        let correlation = median(live.iter().map(|each| each.correlation));
        let full_scale = design.hardware.full_scale_pa;
        let mut rest = Self {
            taxels: all,
            dead,
            stuck,
            noisy,
            noise,
            noise_pa,
            noise_floor_pa: QUIET * noise_pa,
            noise_of_full_scale: noise_pa / full_scale,
            drift,
            correlation,
            warnings: Vec::new(),
            touched: false,
        };
        rest.warnings = rest.touches(design, usual);
        rest.warnings.extend(rest.others_than_rest(frames));
        rest.touched = !rest.warnings.is_empty();
        rest.warnings.extend(rest.others(frames, &silent, usual));
        Ok(rest)
    }

    /// Whether the noise goes on from frame to frame, so that averages lessen it less than they do white noise.
    pub fn goes_on(&self) -> bool {
        self.correlation > GOES_ON
    }

    fn works(&self, taxel: usize) -> bool {
        !self.dead.contains(&taxel) && !self.stuck.contains(&taxel)
    }

    /// Those that work.
    fn live(&self) -> impl Iterator<Item = &UnloadedTaxel> {
        self.taxels.iter().filter(|each| self.works(each.taxel))
    }

    /// Signs that something lay on the sensor or touched it.
    fn touches(&self, design: &Design, usual: f64) -> Vec<String> {
        let (mut said, full_scale) = (Vec::new(), design.hardware.full_scale_pa);
        let live: Vec<&UnloadedTaxel> = self.live().collect();
        if self.noise_pa > LOUD * full_scale {
            said.push(format!(
                "the median taxel varies by {:.1} Pa, more than a hundredth of hardware.full_scale_pa: did something touch \
                 the sensor, or is its unit another?",
                self.noise_pa
            ));
        }
        if self.noisy.len() > (self.taxels.len() / 20).max(2) {
            said.push(format!(
                "{} taxels vary {NOISY} times as much as the median one: did something touch the sensor?",
                self.noisy.len()
            ));
        }
        let middle = median(live.iter().map(|each| each.offset));
        let offsets: Vec<f64> =
            self.taxels.iter().map(|each| if self.works(each.taxel) { each.offset } else { middle }).collect();
        let spread = live.iter().map(|each| (each.offset - middle).abs()).fold(0.0, f64::max);
        if spread > 10.0 * usual && together(&design.sensor, &offsets) > TOGETHER {
            said.push(format!(
                "neighbours have like offsets, up to {spread:.1} from the median: does something lie on the sensor?"
            ));
        }
        said
    }

    /// Frames that read otherwise than nearly all, as a first one of zeros does.
    fn others_than_rest(&self, frames: &[Vec<f64>]) -> Option<String> {
        let middles: Vec<f64> =
            (0..self.taxels.len()).map(|taxel| median(frames.iter().map(|frame| frame[taxel]))).collect();
        let apart = |frame: &Vec<f64>| median(self.live().map(|each| (frame[each.taxel] - middles[each.taxel]).abs()));
        let apart: Vec<f64> = frames.iter().map(apart).collect();
        let least = FAR * median(apart.iter().copied());
        let far: Vec<usize> = (0..frames.len()).filter(|&frame| apart[frame] > least).map(|frame| frame + 1).collect();
        (least > 0.0 && !far.is_empty() && FAR * far.len() as f64 <= frames.len() as f64).then(|| {
            format!(
                "{} of {} read otherwise than all others, the first is frame {}, by {:.1}: leave them out, such as lines at the \
                 beginning with --skip-lines",
                far.len(),
                counted(frames.len(), "frame"),
                far[0],
                apart[far[0] - 1]
            )
        })
    }

    /// Signs that the recording does not suit.
    fn others(&self, frames: &[Vec<f64>], silent: &[usize], usual: f64) -> Vec<String> {
        let mut said = Vec::new();
        if self.noise <= 0.0 {
            said.push(
                "the median taxel never changes: its noise is below the converter's steps, or clipped at its end, and which \
                 taxels are dead is not told"
                    .to_owned(),
            );
        }
        if self.goes_on() {
            said.push(format!(
                "the noise goes on from frame to frame (correlation {:.2}): smoothing brings less than at white noise",
                self.correlation
            ));
        }
        // A third of the frames each, with their noise.
        let chance = usual * (6.0 / frames.len() as f64).sqrt();
        if self.drift.abs() > usual && self.drift.abs() > 4.0 * chance {
            said.push(format!(
                "the median taxel drifts by {:.1}, more than its noise: let the sensor warm up, and wait after a load",
                self.drift
            ));
        }
        let readings: Vec<f64> = frames.iter().flat_map(|frame| self.live().map(|each| frame[each.taxel])).collect();
        for (pick, which) in [(f64::min as fn(f64, f64) -> f64, "least"), (f64::max, "largest")] {
            let end = readings.iter().copied().reduce(pick).unwrap_or(0.0);
            let share =
                readings.iter().filter(|value| value.total_cmp(&end).is_eq()).count() as f64 / readings.len() as f64;
            if share > CUT && self.noise > 1.0 {
                said.push(format!(
                    "{:.0} % of the readings are {end}, the {which} of all: the converter clips the noise there, which is larger \
                     than measured, and shifts the offsets; let its range reach beyond the offsets",
                    100.0 * share
                ));
            }
        }
        if !silent.is_empty() {
            said.push(format!(
                "taxels {silent:?} never change; the converter clips there, or its steps are larger than the noise: press on \
                 them to see whether they are dead"
            ));
        }
        said
    }

    /// The noise in pascals, and the largest stress of a typical frame of contacts: for `sensor.noise`.
    ///
    /// # Errors
    ///
    /// No frame has load, or nearly all frames with load pull, in words.
    pub fn noise_of(&self, design: &Design, loaded: &[Vec<f64>]) -> Result<MeasuredNoise, String> {
        let above = |frame: &Vec<f64>| -> Vec<f64> {
            let of = |taxel: usize, value: f64| design.input.to_pa(taxel, value);
            self.live().map(|each| of(each.taxel, frame[each.taxel]) - of(each.taxel, each.offset)).collect()
        };
        let above: Vec<Vec<f64>> = loaded.iter().map(above).collect();
        let largest = magnitude(above.iter().flatten());
        let of_contacts = || above.iter().filter(|frame| magnitude(*frame) >= LOADED * largest);
        let typical = median(of_contacts().map(magnitude));
        if typical <= QUIET * self.noise_pa {
            return Err("no frame has load above the noise; record contacts".to_owned());
        }
        let [pull, all] =
            [of_contacts().filter(|frame| frame.iter().sum::<f64>() > 0.0).count(), of_contacts().count()];
        if holds(pull, all) {
            return Err(format!(
                "{pull} of {all} frames read less load than the unloaded ones: did something press while those were recorded? \
                 Record them anew; if nothing did, the sign is wrong: compression must be negative"
            ));
        }
        Ok(MeasuredNoise { deviation: self.noise_pa, largest: typical })
    }

    /// Gains and offsets with which these readings are none: the design's gains, 0 for dead and stuck taxels.
    ///
    /// # Errors
    ///
    /// A design without counts, or more dead taxels than it may have, in words.
    pub fn calibration(&self, design: &Design, frames: &[Vec<f64>]) -> Result<Calibration, String> {
        if !design.input.counts() {
            return Err(
                "sensor.calibration is for counts, and this design's frames are in pascals: write sensor.pa_per_count, what a \
                 count is worth, or 1.0 to have offsets in pascals taken off"
                    .to_owned(),
            );
        }
        let (dead, most) = (self.dead.len() + self.stuck.len(), MOST_DEAD.min(self.taxels.len() / 2));
        if dead > most {
            return Err(format!(
                "{dead} taxels are dead or stuck, and {most} of this sensor's can be replaced: mend the sensor, or leave out \
                 the part of it"
            ));
        }
        let (gain, offset) = self
            .taxels
            .iter()
            .map(|each| {
                if !self.works(each.taxel) {
                    return (0.0, 0.0);
                }
                let (gain, _) = design.input.of_taxel(each.taxel);
                let reading = match &design.input.curve {
                    // In pascals; that of the mean count is another.
                    Some(curve) => mean(frames.iter().map(|frame| curve.at(frame[each.taxel]))),
                    None => each.offset,
                };
                // No offset is -0.
                (gain, 0.0 - gain * reading)
            })
            .unzip();
        Ok(Calibration { gain, offset })
    }
}

fn unloaded_taxel(frames: &[Vec<f64>], taxel: usize) -> UnloadedTaxel {
    let count = frames.len() as f64;
    let mean = |frames: &[Vec<f64>]| mean(frames.iter().map(|frame| frame[taxel]));
    let offset = mean(frames);
    let time = |index: usize| index as f64 - 0.5 * (count - 1.0);
    let readings = || frames.iter().enumerate().map(|(index, frame)| (time(index), frame[taxel] - offset));
    let slope = readings().map(|(time, value)| time * value).sum::<f64>()
        / readings().map(|(time, _)| time * time).sum::<f64>();
    let noise: Vec<f64> = readings().map(|(time, value)| value - slope * time).collect();
    let squares: f64 = noise.iter().map(|value| value * value).sum();
    let products: f64 = noise.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let third = frames.len() / 3;
    UnloadedTaxel {
        taxel,
        offset,
        noise: (squares / (count - 2.0)).sqrt(),
        drift: mean(&frames[frames.len() - third..]) - mean(&frames[..third]),
        correlation: if squares > 0.0 { products / squares } else { 0.0 },
    }
}

/// Taxels that never change: the dead ones, the stuck ones, and those of which unloaded frames do not show it.
fn constant(
    design: &Design,
    frames: &[Vec<f64>],
    all: &[UnloadedTaxel],
    noise: f64,
    step: f64,
) -> (Vec<usize>, Vec<usize>, Vec<usize>) {
    let never = |taxel: usize| frames.iter().all(|frame| frame[taxel].to_bits() == frames[0][taxel].to_bits());
    let others: Vec<&UnloadedTaxel> = all.iter().filter(|each| !never(each.taxel)).collect();
    let middle = median(others.iter().map(|each| each.offset));
    let near = median(others.iter().map(|each| (each.offset - middle).abs())).max(noise).max(step);
    let least = frames.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let at_least = others.iter().flat_map(|each| frames.iter().map(|frame| frame[each.taxel])).filter(|&v| v <= least);
    let clips = at_least.count() as f64 > CLIPPED * (others.len() * frames.len()) as f64;
    let tells =
        noise >= 0.5 * step && noise > 0.0 && all.len() as f64 * SAME.powf(frames.len() as f64 - 1.0) < NO_CHANCE;
    let (mut dead, mut stuck, mut silent) = (design.input.dead.clone(), Vec::new(), Vec::new());
    for taxel in (0..all.len()).filter(|&taxel| never(taxel) && !design.input.dead.contains(&taxel)) {
        let reads = frames[0][taxel];
        let is_far = !others.is_empty() && (reads - middle).abs() > FAR * near && reads != 0.0;
        let is_end = design.input.to_pa(taxel, reads).abs() >= design.hardware.full_scale_in_frames();
        if is_end || tells && is_far {
            stuck.push(taxel);
        } else if tells && !(clips && reads <= least) {
            dead.push(taxel);
        } else if !others.is_empty() && 2 * others.len() > all.len() {
            silent.push(taxel);
        }
    }
    dead.sort_unstable();
    (dead, stuck, silent)
}
