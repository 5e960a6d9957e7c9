//! A range of its own for each frame: frames of all strengths in one row, strong behind faint and faint behind strong, by
//! every kind of stream and of intake, word by word against the model; and broken copies that they find.

use golden::design::{Calibration, CalibrationIn, Design, Outputs, PlanKind, Samples, Scaling, Slip, Tension};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::calibration;
use crate::support::effort::half_of;
use crate::support::faults::{broken, some_faults};
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly, with_joint, with_lanes};

/// Strengths of the frames in a row: full scale down to steps, 2^-k each.
const FAINTEST: i32 = 22;

/// Both plans and estimators, every width of the stream, pascals and integers, dead taxels, crosstalk, a calibration in RAM; `make test`
/// plays every second.
fn designs() -> Vec<Design> {
    let small = |name: &str, bits: u32, kind: PlanKind, outputs: Outputs| {
        let mut design = by_plan(shipped("small"), kind, outputs);
        design.name = format!("scaled_{name}");
        design.hardware.stream_bits = bits;
        design
    };
    let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
    let mut integers = small("integers", 128, reduced, Outputs::Resultants);
    (integers.sensor.columns, integers.sensor.rows) = (3, 5);
    let taxels = integers.sensor.taxels();
    let gain = (0..taxels).map(|taxel| 0.5 + taxel as f64 / 7.0).collect();
    integers.input.pa_per_count = Some(-3.5);
    integers.input.calibration = Some(Calibration { gain, offset: vec![-1.5; taxels] });
    integers.input.tension = Tension::Clipped;
    integers.hardware.samples = Samples::Int16;
    integers.algorithm.slip = Some(Slip { limit: 0.4, hysteresis: 0.1 });
    let mut dead = small("dead", 64, reduced, Outputs::Field);
    dead.sensor.rows = 5;
    dead.input.dead = vec![3, 9];
    dead.algorithm.count_contacts = true;
    let mut joint = with_joint(with_lanes(shipped("odd"), 12));
    "scaled_joint".clone_into(&mut joint.name);
    joint.hardware.stream_bits = 128;
    joint.algorithm.count_contacts = true;
    let mut unsigned = small("unsigned", 32, paper, Outputs::Field);
    unsigned.input.pa_per_count = Some(-1.6);
    unsigned.hardware.samples = Samples::Uint16;
    let mut banks = calibration::design(Outputs::Field);
    "scaled_banks".clone_into(&mut banks.name);
    banks.hardware.calibration = CalibrationIn::Ram;
    banks.input.room = 1;
    banks.input.crosstalk = 0.02;
    let mut designs = vec![integers, small("single", 32, reduced, Outputs::Field), joint, dead, banks, unsigned];
    for design in &mut designs {
        design.hardware.scaling = Scaling::PerFrame;
    }
    designs
}

/// Contacts of all strengths at random, each behind another one, and the ends of the ranges.
fn packets(plan: &Plan) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut pascals: Vec<Vec<f64>> = Vec::new();
    for k in (0..=FAINTEST).chain((0..=FAINTEST).rev()) {
        let scale = f64::from(-k).exp2();
        for scale in if k % 2 == 0 { vec![scale] } else { vec![scale, 1.0] } {
            let words = frames::contact(plan, &mut random);
            pascals.push(words.iter().map(|&word| scale * f64::from(f32::from_bits(word))).collect());
        }
    }
    let extremes = frames::extremes(plan, &mut random);
    pascals.extend(extremes.iter().map(|words| words.iter().map(|&word| f64::from(f32::from_bits(word))).collect()));
    for index in (1..pascals.len()).rev() {
        pascals.swap(index, random.random_range(0..=index));
    }
    let counts = plan.design.input.counts();
    let value =
        |(taxel, &pascal): (usize, &f64)| if counts { plan.design.input.from_pa(taxel, pascal) } else { pascal };
    let packet = |frame: &Vec<f64>| frames::filled(plan, frame.iter().enumerate().map(value));
    pascals.iter().map(packet).collect()
}

#[test]
fn frames_of_all_strengths_in_one_row_are_right() {
    let wrong = in_parallel(&half_of(designs()), |design| {
        let plan = planned(design);
        simulate_exactly(&plan, &built(&plan), &packets(&plan), 5)
            .map(drop)
            .map_err(|fault| format!("{}: {fault}", plan.design.name))
    });
    assert_eq!(wrong.into_iter().filter_map(Result::err).collect::<Vec<_>>(), Vec::<String>::new());
}

/// The frames above find what could be wrong of a range: which one, whose, and where it is taken back.
#[test]
fn a_wrong_range_is_noticed() {
    let faults = [
        ("sptfra_frame_scale", "(guessed > STRESS_BOUND)", "(guessed > STRESS_BOUND + 5000000)"),
        ("sptfra_frame_corrections", "counted[sample] ? in_stresses", "1'b1 ? in_stresses"),
        ("sptfra_frame_corrections", "in_saturated & counted", "in_saturated"),
        ("sptfra_frame_corrections", "in_not_finite & counted", "in_not_finite"),
        ("sptfra_fold", "exact_4 <= octets_3 << exponent[2:0]", "exact_4 <= octets_3 << exponent[1:0]"),
        ("sptfra_fold", ".HALF  (DROPPED)", ".HALF  (0)"),
        (
            "sptfra_frame_context",
            ".take       (direction_take),\n            .oldest     (direction_exponent)",
            ".take       (take),\n            .oldest     (direction_exponent)",
        ),
        (
            "sptfra_frame_context",
            ".take       (take),\n            .oldest     (exponent)",
            ".take       (direction_take),\n            .oldest     (exponent)",
        ),
        ("sptfra_output", "error_exponent + FORCE_EXPONENT - scale_exponent", "error_exponent + FORCE_EXPONENT"),
    ];
    let faults = some_faults(faults, |&(module, from, _)| (module, from));
    let plan = planned(&designs().swap_remove(2));
    let packets = packets(&plan);
    let noticed = in_parallel(&faults, |&(module, from, to)| {
        simulate_exactly(&plan, &broken(&plan, module, from, to), &packets, 5).is_err()
    });
    let missed: Vec<&str> =
        faults.iter().zip(noticed).filter(|(_, noticed)| !noticed).map(|(fault, _)| fault.1).collect();
    assert!(missed.is_empty(), "{missed:?}");
}
