//! The `golden` command: frames with known forces, and forces from frames.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use indicatif::ProgressBar;
use serde::Serialize;

use golden::design::Design;
use golden::forces;
use golden::frames;
use golden::metrics::{ERROR_NAMES, ErrorSummary, Outcome};
use golden::scene::Scene;
use golden::solver::{Solution, Solver, Status};

/// Reference solver and ground truth for three-axis tactile sensing from normal stress.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make frames of stress from contacts with known forces.
    ///
    /// The frames go to FRAMES.csv, one frame a line, and the true forces beside it, to FRAMES.forces.csv, in the
    /// columns of `golden solve`.
    Scene {
        /// Scene file (TOML).
        scene: PathBuf,
        /// Where to write the frames (CSV).
        #[arg(long)]
        out: PathBuf,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Solve frames in double precision.
    ///
    /// A line of FORCES.csv has, for one frame: status, `F_x`, `F_y`, `F_z`, mu, phi, `mu_x`, `mu_y`, and with --field then
    /// `f_x`, `f_y`, `f_z` of each taxel. Newtons and radians.
    Solve {
        /// Design file (TOML).
        design: PathBuf,
        /// Frames (CSV): one frame a line, stresses in pascals, compression negative.
        #[arg(long)]
        frames: PathBuf,
        /// Where to write the forces (CSV).
        #[arg(long)]
        out: PathBuf,
        /// Write the forces of each taxel too.
        #[arg(long)]
        field: bool,
        /// True forces of the same frames (CSV, as `golden scene` writes them), to report the errors.
        #[arg(long)]
        reference: Option<PathBuf>,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Scene { scene, out, json } => make_frames(&scene, &out, json),
        Command::Solve { design, frames, out, field, reference, json } => {
            solve(&design, &frames, &out, field, reference.as_deref(), json)
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Refuses an output that is one of the inputs.
fn keep_apart(out: &Path, inputs: &[&Path]) -> Result<(), String> {
    let same = |input: &&&Path| match (out.canonicalize(), input.canonicalize()) {
        (Ok(out), Ok(input)) => out == input,
        _ => false,
    };
    match inputs.iter().find(same) {
        Some(input) => Err(format!(
            "{}: the output would overwrite the input {}; choose another name",
            out.display(),
            input.display()
        )),
        None => Ok(()),
    }
}

#[derive(Serialize)]
struct SceneReport<'a> {
    frames: usize,
    taxels: usize,
    frames_file: &'a Path,
    forces_file: &'a Path,
}

fn make_frames(scene: &Path, out: &Path, json: bool) -> Result<(), Box<dyn Error>> {
    let forces_file = forces::reference_path(out);
    keep_apart(out, &[scene])?;
    keep_apart(&forces_file, &[scene])?;
    let scene = Scene::load(scene)?;
    let made = scene.frames()?;
    if forces_file == out {
        return Err(
            format!("{}: the true forces would overwrite the frames; choose another name", out.display()).into()
        );
    }
    // The forces first: a frame file always has its forces beside it.
    forces::write_reference(&forces_file, &made)?;
    let stresses: Vec<Vec<f64>> = made.into_iter().map(|frame| frame.stress).collect();
    frames::write_frames(out, &stresses)?;
    if json {
        let report = SceneReport {
            frames: stresses.len(),
            taxels: scene.sensor.taxels(),
            frames_file: out,
            forces_file: &forces_file,
        };
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        println!("{} frames of {} taxels in {}", stresses.len(), scene.sensor.taxels(), out.display());
        println!("their true forces in {}", forces_file.display());
    }
    Ok(())
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
}

fn solve(
    design: &Path,
    frames: &Path,
    out: &Path,
    with_field: bool,
    reference: Option<&Path>,
    json: bool,
) -> Result<(), Box<dyn Error>> {
    let inputs = [Some(design), Some(frames), reference];
    keep_apart(out, &inputs.into_iter().flatten().collect::<Vec<_>>())?;
    let design = Design::load(design)?;
    let frames = frames::read_frames(frames, design.sensor.taxels())?;
    let truth = reference.map(|path| forces::read_outcomes(path, frames.len())).transpose()?;
    let solver = Solver::new(&design)?;
    // Draws on a terminal only.
    let progress = ProgressBar::new(frames.len() as u64);
    let solutions = frames
        .iter()
        .map(|frame| {
            progress.inc(1);
            solver.solve(frame)
        })
        .collect::<Result<Vec<_>, _>>()?;
    progress.finish_and_clear();
    forces::write_solutions(out, &solutions, with_field)?;

    let report = SolveReport {
        design: &design.name,
        frames: solutions.len(),
        forces_file: out,
        status_counts: count_statuses(&solutions),
        errors: truth.map(|truth| {
            let found = solutions.iter().map(Outcome::from);
            ErrorSummary::new(&truth.into_iter().zip(found).collect::<Vec<_>>())
        }),
    };
    if json {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print_report(&report);
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

fn print_report(report: &SolveReport) {
    println!("{}: forces of {} frames in {}", report.design, report.frames, report.forces_file.display());
    for count in &report.status_counts {
        println!("  {:>6} frames: {}", count.frames, count.meaning);
    }
    if let Some(errors) = &report.errors {
        println!("errors in %       max  std. error");
        for (name, spread) in ERROR_NAMES.iter().zip(errors.spreads()) {
            println!("  {name:<8} {:>10.2}  {:>10.2}", spread.max, spread.standard_error);
        }
    }
}
