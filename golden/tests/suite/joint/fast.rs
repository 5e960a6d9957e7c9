//! The errors of `sensor1-fast`, against the table of docs/estimators.md that states them.

use std::fs;
use std::path::Path;

use super::{DISC, FRICTIONS, HERTZ, LAYER, OTHER_SEED, SEED, SOFTER, design, within};
use crate::contacts::{Worst, anywhere, centred, inside, pairs, worst};
use golden::scene::Shape;
use golden::solver::Solver;

/// Half of the last digit.
const ROUNDED: f64 = 0.0501;

/// A contact's name in the table, the noise in percent, and the cells: of `sensor1-joint`, then of `sensor1-fast`.
type Row = (String, f64, Vec<[f64; 2]>);

/// `worst (median)`.
fn stated(cell: &str) -> [f64; 2] {
    let numbers: Vec<f64> = cell.split([' ', '(', ')']).filter_map(|number| number.parse().ok()).collect();
    numbers.try_into().unwrap_or_else(|_| panic!("{cell} is no error"))
}

fn rows() -> Vec<Row> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/estimators.md");
    let text = fs::read_to_string(page).unwrap();
    let lines = text.lines().skip_while(|line| !line.starts_with("| contacts | noise | joint 0.2")).skip(2);
    lines
        .map_while(|line| {
            let cells: Vec<&str> = line.strip_prefix('|')?.trim_end_matches('|').split('|').map(str::trim).collect();
            Some((cells[0].to_owned(), cells[1].parse().unwrap(), cells[2..].iter().map(|cell| stated(cell)).collect()))
        })
        .collect()
}

#[test]
fn the_errors_are_those_that_the_docs_state() {
    let designs = ["sensor1-joint", "sensor1-fast"].map(design);
    let solvers = designs.each_ref().map(|design| Solver::new(design).unwrap());
    let taxels = &designs[0].sensor;
    let set = |name: &str| match name {
        "Hertz 7 mm" => centred(taxels, LAYER, HERTZ),
        "Hertz 7 mm, ν 0.45" => centred(taxels, SOFTER, HERTZ),
        "disc 10 mm" => centred(taxels, LAYER, DISC),
        "punch 6 mm" => centred(taxels, LAYER, Shape::Punch { radius_m: 6e-3 }),
        "200 inside" => inside(taxels, LAYER, SEED, 200),
        "1000 more inside" => inside(taxels, LAYER, OTHER_SEED, 1000),
        "200 anywhere" => anywhere(taxels, LAYER, 200),
        "100 pairs" => pairs(taxels, LAYER, SEED, 100),
        other => panic!("no contacts are called {other}"),
    };
    let rows = rows();
    assert_eq!(rows.len(), 10);
    let mut wrong = Vec::new();
    for (name, noise, cells) in rows {
        let set = set(&name);
        let frictions = solvers.iter().flat_map(|solver| FRICTIONS.map(|friction| (solver, friction)));
        for ((solver, friction), stated) in frictions.zip(cells) {
            let Worst { error: [x, y, _], median, .. } = worst(solver, &set, friction, noise / 100.0);
            let found = [x.max(y), median];
            if stated.iter().zip(found).any(|(stated, found)| (stated - found).abs() > ROUNDED) {
                wrong.push(format!("{name}, noise {noise}, friction {friction}: {found:.2?}, stated {stated:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The goals of `sensor1-joint`.
#[test]
fn contacts_are_within_the_goals_too() {
    let design = design("sensor1-fast");
    let solver = Solver::new(&design).unwrap();
    for shape in [HERTZ, DISC] {
        within(&solver, &centred(&design.sensor, LAYER, shape), [6.0, 3.0, 6.0], [8.0; 3], [2.1; 2]);
    }
    for (seed, normal) in [(SEED, [3.0, 3.1]), (OTHER_SEED, [3.5; 2])] {
        within(&solver, &inside(&design.sensor, LAYER, seed, 200), [7.0, 5.0, 7.0], [8.0; 3], normal);
    }
}
