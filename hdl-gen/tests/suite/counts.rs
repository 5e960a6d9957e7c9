//! Counts to stress in fixed point: each taxel as exact as its own gain allows, whatever the others' are.

use golden::design::Design;
use golden::metrics::field_error;
use golden::solver::Solver;
use hdl_gen::model::Model;
use hdl_gen::plan::counts::CountsPlan;
use hdl_gen::plan::{Plan, PlanError};

/// A 4 by 3 design in counts of -10 Pa, with a line `gain,offset` for each taxel.
fn design(lines: &[(f64, f64)]) -> Design {
    let text = "name = \"pad\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
                pa_per_count = -10.0\ncalibration = \"gains.csv\"\n[hardware]\nlanes = 4\n";
    let lines: String = lines.iter().map(|(gain, offset)| format!("{gain:?},{offset:?}\n")).collect();
    Design::from_parts(text, "pad.toml", &[("gains.csv", lines)]).unwrap()
}

/// Twelve taxels of which the sixth is another.
fn one_of(gain: f64, offset: f64) -> Vec<(f64, f64)> {
    (0..12).map(|taxel| if taxel == 5 { (gain, offset) } else { (1.0, 0.0) }).collect()
}

/// The stress in pascals that a taxel's count becomes.
fn stress(plan: &Plan, counts: &CountsPlan, taxel: usize, count: f64) -> f64 {
    let number = counts.number(taxel, (count as f32).to_bits()).fixed;
    counts.to_stress(taxel, number.into()) as f64 * plan.formats.stress.step()
}

#[test]
fn no_gain_and_no_offset_coarsens_another() {
    let extremes: Vec<(f64, f64)> =
        (0..12).map(|taxel| (16.0 * 10_f64.powi(-taxel / 2), f64::from(taxel) * 7.5)).collect();
    for lines in [one_of(1e-6, 0.0), one_of(2e-5, 0.0), one_of(16.0, 0.0), one_of(1.0, 20_000.0), extremes] {
        let design = design(&lines);
        let plan = Plan::new(&design).unwrap();
        let counts = plan.counts.as_ref().unwrap();
        assert!(counts.full_scale as f64 > (1.0 - 3e-5) * plan.formats.stress.bound as f64, "{lines:?}");
        for taxel in 0..12 {
            for share in [0.0, 1e-4, -0.03, 0.5, -0.99] {
                let pascals = share * design.hardware.full_scale_pa;
                let count = design.input.from_pa(taxel, pascals);
                // A gain of 17 bits, and a count that is a float32.
                let count_pa = (count - f64::from(count as f32)).abs() * 10.0 * lines[taxel].0;
                let allowed = pascals.abs() * 2_f64.powi(-16) + count_pa + 4.0 * plan.formats.stress.step();
                let error = (stress(&plan, counts, taxel, count) - pascals).abs();
                assert!(error <= allowed, "{lines:?}: {error} Pa for {pascals} Pa of taxel {taxel}");
            }
        }
    }
}

#[test]
fn the_field_is_as_exact_beside_a_small_gain() {
    let error = |lines: &[(f64, f64)]| {
        let design = design(lines);
        let plan = Plan::new(&design).unwrap();
        let pascals = |taxel: usize| [-3000.0, -9000.0, -12_000.0, 2500.0][taxel % 4] * (1.0 + taxel as f64 / 12.0);
        let frame: Vec<f64> =
            (0..12).map(|taxel| f64::from(design.input.from_pa(taxel, pascals(taxel)) as f32)).collect();
        let words = Model::new(&plan).process(&frame.iter().map(|&count| (count as f32).to_bits()).collect::<Vec<_>>());
        assert_eq!(words[0] & 0x3b, 0, "an answer");
        let value = |word: u32| f64::from(f32::from_bits(word));
        let start = words.len() - 36;
        let found =
            [0, 1, 2].map(|axis| words[start..].iter().skip(axis).step_by(3).map(|&word| value(word)).collect());
        field_error(&Solver::new(&design).unwrap().solve(&frame).unwrap().field, &found)
    };
    let alone = error(&one_of(1.0, 0.0));
    assert!(alone < 1e-4, "{alone:e}");
    for gain in [2e-5, 1e-6] {
        let beside = error(&one_of(gain, 0.0));
        assert!(beside < 1e-4, "{beside:e} beside a gain of {gain:e}, {alone:e} without");
    }
}

#[test]
fn an_offset_that_leaves_no_stress_is_refused() {
    let error = |offset: f64| Plan::new(&design(&one_of(1.0, offset))).map(drop);
    assert!(error(1e5).is_ok(), "ten times the full scale");
    // A full scale of ten counts.
    let mut small = design(&one_of(1.0, 1e6));
    (small.hardware.full_scale_pa, small.algorithm.noise_floor_pa) = (100.0, 0.001);
    let message = match Plan::new(&small) {
        Err(error @ PlanError::Offset { .. }) => error.to_string(),
        other => panic!("{:?}", other.map(drop)),
    };
    for part in ["taxel 5", "1000000", "10.0 counts", "full_scale_pa"] {
        assert!(message.contains(part), "{message}");
    }
}
