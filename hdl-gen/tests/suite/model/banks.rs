//! The thresholds of a calibration in RAM, in the integer model: by those of its bank a design answers as another one
//! that was made with them.

use std::collections::BTreeSet;

use golden::design::{CalibrationIn, Design, Scaling};
use golden::solver::Solver;
use hdl_gen::model::{DIRECTION_UNKNOWN, Model, NO_CONTACT, NO_TENSION};
use hdl_gen::plan::Plan;
use hdl_gen::plan::words::COUNTERS;

use super::{Contact, frame};
use crate::support::designs::design;

const PA_PER_COUNT: f64 = -12.5;

/// Both estimators, by either range.
fn designs() -> Vec<Design> {
    let shipped = |name: &str| {
        let mut design = design(name);
        design.input.pa_per_count = Some(PA_PER_COUNT);
        design.hardware.control = true;
        design.hardware.calibration = CalibrationIn::Ram;
        design
    };
    let both = |name: &str| {
        [Scaling::Fixed, Scaling::PerFrame].map(|range| {
            let mut design = shipped(name);
            design.hardware.scaling = range;
            design
        })
    };
    ["small-control", "sensor1-fast"].into_iter().flat_map(both).collect()
}

#[test]
fn a_banks_noise_floor_is_that_of_a_design_made_with_it() {
    for design in designs() {
        let (solver, plan) = (Solver::new(&design).unwrap(), Plan::new(&design).unwrap());
        let frames: Vec<Vec<u32>> = [(0.5, 0.9), (0.8, 0.2), (0.02, 0.5), (0.5, 0.01)]
            .into_iter()
            .map(|(friction, strength)| {
                let contact = Contact { centre: [0.47, 0.52], radius: 0.5, friction, direction: 0.7, strength };
                let count = |pascals: f32| ((f64::from(pascals) / PA_PER_COUNT) as f32).to_bits();
                frame(&contact, &design, &solver).into_iter().map(count).collect()
            })
            .collect();
        let mut statuses = BTreeSet::new();
        for floor in [0.4, 8.0, 300.0, 2e3, 2e4] {
            let mut made = design.clone();
            made.algorithm.noise_floor_pa = floor;
            let made = Plan::new(&made).unwrap();
            let bank = &made.calibration.as_ref().unwrap().power_up;
            assert_eq!(i64::from(bank.noise), made.thresholds.taxel);
            let mut by_bank = Model::new(&plan);
            by_bank.commit(bank.clone());
            let mut by_design = Model::new(&made);
            for frame in &frames {
                let (mut found, expected) = (by_bank.process(frame), by_design.process(frame));
                assert_eq!(found[COUNTERS] >> 8 & 0xFF, 1);
                found[COUNTERS] &= !(0xFF << 8);
                assert_eq!(found, expected, "{}, {} Pa", design.name, floor);
                statuses.insert(found[0] & (NO_CONTACT | DIRECTION_UNKNOWN | NO_TENSION));
            }
        }
        // Answered as usual, nothing that pulls, no contact.
        assert!(statuses.len() >= 3, "{}: {statuses:x?}", design.name);
    }
}
