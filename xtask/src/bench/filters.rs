//! What a filter leaves of a folded block, and what that costs.

use golden::design::{Design, Filter, PlanKind};
use golden::metrics::field_error;
use golden::solver::{Solution, Solver};
use serde::Serialize;

use super::{BenchError, Scope};
use golden::progress::Progress;
use testbench::co_simulation::planned;
use testbench::frame_set::FrameSet;

/// F1: outermost diagonals removed, in percent of the block's side. F2: p.
const F1_PERCENT: [usize; 3] = [10, 40, 70];
const F2_P: [f64; 4] = [50.0, 10.0, 1.0, 0.1];

/// One filter on one sensor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Filtered {
    /// The design file that the filter is tried on.
    pub design: String,
    /// The hash of that design.
    pub hash: String,
    /// The filter as the design file writes it.
    pub filter: String,
    /// Multiply-accumulates of a frame.
    pub macs: u64,
    /// By the plan.
    pub latency: u64,
    /// By the plan.
    pub interval: u64,
    /// By the plan.
    pub bram36: f64,
    /// Largest difference of a taxel's force from the unfiltered one, over the largest normal force of its frame, on
    /// the sensor's standing scene, in f64.
    pub field_error: f64,
    /// Largest difference of the friction vector from the unfiltered one.
    pub friction_error: f64,
}

/// Tries the filters on the scope's designs by the reduced plan that have none; the first line of each is without.
pub(super) fn measure(scope: &Scope, progress: &Progress) -> Result<Vec<Filtered>, BenchError> {
    let mut rows = Vec::new();
    let unfiltered =
        |design: &Design| design.algorithm.plan == PlanKind::Reduced && design.algorithm.filter == Filter::None;
    // A network belongs to the plan that it was trained with.
    let unfiltered = |design: &Design| unfiltered(design) && design.algorithm.joint.correction.is_none();
    for (path, design) in scope.designs.iter().filter(|(_, design)| unfiltered(design)) {
        progress.stage(format!("filtering the folded blocks of {path}"));
        let frames = FrameSet::standing(&design.sensor)?.as_delivered(design).stress;
        let solve = |design: &Design| -> Result<Vec<Solution>, BenchError> {
            let solver = Solver::new(design)?;
            Ok(frames.iter().map(|frame| solver.solve(frame)).collect::<Result<_, _>>()?)
        };
        let reference = solve(design)?;
        let hash = design.hash();
        for (filter, text) in filters(design.sensor.taxels()) {
            let mut design = design.clone();
            design.algorithm.filter = filter;
            let plan = planned(&design)?;
            let found = solve(&design)?;
            let worst = |error: &dyn Fn(&Solution, &Solution) -> f64| {
                reference.iter().zip(&found).map(|(reference, found)| error(reference, found)).fold(0.0, f64::max)
            };
            rows.push(Filtered {
                design: path.clone(),
                hash: hash.clone(),
                filter: text,
                macs: plan.macs(),
                latency: plan.timeline.latency_cycles,
                interval: plan.timeline.interval_cycles,
                bram36: plan.resources.bram36,
                field_error: worst(&|reference, found| field_error(&reference.field, &found.field)),
                friction_error: worst(&|reference, found| {
                    (reference.mu_x - found.mu_x).hypot(reference.mu_y - found.mu_y)
                }),
            });
        }
    }
    Ok(rows)
}

/// No filter, then the others, as the design file writes them. F1 takes diagonals of the whole matrix.
fn filters(taxels: usize) -> Vec<(Filter, String)> {
    let f1 = F1_PERCENT.map(|percent| percent * (taxels - 1) / 100);
    let none = [(Filter::None, "none".to_owned())];
    let f1 = f1.map(|l| (Filter::F1 { l }, format!("f1, l = {l}")));
    let f2 = F2_P.map(|p| (Filter::F2 { p }, format!("f2, p = {p}")));
    none.into_iter().chain(f1).chain(f2).collect()
}
