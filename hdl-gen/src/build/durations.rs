//! The durations of a plan's blocks, for the cycle model.

use golden::design::Optimise;

use crate::blocks::bz;
use crate::plan::Plan;
use crate::plan::product::Vector;
use crate::plan::schedule::WriteBackSlot;
use crate::plan::streams::Intake;
use crate::timing::buffers::buffers;
use crate::timing::durations::{Durations, Program};
use crate::timing::latency::{self, TAKE_TO_BUS};

/// Of a plan, of which everything but the predicted times is there.
pub(super) fn durations(plan: &Plan) -> Durations {
    let (schedule, estimator) = (&plan.schedule, plan.estimator.block());
    let (field, folded) = (plan.has_field(), plan.channels() > 1);
    let is_sum = |slot: &&WriteBackSlot| {
        let product = &plan.products[slot.product as usize];
        let preloads = product.preload.is_some() && slot.row as usize >= plan.elements();
        preloads || matches!(product.result, Vector::G(..))
    };
    let programs = schedule.programs.iter().zip(writes(plan)).map(|(program, writes)| Program {
        gap: program.gap,
        length: program.length,
        last_slot: program.last_slot,
        writes,
    });
    let sums = schedule.slots.iter().filter(is_sum).map(|slot| slot.cycle);
    Durations {
        drops: plan.streams().drops,
        beats: plan.streams().beats_out() as u64,
        unpacking: if plan.streams().drops { latency::OVERRUN } else { 0 }
            + u64::from(plan.streams().intake == Intake::Unpacked),
        arrival: bz::arrival(plan),
        take_to_taxels: TAKE_TO_BUS + latency::bus_to_taxels(folded),
        take_to_sums: TAKE_TO_BUS + latency::bus_to_sums(folded),
        field,
        composed: field && folded,
        buffers: buffers(field, folded).map(|buffers| buffers as u64),
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
    let folded = plan.channels() > 1;
    let mut writes = vec![Vec::new(); plan.schedule.programs.len()];
    for slot in plan.schedule.slots.iter().filter(|slot| (slot.row as usize) < plan.elements()) {
        let product = &plan.products[slot.product as usize];
        let on_bus = slot.cycle + TAKE_TO_BUS;
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
