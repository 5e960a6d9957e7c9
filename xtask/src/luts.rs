//! The fit of LUTs and flip-flops to Yosys' counts of designs, module by module.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use golden::design::Design;
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::{ERROR, QUANTILES, REST, features};
use nalgebra::{DMatrix, DVector};
use serde::Deserialize;

use crate::bench::cells::{Count, by_module};

/// The table of counts, from the top of the checkout.
pub const COUNTS: &str = "results/luts.csv";
/// The table that the generator holds.
pub const FITTED: &str = "hdl-gen/src/plan/luts.csv";
/// The list of designs.
const LIST: &str = "xtask/designs/counted.toml";
/// Counts by block of other designs.
const BLOCKS: &str = "results/cells.csv";
/// Where a table has a design's sum.
const ALL: &str = "all";
const ABOUT: &str = "\
# LUTs and flip-flops by Yosys (synth_xilinx -family xcup). Designs are those of xtask/designs/counted.toml and cells.csv.
# A module counts with what it instantiates, but for modules that have rows of their own.
# Designs in cells.csv have their sums there. Their modules here may be of an earlier count.
# Errors, in percent, are those of a fit without the design; there is none of a design with a part that no other has.
# command: make luts
design,module,lut,ff,lut_error,ff_error,hash
";
const ABOUT_FITTED: &str = "\
# LUTs and flip-flops of one of each feature, fitted to the counts in results/luts.csv, and the errors in percent of
# designs that the fit has not seen.
# command: make luts
module,feature,lut,ff
";

/// LUTs and flip-flops of each module, by its name without the prefix, or of what is in none of them.
type Counts = BTreeMap<String, [f64; 2]>;
/// Cells of a row, and its LUTs and flip-flops, if it has any.
type Cells<const N: usize> = ([String; N], Option<[f64; 2]>);

/// A design that Yosys has counted.
pub struct Counted {
    plan: Plan,
    /// Of those modules that are known.
    modules: Counts,
    whole: [f64; 2],
    /// Whether [`BLOCKS`] has the sum.
    in_blocks: bool,
}

#[derive(Deserialize)]
struct List {
    files: Vec<PathBuf>,
    design: Vec<toml::Table>,
}

/// A module of a design: how much of each feature it has, its LUTs and flip-flops, and those of the design.
struct Row {
    design: usize,
    features: Vec<f64>,
    counted: [f64; 2],
    whole: [f64; 2],
}

/// A fit.
pub struct Fit {
    /// [`COUNTS`].
    pub counts: String,
    /// [`FITTED`].
    pub fitted: String,
}

/// The designs that are to be counted; `root` is the top of the checkout.
///
/// # Errors
/// The message of a list or a design that is wrong.
pub fn designs(root: &Path) -> Result<Vec<Design>, String> {
    let place = root.join(LIST);
    let List { files, design } =
        toml::from_str(&text(&place)?).map_err(|error| format!("{}: {error}", place.display()))?;
    let drawn = design.into_iter().map(|mut keys| {
        keys.insert("format".to_owned(), 3.into());
        Design::from_toml(&keys.to_string(), &place.display().to_string())
    });
    let designs = files.iter().map(|file| Design::load(&root.join(file))).chain(drawn);
    designs.map(|design| design.map_err(|error| error.to_string())).collect()
}

/// The designs among them that [`COUNTS`] does not have.
///
/// # Errors
/// The message of a file that is wrong.
pub fn missing(root: &Path) -> Result<Vec<Design>, String> {
    let known = known(root)?;
    Ok(designs(root)?.into_iter().filter(|design| !known.contains_key(&design.hash())).collect())
}

/// Files by which the command makes a design, with their names: the design's own last.
pub fn files(design: &Design) -> Vec<(String, String)> {
    let named = |name: &str| format!("{}.{name}", design.name);
    let beside = design.files().into_iter().map(|(name, content)| (named(name), content));
    beside.chain([(named("toml"), design.to_toml_with(named))]).collect()
}

/// Designs with their counts: those that [`COUNTS`] has, those with statistics in a folder, and of [`BLOCKS`].
///
/// # Errors
/// The message of a file that is wrong.
pub fn counted(root: &Path, statistics: Option<&Path>) -> Result<Vec<Counted>, String> {
    let mut known = known(root)?;
    let mut counted: Vec<Counted> = Vec::new();
    for design in designs(root)? {
        let plan = plan(&design)?;
        let file = statistics.map(|folder| folder.join(format!("{}.stat.json", design.name)));
        let modules = match (known.remove(&design.hash()), file.filter(|file| file.exists())) {
            (Some(modules), _) => modules,
            (None, Some(file)) => count(&plan, &file)?,
            (None, None) => continue,
        };
        let whole = [0, 1].map(|kind| modules.values().map(|count| count[kind]).sum());
        counted.push(Counted { plan, modules, whole, in_blocks: false });
    }
    for (name, blocks) in blocks(root)? {
        let plan = plan(&Design::load(&root.join(format!("designs/{name}.toml"))).map_err(|error| error.to_string())?)?;
        if let Some(same) = counted.iter_mut().find(|of| of.plan.design.name == plan.design.name) {
            same.in_blocks = true;
            continue;
        }
        let Some(&whole) = blocks.get(ALL) else { return Err(format!("{BLOCKS}: {name} has no row {ALL}")) };
        let known = plan.resources.blocks.iter().filter_map(|block| {
            let [module] = block.modules[..] else { return None };
            Some((module.strip_prefix("sptfra_")?.to_owned(), *blocks.get(block.name)?))
        });
        let modules = known.filter(|(module, _)| modules(&plan).contains(&module.as_str())).collect();
        counted.push(Counted { plan, modules, whole, in_blocks: true });
    }
    Ok(counted)
}

fn text(path: &Path) -> Result<String, String> {
    let failed = |error| format!("{}: cannot read the file: {error}; restore it from the repository", path.display());
    fs::read_to_string(path).map_err(failed)
}

fn plan(design: &Design) -> Result<Plan, String> {
    Plan::new(design).map_err(|error| format!("{}: {error}", design.name))
}

/// Modules with rows of their own.
fn modules(plan: &Plan) -> Vec<&'static str> {
    let mut modules: Vec<&str> = features(plan).into_iter().map(|(module, ..)| module).collect();
    modules.dedup();
    modules
}

/// Counts the modules of a design in Yosys' statistics.
fn count(plan: &Plan, statistics: &Path) -> Result<Counts, String> {
    let modules = modules(plan);
    let place = |name: &str| modules.iter().position(|of| name.strip_prefix("sptfra_") == Some(of));
    let rest = modules.iter().position(|of| *of == REST).unwrap_or(modules.len());
    let counts = by_module(&plan.design.name, statistics, rest, place).map_err(|error| error.to_string())?;
    let counts = counts.into_iter().map(|Count { lut, ff, .. }| [lut as f64, ff as f64]);
    let has = |module: &str| features(plan).iter().any(|(of, _, value)| *of == module && *value > 0.0);
    let counts = modules.into_iter().zip(counts).filter(|(module, [lut, ff])| lut + ff > 0.0 || has(module));
    Ok(counts.map(|(module, count)| (module.to_owned(), count)).collect())
}

/// Rows of a table: cells in these columns, and the LUTs and flip-flops.
fn rows<const N: usize>(path: &Path, columns: [&str; N]) -> Result<Vec<Cells<N>>, String> {
    let text = text(path)?;
    let mut lines = text.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap_or_default();
    let place = |name: &str| {
        let found = header.iter().position(|column| *column == name);
        found.ok_or_else(|| format!("{}: there is no column {name}; restore the table", path.display()))
    };
    let (lut, ff) = (place("lut")?, place("ff")?);
    let mut places = [0; N];
    for (at, name) in columns.into_iter().enumerate() {
        places[at] = place(name)?;
    }
    let row = |cells: Vec<&str>| {
        let cell = |at: usize| cells.get(at).copied().unwrap_or_default();
        let numbers = [lut, ff].map(|at| cell(at).parse().ok());
        let [Some(lut), Some(ff)] = numbers else { return (places.map(|at| cell(at).to_owned()), None) };
        (places.map(|at| cell(at).to_owned()), Some([lut, ff]))
    };
    Ok(lines.map(row).collect())
}

/// Counts by hash of the design.
fn known(root: &Path) -> Result<BTreeMap<String, Counts>, String> {
    let (mut designs, mut counts) = (BTreeMap::new(), Counts::new());
    for ([module, hash], count) in rows(&root.join(COUNTS), ["module", "hash"])? {
        // The sum stands behind the modules.
        if module == ALL {
            designs.insert(hash, std::mem::take(&mut counts));
        } else if let Some(count) = count {
            counts.insert(module, count);
        }
    }
    designs.retain(|_, counts| !counts.is_empty());
    Ok(designs)
}

/// Counts of blocks by design.
fn blocks(root: &Path) -> Result<BTreeMap<String, Counts>, String> {
    let mut designs: BTreeMap<String, Counts> = BTreeMap::new();
    for ([design, block], count) in rows(&root.join(BLOCKS), ["design", "block"])? {
        designs.entry(design).or_default().extend(count.map(|count| (block, count)));
    }
    Ok(designs)
}

/// The fit to the counts of designs, and its errors, each of a design that the fit has not seen.
pub fn fit(counted: &[Counted]) -> Fit {
    let features: Vec<Vec<_>> = counted.iter().map(|of| features(&of.plan)).collect();
    let order = counted.first().map(|of| modules(&of.plan)).unwrap_or_default();
    let of_module = |design: usize, module: &str| -> Vec<f64> {
        features[design].iter().filter(|(of, ..)| *of == module).map(|(.., value)| *value).collect()
    };
    let rows = |module: &str| -> Vec<Row> {
        let row = |(design, of): (usize, &Counted)| {
            let counted = *of.modules.get(module)?;
            Some(Row { design, features: of_module(design, module), counted, whole: of.whole })
        };
        counted.iter().enumerate().filter_map(row).collect()
    };
    let rows: Vec<(&str, Vec<Row>)> = order.into_iter().map(|module| (module, rows(module))).collect();
    let mut table = ABOUT.to_owned();
    let mut errors = [Vec::new(), Vec::new()];
    for (design, Counted { plan, modules, whole, in_blocks }) in counted.iter().enumerate() {
        let name = &plan.design.name;
        for (module, [lut, ff]) in modules {
            let _ = writeln!(table, "{name},{module},{lut},{ff},,,");
        }
        let estimate = |kind: usize| -> Option<f64> {
            let of = |(module, rows): &(&str, Vec<Row>)| -> Option<f64> {
                let own = of_module(design, module);
                let others: Vec<&Row> = rows.iter().filter(|row| row.design != design).collect();
                let known = |at: usize| others.iter().any(|row| row.features[at] > 0.0);
                let is_known = own.iter().enumerate().all(|(at, of)| *of <= 0.0 || known(at));
                is_known.then(|| own.iter().zip(solve(&others, kind)).map(|(of, one)| of * one).sum())
            };
            rows.iter().map(of).sum()
        };
        let shown = [0, 1].map(|kind| {
            let error = 100.0 * (estimate(kind)? / whole[kind] - 1.0);
            errors[kind].push(error.abs());
            Some(format!("{error:.1}"))
        });
        let [lut_error, ff_error] = shown.map(Option::unwrap_or_default);
        let [lut, ff] = whole.map(|sum| if *in_blocks { String::new() } else { sum.to_string() });
        let hash = plan.design.hash();
        let _ = writeln!(table, "{name},{ALL},{lut},{ff},{lut_error},{ff_error},{hash}");
    }
    let mut fitted = ABOUT_FITTED.to_owned();
    for (name, share) in QUANTILES {
        let [lut, ff] = [0, 1].map(|kind| quantile(&errors[kind], share));
        let _ = writeln!(table, "{name},{ERROR},,,{lut:.1},{ff:.1},");
        let _ = writeln!(fitted, "{ERROR},{name},{lut:.1},{ff:.1}");
    }
    for (module, rows) in &rows {
        let every: Vec<&Row> = rows.iter().collect();
        let [lut, ff] = [0, 1].map(|kind| solve(&every, kind));
        let names = features[0].iter().filter(|(of, ..)| of == module).map(|(_, feature, _)| feature);
        for (at, feature) in names.enumerate().filter(|&(at, _)| rows.iter().any(|row| row.features[at] > 0.0)) {
            let _ = writeln!(fitted, "{module},{feature},{:.1},{:.1}", lut[at], ff[at]);
        }
    }
    Fit { counts: table, fitted }
}

/// The least error that so large a share of the designs is not above; 0 without designs.
fn quantile(errors: &[f64], share: f64) -> f64 {
    let mut errors = errors.to_vec();
    errors.sort_by(f64::total_cmp);
    let rank = (share * errors.len() as f64).ceil() as usize;
    errors.get(rank.saturating_sub(1)).copied().unwrap_or_default()
}

/// Least squares, relative to each design's size. What is negative is left out, the most negative first: no feature takes
/// logic away. Nothing is known of a feature that no row has: it is 0.
fn solve(rows: &[&Row], kind: usize) -> Vec<f64> {
    let number = rows.first().map_or(0, |row| row.features.len());
    let mut kept: Vec<usize> = (0..number).filter(|&at| rows.iter().any(|row| row.features[at] > 0.0)).collect();
    let counted = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.counted[kind] / row.whole[kind]));
    let mut fitted = vec![0.0; number];
    while !kept.is_empty() {
        let system = DMatrix::from_fn(rows.len(), kept.len(), |row, column| {
            rows[row].features[kept[column]] / rows[row].whole[kind]
        });
        // A decomposition with both sides has a solution.
        let Ok(solved) = system.svd(true, true).solve(&counted, 1e-12) else { break };
        let least = (0..kept.len()).min_by(|&a, &b| solved[a].total_cmp(&solved[b]));
        if let Some(least) = least.filter(|&least| solved[least] < 0.0) {
            kept.remove(least);
            continue;
        }
        kept.iter().zip(solved.iter()).for_each(|(&feature, &value)| fitted[feature] = value);
        break;
    }
    fitted
}
