//! `golden solve`: forces from frames.

use std::error::Error;
use std::path::Path;

use golden::check::check;
use golden::design::Design;
use golden::forces;
use golden::metrics::{BodyErrors, ERROR_NAMES, ErrorSummary, Outcome, Quantiles};
use golden::progress::Progress;
use golden::solver::{Solution, Solver, Status};
use golden::table::Table;
use serde::Serialize;

use super::{Recording, is_standard, keep_apart, solve_lines, warn};

#[derive(Serialize)]
struct StatusCount {
    status: u32,
    meaning: String,
    frames: usize,
}

#[derive(Serialize)]
struct SolveReport<'a> {
    design: &'a str,
    frames: usize,
    forces_file: &'a Path,
    status_counts: Vec<StatusCount>,
    /// Errors against the true forces, in percent.
    #[serde(skip_serializing_if = "Option::is_none")]
    errors: Option<ErrorSummary>,
    /// Those of each body, where the design tells several apart and the true forces do so too.
    #[serde(skip_serializing_if = "Option::is_none")]
    bodies: Option<BodyErrors>,
}

/// Solves `frames` and writes the forces to `out`, or prints them where that is `-`.
pub fn run(
    design: &Path,
    frames: &Recording,
    out: &Path,
    with_field: bool,
    reference: Option<&Path>,
    json: bool,
) -> Result<(), Box<dyn Error>> {
    if is_standard(out) {
        if reference.is_some() || json {
            return Err("--out -: standard output has the forces alone; name a file with --reference and --json".into());
        }
        return solve_lines::run(design, frames, with_field);
    }
    if is_standard(frames.file) {
        return Err("--frames -: forces of standard input go to standard output; write --out - too".into());
    }
    let named = Design::files_named_in(design)?;
    let inputs = [Some(design), Some(frames.file), reference].into_iter().flatten();
    keep_apart(out, &inputs.chain(named.iter().map(AsRef::as_ref)).collect::<Vec<_>>())?;
    let design = Design::load(design)?;
    let frames = frames.read(&design)?;
    if let Some(reference) = reference {
        forces::compare_sensor(reference, &design.name, &design.sensor)?;
    }
    let truth = reference.map(|path| forces::read_outcomes(path, frames.len())).transpose()?;
    let bodies = reference
        .filter(|_| design.algorithm.contacts > 1)
        .map(|path| forces::read_bodies(path, frames.len(), &design.sensor))
        .transpose()?
        .flatten();
    if let Some(thin) = design.thin_layer() {
        eprintln!("warning: {thin}");
    }
    let progress = Progress::of("matrices");
    let solver = Solver::new(&design)?;
    progress.counted("solving", frames.len() as u64);
    let mut workspace = solver.workspace();
    let mut solutions = vec![Solution::zeros(Status::default(), 0); frames.len()];
    for (frame, solution) in frames.iter().zip(&mut solutions) {
        solver.solve_into(&mut workspace, frame, solution)?;
        progress.step();
    }
    drop(progress);
    forces::write_solutions(out, &solutions, with_field)?;
    warn(&check(&design, &frames, Some(solver.matrices())));

    let report = SolveReport {
        design: &design.name,
        frames: solutions.len(),
        forces_file: out,
        status_counts: count_statuses(&solutions),
        errors: truth.map(|truth| {
            let found = solutions.iter().map(Outcome::from);
            ErrorSummary::new(&truth.into_iter().zip(found).collect::<Vec<_>>())
        }),
        bodies: bodies.map(|truth| BodyErrors::new(truth.iter().zip(&solutions))),
    };
    if json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print_report(&report)?;
    }
    Ok(())
}

fn count_statuses(solutions: &[Solution]) -> Vec<StatusCount> {
    let mut words: Vec<u32> = solutions.iter().map(|solution| solution.status.0).collect();
    words.sort_unstable();
    words
        .chunk_by(|a, b| a == b)
        .map(|equal| StatusCount { status: equal[0], meaning: Status(equal[0]).to_string(), frames: equal.len() })
        .collect()
}

fn print_report(report: &SolveReport) -> std::io::Result<()> {
    say!("{}: forces of {} frames in {}", report.design, report.frames, report.forces_file.display());
    for count in &report.status_counts {
        say!("  {:>6} frames: {}", count.frames, count.meaning);
    }
    if let Some(errors) = &report.errors {
        let mut table = Table::new(["errors in %", "max", "std. error"]);
        for (name, spread) in ERROR_NAMES.iter().zip(errors.spreads()) {
            table.row([name.to_string(), format!("{:.2}", spread.max), format!("{:.2}", spread.standard_error)]);
        }
        say!("{}", table.text(0, 0));
    }
    if let Some(bodies) = &report.bodies {
        say!("{} of {} frames have the right number of bodies", bodies.right, bodies.frames);
        if bodies.right == 0 {
            say!("there is no body to compare with a true one");
            return Ok(());
        }
        let mut table = Table::new(["errors of each body", "median", "95 %", "worst"]);
        let rows = [
            ("along the surface, %", bodies.tangential),
            ("normal, %", bodies.normal),
            ("centre, mm", bodies.centre_mm),
            ("T_z over F_z, mm", bodies.turn_mm),
        ];
        // A file of true forces may have no torques.
        for (name, Quantiles { median, most, worst }) in rows.into_iter().filter(|(_, of)| !of.worst.is_nan()) {
            table.row([name.to_owned(), format!("{median:.2}"), format!("{most:.2}"), format!("{worst:.2}")]);
        }
        say!("{}", table.text(0, 0));
    }
    Ok(())
}
