//! `cargo xtask solver`: frames a second of the f64 solver.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use golden::design::Design;
use golden::progress::Progress;
use golden::solver::{PIECE, Past, Solution, Solver, SolverError, Status};
use golden::table::Table;
use nalgebra::DVector;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sptfra::arguments::design_file;
use sptfra::message::{self, json_or};
use xtask::bench::solver::{SolverRate, Speed};

/// Different frames, solved in turn.
const FRAMES: usize = 128;
/// Frames for each core, where all are at work.
const FRAMES_OF_CORE: usize = 8 * FRAMES;
/// Repetitions, of which the median is reported.
const REPETITIONS: usize = 7;
/// A repetition takes at least this time, so that the clock's own steps do not matter.
const LEAST: Duration = Duration::from_millis(100);

/// Measures how many frames a second the solver in double precision takes.
///
/// One frame after the other, as they come from a sensor, and in batches, as from a file; on one core. The frames are
/// pushed contacts at random places, the same in every run: as many a frame as the design separates, two at most. Each
/// figure is the median of several repetitions.
#[derive(clap::Args)]
pub struct Args {
    /// Design files (TOML).
    #[arg(required = true, value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Measures each of the designs.
pub fn run(args: &Args) -> message::Result {
    let Args { designs, json } = args;
    let progress = Progress::new();
    progress.counted_in("designs", "measuring", designs.len() as u64);
    let reports =
        designs.iter().map(|path| measure(path).inspect(|_| progress.step())).collect::<Result<Vec<_>, _>>()?;
    drop(progress);
    Ok(json_or(&reports, *json, |reports| text(reports))?.into())
}

fn text(reports: &[SolverRate]) -> String {
    let mut table =
        Table::new(["design", "plan", "taxels", "setup s", "one by one", "us", "in batches", "us", "all cores", "us"]);
    for report in reports {
        let SolverRate { design, plan, taxels, setup_s, one_by_one, in_batches, on_all_cores, .. } = report;
        let mut row = vec![design.clone(), plan.to_string(), taxels.to_string(), format!("{setup_s:.2}")];
        for speed in [one_by_one, in_batches, on_all_cores] {
            row.extend([format!("{:.0}", speed.frames_per_second), format!("{:.1}", speed.us_per_frame)]);
        }
        table.row(row);
    }
    let cores = rayon::current_num_threads();
    format!(
        "frames a second on one core, and on all {cores} in batches, median of {REPETITIONS} repetitions\n{}\n",
        table.text(0, 0)
    )
}

fn measure(path: &Path) -> Result<SolverRate, Box<dyn Error>> {
    let design = Design::load(path)?;
    let start = Instant::now();
    let solver = Solver::new(&design)?;
    let setup_s = start.elapsed().as_secs_f64();
    let frames = contacts(&design, &solver);
    let mut workspace = solver.workspace();
    let mut solution = Solution::zeros(Status::default(), 0);
    let one_by_one =
        speed(FRAMES, || frames.iter().try_for_each(|frame| solver.solve_into(&mut workspace, frame, &mut solution)))?;
    let mut solutions = Vec::new();
    let in_batches = speed(FRAMES, || solver.solve_batch(&mut workspace, &frames, &mut solutions))?;
    let cores = rayon::current_num_threads();
    let many = cores * FRAMES_OF_CORE;
    let values: Vec<f64> = frames.iter().cycle().take(many).flatten().copied().collect();
    let mut found = vec![0.0; many];
    let on_all_cores = speed(many, || {
        let places = found.chunks_mut(PIECE);
        solver.solve_on_all_cores(&values, &mut Past::default(), places, |place, index, solution| {
            place[index] = solution.resultant[2];
        })
    })?;
    Ok(SolverRate {
        file: path.display().to_string(),
        hash: design.hash(),
        plan: design.algorithm.plan,
        taxels: solver.taxels(),
        design: design.name,
        setup_s,
        repetitions: REPETITIONS,
        one_by_one,
        in_batches,
        cores,
        on_all_cores,
        numpy_frames_per_second: None,
    })
}

/// Times a function that solves so many frames.
fn speed(frames: usize, mut solve: impl FnMut() -> Result<(), SolverError>) -> Result<Speed, SolverError> {
    // Once to ask for memory and fill the caches, then as often as it takes.
    solve()?;
    let mut times = Vec::with_capacity(REPETITIONS);
    for _ in 0..REPETITIONS {
        let (start, mut rounds) = (Instant::now(), 0);
        while start.elapsed() < LEAST {
            solve()?;
            rounds += 1;
        }
        times.push(start.elapsed().as_secs_f64() * 1e6 / (rounds * frames) as f64);
    }
    times.sort_by(f64::total_cmp);
    let median = times[REPETITIONS / 2];
    Ok(Speed {
        frames_per_second: 1e6 / median,
        us_per_frame: median,
        us_per_frame_range: [times[0], times[REPETITIONS - 1]],
    })
}

/// Frames of pushed contacts on about a tenth of the sensor, at half the full scale; of two where the design separates them.
fn contacts(design: &Design, solver: &Solver) -> Vec<Vec<f64>> {
    let sensor = &design.sensor;
    let matrices = solver.matrices();
    let several = design.algorithm.contacts > 1;
    // Of two each has a half along x, and half the width.
    let (places, width) = if several { (&[0.1..0.2, 0.75..0.85][..], 0.1) } else { (&[0.3..0.7][..], 0.2) };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut frame = || {
        let mut stress = DVector::zeros(sensor.taxels());
        for place in places {
            let x = sensor.columns as f64 * random.random_range(place.clone());
            let y = sensor.rows as f64 * random.random_range(0.3..0.7);
            let [a, b] = [sensor.columns, sensor.rows].map(|side| width * side as f64 + 0.5);
            let press = DVector::from_fn(sensor.taxels(), |taxel, _| {
                let [column, row] = [taxel % sensor.columns, taxel / sensor.columns].map(|place| place as f64);
                (1.0 - ((column - x) / a).powi(2) - ((row - y) / b).powi(2)).max(0.0).sqrt()
            });
            let (sine, cosine) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
            stress += &matrices.c31 * &press * (0.5 * cosine) + &matrices.c32 * &press * (0.5 * sine);
            stress -= &matrices.c33 * &press;
        }
        let scale = 0.5 * design.hardware.full_scale_pa / stress.amax();
        stress.iter().enumerate().map(|(taxel, stress)| design.input.from_pa(taxel, scale * stress)).collect()
    };
    (0..FRAMES).map(|_| frame()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_have_as_many_contacts_as_the_design_separates() {
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/../designs/sensor1-fast.toml");
        for contacts in [1, 2] {
            let mut design = Design::load(Path::new(place)).expect("a design");
            design.algorithm.contacts = contacts;
            let solver = Solver::new(&design).expect("matrices");
            for frame in super::contacts(&design, &solver) {
                assert_eq!(solver.solve(&frame).expect("a whole frame").contacts, contacts);
            }
        }
    }
}
