//! Banks of a calibration in RAM: any content, what one takes, what a tare makes of one. `xtask` has these, too.

use golden::design::Curve;
use hdl_gen::format::{largest, round_shift};
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, CalibrationPlan, CurveMap, DeadMap, Reading};
use hdl_gen::plan::dead::{DeadPlan, MOST_WEIGHT, WEIGHT_BITS};
use hdl_gen::plan::gain::GAIN_BITS;
use rand::Rng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;

/// Gains of both signs, offsets and thresholds; one in five has them anywhere within the bounds, the others keep frames
/// readable. Dead taxels and curve are those of power-up.
pub fn random_bank(of: &CalibrationPlan, random: &mut ChaCha8Rng) -> Bank {
    let usual = &of.power_up;
    let far = random.random_bool(0.2);
    let gain = |&(_, exponent): &(i32, i32), random: &mut ChaCha8Rng| {
        let mantissa = random.random_range(1 << 16..1 << 17);
        let near = (exponent + random.random_range(-2..=1)).clamp(-512, 511);
        let exponent = if far { random.random_range(-512..512) } else { near };
        (if random.random_bool(0.2) { mantissa } else { -mantissa }, exponent)
    };
    // From nothing is noise to all of it is.
    let noise_bits = random.random_range(0..26);
    let limit = if far { of.offset_limit } else { of.offset_limit / 40 };
    Bank {
        gains: usual.gains.iter().map(|usual| gain(usual, random)).collect(),
        offsets: (0..of.taxels).map(|_| random.random_range(-limit..=limit) as i32).collect(),
        contact: random.random_range(1..=usual.contact.saturating_mul(50)),
        noise: random.random_range(1..=1 << noise_bits),
        dead: usual.dead.clone(),
        curve: usual.curve.clone(),
    }
}

/// Any taxels, any weights up to the most together, any shift; none without room.
pub fn random_map(of: &CalibrationPlan, random: &mut ChaCha8Rng) -> DeadMap {
    let room = of.power_up.dead.room;
    let count = random.random_range(0..=room);
    let mut taxels = sample(random, of.taxels, count).into_vec();
    taxels.sort_unstable();
    let shift = random.random_range(0..18);
    // The magnitudes of so many at their largest are the most that an accumulator takes.
    let most = 131_071.min(((1 << 21) - 1) / of.taxels as i32);
    let weights = (0..count)
        .map(|place| {
            let sign = if place == 0 { 1 } else { -1 };
            let weight = |random: &mut ChaCha8Rng| {
                sign * if random.random_bool(0.5) { most } else { random.random_range(-most..=most) }
            };
            let mut weights: Vec<i32> = (0..of.taxels).map(|_| weight(random)).collect();
            for &taxel in &taxels {
                weights[taxel] = 0;
            }
            weights
        })
        .collect();
    DeadMap { room, dead: DeadPlan { taxels, weights, shift } }
}

/// Points anywhere, as many as there is room for or a few; one in five reaches as far as a bank's curve can.
pub fn random_curve(plan: &Plan, usual: &CurveMap, random: &mut ChaCha8Rng) -> CurveMap {
    let counts = plan.design.input.curve.as_ref().map_or(1.0, Curve::largest_count);
    let pascals = plan.design.hardware.full_scale_pa;
    loop {
        let parts = if random.random_bool(0.3) { usual.format.room } else { random.random_range(1..=8) };
        let far = random.random_bool(0.2);
        let [reach, most] = if far { [1.9 * counts, 7.9 * pascals] } else { [counts, 2.5 * pascals] };
        let mut numbers: Vec<f64> = (0..=parts).map(|_| random.random_range(-0.3 * reach..reach)).collect();
        let mut values: Vec<f64> = (0..=parts).map(|_| random.random_range(-0.2 * most..most)).collect();
        numbers.sort_by(f64::total_cmp);
        values.sort_by(f64::total_cmp);
        let sign = if random.random_bool(0.3) { 1.0 } else { -1.0 };
        let points = numbers.into_iter().zip(values).map(|(count, value)| [count, sign * value]).collect();
        // Some are too steep.
        if let Ok(map) = CurveMap::new(usual.format, &Curve { points, law: None }) {
            return map;
        }
    }
}

/// Whether a bank takes all of this.
pub fn takes(of: &CalibrationPlan, bank: &Bank) -> bool {
    let gain = |&(mantissa, exponent): &(i32, i32)| {
        (1 << (GAIN_BITS - 2)..1 << (GAIN_BITS - 1)).contains(&mantissa.abs()) && (-512..512).contains(&exponent)
    };
    bank.gains.iter().all(gain)
        && bank.offsets.iter().all(|&offset| i64::from(offset).abs() <= of.offset_limit)
        && bank.contact > 0
        && (1..1 << 26).contains(&bank.noise)
        && takes_map(&bank.dead, of.taxels)
        && bank.curve.as_ref().is_none_or(CurveMap::fits)
        && bank.curve.as_ref().map(|curve| curve.format) == of.curve()
}

/// Whether a bank takes a map of dead taxels: numbers that ascend and are those of taxels, weights within their width, none
/// of a dead taxel, and no more of them together than an accumulator takes.
pub fn takes_map(map: &DeadMap, taxels: usize) -> bool {
    let DeadPlan { taxels: dead, weights, shift } = &map.dead;
    let sum = |weights: &Vec<i32>| weights.iter().map(|&weight| i64::from(weight).abs()).sum::<i64>();
    let alive = |weights: &Vec<i32>| dead.iter().all(|&taxel| weights[taxel] == 0);
    dead.len() <= map.room
        && *shift < WEIGHT_BITS
        && dead.windows(2).all(|pair| pair[0] < pair[1])
        && dead.iter().all(|&taxel| taxel < taxels)
        && weights.iter().flatten().all(|&weight| i64::from(weight).abs() <= largest(WEIGHT_BITS))
        && weights.iter().all(|weights| sum(weights) <= MOST_WEIGHT && alive(weights))
}

/// What a tare makes of a bank: offsets less the mean of each taxel's stress in the frames, a power of two of them. None
/// if they do not look like rest, or an offset leaves its bounds.
pub fn tared(bank: &Bank, of: &CalibrationPlan, frames: &[Vec<u32>]) -> Option<Bank> {
    let log2 = frames.len().trailing_zeros();
    let mut tared = bank.clone();
    for taxel in 0..bank.offsets.len() {
        let readings: Vec<Reading> = frames.iter().map(|frame| of.stress_of(bank, taxel, frame[taxel])).collect();
        if readings.iter().any(|reading| reading.saturated || reading.not_finite) {
            return None;
        }
        let steps = || readings.iter().map(|reading| reading.steps);
        if steps().max()? - steps().min()? > i64::from(bank.noise) {
            return None;
        }
        let offset = i64::from(bank.offsets[taxel]) - round_shift(steps().sum(), log2);
        if offset.abs() > of.offset_limit {
            return None;
        }
        tared.offsets[taxel] = offset as i32;
    }
    Some(tared)
}
