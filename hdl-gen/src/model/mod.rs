//! The integer model: executes a plan bit for bit as the hardware does.
//!
//! One packet of input words in, one frame of output words out. Order of summation does not matter: every sum is
//! exact in its width, by the bounds of the plan.

mod reduced;
mod summary;
#[cfg(test)]
mod tests;

use crate::cores::{fixed_to_float, float_to_fixed};
use crate::estimators::{ByPq, Contact, Seen};
use crate::plan::Plan;
use crate::plan::format::{FRICTION_FRACTION, round_shift};
use crate::plan::product::{Epilogue, Vector};

use summary::Summary;
pub use summary::inverse_gain;

/// Status bit: `sum |b|` below the noise floor.
pub const NO_CONTACT: u32 = 1;
/// Status bit: no tension or compression above the noise floor, or a line without sense.
pub const DIRECTION_UNKNOWN: u32 = 1 << 1;
/// Status bit: the minimum lies at an end of [-1, 1], or the dependent component was clipped.
pub const AT_BOUND: u32 = 1 << 2;
/// Status bit: an input beyond the full scale, or a clipped intermediate.
pub const SATURATED: u32 = 1 << 3;
/// Status bit: NaN or infinity in.
pub const NOT_FINITE: u32 = 1 << 4;
/// Status bit: early or late TLAST.
pub const BAD_LENGTH: u32 = 1 << 5;

pub use crate::plan::SUMMARY_WORDS;

/// The vectors of one frame, as the plan's products fill them.
struct Vectors {
    stress: Vec<i64>,
    weight: Vec<i64>,
    partial: [Vec<i64>; 3],
    g: ByPq<Vec<i64>>,
    u: [Vec<i64>; 3],
}

impl Vectors {
    fn new(stress: Vec<i64>) -> Self {
        let empty = || vec![0; stress.len()];
        Self {
            weight: empty(),
            partial: std::array::from_fn(|_| empty()),
            g: std::array::from_fn(|_| std::array::from_fn(|_| empty())),
            u: std::array::from_fn(|_| empty()),
            stress,
        }
    }

    fn get(&self, vector: Vector) -> &Vec<i64> {
        match vector {
            Vector::Weight => &self.weight,
            Vector::Partial(p) => &self.partial[usize::from(p) - 1],
            Vector::G(p, q) => &self.g[usize::from(p) - 1][usize::from(q)],
            Vector::U(q) => &self.u[usize::from(q)],
            // The paper's plan has no other vectors.
            _ => &self.stress,
        }
    }

    fn get_mut(&mut self, vector: Vector) -> &mut Vec<i64> {
        match vector {
            Vector::Weight => &mut self.weight,
            Vector::Partial(p) => &mut self.partial[usize::from(p) - 1],
            Vector::G(p, q) => &mut self.g[usize::from(p) - 1][usize::from(q)],
            Vector::U(q) => &mut self.u[usize::from(q)],
            _ => &mut self.stress,
        }
    }
}

/// The stress of a taxel, and what is to be said of it.
struct Stress {
    steps: i64,
    saturated: bool,
    not_finite: bool,
}

/// Executes a plan, frame by frame.
#[derive(Clone, Debug)]
pub struct Model<'plan> {
    plan: &'plan Plan,
    frames: u16,
}

impl<'plan> Model<'plan> {
    /// A model just out of reset.
    pub fn new(plan: &'plan Plan) -> Self {
        Self { plan, frames: 0 }
    }

    /// As after the hardware's reset: the frame counter starts again.
    pub fn reset(&mut self) {
        self.frames = 0;
    }

    /// Words of every output frame: 8, and for the field 3 m more.
    pub fn output_words(&self) -> usize {
        self.plan.beats_out()
    }

    /// The output frame for one packet: float32 words in Pa up to and including the one with TLAST.
    pub fn process(&mut self, packet: &[u32]) -> Vec<u32> {
        let counter = u32::from(self.frames) << 16;
        self.frames = self.frames.wrapping_add(1);
        let taxels = self.plan.taxels();
        let converted: Vec<Stress> =
            packet.iter().take(taxels).enumerate().map(|(taxel, &word)| self.convert(taxel, word)).collect();
        let mut bad = 0;
        if packet.len() != taxels {
            bad |= BAD_LENGTH;
        }
        if converted.iter().any(|stress| stress.not_finite) {
            bad |= NOT_FINITE;
        }
        if bad != 0 {
            return self.blank(counter | bad);
        }
        let saturated = converted.iter().any(|stress| stress.saturated);
        let stress: Vec<i64> = converted.iter().map(|stress| stress.steps).collect();
        if Contact::new(&stress).stress_sum < self.plan.thresholds.contact {
            return self.blank(counter | NO_CONTACT);
        }
        self.answer(counter, &stress, saturated)
    }

    /// One input word as stress.
    fn convert(&self, taxel: usize, word: u32) -> Stress {
        let format = self.plan.formats.stress;
        let number = self.plan.counts.as_ref().map_or(format, |counts| counts.count);
        let converted = float_to_fixed::convert(word, -number.lsb, number.bound as u32);
        let number = i64::from(converted.fixed);
        let (mut steps, mut saturated) = (number, converted.saturated);
        if let Some(counts) = &self.plan.counts {
            steps = counts.to_stress(taxel, number);
            if steps.abs() >= counts.full_scale {
                (steps, saturated) = (steps.signum() * format.bound, true);
            }
        }
        Stress { steps, saturated, not_finite: converted.not_finite }
    }

    fn answer(&self, counter: u32, stress: &[i64], saturated: bool) -> Vec<u32> {
        match self.plan.formats.folded {
            Some(folded) => reduced::answer(self.plan, &folded, counter, stress, saturated),
            None => self.paper_answer(counter, stress, saturated),
        }
    }

    fn paper_answer(&self, counter: u32, stress: &[i64], saturated: bool) -> Vec<u32> {
        let plan = self.plan;
        let vectors = self.products(stress.to_vec());
        let sums: ByPq<i64> = std::array::from_fn(|p| std::array::from_fn(|q| vectors.g[p][q].iter().sum()));
        let (mut words, summary) = scalars(plan, counter, stress, saturated, &sums, &vectors.u);
        let force_exponent = plan.formats.g.lsb - FRICTION_FRACTION as i32;
        let [mu_x, mu_y] = summary.friction;
        for taxel in 0..plan.taxels() {
            for [g0, g1, g2] in &vectors.g {
                let force = (g0[taxel] << FRICTION_FRACTION) + mu_x * g1[taxel] + mu_y * g2[taxel];
                words.push(fixed_to_float::convert(force, force_exponent));
            }
        }
        words
    }

    /// Every product of the plan, in order, with its epilogue.
    fn products(&self, stress: Vec<i64>) -> Vectors {
        let mut vectors = Vectors::new(stress);
        for product in &self.plan.products {
            let matrix = &self.plan.matrices[product.matrix];
            let operand = vectors.get(product.operand());
            let result: Vec<i64> = (0..operand.len())
                .map(|row| {
                    let rounded = round_shift(matrix.row_product(row, 0, operand), product.shift);
                    match product.epilogue {
                        Epilogue::ClipNegate => (-rounded).max(0),
                        Epilogue::Add(partial) => rounded + vectors.get(partial)[row],
                        _ => rounded,
                    }
                })
                .collect();
            *vectors.get_mut(product.result) = result;
        }
        vectors
    }

    fn blank(&self, status: u32) -> Vec<u32> {
        let mut words = vec![0; self.output_words()];
        words[0] = status;
        words
    }
}

/// The eight words before the field, from the sums `G_pq` and the vectors `u_q` of a frame; what Op found goes with
/// them.
fn scalars(
    plan: &Plan,
    counter: u32,
    stress: &[i64],
    saturated: bool,
    sums: &ByPq<i64>,
    u: &[Vec<i64>; 3],
) -> (Vec<u32>, Summary) {
    let (sensor, noise_floor) = (&plan.design.sensor, plan.thresholds.taxel);
    let found =
        plan.estimator.slot().find(&Seen { sensor, stress, contact: Contact::new(stress), noise_floor, sums, u });
    let summary = Summary::new(sums, found.friction);

    let mut status = counter;
    if found.unknown {
        status |= DIRECTION_UNKNOWN;
    } else if found.at_bound {
        status |= AT_BOUND;
    }
    if saturated || found.saturated {
        status |= SATURATED;
    }
    let force_exponent = plan.formats.g.lsb - FRICTION_FRACTION as i32;
    let mut words = vec![status];
    words.extend(summary.forces.map(|force| fixed_to_float::convert(force, force_exponent)));
    words.push(fixed_to_float::convert(summary.friction_quotient as i64, summary.friction_exponent));
    words.push(fixed_to_float::convert(i64::from(summary.angle), -(crate::cores::cordic::ANGLE_FRACTION_BITS as i32)));
    words.extend(summary.friction.map(|mu| fixed_to_float::convert(mu, -(FRICTION_FRACTION as i32))));
    (words, summary)
}
