//! `sptfra solve`: forces from frames.

use std::path::{Path, PathBuf};

use golden::check::check;
use golden::design::Design;
use golden::forces;
use golden::metrics::{ContactErrors, ERROR_NAMES, ErrorSummary, Outcome, Quantiles};
use golden::numbers::counted;
use golden::progress::Progress;
use golden::resolved::keep_apart;
use golden::solver::{Solution, Solver, Status};
use golden::table::Table;
use serde::Serialize;

use super::recording::{LayoutArguments, Recording, is_standard, warn};
use super::solve_lines;
use crate::arguments::{design_file, rows_file};
use crate::message::{self, Message, json_or, say};

const EXAMPLE: &str = "Example:\n  sptfra solve pad --frames frames.csv --out forces.csv";

/// Computes forces from frames in double precision.
///
/// A line of FORCES.csv has, for one frame: status, `F_x`, `F_y`, `F_z`, mu, phi, `mu_x`, `mu_y`, and with --field then
/// `f_x`, `f_y`, `f_z` of each taxel. Newtons and radians.
///
/// With `--out -` the lines go to standard output, each as soon as its frame is there. With `--frames -`, from standard
/// input, the command is a filter for frames as they come from a sensor. The first frames are checked.
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Frames (CSV or .npy), one a line, in pascals or counts; `-`: standard input.
    ///
    /// In pascals compression is negative.
    #[arg(long, value_name = "FRAMES.csv")]
    frames: PathBuf,
    #[command(flatten)]
    layout: LayoutArguments,
    /// Where to write the forces (CSV, or .npy by its ending); `-`: standard output.
    #[arg(long, value_name = "FORCES.csv", value_parser = rows_file())]
    out: PathBuf,
    /// Write the forces of each taxel too.
    #[arg(long)]
    field: bool,
    /// True forces of the frames (CSV of `sptfra scene`), to report the errors.
    #[arg(long, value_name = "FORCES.csv")]
    reference: Option<PathBuf>,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

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
    /// Those of each contact, where the design and the true forces separate several.
    #[serde(skip_serializing_if = "Option::is_none")]
    contacts: Option<ContactErrors>,
}

/// Solves frames and writes the forces, or prints them as they come.
pub fn run(args: &Args) -> message::Result {
    let Args { design, frames, layout, out, field, reference, json } = args;
    let (frames, reference) = (&Recording { file: frames, layout: layout.layout() }, reference.as_deref());
    if is_standard(out) {
        if reference.is_some() || *json {
            return Err("--out -: standard output has the forces alone; name a file with --reference and --json".into());
        }
        return solve_lines::run(design, frames, *field).map(|()| Message::default());
    }
    if is_standard(frames.file) {
        return Err("--frames -: forces of standard input go to standard output; write --out - too".into());
    }
    let mut inputs = Design::inputs_at(design)?;
    inputs.extend([Some(frames.file), reference].into_iter().flatten().map(Path::to_path_buf));
    keep_apart(out, &inputs)?;
    let design = Design::load(design)?;
    let recording = frames.read_all(&design)?;
    let frames = &recording.frames;
    if let Some(reference) = reference {
        forces::compare_sensor(reference, &design.name, &design.sensor)?;
    }
    let outcomes = |path| recording.lines_of(|count| forces::read_outcomes(path, count));
    let truth = reference.map(outcomes).transpose()?;
    let of_contacts = |path, count| forces::read_contacts(path, count, &design.sensor).map(Option::unwrap_or_default);
    let contacts = reference
        .filter(|_| design.algorithm.contacts > 1)
        .map(|path| recording.lines_of(|count| of_contacts(path, count)))
        .transpose()?
        .filter(|contacts| !contacts.is_empty());
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
    forces::write_solutions(out, &solutions, *field)?;
    warn(&check(&design, frames, Some(solver.matrices())));

    let report = SolveReport {
        design: &design.name,
        frames: solutions.len(),
        forces_file: out,
        status_counts: count_statuses(&solutions),
        errors: truth.map(|truth| {
            let found = solutions.iter().map(Outcome::from);
            ErrorSummary::new(&truth.into_iter().zip(found).collect::<Vec<_>>())
        }),
        contacts: contacts.map(|truth| ContactErrors::new(truth.iter().zip(&solutions))),
    };
    Ok(json_or(&report, *json, text)?.into())
}

fn count_statuses(solutions: &[Solution]) -> Vec<StatusCount> {
    let mut words: Vec<u32> = solutions.iter().map(|solution| solution.status.0).collect();
    words.sort_unstable();
    words
        .chunk_by(|a, b| a == b)
        .map(|equal| StatusCount { status: equal[0], meaning: Status(equal[0]).to_string(), frames: equal.len() })
        .collect()
}

fn text(report: &SolveReport<'_>) -> String {
    let mut text = String::new();
    say!(text, "{}: forces of {} in {}", report.design, counted(report.frames, "frame"), report.forces_file.display());
    for count in &report.status_counts {
        say!(text, "  {:>13}: {}", counted(count.frames, "frame"), count.meaning);
    }
    if let Some(errors) = &report.errors {
        let mut table = Table::new(["errors in %", "max", "std. error"]);
        for (name, spread) in ERROR_NAMES.iter().zip(errors.spreads()) {
            table.row([name.to_string(), format!("{:.2}", spread.max), format!("{:.2}", spread.standard_error)]);
        }
        text += &table.text(0, 0);
        text.push('\n');
    }
    if let Some(contacts) = &report.contacts {
        say!(text, "{} of {} frames have the right number of contacts", contacts.right, contacts.frames);
        if contacts.right == 0 {
            say!(text, "there is no contact to compare with a true one");
            return text;
        }
        let mut table = Table::new(["errors of each contact", "median", "95 %", "worst"]);
        let rows = [
            ("along the surface, %", contacts.tangential),
            ("normal, %", contacts.normal),
            ("centre, mm", contacts.centre_mm),
            ("T_z over F_z, mm", contacts.turn_mm),
        ];
        // A file of true forces may have no torques.
        for (name, Quantiles { median, most, worst }) in rows.into_iter().filter(|(_, of)| !of.worst.is_nan()) {
            table.row([name.to_owned(), format!("{median:.2}"), format!("{most:.2}"), format!("{worst:.2}")]);
        }
        text += &table.text(0, 0);
        text.push('\n');
    }
    text
}
