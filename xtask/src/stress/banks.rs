//! Banks with anything in all of their parts, and some that do not hang together.

use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, CalibrationPlan};
use hdl_gen::plan::dead::DeadPlan;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::random_banks::{random_bank, random_curve, random_map, takes};

/// A bank with anything in all of its parts.
pub fn any_bank(plan: &Plan, of: &CalibrationPlan, random: &mut ChaCha8Rng) -> Bank {
    let curve = of.power_up.curve.as_ref().map(|usual| random_curve(plan, usual, random));
    let bank = Bank { dead: random_map(of, random), curve, ..random_bank(of, random) };
    debug_assert!(takes(of, &bank));
    bank
}

/// The same with words that do not go together, each of which alone a bank takes; None where no words can do that.
pub fn contradictory(of: &CalibrationPlan, bank: &Bank, random: &mut ChaCha8Rng) -> Option<Bank> {
    let mut wrong = bank.clone();
    let taxel = random.random_range(0..of.taxels);
    match &mut wrong.curve {
        // Its end where it begins.
        Some(map) if wrong.dead.room == 0 || random.random_bool(0.5) => map.curve.last = map.curve.segments[0].first,
        // A dead taxel that reads itself.
        _ if wrong.dead.room > 0 => {
            let mut weights = vec![0; of.taxels];
            weights[taxel] = 5;
            wrong.dead.dead = DeadPlan { taxels: vec![taxel], weights: vec![weights], shift: 0 };
        }
        _ => return None,
    }
    debug_assert!(!takes(of, &wrong));
    Some(wrong)
}

/// A word that no bank takes, and its place.
pub fn out_of_bounds(of: &CalibrationPlan, random: &mut ChaCha8Rng) -> (u32, u32) {
    let taxels = of.taxels as u32;
    let words = [
        (random.random_range(0..taxels), 12_345),
        (taxels + random.random_range(0..taxels), of.offset_limit as u32 + 1),
        (2 * taxels, 0),
        (2 * taxels + 1, 0),
        (2 * taxels + 1, 1 << 26),
    ];
    words[random.random_range(0..words.len())]
}
