//! The durations of a plan's blocks, for the cycle model.

use golden::design::Optimise;

use super::Plan;
use super::product::Vector;
use super::schedule::Visit;
use super::streams::Intake;
use crate::blocks::bz;
use crate::timing::durations::{Durations, Program};
use crate::timing::latency::{self, VISIT_TO_BUS};
use crate::timing::places::places;

/// Of a plan, of which everything but the predicted times is there.
pub(super) fn durations(plan: &Plan) -> Durations {
    let (schedule, estimator) = (&plan.schedule, plan.estimator.slot());
    let (field, folded) = (plan.has_field(), plan.ways() > 1);
    let is_sum = |visit: &&Visit| {
        let product = &plan.products[visit.product as usize];
        let leads = product.lead.is_some() && visit.row as usize >= plan.elements();
        leads || matches!(product.result, Vector::G(..))
    };
    let programs = schedule.programs.iter().zip(writes(plan)).map(|(program, writes)| Program {
        gap: program.gap,
        length: program.length,
        last_visit: program.last_visit,
        writes,
    });
    let sums = schedule.visits.iter().filter(is_sum).map(|visit| visit.cycle);
    Durations {
        drops: plan.streams().drops,
        beats: plan.streams().beats_out() as u64,
        unpacking: if plan.streams().drops { latency::OVERRUN } else { 0 }
            + u64::from(plan.streams().intake == Intake::Unpacked),
        arrival: bz::arrival(plan),
        visit_to_taxels: VISIT_TO_BUS + latency::bus_to_taxels(folded),
        visit_to_sums: VISIT_TO_BUS + latency::bus_to_sums(folded),
        field,
        composed: field && folded,
        places: places(field, folded).map(|places| places as u64),
        interval: plan.design.hardware.optimise != Optimise::Latency,
        residuals: plan.operands.residuals(),
        line: estimator.line_latency(),
        direction: estimator.contact_latency(),
        stages: estimator.stages(&plan.design.sensor),
        programs: programs.collect(),
        last_sum: sums.max().unwrap_or(0),
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
