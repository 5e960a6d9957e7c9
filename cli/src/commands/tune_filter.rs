//! `sptfra tune-filter`: the filter of each matrix.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use golden::design::{Design, Filter};
use golden::numbers::counted;
use golden::output::write_together;
use golden::progress::Progress;
use golden::resolved::{Resolved, folder, keep_apart};
use golden::table::Table;
use golden::tune_filter::{Choice, candidate_count, rebase, reference_frames, tune_filter};
use serde::Serialize;

use crate::arguments::design_file;
use crate::message::{self, json_or, say};

const EXAMPLE: &str = "Example:\n  sptfra tune-filter pad --out tuned.toml";

const CHOOSE_FILES: &str = include_str!("../help/tune-filter.txt");

/// Tunes the filter of each matrix for a design with filter f3.
///
/// Tries, one matrix at a time, the bands f1 with l = 10 to 90 and the row thresholds f2 with p = 10 to 90 on the frames
/// of the design's reference scenes. Chooses the least product of friction error and entries kept. Hardware is then
/// generated from RESOLVED.toml without a search.
#[derive(clap::Args)]
#[command(after_help = EXAMPLE, after_long_help = format!("{EXAMPLE}\n\n{}", CHOOSE_FILES.trim_end()))]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Where to write the design with the filters (TOML).
    #[arg(long, value_name = "RESOLVED.toml")]
    out: PathBuf,
    /// Where to write the measured error of every candidate (CSV).
    #[arg(long, value_name = "CANDIDATES.csv")]
    csv: Option<PathBuf>,
    /// Report as JSON, with every candidate.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    resolved: &'a Path,
    #[serde(flatten)]
    choice: &'a Choice,
}

/// Searches the filters of a design and writes the resolved one, and the candidates where asked for.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, out, csv, json } = args;
    let csv = csv.as_deref();
    let mut design = Design::load(path)?;
    let from = folder(path);
    let scenes = match &design.algorithm.filter {
        Filter::F3 { scenes, .. } => scenes.clone(),
        _ => Vec::new(),
    };
    let mut inputs: Vec<_> = scenes.iter().map(|scene| from.join(scene)).collect();
    inputs.extend(Design::inputs_at(path)?);
    for output in [Some(out.as_path()), csv].into_iter().flatten() {
        keep_apart(output, &inputs)?;
    }
    let resolved = Resolved::new(&design, path, out)?;
    if let Some(csv) = csv.filter(|csv| resolved.holds(&design, csv)) {
        return Err(format!("{}: named for both the design and the table; choose two names", csv.display()).into());
    }
    let frames = reference_frames(&design, from)?;
    let progress = Progress::new();
    progress.counted_in("filters", "judging", candidate_count(design.sensor.taxels()) as u64);
    let choice = tune_filter(&design, &frames, &|| progress.step())?;
    drop(progress);

    let before = design.algorithm.clone();
    design.algorithm.filter = Filter::F3 { scenes, choices: Some(Box::new(choice.choices())) };
    rebase(&mut design, path, out);
    design.algorithm.take_errors(&before);
    let remark = "Resolved by `sptfra tune-filter`: the filter of each matrix is chosen by the scenes named here.";
    let mut contents = resolved.contents(&design, remark);
    if let Some(csv) = csv {
        contents.insert(0, (csv.to_path_buf(), table(&choice)));
    }
    write_together(&contents)?;

    let report = Report { design: &design.name, resolved: out, choice: &choice };
    Ok(json_or(&report, *json, |report| text(report.design, out, &choice))?.into())
}

fn table(choice: &Choice) -> String {
    let mut text = "matrix,filter,nnz,e_mu,e_mu_nnz,chosen\n".to_owned();
    for candidate in &choice.candidates {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{:?},{:?},{}",
            candidate.matrix,
            candidate.filter,
            candidate.nnz,
            candidate.e_mu,
            candidate.cost,
            u8::from(candidate.chosen)
        );
    }
    text
}

fn text(name: &str, out: &Path, choice: &Choice) -> String {
    let mut table = Table::new(["matrix", "filter", "Nnz", "e_mu %", "e_mu * Nnz"]);
    for candidate in choice.candidates.iter().filter(|candidate| candidate.chosen) {
        table.row([
            candidate.matrix.to_string(),
            candidate.filter.to_string(),
            candidate.nnz.to_string(),
            format!("{:.4}", candidate.e_mu),
            format!("{:.1}", candidate.cost),
        ]);
    }
    let whole = |what: &str, nnz: String, e_mu: f64| [what.to_owned(), String::new(), nnz, format!("{e_mu:.4}")];
    table.row(whole("all together", choice.nnz_chosen.to_string(), choice.e_mu_chosen));
    table.row(whole("without a filter", String::new(), choice.e_mu_unfiltered));
    let mut text = String::new();
    say!(text, "{name}: filters chosen by {}\n{}", counted(choice.frames, "frame"), table.text(0, 0));
    say!(text, "the resolved design is {}", out.display());
    text
}
