//! The fit of LUTs and flip-flops to Yosys' counts of shipped designs, and of modules that these do not have.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use golden::design::Design;
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::{NOT_COUNTED, features};
use nalgebra::{DMatrix, DVector};

use crate::bench::cells::{Count, by_module};

/// Where a table has a design's sum.
const ALL: &str = "all";
/// Where it has what is in no block.
const REST: &str = "rest";
const ABOUT: &str = "\
# LUTs and flip-flops by Yosys (synth_xilinx -family xcup): whole designs as in cells.csv, and single modules of others.
# Errors, in percent, are those of a fit without the design.
# command: make luts
design,block,lut,ff,lut_error,ff_error
";

/// LUTs and flip-flops of each block of each design: `sptfra_…` of a module, or as `metadata.json` calls a block.
pub type Counts = BTreeMap<String, Vec<(String, [f64; 2])>>;

/// A block of a design: what it has of each feature, and its LUTs and flip-flops.
struct Equation {
    design: usize,
    features: Vec<f64>,
    counted: [f64; 2],
}

/// A fit.
pub struct Fit {
    /// Table of counts and errors, CSV.
    pub table: String,
    /// LUTs and flip-flops of one of each feature.
    pub fitted: [Vec<f64>; 2],
    /// Percent by which whole designs are off at most that the fit has not seen.
    pub error_percent: [u32; 2],
}

/// Reads counts in a table with the columns design, block, lut and ff.
pub fn read(table: &str) -> Option<Counts> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next()?;
    let places = ["design", "block", "lut", "ff"].map(|name| header.iter().position(|column| *column == name));
    let mut counts = Counts::new();
    for line in lines {
        let [design, block, lut, ff] = places.map(|place| line.get(place?).copied());
        if block? != ALL {
            let count = [lut?.parse().ok()?, ff?.parse().ok()?];
            counts.entry(design?.to_owned()).or_default().push((block?.to_owned(), count));
        }
    }
    Some(counts)
}

/// Counts a part of a design in Yosys' statistics, module by module.
///
/// # Errors
/// The message of a design that cannot be planned, and of a file that is none.
pub fn count(design: &Path, statistics: &Path) -> Result<Vec<(String, [f64; 2])>, String> {
    let plan = plan(design)?;
    let mut modules: Vec<String> = features(&plan).iter().map(|(module, ..)| format!("sptfra_{module}")).collect();
    modules.dedup();
    let place = |module: &str| modules.iter().position(|of| of == module);
    let counts = by_module(&plan.design.name, statistics, modules.len(), place).map_err(|error| error.to_string())?;
    let counts = counts.into_iter().map(|Count { lut, ff, .. }| [lut as f64, ff as f64]);
    Ok(modules.into_iter().zip(counts).filter(|(_, [lut, ff])| lut + ff > 0.0).collect())
}

fn plan(design: &Path) -> Result<Plan, String> {
    let loaded = Design::load(design).map_err(|error| error.to_string())?;
    Plan::new(&loaded).map_err(|error| format!("{}: {error}", design.display()))
}

/// A row of the linear system for each block of a design.
fn equations(design: usize, plan: &Plan, blocks: &[(String, [f64; 2])]) -> Vec<Equation> {
    let features = features(plan);
    let row = |&(_, counted): &(String, [f64; 2])| Equation { design, features: vec![0.0; features.len()], counted };
    let mut rows: Vec<Equation> = blocks.iter().map(row).collect();
    let resources = &plan.resources.blocks;
    for (at, (module, _, value)) in features.into_iter().enumerate() {
        let module = format!("sptfra_{module}");
        let named = resources.iter().find(|block| block.modules.contains(&module.as_str())).map(|block| block.name);
        let own = blocks.iter().position(|(block, _)| *block == module || Some(block.as_str()) == named);
        // In a part of a design there is no rest.
        if let Some(row) = own.or(blocks.iter().position(|(block, _)| block == REST)) {
            rows[row].features[at] = value;
        }
    }
    rows
}

/// The fit to the counts of designs in a folder, and of parts of others in a second one.
///
/// # Errors
/// The message of a design that cannot be planned.
pub fn fit(whole: (&Counts, &Path), parts: (&Counts, &Path)) -> Result<Fit, String> {
    let mut rows = Vec::new();
    let designs = [whole, parts].into_iter().flat_map(|(counts, folder)| counts.iter().map(move |of| (of, folder)));
    for (number, ((name, blocks), folder)) in designs.enumerate() {
        rows.extend(equations(number, &plan(&folder.join(format!("{name}.toml")))?, blocks));
    }
    let mut table = ABOUT.to_owned();
    for (name, blocks) in parts.0 {
        for (block, [lut, ff]) in blocks {
            let _ = writeln!(table, "{name},{block},{lut},{ff},,");
        }
    }
    let mut error_percent = [0; 2];
    for (number, name) in whole.0.keys().enumerate() {
        let (own, others): (Vec<&Equation>, Vec<&Equation>) = rows.iter().partition(|row| row.design == number);
        let [(lut, lut_error), (ff, ff_error)] = [0, 1].map(|kind| {
            let fitted = solve(&others, kind);
            let counted: f64 = own.iter().map(|row| row.counted[kind]).sum();
            let estimate: f64 =
                own.iter().flat_map(|row| row.features.iter().zip(&fitted)).map(|(a, b)| a * b.max(0.0)).sum();
            let error = 100.0 * (estimate / counted - 1.0);
            error_percent[kind] = error_percent[kind].max(error.abs().ceil() as u32);
            (counted, error)
        });
        let _ = writeln!(table, "{name},{ALL},{lut},{ff},{lut_error:.1},{ff_error:.1}");
    }
    let every: Vec<&Equation> = rows.iter().collect();
    let fitted =
        [0, 1].map(|kind| solve(&every, kind).into_iter().map(|value| (10.0 * value).round() / 10.0).collect());
    Ok(Fit { table, fitted, error_percent })
}

/// Least squares, relative to each design's size. What is negative is left out, the most negative first: no feature takes
/// logic away.
fn solve(rows: &[&Equation], kind: usize) -> Vec<f64> {
    let mut sizes = BTreeMap::new();
    for row in rows {
        *sizes.entry(row.design).or_insert(0.0) += row.counted[kind];
    }
    let number = rows.first().map_or(0, |row| row.features.len());
    let mut kept: Vec<usize> = (0..number).filter(|&at| rows.iter().any(|row| row.features[at] != 0.0)).collect();
    let seen = kept.clone();
    let counted = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.counted[kind] / sizes[&row.design]));
    loop {
        let system = DMatrix::from_fn(rows.len(), kept.len(), |row, column| {
            rows[row].features[kept[column]] / sizes[&rows[row].design]
        });
        let solved = system.svd(true, true).solve(&counted, 1e-12).unwrap_or_default();
        let least = (0..kept.len()).min_by(|&a, &b| solved[a].total_cmp(&solved[b]));
        if let Some(least) = least.filter(|&least| solved[least] < 0.0) {
            kept.remove(least);
            continue;
        }
        let mut fitted = vec![NOT_COUNTED; number];
        for &feature in &seen {
            fitted[feature] = 0.0;
        }
        kept.iter().zip(solved.iter()).for_each(|(&feature, &value)| fitted[feature] = value);
        return fitted;
    }
}
