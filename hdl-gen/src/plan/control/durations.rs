//! What a plan's blocks take, as far as it does not depend on the frames under way.

use golden::design::Optimise;

use crate::blocks::bz::{self, Arrival};
use crate::blocks::latency::{self, VISIT_TO_BUS};
use crate::estimators;
use crate::plan::Plan;
use crate::plan::places;
use crate::plan::product::Vector;
use crate::plan::schedule::{Program, Visit};
use crate::plan::streams::Intake;

/// Durations that do not depend on the frames under way.
pub(super) struct Durations {
    pub(super) beats: u64,
    /// From a frame's first beat out of the skid buffer to the first that enters Bz: where it waits for room, or is
    /// unpacked.
    pub(super) unpacking: u64,
    /// What a frame brings, counted from there.
    pub(super) arrival: Arrival,
    /// From a visit to its taxels having left the unfolding.
    pub(super) visit_to_taxels: u64,
    /// From the visit to the last sum, or the last g, to the sums being complete.
    pub(super) visit_to_sums: u64,
    pub(super) field: bool,
    /// Whether the lanes put the field together, once the friction is known; else it is there with the sums.
    pub(super) composed: bool,
    /// Frames that have a place from their start until they have left, if any is needed.
    pub(super) places: Option<u64>,
    pub(super) interval: bool,
    /// Frames whose residual has a place.
    pub(super) residuals: usize,
    /// Of the stage before the search, if there is one: without it the search waits for all that it needs at once.
    pub(super) line: Option<u64>,
    /// From the last stress to what `CeAn` knows of the frame.
    pub(super) direction: u64,
    /// Of the search; behind the first one a frame's `u_q` has no place any more.
    pub(super) stages: Vec<estimators::Stage>,
    pub(super) programs: Vec<Program>,
    /// Of each program, counted from its first issue: when its results are written to the operand memories, and the stress
    /// that comes in stands still.
    pub(super) writes: Vec<Vec<u64>>,
    /// Visit of the last of the sums, in the first program.
    pub(super) last_sum: u64,
}

impl Durations {
    pub(super) fn new(plan: &Plan) -> Self {
        let (schedule, estimator) = (&plan.schedule, plan.estimator.slot());
        let (field, folded) = (plan.has_field(), plan.ways() > 1);
        let is_sum = |visit: &&Visit| {
            let product = &plan.products[visit.product as usize];
            let leads = product.lead.is_some() && visit.row as usize >= plan.elements();
            leads || matches!(product.result, Vector::G(..))
        };
        let sums = schedule.visits.iter().filter(is_sum).map(|visit| visit.cycle);
        Self {
            beats: plan.streams().beats_out() as u64,
            unpacking: if plan.streams().drops { latency::OVERRUN } else { 0 }
                + u64::from(plan.streams().intake == Intake::Unpacked),
            arrival: bz::arrival(plan),
            visit_to_taxels: VISIT_TO_BUS + latency::bus_to_taxels(folded),
            visit_to_sums: VISIT_TO_BUS + latency::bus_to_sums(folded),
            field,
            composed: field && folded,
            places: places::places(field, folded).map(|places| places as u64),
            interval: plan.design.hardware.optimise != Optimise::Latency,
            residuals: plan.operands.residuals(),
            line: estimator.line_latency(),
            direction: estimator.contact_latency(),
            stages: estimator.stages(&plan.design.sensor),
            programs: schedule.programs.clone(),
            writes: writes(plan),
            last_sum: sums.max().unwrap_or(0),
        }
    }
}

/// When each program's results take the operand memories' port, which holds up the stress.
fn writes(plan: &Plan) -> Vec<Vec<u64>> {
    let folded = plan.ways() > 1;
    let mut writes = vec![Vec::new(); plan.schedule.programs.len()];
    for visit in plan.schedule.visits.iter().filter(|visit| (visit.row as usize) < plan.elements()) {
        let product = &plan.products[visit.product as usize];
        let on_bus = visit.cycle + VISIT_TO_BUS;
        let of_program = &mut writes[product.program];
        match product.result {
            Vector::Weight => {
                let last = on_bus + latency::bus_to_taxels(folded) + latency::taxels_to_write(folded);
                // Of a folded grid |w|, and y+ behind it.
                of_program.extend(last - u64::from(folded)..=last);
            }
            Vector::Residual(_) | Vector::Explained => of_program.push(on_bus + latency::bus_to_write(folded)),
            Vector::G(3, _) if !folded => of_program.push(on_bus + latency::bus_to_write(folded)),
            _ => {}
        }
    }
    writes
}
