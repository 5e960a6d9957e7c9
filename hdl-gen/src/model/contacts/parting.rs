//! The forces of several bodies parted: as whole numbers, by what they cause, and that as frames.

use golden::design::Tension;

use super::align::align;
use crate::cores::fixed_to_float;
use crate::plan::Plan;
use crate::plan::contacts::{ContactsPlan, FORCE_BITS, PART_BITS};

/// Largest force in steps.
const LARGEST: i64 = (1 << (FORCE_BITS - 1)) - 1;

/// Forces of all taxels in steps of `2^unit` newtons, `[f_x, f_y, f_z]` of each.
#[derive(Clone, Debug)]
pub(super) struct Forces {
    pub(super) unit: i32,
    pub(super) of: Vec<[i64; 3]>,
    /// Whether one of them, or a stress of the frame, did not fit.
    pub(super) clipped: bool,
}

impl Forces {
    /// Those of a field.
    pub(super) fn of_field(unit: i32, field: &[u32]) -> Self {
        let mut clipped = false;
        let mut steps = |word| {
            let force = align(word, unit, FORCE_BITS);
            clipped |= force.clipped;
            force.steps
        };
        let of = field.as_chunks::<3>().0.iter().map(|words| words.map(&mut steps)).collect();
        Self { unit, of, clipped }
    }

    /// Adds those of a field.
    pub(super) fn add(&mut self, field: &[u32]) {
        for (sum, words) in self.of.iter_mut().zip(field.as_chunks::<3>().0) {
            for (sum, &word) in sum.iter_mut().zip(words) {
                let force = align(word, self.unit, FORCE_BITS);
                *sum += force.steps;
                self.clipped |= force.clipped || sum.abs() > LARGEST;
                *sum = (*sum).clamp(-LARGEST, LARGEST);
            }
        }
    }

    /// As a field.
    pub(super) fn field(&self) -> impl Iterator<Item = u32> {
        self.of.as_flattened().iter().map(|&force| fixed_to_float::convert(force, self.unit))
    }

    /// The frames, in float32, that so many bodies would cause alone, without what pulls where the sensor does not read
    /// it; `regions` has the body of each taxel, `frame` the words of the whole one.
    pub(super) fn frames(&mut self, plan: &Plan, of: &ContactsPlan, frame: &[u32], regions: &[u8]) -> Vec<Vec<u32>> {
        let columns = plan.design.sensor.columns;
        let bodies = regions.iter().max().map_or(0, |&last| usize::from(last) + 1);
        let place = |taxel: usize| [taxel % columns, taxel / columns];
        let mut parts = vec![vec![0; self.of.len()]; bodies];
        for (from, (force, &body)) in self.of.iter().zip(regions).enumerate() {
            for (to, sum) in parts[usize::from(body)].iter_mut().enumerate() {
                let coefficients = of.coefficient(columns, place(to), place(from));
                *sum += coefficients.iter().zip(force).map(|(coefficient, force)| coefficient * force).sum::<i64>();
            }
        }
        let unit = self.unit + of.unit;
        let stress: Vec<_> = frame.iter().map(|&word| align(word, unit, PART_BITS)).collect();
        self.clipped |= stress.iter().any(|stress| stress.clipped);
        let most = if plan.design.input.tension == Tension::Clipped { 0 } else { i64::MAX };
        let word = |body: usize, taxel: usize| {
            let steps = if usize::from(regions[taxel]) == body {
                let others = (0..bodies).filter(|&other| other != body).map(|other| parts[other][taxel]);
                stress[taxel].steps - others.sum::<i64>()
            } else {
                parts[body][taxel]
            };
            fixed_to_float::convert(steps.min(most), unit)
        };
        (0..bodies).map(|body| (0..self.of.len()).map(|taxel| word(body, taxel)).collect()).collect()
    }
}
