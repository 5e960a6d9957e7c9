//! Fit of LUTs and flip-flops to Yosys' counts of drawn designs: the constants of `hdl_gen::plan::luts`.

use std::collections::BTreeMap;
use std::fmt::Write;

use golden::design::{Design, DesignError};
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::{FEATURES, features};
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Drawn designs.
pub const DRAWN: u64 = 33;

/// Times that the fit goes through all features: each is the best one while the others stand.
const SWEEPS: usize = 20_000;

/// Shipped designs among them: a correction network has weights, which are not drawn.
pub const SHIPPED: [&str; 7] = [
    "designs/sensor1-fast.toml",
    "designs/sensor1-fast-64.toml",
    "designs/sensor1-fast-100.toml",
    "designs/sensor1-reduced.toml",
    "designs/sensor1-reduced-64.toml",
    "designs/sensor1-resultants.toml",
    "golden/tests/designs/small-joint.toml",
];

/// One design of the fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// What the counts depend on.
    pub features: [f64; FEATURES.len()],
    /// LUTs and flip-flops that Yosys counts.
    pub counted: [f64; 2],
}

impl Row {
    /// A design's row.
    pub fn new(name: &str, plan: &Plan, counted: [f64; 2]) -> Self {
        Self { name: name.to_owned(), features: features(plan), counted }
    }
}

/// The drawn design of a number.
///
/// # Errors
/// The message of a draw that is no design.
pub fn draw(number: u64) -> Result<Design, DesignError> {
    let mut random = ChaCha8Rng::seed_from_u64(number);
    let mut one_in = |chance: u32| random.random_ratio(1, chance);
    let (grid, paper, wide, resultants) = (one_in(3), one_in(4), one_in(5), one_in(4));
    let (counts, ram, dead, control) = (one_in(2), one_in(2), one_in(3), one_in(2));
    let (per_frame, contacts, area) = (one_in(2), one_in(3), one_in(3));
    let paper = paper && !grid;
    let counts = counts || ram || dead;
    let lanes = *[4, 8, 16, 32].choose(&mut random).unwrap_or(&4);
    // A wide stream carries neither banks nor dead taxels.
    let stream = if paper || ram || dead { 32 } else { *[32, 64, 128].choose(&mut random).unwrap_or(&32) };
    let [columns, rows] = [0, 1].map(|_| random.random_range(5..=9));
    let mut text = format!(
        "format = 3\nname = \"drawn_{number:02}\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 4.0]\n\
         depth_mm = 3.0\n"
    );
    if counts {
        text += "pa_per_count = -12.5\n";
    }
    if dead {
        text += if ram { "dead = { taxels = [7], room = 2 }\n" } else { "dead = [7]\n" };
    }
    let _ = writeln!(text, "[algorithm]\nplan = \"{}\"", if paper { "paper" } else { "reduced" });
    text += if grid {
        "estimator = \"joint\"\ngain = 1.1\nfriction_correction = [1.0, 0.0]\n"
    } else {
        "estimator = \"line\"\n"
    };
    let _ = writeln!(text, "count_contacts = {}", contacts && !paper);
    let _ = writeln!(text, "outputs = \"{}\"", if resultants && !paper { "resultants" } else { "field" });
    let _ = writeln!(text, "[hardware]\nlanes = {lanes}\nstream_bits = {stream}");
    let _ = writeln!(text, "control = {}", control || ram);
    let _ = writeln!(text, "scaling = \"{}\"", if per_frame { "per_frame" } else { "fixed" });
    if ram {
        text += "calibration = \"ram\"\n";
    }
    if wide && !paper {
        text += "data_bits = 35\ncoefficient_bits = 27\n";
    }
    if area && grid {
        text += "optimise = \"area\"\n";
    }
    Design::from_toml(&text, &format!("drawn_{number:02}"))
}

/// Least squares of the counts on the features, in whole cells: LUTs and flip-flops of each. None is negative, since no
/// feature takes logic away; so a feature that few rows have does no harm.
pub fn fit(rows: &[Row]) -> [[f64; 2]; FEATURES.len()] {
    let mut fitted = [[0.0; 2]; FEATURES.len()];
    for kind in 0..2 {
        let mut left: Vec<f64> = rows.iter().map(|row| row.counted[kind]).collect();
        for _ in 0..SWEEPS {
            for feature in 0..FEATURES.len() {
                let column = || rows.iter().map(|row| row.features[feature]);
                let square: f64 = column().map(|value| value * value).sum();
                let towards: f64 = column().zip(&left).map(|(value, left)| value * left).sum();
                let old = fitted[feature][kind];
                let new = if square > 0.0 { (old + towards / square).max(0.0) } else { 0.0 };
                left.iter_mut().zip(column()).for_each(|(left, value)| *left -= (new - old) * value);
                fitted[feature][kind] = new;
            }
        }
    }
    fitted.map(|kinds| kinds.map(f64::round))
}

/// What a fit says of a row.
pub fn estimate(fitted: &[[f64; 2]; FEATURES.len()], row: &Row, kind: usize) -> f64 {
    row.features.iter().zip(fitted).map(|(value, fitted)| value * fitted[kind]).sum()
}

/// The estimate of each row by a fit that has not seen it.
pub fn left_out(rows: &[Row]) -> Vec<[f64; 2]> {
    let without = |at: usize| [&rows[..at], &rows[at + 1..]].concat();
    (0..rows.len())
        .map(|at| (fit(&without(at)), at))
        .map(|(fitted, at)| [0, 1].map(|kind| estimate(&fitted, &rows[at], kind)))
        .collect()
}

/// The table: a line for each design, with features, counts and the estimates of fits that have not seen it.
pub fn csv(rows: &[Row]) -> String {
    let mut text = format!(
        "# LUT and flip-flops by Yosys (synth_xilinx -family xcup), and a linear fit to the other designs of the table.\n\
         # command: make luts\ndesign,{},lut,lut_fit,ff,ff_fit\n",
        FEATURES.join(",")
    );
    for (Row { name, features, counted: [lut, ff] }, [lut_fit, ff_fit]) in rows.iter().zip(left_out(rows)) {
        let features = features.map(|value| value.to_string()).join(",");
        let _ = writeln!(text, "{name},{features},{lut},{lut_fit:.0},{ff},{ff_fit:.0}");
    }
    text
}

/// LUTs and flip-flops of the designs of such a table, by name.
pub fn read(text: &str) -> Option<BTreeMap<String, [f64; 2]>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let [lut, _, ff, _] = *cells.get(1 + FEATURES.len()..)? else { return None };
            Some(((*cells.first()?).to_owned(), [lut.parse().ok()?, ff.parse().ok()?]))
        })
        .collect()
}
