//! The errors of the fast designs, against the tables of docs/estimators.md that state them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::thread;

use super::{DISC, FRICTIONS, HERTZ, LAYER, OTHER_SEED, SEED, SOFTER, design, within};
use crate::contacts::{Pressed, Worst, anywhere, centred, inside, pairs, worst};
use crate::effort::some_of;
use golden::design::{Design, Sensor};
use golden::scene::Shape;
use golden::solver::Solver;

/// Half of the last digit.
const ROUNDED: f64 = 0.0501;
/// Rows of errors in each table: of four designs for sensor 1, of two for sensor 2, of three of the wide family.
const ROWS: [usize; 3] = [80, 40, 42];

/// A contact's name in a table, the noise in percent, and three cells for each design.
type Row = (String, f64, Vec<[f64; 2]>);

/// `worst (median)`.
fn stated(cell: &str) -> [f64; 2] {
    let numbers: Vec<f64> = cell.split([' ', '(', ')']).filter_map(|number| number.parse().ok()).collect();
    numbers.try_into().unwrap_or_else(|_| panic!("{cell} is no error"))
}

fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}

/// The tables of the page whose columns are designs: their names, and the rows.
fn tables() -> Vec<(Vec<String>, Vec<Row>)> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/estimators.md");
    let text = fs::read_to_string(page).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let heads = (0..lines.len()).filter(|&at| lines[at].starts_with("| contacts | noise | `"));
    let table = |head: usize| {
        let names = lines[head].split('`').skip(1).step_by(2).map(str::to_owned).collect();
        let rows = lines[head + 2..].iter().take_while(|line| line.starts_with('|'));
        let row = |line: &&str| {
            let cells = cells(line);
            (cells[0].to_owned(), cells[1].parse().unwrap(), cells[2..].iter().map(|cell| stated(cell)).collect())
        };
        (names, rows.map(row).collect())
    };
    heads.map(table).collect()
}

/// The contacts that a table calls so.
fn set(taxels: &Sensor, contacts: &str) -> Vec<Pressed> {
    match contacts {
        "Hertz 7 mm" => centred(taxels, LAYER, HERTZ),
        "Hertz 7 mm, ν 0.45" => centred(taxels, SOFTER, HERTZ),
        "disc 10 mm" => centred(taxels, LAYER, DISC),
        "disc 10 mm, ν 0.45" => centred(taxels, SOFTER, DISC),
        "punch 6 mm" => centred(taxels, LAYER, Shape::Punch { radius_m: 6e-3 }),
        "200 inside" => inside(taxels, LAYER, SEED, 200),
        "200 inside, ν 0.45" => inside(taxels, SOFTER, SEED, 200),
        "1000 more inside" => inside(taxels, LAYER, OTHER_SEED, 1000),
        "200 anywhere" => anywhere(taxels, LAYER, 200),
        "100 pairs" => pairs(taxels, LAYER, SEED, 100),
        other => panic!("no contacts are called {other}"),
    }
}

/// The cells on these contacts that are not what the designs err by. The contacts are made once for each sensor.
fn wrong_on(designs: &[Design], contacts: &str, rows: &[Row]) -> Vec<String> {
    let mut sets: Vec<(&Sensor, Vec<Pressed>)> = Vec::new();
    for Design { sensor, .. } in designs {
        if sets.iter().all(|(of, _)| *of != sensor) {
            sets.push((sensor, set(sensor, contacts)));
        }
    }
    let on = |design: &Design| &sets.iter().find(|(of, _)| **of == design.sensor).unwrap().1;
    let own = rows.iter().filter(|(of, ..)| of == contacts);
    own.flat_map(|row| {
        let designs = designs.iter().zip(row.2.chunks_exact(FRICTIONS.len()));
        designs.flat_map(|(design, cells)| wrong(design, on(design), row, cells)).collect::<Vec<_>>()
    })
    .collect()
}

/// Those of a row and a design.
fn wrong(design: &Design, set: &[Pressed], (contacts, noise, _): &Row, cells: &[[f64; 2]]) -> Vec<String> {
    let mut wrong = Vec::new();
    let solver = Solver::new(design).unwrap();
    for (friction, stated) in FRICTIONS.into_iter().zip(cells) {
        let Worst { error: [x, y, _], median, .. } = worst(&solver, set, friction, noise / 100.0);
        let found = [x.max(y), median];
        if stated.iter().zip(found).any(|(stated, found)| (stated - found).abs() > ROUNDED) {
            let of = &design.name;
            wrong.push(format!("{of}, {contacts}, noise {noise}, {friction}: {found:.1?}, stated {stated:?}"));
        }
    }
    wrong
}

#[test]
fn the_errors_are_those_that_the_docs_state() {
    let tables = tables();
    assert_eq!(tables.iter().map(|(names, rows)| names.len() * rows.len()).collect::<Vec<_>>(), ROWS);
    for (names, rows) in tables {
        let designs: Vec<Design> = names.iter().map(|name| design(name)).collect();
        let contacts: BTreeSet<&str> = rows.iter().map(|(of, ..)| &**of).collect();
        let (designs, rows) = (&designs, &rows);
        let wrong: Vec<String> = thread::scope(|scope| {
            let running: Vec<_> =
                some_of(contacts).into_iter().map(|of| scope.spawn(move || wrong_on(designs, of, rows))).collect();
            running.into_iter().flat_map(|of| of.join().unwrap()).collect()
        });
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

/// The goals of `sensor1-joint`.
#[test]
fn contacts_are_within_the_goals_too() {
    for name in some_of(["sensor1-fast", "sensor1-fast-64", "sensor1-fast-100", "sensor2-fast"]) {
        let design = design(name);
        let solver = Solver::new(&design).unwrap();
        for shape in [HERTZ, DISC] {
            within(&solver, &centred(&design.sensor, LAYER, shape), [6.0, 3.0, 6.0], [8.0; 3], [2.1; 2]);
        }
        for (seed, normal) in [(SEED, [3.0, 3.1]), (OTHER_SEED, [3.5; 2])] {
            within(&solver, &inside(&design.sensor, LAYER, seed, 200), [7.0, 5.0, 7.0], [8.0; 3], normal);
        }
    }
}
