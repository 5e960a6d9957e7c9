//! `sptfra sweep`: speed against error over variants of designs.

use std::fs;
use std::path::{Path, PathBuf};

use crate::arguments::{design_file, word};
use crate::message;
use golden::design::{Design, Estimator, PlanKind};
use golden::output::{write_together, write_whole};

use golden::progress::Progress;
use hdl_gen::write::io_error;
use testbench::sweep::grid::{Axes, FilterAxis, jobs};
use testbench::sweep::page;
use testbench::sweep::store::Store;
use testbench::sweep::{Outcomes, Simulate, Sweep, SweepError, SweepScene, csv_file};

/// Where results go.
const OUT: &str = "target/sweep";

/// Most frames of each kind of contact on which every point is judged: the table of kinds has more of them.
const FRAMES_OF_KIND: u64 = 6;

/// Measures speed against error for variants of designs on scenes with known forces.
///
/// Each point is a file in OUT/points, written whole. A sweep that was stopped continues from there. Without axes: filters
/// with plans, and widths and lanes one at a time around each design. Axes named beside --filters, --plans, --estimators
/// or --full are combined.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra sweep pad --scene scenes/sensor1-hertz.toml --lanes 8,16,32 --out sweep")]
#[allow(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Args {
    /// Design files (TOML) to vary.
    #[arg(required = true, value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Scene files (TOML) with known forces [default: contacts made for the sensor]
    #[arg(long = "scene", value_name = "SCENE.toml", num_args = 1..)]
    scenes: Vec<PathBuf>,
    /// Filters, comma-separated: none, f1, f2, f3, f1-40, f2-50.
    ///
    /// f1 and f2 take L and p from 10 to 90. f3 needs a design that has it.
    #[arg(long, value_delimiter = ',')]
    filters: Vec<FilterAxis>,
    /// Plans.
    #[arg(long, value_delimiter = ',', value_parser = word::<PlanKind>())]
    plans: Vec<PlanKind>,
    /// Widths of the coefficients in bits.
    #[arg(long, value_name = "BITS", value_delimiter = ',')]
    coefficient_bits: Vec<u32>,
    /// Widths of the vectors in bits.
    #[arg(long, value_name = "BITS", value_delimiter = ',')]
    data_bits: Vec<u32>,
    /// Numbers of lanes.
    #[arg(long, value_delimiter = ',')]
    lanes: Vec<usize>,
    /// Estimators.
    ///
    /// `joint` needs a given design with its constants.
    #[arg(long, value_delimiter = ',', value_parser = word::<Estimator>())]
    estimators: Vec<Estimator>,
    /// Every combination: thousands of points.
    #[arg(long)]
    full: bool,
    /// Points to simulate too.
    ///
    /// In Verilator, word by word.
    #[arg(long, value_name = "POINTS", value_parser = word::<Simulate>(), default_value = "none", num_args = 0..=1, default_missing_value = "all")]
    simulate: Simulate,
    /// Compare the points on N frames of each kind of contact too; without N: 40.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "40", default_value_t = 0, hide_default_value = true)]
    kinds: u64,
    /// Folder for points, tables, report and designs.
    ///
    /// It gets the points, sweep.json, sweep.csv, report.html and the recommended designs.
    #[arg(long, value_name = "FOLDER", default_value = OUT)]
    out: PathBuf,
    /// Write a folder OUT/jobs/KEY for each point, and compute nothing.
    ///
    /// It has the files that `sptfra run` needs.
    #[arg(long, conflicts_with = "json")]
    prepare: bool,
    /// Folder with reports KEY.json of such runs, in place of simulations.
    ///
    /// `sptfra run --json` writes them.
    #[arg(long, value_name = "FOLDER")]
    runs: Option<PathBuf>,
    /// Print the points as JSON.
    #[arg(long)]
    json: bool,
}

/// Sweeps.
pub fn run(arguments: &Args) -> message::Result {
    let designs = arguments.designs.iter().map(|path| Design::load(path)).collect::<Result<Vec<_>, _>>()?;
    let mut scenes = arguments.scenes.iter().map(|path| SweepScene::load(path)).collect::<Result<Vec<_>, _>>()?;
    let axes = Axes {
        filters: arguments.filters.clone(),
        plans: arguments.plans.clone(),
        coefficient_bits: arguments.coefficient_bits.clone(),
        data_bits: arguments.data_bits.clone(),
        lanes: arguments.lanes.clone(),
        estimators: arguments.estimators.clone(),
        full: arguments.full,
    };
    let jobs = jobs(&designs, &axes, &mut scenes, arguments.kinds.min(FRAMES_OF_KIND))?;
    let sweep =
        Sweep { jobs, scenes, simulate: arguments.simulate, runs: arguments.runs.clone(), kinds: arguments.kinds };
    if arguments.prepare {
        let count = sweep.prepare(&arguments.out)?;
        return Ok(format!(
            "{count} of {} points to run in {}\n",
            sweep.jobs.len(),
            arguments.out.join("jobs").display()
        )
        .into());
    }
    let store = Store::open(&arguments.out)?;
    let progress = Progress::new();
    let outcomes = sweep.run(&store, &progress)?;
    progress.stage("drawing the report");
    let json = serde_json::to_string_pretty(&outcomes.points)? + "\n";
    let place = |name: &str| arguments.out.join(name);
    write_whole(&place("sweep.json"), json.as_bytes())?;
    write_whole(&place("sweep.csv"), csv_file::csv(&outcomes.points)?.as_bytes())?;
    let contents = page::Contents::new(&designs, &sweep, &outcomes.points)?;
    write_recommended(&arguments.out, contents.recommended())?;
    let page = place("report.html");
    write_whole(&page, page::render(&contents)?.as_bytes())?;
    drop(progress);
    Ok(if arguments.json { json } else { summary(&outcomes, &contents, &arguments.out) }.into())
}

/// Writes the recommended designs in place of those of the sweep before, which may have had other names.
fn write_recommended<'a>(out: &Path, files: impl Iterator<Item = &'a (String, String)>) -> Result<(), SweepError> {
    let folder = out.join(page::RECOMMENDED);
    let failed = |action| io_error(&folder, action);
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(failed("remove the recommended designs in"))?;
    }
    let files: Vec<(PathBuf, String)> = files.map(|(name, text)| (out.join(name), text.clone())).collect();
    if !files.is_empty() {
        fs::create_dir(&folder).map_err(failed("make the folder"))?;
    }
    Ok(write_together(&files)?)
}

fn summary(outcomes: &Outcomes, contents: &page::Contents, out: &Path) -> String {
    let mut lines = vec![format!("{} points, {} of them computed now", outcomes.points.len(), outcomes.computed)];
    lines.extend(contents.verified.iter().map(|(count, how)| format!("  {count:>6} {how}")));
    lines.extend(contents.refusals.iter().map(|refusal| format!("         {refusal}")));
    let file = |name: &str| out.join(name).display().to_string();
    lines.push(format!("written: {}, {}, {}", file("report.html"), file("sweep.json"), file("sweep.csv")));
    if out.join(page::RECOMMENDED).is_dir() {
        lines.push(format!("the designs that the report recommends: {}", file(page::RECOMMENDED)));
    }
    lines.join("\n") + "\n"
}
