//! `testbench sweep`.

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use golden::design::{Design, PlanKind};
use golden::output::write_whole;

use testbench::hard::{self, Scope};
use testbench::page;
use testbench::progress::Progress;
use testbench::sweep::grid::{Axes, FilterAxis, jobs};
use testbench::sweep::point::Verified;
use testbench::sweep::store::Store;
use testbench::sweep::{Outcomes, Simulate, Sweep, SweepScene, table};

/// Where results go.
const OUT: &str = "target/sweep";

#[derive(Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Arguments {
    /// Design files (TOML) to vary.
    #[arg(required = true)]
    designs: Vec<PathBuf>,
    /// Scene files (TOML) with known forces; a design without one of its sensor gets a standing scene.
    #[arg(long = "scene", value_name = "SCENE.toml", num_args = 1..)]
    scenes: Vec<PathBuf>,
    /// Filters, comma-separated: none, f1 and f2 (L and p from 10 to 90), f3 (of a design that has it), f1-40, f2-50.
    #[arg(long, value_delimiter = ',', value_parser = filter)]
    filters: Vec<FilterAxis>,
    /// Plans.
    #[arg(long, value_delimiter = ',')]
    plans: Vec<PlanWord>,
    /// Widths of the coefficients in bits.
    #[arg(long, value_delimiter = ',')]
    coefficient_bits: Vec<u32>,
    /// Widths of the vectors in bits.
    #[arg(long, value_delimiter = ',')]
    data_bits: Vec<u32>,
    /// Numbers of lanes.
    #[arg(long, value_delimiter = ',')]
    lanes: Vec<usize>,
    /// Every combination: thousands of points.
    #[arg(long)]
    full: bool,
    /// What to run through the RTL in Verilator too, word by word; `all` if nothing is said.
    #[arg(long, value_enum, default_value = "none", num_args = 0..=1, default_missing_value = "all")]
    simulate: Simulate,
    /// Add the table of hard cases to the page, as `testbench hard` makes it; through the RTL too with --simulate.
    #[arg(long)]
    hard: bool,
    /// Folder for the points and for sweep.json, sweep.csv and report.html.
    #[arg(long, value_name = "FOLDER", default_value = OUT)]
    out: PathBuf,
    /// Print the points' keys, one a line, and compute nothing.
    #[arg(long, conflicts_with_all = ["point", "json"])]
    list: bool,
    /// Compute this point alone, if it is not there.
    #[arg(long, value_name = "KEY")]
    point: Option<String>,
    /// Print the points as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum PlanWord {
    Paper,
    Reduced,
}

fn filter(word: &str) -> Result<FilterAxis, String> {
    word.parse().map_err(|error: testbench::sweep::SweepError| error.to_string())
}

/// Sweeps; returns what to print.
pub fn run(arguments: &Arguments) -> Result<String, Box<dyn Error>> {
    let designs = arguments.designs.iter().map(|path| Design::load(path)).collect::<Result<Vec<_>, _>>()?;
    let mut scenes = arguments.scenes.iter().map(|path| SweepScene::load(path)).collect::<Result<Vec<_>, _>>()?;
    let plan = |word: &PlanWord| match word {
        PlanWord::Paper => PlanKind::Paper,
        PlanWord::Reduced => PlanKind::Reduced,
    };
    let axes = Axes {
        filters: arguments.filters.clone(),
        plans: arguments.plans.iter().map(plan).collect(),
        coefficient_bits: arguments.coefficient_bits.clone(),
        data_bits: arguments.data_bits.clone(),
        lanes: arguments.lanes.clone(),
        full: arguments.full,
    };
    let jobs = jobs(&designs, &axes, &mut scenes)?;
    if arguments.list {
        return Ok(jobs.iter().map(|job| job.key.clone() + "\n").collect());
    }
    let sweep = Sweep { jobs, scenes, simulate: arguments.simulate };
    let store = Store::open(&arguments.out)?;
    if let Some(key) = &arguments.point {
        let point = sweep.run_one(key, &store)?;
        return Ok(if arguments.json {
            serde_json::to_string_pretty(&point)? + "\n"
        } else {
            format!("{}: {}\n", store.path(key).display(), point.label())
        });
    }
    let progress = Progress::new();
    let outcomes = sweep.run(&store, &progress)?;
    progress.stage("drawing the report");
    let json = serde_json::to_string_pretty(&outcomes.points)? + "\n";
    let place = |name: &str| arguments.out.join(name);
    write_whole(&place("sweep.json"), json.as_bytes())?;
    write_whole(&place("sweep.csv"), table::csv(&outcomes.points)?.as_bytes())?;
    let mut contents = page::Contents::new(&designs, &sweep, &outcomes.points)?;
    if arguments.hard {
        contents = contents.with_hard_cases(&hard::table(
            Scope { large: true, rtl: arguments.simulate != Simulate::None },
            &progress,
        )?);
    }
    write_whole(&place("report.html"), page::render(&contents)?.as_bytes())?;
    drop(progress);
    Ok(if arguments.json { json } else { summary(&outcomes, &arguments.out) })
}

fn summary(outcomes: &Outcomes, out: &Path) -> String {
    let Outcomes { points, computed } = outcomes;
    let with = |verified| points.iter().filter(|point| point.verified == verified).count();
    let mut lines = vec![format!("{} points, {computed} of them computed now", points.len())];
    for verified in [Verified::Rtl, Verified::Model, Verified::Golden] {
        let count = with(verified);
        if count > 0 {
            lines.push(format!("  {count:>6} {}", verified.title()));
        }
    }
    lines.extend(refusals(outcomes).iter().map(|refusal| format!("         {refusal}")));
    let file = |name: &str| out.join(name).display().to_string();
    lines.push(format!("written: {}, {}, {}", file("report.html"), file("sweep.json"), file("sweep.csv")));
    lines.join("\n") + "\n"
}

/// Why points are not in hardware, each reason once.
fn refusals(outcomes: &Outcomes) -> Vec<&str> {
    let mut reasons: Vec<&str> = outcomes.points.iter().filter_map(|point| point.refusal.as_deref()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    reasons
}
