//! The integer model: executes a plan bit for bit as the hardware does.
//!
//! One packet of input words in, one frame of output words out. Order of summation does not matter: every sum is
//! exact in its width, by the bounds of the plan.

pub mod contacts;
mod integer;
mod range;
mod status;
mod summary;
#[cfg(test)]
mod tests;

use std::ops::Range;

use golden::design::Tension;
use golden::products::{ByPq, Frame, Scalar};

use crate::cores::{fixed_to_float, float_to_fixed};
use crate::estimators::{Contact, Inputs};
use crate::format::FRICTION_FRACTION;
use crate::plan::calibration::{Bank, Reading};
use crate::plan::dead::{DeadPlan, GUESSED_SHARE};
use crate::plan::product::{Coefficients, Product, Vector};
use crate::plan::smoothing::{Average, MOST_RATE};
use crate::plan::vector_formats::field_shifts;
use crate::plan::{Plan, words};

use integer::Integer;
use range::Scaled;
pub use status::*;
use summary::Summary;
pub use summary::inverse_gain;

/// [`golden::solver::PULLING`] with [`FRICTION_FRACTION`] fraction bits.
pub const PULLING: i64 = (golden::solver::PULLING * (1_u32 << FRICTION_FRACTION) as f64) as i64;

pub use crate::plan::SUMMARY_WORDS;

/// Executes a plan, frame by frame.
#[derive(Clone, Debug)]
pub struct Model<'plan> {
    plan: &'plan Plan,
    frames: u16,
    /// Whether the last frame slipped.
    slips: bool,
    /// Of a calibration in RAM, the active bank, and how many were before it.
    bank: Option<Bank>,
    version: u8,
    /// What readings have crept, taxel by taxel.
    creep: Vec<i64>,
    average: Average,
    /// The weight of a frame in it is `2^-rate`.
    rate: u32,
}

impl<'plan> Model<'plan> {
    /// A model just out of reset.
    pub fn new(plan: &'plan Plan) -> Self {
        let bank = plan.calibration.as_ref().map(|calibration| calibration.power_up.clone());
        let rate = plan.smoothing.as_ref().map_or(0, |smoothing| smoothing.rate);
        Self { plan, frames: 0, slips: false, bank, version: 0, creep: Vec::new(), average: Average::default(), rate }
    }

    /// The bank that is active for the frames from now on, where the design's calibration is in RAM.
    pub fn commit(&mut self, bank: Bank) {
        if self.bank.replace(bank).is_some() {
            self.version = self.version.wrapping_add(1);
        }
    }

    /// What is written to the register `SMOOTHING`: from the next frame on the weight of a frame in the average is `2^-rate`.
    pub fn smooth(&mut self, rate: u32) {
        self.rate = rate.min(MOST_RATE);
    }

    /// As after a soft reset of the hardware: frame counter, creep and average start again; calibration and rate stay.
    pub fn reset(&mut self) {
        (self.frames, self.slips) = (0, false);
        self.creep.clear();
        self.average = Average::default();
    }

    /// The output frame for one packet: its words in memory's order, float32 in Pa, up to the last of the beat with TLAST;
    /// words that are missing in that are 0. Its timestamp is 0: when a packet comes is not the model's to know.
    pub fn process(&mut self, packet: &[u32]) -> Vec<u32> {
        let mut words = self.answer_to(packet);
        words[words::COUNTERS] |= u32::from(self.version) << 8;
        words
    }

    fn answer_to(&mut self, packet: &[u32]) -> Vec<u32> {
        let counter = u32::from(self.frames) << 16;
        self.frames = self.frames.wrapping_add(1);
        let (taxels, streams) = (self.plan.taxels(), self.plan.streams());
        let words = packet.iter().copied().chain(std::iter::repeat(0)).take(streams.whole_beats(packet.len()));
        let samples = streams.samples_of(words).take(taxels);
        let converted: Vec<Reading> = samples.enumerate().map(|(taxel, word)| self.convert(taxel, word)).collect();
        let mut bad = 0;
        if !streams.is_frame(packet.len()) {
            bad |= BAD_LENGTH;
        }
        if converted.iter().any(|stress| stress.not_finite) {
            bad |= NOT_FINITE;
        }
        if bad != 0 {
            return self.blank(counter | bad);
        }
        let mut saturated = converted.iter().any(|stress| stress.saturated);
        let mut stress: Vec<i64> = converted.iter().map(|stress| stress.steps).collect();
        if let Some(dead) = self.dead() {
            saturated |= dead.replace(&mut stress, self.plan.formats.stress);
        }
        if let Some(crosstalk) = &self.plan.crosstalk {
            crosstalk.remove(&mut stress, self.plan.formats.stress);
        }
        if let Some(creep) = &self.plan.creep {
            creep.remove(&mut self.creep, &mut stress, self.plan.formats.stress);
        }
        let replaced = self.plan.dead.as_ref().or(self.bank.as_ref().map(|bank| &bank.dead.dead));
        let replaced = replaced.map_or(&[][..], |dead| &dead.taxels);
        if let Some(smoothing) = &self.plan.smoothing {
            smoothing.take(self.rate, &mut self.average, &mut stress, replaced);
        }
        let replaced_sum: i64 = replaced.iter().map(|&taxel| stress[taxel].abs()).sum();
        let mut noted = if self.replaced() > 0 { REPLACED } else { 0 };
        let stress_sum = Contact::new(&stress, self.plan.design.sensor.columns).stress_sum;
        if GUESSED_SHARE * replaced_sum > stress_sum {
            noted |= TOO_MANY_REPLACED;
        }
        let contact = self.bank.as_ref().map_or(self.plan.thresholds.contact, |bank| i64::from(bank.contact));
        if stress_sum < contact {
            self.slips = false;
            return self.blank(counter | NO_CONTACT);
        }
        let mut words = self.answer(counter | noted, &stress, saturated);
        words[words::COUNTERS] |= (self.replaced() as u32) << 16;
        words
    }

    /// Taxels whose readings others replace, in ROM or of the active bank.
    fn dead(&self) -> Option<&DeadPlan> {
        self.plan.dead.as_ref().or(self.bank.as_ref().map(|bank| &bank.dead.dead))
    }

    fn replaced(&self) -> usize {
        self.dead().map_or(0, |dead| dead.taxels.len())
    }

    /// Stress of a taxel that is noise, in steps of what was read: of the active bank, where there is one.
    fn noise_floor(&self) -> i64 {
        self.bank.as_ref().map_or(self.plan.thresholds.taxel, |bank| i64::from(bank.noise))
    }

    /// One input word as stress.
    fn convert(&self, taxel: usize, word: u32) -> Reading {
        let format = self.plan.formats.stress;
        if self.dead().is_some_and(|dead| dead.taxels.contains(&taxel)) {
            return Reading { steps: 0, saturated: false, not_finite: false };
        }
        if let Some((calibration, bank)) = self.plan.calibration.as_ref().zip(self.bank.as_ref()) {
            return calibration.stress_of(bank, taxel, word);
        }
        let Some(counts) = &self.plan.counts else {
            let converted = float_to_fixed::convert(word, -format.lsb, format.bound as u32);
            let steps = i64::from(converted.fixed);
            return Reading { steps, saturated: converted.saturated, not_finite: converted.not_finite };
        };
        counts.stress_of(taxel, word, format)
    }

    fn answer(&mut self, counter: u32, stress: &[i64], saturated: bool) -> Vec<u32> {
        let scaled = Scaled::new(self.plan, stress, self.average.variance);
        let (mut words, summary) = match self.plan.formats.folded {
            None => self.execute(&integer::by_taxel(self.plan), counter, &scaled, saturated),
            Some(_) => self.execute(&integer::by_orbit(self.plan), counter, &scaled, saturated),
        };
        scaled.back(&mut words);
        let read = self.plan.design.input.tension == Tension::Read;
        let pushed = summary.friction.iter().map(|mu| mu.abs()).sum::<i64>() >= PULLING;
        if read
            && (pushed || words[words::STATUS] & DIRECTION_UNKNOWN != 0)
            && stress.iter().all(|&stress| stress <= self.noise_floor())
        {
            words[words::STATUS] |= NO_TENSION;
        }
        if let Some([limit, release]) = self.plan.thresholds.slip {
            self.slips = summary.friction_coefficient() >= if self.slips { release } else { limit };
            words[words::STATUS] |= if self.slips { SLIP } else { 0 };
        }
        words
    }

    fn execute<const W: usize>(
        &self,
        integers: &Scalar<Integer<'_>, W>,
        counter: u32,
        scaled: &Scaled,
        saturated: bool,
    ) -> (Vec<u32>, Summary) {
        let products = &self.plan.products;
        let needs_friction = |product: &Product| product.coefficients == Coefficients::Friction;
        let search = products.iter().position(needs_friction).unwrap_or(products.len());
        let mut frame = frame(self.plan, integers, &scaled.stress);
        run(self.plan, integers, 0..search, [0, 0], &mut frame);
        let contacts = self.count_contacts(&frame);
        let floor = self.noise_floor() << scaled.exponent;
        let (mut words, summary) = scalars(self.plan, counter, scaled, floor, saturated, &frame.sums, &frame.u);
        words[words::COUNTERS] |= contacts;
        words[words::STATUS] |= if contacts > 1 { SEVERAL_CONTACTS } else { 0 };
        run(self.plan, integers, search..products.len(), summary.friction, &mut frame);
        if self.plan.has_field() {
            words.extend(self.field(&frame, summary.friction));
        }
        (words, summary)
    }

    /// Contacts of a frame whose weights are there: one, where the design does not count them.
    fn count_contacts<const W: usize>(&self, frame: &Integers<'_, W>) -> u32 {
        let Plan { design, formats, .. } = self.plan;
        if !design.algorithm.count_contacts {
            return 1;
        }
        let weight = match formats.folded {
            None => frame.get(Vector::Weight).as_flattened(),
            Some(_) => &frame.weight,
        };
        contacts::count(weight, design.sensor.columns)
    }

    /// Forces of every taxel, from what the plan's products have left of them.
    fn field<const W: usize>(&self, frame: &Integers<'_, W>, [mu_x, mu_y]: [i64; 2]) -> Vec<u32> {
        let formats = &self.plan.formats;
        let shares = [mu_x, mu_y, -(1 << FRICTION_FRACTION)];
        let of_taxel = |taxel: usize| -> [u32; 3] {
            std::array::from_fn(|p| match &formats.folded {
                None => {
                    let [g0, g1, g2] = [0, 1, 2].map(|q| frame.get(Vector::G(1 + p as u8, q)).as_flattened()[taxel]);
                    let force = (g0 << FRICTION_FRACTION) + mu_x * g1 + mu_y * g2;
                    fixed_to_float::convert(force, formats.g.lsb - FRICTION_FRACTION as i32)
                }
                Some(folded) => {
                    let (force_shift, weight_shift, exponent) = field_shifts(formats, folded);
                    let share = (shares[p] * frame.weight[taxel]) << weight_shift;
                    fixed_to_float::convert((frame.force[p][taxel] << force_shift) + share, exponent)
                }
            })
        };
        (0..self.plan.taxels()).flat_map(of_taxel).collect()
    }

    fn blank(&self, status: u32) -> Vec<u32> {
        let mut words = vec![0; self.plan.streams().words_out];
        words[0] = status;
        words
    }
}

/// A frame in the integers of a plan.
type Integers<'plan, const W: usize> = Frame<Scalar<Integer<'plan>, W>>;

/// A frame with its stress, of each taxel.
fn frame<'plan, const W: usize>(
    plan: &'plan Plan,
    integers: &Scalar<Integer<'plan>, W>,
    stress: &[i64],
) -> Integers<'plan, W> {
    let mut frame = Frame::new(integers, plan.products.iter().map(|product| &product.step));
    frame.stress.copy_from_slice(stress);
    frame.load(integers);
    frame
}

/// Executes products of a plan.
fn run<'plan, const W: usize>(
    plan: &'plan Plan,
    integers: &Scalar<Integer<'plan>, W>,
    products: Range<usize>,
    friction: [i64; 2],
    frame: &mut Integers<'plan, W>,
) {
    for index in products {
        frame.step(integers, index, &plan.products[index].step, friction);
    }
}

/// The words before the field, from the sums `G_pq` and the vectors `u_q` of a frame; what Op found goes with
/// them. The noise floor is scaled as the frame is.
fn scalars(
    plan: &Plan,
    counter: u32,
    scaled: &Scaled,
    noise_floor: i64,
    saturated: bool,
    sums: &ByPq<i64>,
    u: &[Vec<i64>; 3],
) -> (Vec<u32>, Summary) {
    let (sensor, stress) = (&plan.design.sensor, scaled.stress.as_slice());
    // The estimator takes the upper bits.
    let below = plan.formats.u.bits - plan.formats.u.narrowed().bits;
    let upper = u.each_ref().map(|of_q| of_q.iter().map(|value| value >> below).collect());
    let contact = Contact::new(stress, sensor.columns);
    let inputs = Inputs { sensor, stress, contact, noise_floor, sums, u: &upper };
    let estimate = plan.estimator.block().find(&inputs);
    let summary = Summary::new(sums, estimate.friction);

    let mut status = counter;
    if estimate.unknown {
        status |= DIRECTION_UNKNOWN;
    } else if estimate.at_bound {
        status |= AT_BOUND;
    }
    if saturated || estimate.saturated {
        status |= SATURATED;
    }
    let friction = FRICTION_FRACTION as i32;
    let angle_exponent = -(crate::cores::cordic::ANGLE_FRACTION_BITS as i32);
    let mut answer = vec![0; SUMMARY_WORDS];
    answer[words::STATUS] = status;
    let mut put = |first: usize, values: &[i64], exponent: i32| {
        for (word, &value) in answer[first..].iter_mut().zip(values) {
            *word = fixed_to_float::convert(value, exponent);
        }
    };
    put(words::FORCE, &summary.forces, plan.formats.g.lsb - friction);
    put(words::TORQUE, &summary.torques, plan.formats.torque_lsb - friction);
    put(words::MU, &[summary.friction_quotient as i64], summary.friction_exponent);
    put(words::MU + 1, &[i64::from(summary.angle)], angle_exponent);
    put(words::MU_XY, &summary.friction, -friction);
    let mut is_uncertain = plan.thresholds.thin;
    if let Some(of) = &plan.thresholds.error {
        // Without a direction the error is as much as presses.
        let log = if estimate.unknown { 0 } else { of.log(&contact, scaled.exponent, scaled.variance) };
        let (error, exponent) = summary.standard_error(log);
        put(words::STANDARD_ERROR, &[error], plan.formats.g.lsb - friction + exponent);
        is_uncertain |= log > of.limit;
    }
    if is_uncertain {
        answer[words::STATUS] |= LOW_CONFIDENCE;
    }
    (answer, summary)
}
