//! Banks of a calibration in RAM with any content that one takes.

use golden::design::Curve;
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, CalibrationPlan, CurveMap, DeadMap};
use hdl_gen::plan::dead::DeadPlan;
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
