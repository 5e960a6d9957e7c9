//! Several bodies, bit for bit as `sptfra_contacts` has them around the core for one.

pub mod align;
pub mod float;
mod parting;
pub mod records;
pub mod regions;

use super::Model;
use crate::blocks;
use crate::plan::contacts::records::FRAME;
use crate::plan::contacts::{ContactsPlan, FORCE_BITS};
use crate::plan::{Plan, SUMMARY_WORDS, words};
use align::align;
use parting::Forces;
use records::{Counted, Records};

/// From the largest exponent of a field's float32 to the power of two of its steps: the largest force has 23 bits.
const TO_UNIT: i32 = 149;

/// Times that the bodies are solved, as in [`golden::bodies`].
const ROUNDS: usize = 2;

impl Model<'_> {
    /// The answer to a packet where there may be several bodies.
    pub(super) fn answer_of_bodies(&mut self, of: &ContactsPlan, records: &mut Records, packet: &[u32]) -> Vec<u32> {
        let packet = &self.plan.streams().unpacked(packet)[..];
        let number = self.frames;
        let whole = self.answer_to(packet);
        let (header, field) = whole.split_at(SUMMARY_WORDS);
        let largest = field.iter().map(|word| word >> 23 & 0xff).max().unwrap_or(0);
        let unit = largest as i32 - TO_UNIT;
        let weight = |taxel: &[u32; 3]| (-align(taxel[2], unit, FORCE_BITS).steps).max(0);
        let weights: Vec<i64> = field.as_chunks().0.iter().map(weight).collect();
        let Plan { design, .. } = self.plan;
        let found = regions::find(&weights, design.sensor.columns, blocks::regions::steps(&design.sensor), of.contacts);
        records.take(FRAME, false, header);
        let mut forces = Forces::of_field(unit, field);
        let several = found.kept() > 1;
        for round in (1..=ROUNDS).filter(|_| several) {
            let frames = forces.frames(self.plan, of, packet, &found.regions);
            forces.of.fill([0; 3]);
            for (body, frame) in frames.iter().enumerate() {
                let answer = self.answer_to(frame);
                let (header, field) = answer.split_at(SUMMARY_WORDS);
                records.take(body as u8, round < ROUNDS, header);
                forces.add(field);
            }
        }
        self.frames = number.wrapping_add(1);
        let mut taxels: Vec<u16> = found.taxels.iter().map(|&taxels| taxels as u16).collect();
        if header[words::CENSUS] & 0xFF != 0 && taxels.is_empty() {
            // A contact of which nothing presses.
            taxels.push(0);
        }
        let bodies = found.bodies.max(taxels.len() as u32).min(u8::MAX.into()) as u8;
        let mut answer =
            records.finish(Counted { kept: taxels.len(), bodies, taxels: &taxels, saturated: forces.clipped });
        answer[words::STATUS] = answer[words::STATUS] & 0xFFFF | u32::from(number) << 16;
        match (self.plan.field_words() > 0, several) {
            (false, _) => {}
            (true, false) => answer.extend(field),
            (true, true) => answer.extend(forces.field()),
        }
        answer
    }
}
