//! One point: its speed from the plan, its errors from the integer model, or from the RTL where that is asked for.

use std::error::Error;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use golden::design::Design;
use golden::filter::nnz_of;
use golden::matrices::MatrixName;
use golden::metrics::Outcome;
use golden::solver::{Solution, Solver};
use hdl_gen::plan::Plan;
use hdl_gen::plan::streams::Streams;

use super::distributed::RunReport;
use super::grid::Job;
use super::point::{AgainstSolver, Calibration, Hardware, Point, Verified};
use super::{SweepError, SweepScene};
use crate::accuracy::{SolverError, StatusCounts, against_truth};
use crate::co_simulation::{CoSimulation, model_answers, planned};
use crate::frame_set::FrameSet;
use crate::stream_words::{as_received, decode, packets};

/// Decides the pauses of the streams and the registers' random start.
const SEED: u32 = 1;

/// What says that the RTL of a point is its model.
#[derive(Clone, Debug)]
pub enum Proof<'a> {
    /// Nothing but the tests.
    None,
    /// A simulation now; compilations take turns.
    Simulation(&'a Mutex<()>),
    /// A report of `sptfra run --json`.
    Report(PathBuf),
}

/// Computes a point.
///
/// # Errors
/// [`SweepError`] if the design has neither hardware nor a solution, or its RTL is not what the model says.
pub fn evaluate(job: &Job, scene: &SweepScene, proof: &Proof<'_>) -> Result<Point, SweepError> {
    let design = &job.design;
    let frames = scene.frames.clone().as_delivered(design);
    let truth = frames.truth.clone().unwrap_or_default();
    let packets = packets(Streams::of(design), &frames.stress);
    let at = |problem: Box<dyn Error + Send + Sync>| SweepError::at(job.label(scene), problem);
    let solver = Solver::new(design).map_err(|error| at(error.into()))?;
    let received = packets.iter().map(|packet| as_received(Streams::of(design), packet));
    let solutions = solver.solve_in_order(received).map_err(|error| at(error.into()))?;
    let mut point = described(job, scene, &solver, &solutions, &truth);
    let plan = match Plan::new(design) {
        Ok(plan) => plan,
        Err(refusal) => {
            point.refusal = Some(refusal.to_string());
            return Ok(point);
        }
    };
    let co_simulation = CoSimulation::new(&plan, packets, SEED);
    point.verified = Verified::Model;
    if let Proof::Simulation(compiler) = proof {
        let turn = compiler.lock().unwrap_or_else(PoisonError::into_inner);
        let verdict = co_simulation.run().map_err(|error| at(error.into()))?;
        drop(turn);
        verdict.right().map_err(|fault| at(format!("{fault}; please report this design").into()))?;
        point.verified = Verified::Rtl;
    }
    let answers: Vec<Solution> = co_simulation.expected.iter().filter_map(|words| decode(words)).collect();
    let error = SolverError::new(&answers, &solutions);
    let bounded = |value: f64| value.is_finite().then_some(value);
    point.against_solver =
        Some(AgainstSolver { resultant_max: bounded(error.resultant_max), field_max: bounded(error.field_max) });
    point.status_counts = StatusCounts::new(&answers);
    point.errors = against_truth(&answers, &truth);
    point.mean_mu = mean(answers.iter().map(|answer| answer.mu));
    if let Proof::Report(path) = proof {
        RunReport::read(path)
            .and_then(|report| report.check(&plan, co_simulation.packets.len(), &point.errors, &point.status_counts))
            .map_err(|problem| at(format!("{} {problem}; remove it, or run the point again", path.display()).into()))?;
        point.verified = Verified::Rtl;
    }
    let clock = design.hardware.clock_mhz;
    let timeline = &plan.timeline;
    point.lanes = plan.design.hardware.lanes;
    point.hardware = Some(Hardware {
        latency_cycles: timeline.latency_cycles,
        interval_cycles: timeline.interval_cycles,
        latency_us: timeline.latency_cycles as f64 / clock,
        interval_us: timeline.interval_cycles as f64 / clock,
        dsp: plan.resources.dsp,
        bram36: plan.resources.bram36,
        rom_bits: plan.resources.rom_bits,
        macs: plan.macs(),
    });
    Ok(point)
}

/// The point as the f64 solver sees it.
fn described(job: &Job, scene: &SweepScene, solver: &Solver, solutions: &[Solution], truth: &[Outcome]) -> Point {
    let Design { sensor, algorithm, hardware, .. } = &job.design;
    let nnz = MatrixName::ALL.map(|name| {
        // A solver exists, so F3 has its choices.
        let kept = algorithm.filter.of(name).map_or(0, |filter| nnz_of(solver.matrices(), name, filter));
        (name.to_string(), kept)
    });
    let errors = against_truth(solutions, truth);
    Point {
        key: job.key.clone(),
        sensor: sensor.clone(),
        scene: scene.name.clone(),
        plan: algorithm.plan,
        kernel: algorithm.kernel,
        filter: algorithm.filter.to_string(),
        estimator: algorithm.estimator,
        calibration: Calibration::of(algorithm),
        coefficient_bits: hardware.coefficient_bits,
        data_bits: hardware.data_bits,
        lanes: hardware.lanes,
        verified: Verified::Golden,
        refusal: None,
        hardware: None,
        nnz_total: nnz.iter().map(|(_, count)| count).sum(),
        nnz: nnz.into_iter().collect(),
        frames: solutions.len(),
        mean_mu: mean(solutions.iter().map(|solution| solution.mu)),
        errors,
        solver_errors: errors,
        against_solver: None,
        status_counts: StatusCounts::of(&solutions.iter().map(|solution| solution.status).collect::<Vec<_>>()),
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// The answers of a design's integer model to frames in Pa, decoded; for pictures.
///
/// # Errors
/// [`SweepError::At`] if the design has no plan.
pub fn answers(design: &Design, frames: &FrameSet) -> Result<Vec<Solution>, SweepError> {
    let plan = planned(design).map_err(|error| SweepError::at(&design.name, error))?;
    let packets = packets(plan.streams(), &frames.clone().as_delivered(design).stress);
    Ok(model_answers(&plan, &packets).iter().filter_map(|words| decode(words)).collect())
}
