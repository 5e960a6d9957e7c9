//! `golden choose`: the filter of each matrix.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use golden::choose::{Choice, candidate_count, choose, rebase_scenes, reference_frames};
use golden::design::{Design, Filter};
use golden::output::write_together;
use golden::progress::Progress;
use golden::table::Table;
use serde::Serialize;

use super::{Resolved, folder, keep_apart};

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    resolved: &'a Path,
    #[serde(flatten)]
    choice: &'a Choice,
}

/// Searches the filters of the design in `path` and writes the resolved design to `out`, the candidates to `csv`.
pub fn run(path: &Path, out: &Path, csv: Option<&Path>, json: bool) -> Result<(), Box<dyn Error>> {
    let mut design = Design::load(path)?;
    let from = folder(path);
    let scenes = match &design.algorithm.filter {
        Filter::F3 { scenes, .. } => scenes.clone(),
        _ => Vec::new(),
    };
    let mut inputs: Vec<_> = scenes.iter().map(|scene| from.join(scene)).collect();
    inputs.extend(Design::files_named_in(path)?);
    inputs.push(path.to_path_buf());
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    for output in [Some(out), csv].into_iter().flatten() {
        keep_apart(output, &inputs)?;
    }
    let resolved = Resolved::new(&design, path, out)?;
    if let Some(csv) = csv.filter(|csv| resolved.holds(&design, csv)) {
        return Err(format!("{}: named for both the design and the table; choose two names", csv.display()).into());
    }
    let frames = reference_frames(&design, from)?;
    let progress = Progress::new();
    progress.counted_in("filters", "judging", candidate_count(design.sensor.taxels()) as u64);
    let choice = choose(&design, &frames, &|| progress.step())?;
    drop(progress);

    design.algorithm.filter =
        Filter::F3 { scenes: rebase_scenes(&scenes, from, folder(out)), choices: Some(Box::new(choice.choices())) };
    let remark = "Resolved by `golden choose`: the filter of each matrix is chosen by the scenes named here.";
    let mut contents = resolved.contents(&design, remark);
    if let Some(csv) = csv {
        contents.insert(0, (csv.to_path_buf(), table(&choice)));
    }
    write_together(&contents)?;

    if json {
        let report = Report { design: &design.name, resolved: out, choice: &choice };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print_report(&design.name, out, &choice)?;
    }
    Ok(())
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

fn print_report(name: &str, out: &Path, choice: &Choice) -> std::io::Result<()> {
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
    say!("{name}: filters chosen by {} frames\n{}", choice.frames, table.text(0, 0));
    say!("the resolved design is {}", out.display());
    Ok(())
}
