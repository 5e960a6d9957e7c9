//! The formulas, and the hardware's model, against the solver's own records.

use golden::bodies::{Finder, Found};
use golden::design::{Design, Estimator, Outputs};
use golden::scene::SceneFrame;
use golden::solver::{Solution, Solver, Status};
use hdl_gen::model::contacts::records::{Counted, Records};
use hdl_gen::plan::contacts::records::Constants;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::formulas::{Exact, Headers, Worst, exact, header};
use super::{design, hostile};
use crate::bodies::kinds::{Kind, frame};

/// The words of an answer.
fn words(solution: &Solution) -> [u32; 16] {
    let Solution { status, resultant: [x, y, z], torque: [about_x, about_y, about_z], mu, phi, .. } = solution;
    let Solution { mu_x, mu_y, standard_error, .. } = solution;
    header(status.0, [*x, *y, *z, *about_x, *about_y, *about_z, *mu, *phi, *mu_x, *mu_y, *standard_error])
}

/// What the core would answer to a frame and to each of its bodies in both rounds, and the taxels of each body.
struct Answers {
    headers: Headers,
    taxels: Vec<u16>,
    bodies: usize,
}

/// The solver's way to its bodies, step by step; to the last bit, since what is a rounding off may be another answer of the
/// search.
fn answers(design: &Design, frame: &SceneFrame) -> Answers {
    let mut one = design.clone();
    (one.algorithm.contacts, one.algorithm.outputs) = (1, Outputs::Field);
    let gain = if one.algorithm.estimator == Estimator::Joint { one.algorithm.joint.gain } else { 1.0 };
    let solver = Solver::new(&one).expect("matrices");
    let matrices = solver.matrices();
    let whole = solver.solve(&frame.stress).expect("a whole frame");
    let mut found = Found::default();
    let weight: Vec<f64> = whole.field[2].iter().map(|force| (-force).max(0.0)).collect();
    Finder::new(&one.sensor, design.algorithm.contacts).find(&weight, &mut found);
    let mut forces = whole.field.clone();
    let mut stress = matrices.c33.dense().column(0).clone_owned();
    stress.copy_from_slice(&frame.stress);
    let mut rounds = Vec::new();
    for _ in 0..2 {
        let alone = |body: usize| {
            let [x, y, z] = forces.each_ref().map(|forces| {
                let mut own = stress.clone();
                for ((own, force), &of) in own.iter_mut().zip(forces).zip(&found.regions) {
                    *own = if of == Some(body) { force / gain } else { 0.0 };
                }
                own
            });
            &matrices.c31 * &x + &matrices.c32 * &y + &matrices.c33 * &z
        };
        let mut parts: Vec<_> = (0..found.taxels.len()).map(alone).collect();
        let left = parts.iter().fold(stress.clone(), |left, part| left - part);
        for (taxel, &left) in left.iter().enumerate() {
            parts[found.regions[taxel].expect("a body")][taxel] += left;
        }
        let round: Vec<Solution> =
            parts.iter().map(|part| solver.solve(part.as_slice()).expect("a whole frame")).collect();
        for (p, of_axis) in forces.iter_mut().enumerate() {
            for (taxel, force) in of_axis.iter_mut().enumerate() {
                *force = round.iter().fold(0.0, |all, of_body| all + of_body.field[p][taxel]);
            }
        }
        rounds.push(round.iter().map(words).collect::<Vec<_>>());
    }
    let last = rounds.pop().unwrap_or_default();
    let headers = Headers { frame: words(&whole), last, before: rounds.pop().unwrap_or_default() };
    Answers { headers, taxels: found.taxels.iter().map(|&taxels| taxels as u16).collect(), bodies: found.bodies }
}

/// Asserts that these are the solver's, to what rounding the headers to float32 leaves.
fn same(solution: &Solution, exact: &Exact, taxels: &[u16], label: &str) {
    assert_eq!(exact.status, solution.status.0, "{label}");
    let near = |found: f64, size: f64, expected: f64, what: &str| {
        assert!((found - expected).abs() < 1e-6 * size, "{label}, {what}: {found}, not {expected}");
    };
    let Solution { resultant, torque, mu, phi, mu_x, mu_y, standard_error, records, .. } = solution;
    let expected = resultant.iter().chain(torque).chain([mu, phi, mu_x, mu_y, standard_error]);
    for (word, (value, &expected)) in exact.frame.iter().zip(expected).enumerate() {
        near(value.exact, value.size, expected, &format!("word {}", 2 + word));
    }
    for (found, record) in exact.records.iter().zip(records) {
        assert_eq!((usize::from(taxels[found.body]), found.status), (record.taxels, record.status.0), "{label}");
        let [x, y] = record.centre_m;
        let [force_x, force_y, force_z] = record.force;
        let expected = [x, y, force_x, force_y, force_z, record.mu, record.standard_error];
        found
            .values
            .iter()
            .zip(expected)
            .for_each(|(value, expected)| near(value.exact, value.size, expected, "record"));
    }
}

#[test]
fn formulas_and_model_are_the_solver_s() {
    let mut worst = Worst::default();
    let mut seen = [0; 9];
    for (name, contacts) in [("sensor1-wide", 4), ("sensor2-joint", 2), ("sensor1-reduced", 3)] {
        let mut design = design(name, contacts);
        // That scales without rounding.
        design.algorithm.joint.gain = 2.0;
        // Parts are not clipped.
        design.hardware.full_scale_pa = 1e9;
        let several = Solver::new(&design).expect("matrices");
        let mut model = Records::new(contacts, &Constants::of(&design));
        let middle = design.sensor.position_m(design.sensor.taxels() - 1).map(|last| 0.5 * last);
        let reach = 2e-3 * design.sensor.pitch_mm[0].max(design.sensor.pitch_mm[1]);
        for kind in [Kind::Opposed, Kind::Anyhow, Kind::Three, Kind::Heavier(6), Kind::One] {
            for seed in 0..3 {
                let label = format!("{name}, {kind:?}, {seed}");
                let frame = frame(&design.sensor, kind, 900 + seed);
                let solution = several.solve(&frame.stress).expect("a whole frame");
                let Answers { headers, mut taxels, bodies } = answers(&design, &frame);
                let kept = taxels.len();
                seen[kept] += 1;
                taxels.resize(contacts, 0);
                let found = headers
                    .answer(&mut model, Counted { kept, bodies: bodies as u8, taxels: &taxels, saturated: false });
                assert_eq!((found[13] & 0xFF) as usize, solution.bodies, "{label}");
                if kept > 1 {
                    let exact = exact(&headers, middle, reach, design.algorithm.joint.doubt, bodies > contacts);
                    same(&solution, &exact, &taxels, &label);
                    exact.compare(&found, &taxels, &mut worst);
                    continue;
                }
                assert_eq!((found[0], &found[1..13]), (solution.status.0, &headers.frame[1..13]), "{label}");
                let [record, ..] = &solution.records[..] else { panic!("{label}: no record") };
                let status = found[16] >> 16;
                assert_eq!((found[16] as u16, status), (record.taxels as u16, record.status.0), "{label}");
                let floats = record.centre_m.into_iter().chain(record.force).chain([record.mu, record.standard_error]);
                for (found, expected) in found[17..24].iter().zip(floats) {
                    let found = f64::from(f32::from_bits(*found));
                    assert!(
                        (found - expected).abs() <= 3e-7 * (expected.abs() + middle[0]),
                        "{label}: {found} {expected}"
                    );
                }
                assert!(found[24..].iter().all(|&word| word == 0), "{label}");
            }
        }
    }
    assert!(seen[1] >= 3 && seen[2] >= 6 && seen[3] >= 2, "{seen:?}");
    let worst = worst.frame.into_iter().chain(worst.record).fold(0.0, f64::max);
    assert!(worst < 12.0 * 2.0_f64.powi(-24), "{worst}");
}

/// The solver says of a frame without a body what the hardware says of it as it is.
#[test]
fn no_body_leaves_the_frame_as_it_is() {
    let design = design("sensor1-wide", 4);
    let solver = Solver::new(&design).expect("matrices");
    let solution = solver.solve(&vec![0.0; design.sensor.taxels()]).expect("a whole frame");
    assert_eq!((solution.status, solution.bodies), (Status::NO_CONTACT, 0));
    let mut model = Records::new(4, &Constants::of(&design));
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for headers in [Headers { frame: words(&solution), last: Vec::new(), before: Vec::new() }, hostile(0, &mut random)]
    {
        let found = headers.answer(&mut model, Counted { kept: 0, bodies: 200, taxels: &[7; 4], saturated: false });
        assert_eq!((&found[..16], &found[16..]), (&headers.frame[..], &[0; 32][..]));
    }
}
