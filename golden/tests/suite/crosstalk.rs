//! Crosstalk of row-column arrays: what it does to forces, and that the key undoes it.

use golden::calibrate::recorded::{Measured, fit_forces};
use golden::check::{Kind as Finds, check};
use golden::design::Design;
use golden::matrices::Matrices;
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame, normal};
use golden::solver::Solver;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::designs::design as shipped;

/// Each reading has this share of the sums of its row and of its column added.
const SHARE: f64 = 0.02;

/// Errors of the normal and of the tangential force in percent of the normal one.
fn errors(design: &Design, frames: &[(Vec<f64>, &SceneFrame)]) -> [Quantiles; 2] {
    let solver = Solver::new(design).unwrap();
    let of = |(read, truth): &(Vec<f64>, &SceneFrame)| {
        let found = solver.solve(read).unwrap().resultant;
        let [x, y, z] = [0, 1, 2].map(|axis| found[axis] - truth.force[axis]);
        [z.abs(), x.hypot(y)].map(|error| 100.0 * error / truth.force[2].abs())
    };
    let found: Vec<[f64; 2]> = frames.iter().map(of).collect();
    [0, 1].map(|kind| Quantiles::of(found.iter().map(|errors| errors[kind]).collect()))
}

#[test]
fn the_key_undoes_crosstalk() {
    let plain = shipped("sensor1-fast");
    let mut crossed = plain.clone();
    crossed.input.crosstalk = SHARE;
    let contacts = Kind::Sliding.frames(&plain.sensor, 0.5, 90_000..90_200).unwrap();
    let read = |design: &Design| -> Vec<(Vec<f64>, &SceneFrame)> {
        let deliver = |truth: &SceneFrame| {
            let mut frame = truth.stress.clone();
            design.deliver(&mut frame);
            frame
        };
        contacts.iter().map(|truth| (deliver(truth), truth)).collect()
    };
    let expected = errors(&plain, &read(&plain));
    let frames = read(&crossed);
    let [before, after] = [&plain, &crossed].map(|design| errors(design, &frames));
    for (name, [normal, tangential]) in [("none", &expected), ("uncorrected", &before), ("corrected", &after)] {
        println!("{name}: normal {normal:.2?} %, tangential {tangential:.2?} %");
    }
    assert!(before[0].median > 30.0, "crosstalk of 2 % is no small matter");
    for (after, expected) in after.iter().zip(&expected) {
        assert!((after.median - expected.median).abs() < 1e-6 && (after.worst - expected.worst).abs() < 1e-6);
    }
    // What stands for a dead taxel has crosstalk, too.
    let mut dead = plain.clone();
    dead.input.dead = vec![44];
    let without = errors(&dead, &read(&dead));
    let mut both = crossed.clone();
    both.input.dead = vec![44];
    let with = errors(&both, &read(&both));
    println!("a dead taxel: {without:.2?}, with crosstalk {with:.2?}");
    for (with, without) in with.iter().zip(&without) {
        assert!(with.median < without.median + 0.1 && with.most < without.most + 0.5);
    }
}

#[test]
fn gains_are_found_through_crosstalk() {
    let mut truth = shipped("sensor1-fast");
    truth.input.crosstalk = SHARE;
    truth.input.pa_per_count = Some(-10.0);
    let contacts = Kind::Sliding.frames(&truth.sensor, 0.0, 91_000..91_030).unwrap();
    let solver = Solver::new(&shipped("sensor1-fast")).unwrap();
    let mut frames = vec![vec![0.0; truth.sensor.taxels()]; 5];
    let mut forces = vec![[None, None, Some(0.0)]; 5];
    for contact in &contacts {
        let mut frame = contact.stress.clone();
        // The solver's own error without crosstalk is none of the calibration's.
        let load = solver.solve(&frame).unwrap().resultant[2];
        truth.deliver(&mut frame);
        for rest in 0..2 {
            frames.push(if rest == 0 { frame.clone() } else { vec![0.0; truth.sensor.taxels()] });
            forces.push([None, None, Some(if rest == 0 { load } else { 0.0 })]);
        }
    }
    let mut guess = truth.clone();
    guess.input.pa_per_count = Some(-8.0);
    let measured = Measured { forces, ..Measured::default() };
    let found = fit_forces(&guess, &frames, &measured).unwrap();
    let calibrated = Solver::new(&found.design).unwrap();
    for (frame, force) in frames.iter().zip(&measured.forces).filter(|(_, force)| force[2] != Some(0.0)) {
        let load = calibrated.solve(frame).unwrap().resultant[2];
        let error = load / force[2].unwrap() - 1.0;
        assert!(error.abs() < 0.03, "{load} {:?}", force[2]);
    }
    assert_eq!(found.design.input.crosstalk.to_bits(), SHARE.to_bits());
    assert_eq!(found.design.input.noise.to_bits(), truth.input.noise.to_bits());
}

/// Contacts with crosstalk and noise, as a design's sensor delivers them.
fn recorded(
    design: &Design,
    contacts: &[SceneFrame],
    (share, noise): (f64, f64),
    random: &mut ChaCha8Rng,
) -> Vec<Vec<f64>> {
    let mut crossed = design.clone();
    crossed.input.crosstalk = share;
    let mut read = |contact: &SceneFrame| {
        let mut frame = contact.stress.clone();
        crossed.deliver(&mut frame);
        let peak = frame.iter().fold(0.0_f64, |peak, stress| peak.max(stress.abs()));
        for stress in &mut frame {
            *stress += noise * peak * normal(random);
        }
        frame
    };
    contacts.iter().map(&mut read).collect()
}

#[test]
fn check_measures_crosstalk_and_invents_none() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (mut sets, mut worst) = (0, 0.0_f64);
    for name in ["sensor1-wide", "sensor2-clipped-wide"] {
        let design = shipped(name);
        for kind in Kind::all() {
            let contacts = kind.frames(&design.sensor, 0.5, 500..524).unwrap();
            for noise in [0.0, 0.01, 0.02] {
                let frames = recorded(&design, &contacts, (0.0, noise), &mut random);
                let findings = check(&design, &frames, None);
                let invented = findings.iter().find(|finding| finding.kind == Finds::Crosstalk);
                assert!(invented.is_none(), "{name}, {kind}, noise {noise}: {invented:?}");
                sets += 1;
            }
            for (share, noise) in [(0.01, 0.01), (0.02, 0.01), (0.05, 0.0)] {
                let frames = recorded(&design, &contacts, (share, noise), &mut random);
                let findings = check(&design, &frames, None);
                assert_eq!(findings[0].kind, Finds::Crosstalk, "{name}, {kind}, {share}: {findings:?}");
                let said = findings[0].to_string();
                let found: f64 = said.rsplit("sensor.crosstalk = ").next().unwrap().parse().unwrap();
                // What is left of F_z's error.
                let left = 100.0 * ((1.0 + 20.0 * share) / (1.0 + 20.0 * found) - 1.0).abs();
                worst = worst.max(left);
                assert!(left < 3.0, "{name}, {kind}, {share}: {said}");
                // With the key it is known, and nothing else was found because of it.
                let mut corrected = design.clone();
                corrected.input.crosstalk = found;
                assert_eq!(check(&corrected, &frames, None), findings[1..], "{name}, {kind}, {share}");
            }
        }
    }
    println!("0 of {sets} sets without crosstalk have a finding; the shares found leave {worst:.2} % of F_z at most");
}

/// Of small grids a contact covers much: crosstalk shows on most of them, and none is invented.
#[test]
fn crosstalk_of_small_grids() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for (columns, rows, least) in [(7, 5, 32), (6, 6, 22), (8, 4, 32), (5, 8, 40), (8, 8, 52)] {
        let text = format!(
            "format = 3\nbase = \"../golden/tests/plain.toml\"\nname = \"pad\"\n[sensor]\ncolumns = {columns}\n\
             rows = {rows}\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n"
        );
        let design = Design::from_toml(&text, "pad.toml").unwrap();
        let (mut found, mut worst, mut invented) = (0, 0.0_f64, 0);
        for kind in Kind::all() {
            let contacts = kind.frames(&design.sensor, 0.5, 500..524).unwrap();
            let share_of = |share: f64, noise: f64, random: &mut ChaCha8Rng| {
                let findings = check(&design, &recorded(&design, &contacts, (share, noise), random), None);
                let finding = findings.into_iter().find(|finding| finding.kind == Finds::Crosstalk)?;
                Some(finding.to_string().rsplit("sensor.crosstalk = ").next()?.parse::<f64>().unwrap())
            };
            for noise in [0.0, 0.01, 0.02] {
                let is = share_of(0.0, noise, &mut random);
                if let Some(share) = is {
                    println!("{columns}x{rows} {kind} invented {share}");
                }
                invented += usize::from(is.is_some());
            }
            for (share, noise) in [(0.01, 0.01), (0.02, 0.01), (0.05, 0.0)] {
                let reads = |share: f64| 1.0 + share * f64::from(columns + rows);
                if let Some(is) = share_of(share, noise, &mut random) {
                    found += 1;
                    worst = worst.max(100.0 * (reads(share) / reads(is) - 1.0).abs());
                }
            }
        }
        println!(
            "{columns} x {rows}: found in {found} of 54, leaves {worst:.1} % of F_z, invented in {invented} of 54"
        );
        assert!(
            found >= least && invented == 0 && worst < 3.5,
            "{columns} x {rows}: {found}, {invented}, {worst:.1} %"
        );
    }
}

/// Rows and columns with shares of their own: `sensor.crosstalk` is not for these, and what the message says undoes them.
#[test]
fn check_measures_unequal_shares() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let design = shipped("sensor1-wide");
    let (columns, matrices) = (design.sensor.columns, Matrices::of(&design).unwrap());
    // Adds shares of the sums of rows and of columns, and of that of the frame.
    let add = |frame: &mut [f64], [row, column, all]: [f64; 3]| {
        let rows: Vec<f64> = frame.chunks(columns).map(|row| row.iter().sum()).collect();
        let sums: Vec<f64> = (0..columns).map(|column| frame.iter().skip(column).step_by(columns).sum()).collect();
        let total: f64 = rows.iter().sum();
        for (taxel, stress) in frame.iter_mut().enumerate() {
            *stress += row * rows[taxel / columns] + column * sums[taxel % columns] + all * total;
        }
    };
    let mut missed = 0;
    for kind in Kind::all().step_by(3) {
        let contacts = kind.frames(&design.sensor, 0.5, 500..524).unwrap();
        for shares in [[0.02, 0.0], [0.0, 0.03], [0.04, 0.01]] {
            let crossed: Vec<SceneFrame> = contacts
                .iter()
                .cloned()
                .map(|mut contact| {
                    add(&mut contact.stress, [shares[0], shares[1], 0.0]);
                    contact
                })
                .collect();
            let mut frames = recorded(&design, &crossed, (0.0, 0.01), &mut random);
            let findings = check(&design, &frames, Some(&matrices));
            let Some(finding) = findings.iter().find(|finding| finding.kind == Finds::Crosstalk) else {
                println!("{kind}, {shares:?}: not found, {findings:?}");
                missed += 1;
                continue;
            };
            let said = finding.to_string();
            assert!(said.contains("corrects equal shares alone"), "{kind}: {said}");
            let number = |before: &str| -> f64 {
                said.split(before).nth(1).map_or(0.0, |rest| rest.split(' ').next().unwrap().parse().unwrap())
            };
            let excess = 1000.0 * (shares[0] + shares[1]);
            assert!((number("comes out about ") - excess).abs() < 6.0, "{kind}, {shares:?}: {said}");
            let factors = [-number("from each taxel "), -number("row's sum and "), number("and add ")];
            for frame in &mut frames {
                add(frame, factors);
            }
            assert!(
                check(&design, &frames, Some(&matrices)).iter().all(|left| left.kind != Finds::Crosstalk),
                "{kind}: {said}"
            );
        }
    }
    assert!(missed <= 2, "{missed} of 18 sets");
}
