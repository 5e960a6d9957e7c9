//! Counts to stress in fixed point: each taxel as exact as its own gain allows, whatever the others' are.

use golden::design::Design;
use golden::metrics::field_error;
use golden::solver::Solver;
use hdl_gen::model::Model;
use hdl_gen::plan::counts::CountsPlan;
use hdl_gen::plan::{Plan, PlanError};

/// A 4 by 3 design in counts of -10 Pa, with a line `gain,offset` for each taxel.
fn design(lines: &[(f64, f64)]) -> Design {
    let text = "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
                pa_per_count = -10.0\ncalibration = \"gains.csv\"\n[algorithm]\nestimator = \"line\"\ncount_contacts = false\n[hardware]\nlanes = 4\nscaling = \"fixed\"\n";
    let lines: String = lines.iter().map(|(gain, offset)| format!("{gain:?},{offset:?}\n")).collect();
    Design::from_parts(text, "pad.toml", &[("gains.csv", lines)]).unwrap()
}

/// Twelve taxels of which the sixth is another.
fn one_of(gain: f64, offset: f64) -> Vec<(f64, f64)> {
    (0..12).map(|taxel| if taxel == 5 { (gain, offset) } else { (1.0, 0.0) }).collect()
}

/// The stress in pascals that a taxel's count becomes.
fn stress(plan: &Plan, counts: &CountsPlan, taxel: usize, count: f64) -> f64 {
    let stress = plan.formats.stress;
    counts.stress_of(taxel, (count as f32).to_bits(), stress).steps as f64 * stress.step()
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

/// The 4 by 3 design along a curve, with a line `gain,offset` for each taxel.
fn curved(curve: &str, points: &str, lines: &[(f64, f64)]) -> Design {
    let text = format!(
        "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
         curve = {curve}\ncalibration = \"gains.csv\"\n[algorithm]\nestimator = \"line\"\ncount_contacts = false\n[hardware]\nlanes = 4\nscaling = \"fixed\"\n"
    );
    let lines: String = lines.iter().map(|(gain, offset)| format!("{gain:?},{offset:?}\n")).collect();
    Design::from_parts(&text, "pad.toml", &[("gains.csv", lines), ("points.csv", points.to_owned())]).unwrap()
}

const POINTS: &str = "-200,9000\n0,0\n1,-1\n100,-2000\n1000,-30000\n4000,-120000\n";

#[test]
fn a_curve_is_followed_to_its_last_bits() {
    let gains: Vec<(f64, f64)> = (0..12).map(|taxel| (0.5 + 0.1 * f64::from(taxel), 20.0 * f64::from(taxel))).collect();
    for (curve, points) in [("\"points.csv\"", POINTS), ("{ power = 1.25, scale = -0.5 }", "")] {
        let design = curved(curve, points, &gains);
        let plan = Plan::new(&design).unwrap();
        let counts = plan.counts.as_ref().unwrap();
        for taxel in 0..12 {
            for count in [-300.0, -50.5, 0.0, 0.25, 3.0, 77.0, 100.0, 640.0, 1500.25, 3000.0] {
                let exact = design.input.to_pa(taxel, count);
                if exact.abs() > 0.99 * design.hardware.full_scale_pa {
                    continue;
                }
                // Gains of at least fifteen bits, a slope of 17, and a count in steps of 2^-25 of the largest.
                let allowed = exact.abs() * 1e-4 + 0.05;
                let error = (stress(&plan, counts, taxel, count) - exact).abs();
                assert!(error <= allowed, "{curve}: {error} Pa for {exact} Pa, {count} of taxel {taxel}");
            }
        }
    }
}

#[test]
fn a_curve_that_has_no_steps_is_refused() {
    let error = |points: &str, lines: &[(f64, f64)]| match Plan::new(&curved("\"points.csv\"", points, lines)) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("a plan"),
    };
    let message = error("0,0\n10000,-1\n10000.02,-100000\n", &one_of(1.0, 0.0));
    assert!(
        ["between the counts 10000 and 10000.02", "leave one out"].iter().all(|part| message.contains(part)),
        "{message}"
    );
    assert!(Plan::new(&curved("\"points.csv\"", POINTS, &one_of(1e-3, 0.0))).is_ok(), "a gain of any size");
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
