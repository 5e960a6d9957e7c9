//! What banks may hold, and what a tare makes of that, in the integers of the plan.

use golden::design::{Calibration, CalibrationIn, Design};
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::CalibrationPlan;

use crate::support::banks::{takes, tared};
use crate::support::shipped;

fn design() -> Design {
    let mut design = shipped("small-control");
    design.input.pa_per_count = Some(-12.5);
    design.hardware.calibration = CalibrationIn::Ram;
    design
}

fn plan(data_bits: u32) -> CalibrationPlan {
    let mut design = design();
    design.hardware.data_bits = data_bits;
    Plan::new(&design).expect("a plan").calibration.expect("in RAM")
}

/// By every content: the full scale is read as such, what is below it is not, and no stress leaves its bounds.
#[test]
fn the_full_scale_is_reached_by_every_content() {
    for plan in [plan(27), plan(22)] {
        let gains = [1e-9, 3e-5, 0.7, 0.99999, 1.0, 1.00001, 15.9];
        // In steps, within a full scale of either side: beyond, one end of the range cannot be read.
        let shares = [0.0, 0.4, -0.4, 1.9, -1.9];
        for (gain, share) in gains.iter().flat_map(|gain| shares.map(|share| (*gain, share))) {
            let counts = plan.stress.bound as f64 / plan.count_steps;
            let calibration = Calibration { gain: vec![gain; 12], offset: vec![share * counts; 12] };
            let bank = plan.bank(&calibration, &plan.power_up).expect("a plan");
            assert!(takes(&plan, &bank));
            let at = |part: f64| {
                let count = (part * counts - share * counts) / gain;
                plan.stress_of(&bank, 3, (count as f32).to_bits())
            };
            // A float32 of a count far from 0 is off by as much as a step of the stress and more.
            for (part, saturated) in [(1.00001, true), (-1.00001, true), (0.9999, false), (-0.9999, false)] {
                let reading = at(part);
                assert_eq!(reading.saturated, saturated, "gain {gain}, offset {share}, {part}");
                assert!(reading.steps.abs() <= plan.stress.bound);
                let off = (reading.steps as f64 / plan.stress.bound as f64 - part).abs();
                assert!(off < 2e-5, "gain {gain}, offset {share}, {part}: {off}");
            }
        }
    }
}

/// A taxel that the design replaces does not keep the others from a tare, whatever it reads.
#[test]
fn a_dead_taxel_is_at_rest() {
    let mut design = design();
    design.input.dead = vec![3];
    let plan = Plan::new(&design).expect("a plan").calibration.expect("a plan");
    let frames: Vec<Vec<u32>> = [1e9, -7.0]
        .map(|stuck: f32| (0..12).map(|taxel| if taxel == 3 { stuck } else { 20.0 }.to_bits()).collect())
        .to_vec();
    let at_rest = tared(&plan.power_up, &plan, &frames).expect("rest");
    assert_eq!((at_rest.offsets[3], at_rest.offsets[2] != 0), (0, true));
    design.input.dead.clear();
    let plan = Plan::new(&design).expect("a plan").calibration.expect("a plan");
    assert_eq!(tared(&plan.power_up, &plan, &frames), None);
}
