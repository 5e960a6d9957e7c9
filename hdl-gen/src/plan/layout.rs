//! Layout of the PEs' operand memories: which vector stands where.

use super::product::{Product, Vector};
use crate::resources::memory::memory;

/// Where a vector stands in every PE's operand memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// From this word on.
    Fixed(usize),
    /// In the bank of the frame's stress: word 0 or word m, alternating from frame to frame.
    StressBank,
}

/// The operand memories' contents, in slots of as many words as a vector has elements (taxels, or orbits where vectors
/// are folded).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperandLayout {
    elements: usize,
    /// Vectors with a slot of their own, after the two banks of the stress.
    fixed: Vec<Vector>,
    /// The vector that takes the stress's place once no product reads the stress any more.
    reuses_stress: Option<Vector>,
    /// Frames whose residual has a buffer: a second bank of it stands behind everything else.
    residuals: usize,
}

/// Vectors of a residual: what is left of the stress for the field, and its parts by friction component.
const RESIDUAL: [Vector; 3] = [Vector::Residual(0), Vector::Residual(1), Vector::Residual(2)];

impl OperandLayout {
    /// Two banks of stress, so that one frame arrives while another is worked on; then every other operand in
    /// the order of first use, those that a product reads together side by side. One of them needs no slot of its own.
    /// The residual has two banks where words of `bits` bits have room for them in block memories that are there anyway:
    /// then the lanes work on one frame's while another's waits for its friction.
    pub fn new(products: &[Product], elements: usize, bits: u32) -> Self {
        let last_reader = products.iter().rposition(|product| product.operands.contains(&Vector::Stress));
        // Programs of several frames take turns, so that the stress of the next one may be there already.
        let one_frame = products.iter().all(|product| product.program == 0 && product.preload.is_none());
        let comes_later = |vector: Vector| {
            let producer = products.iter().position(|product| product.result == vector);
            one_frame && producer > last_reader
        };
        let mut layout = Self { elements, fixed: Vec::new(), reuses_stress: None, residuals: 1 };
        let mut lists: Vec<&[Vector]> = products.iter().map(|product| product.operands.as_slice()).collect();
        // Vectors that one product reads stand next to each other, in its order.
        lists.sort_by_key(|list| std::cmp::Reverse(list.len()));
        for operand in lists.into_iter().flatten().copied() {
            if operand == Vector::Stress || layout.fixed.contains(&operand) || layout.reuses_stress == Some(operand) {
                continue;
            }
            if layout.reuses_stress.is_none() && comes_later(operand) {
                layout.reuses_stress = Some(operand);
            } else {
                layout.fixed.push(operand);
            }
        }
        let bram36 = |words| memory("operands", 1, words, bits, false).bram36;
        let words = layout.words();
        if layout.fixed.starts_with(&RESIDUAL) && bram36(words + RESIDUAL.len() * elements) <= bram36(words) {
            layout.residuals = 2;
        }
        layout
    }

    /// Frames whose residual has a buffer.
    pub fn residuals(&self) -> usize {
        self.residuals
    }

    /// Words from a residual to its place in the second bank; 0 if there is none.
    pub fn residual_bank(&self) -> usize {
        if self.residuals > 1 { self.fixed.len() * self.elements } else { 0 }
    }

    /// Words of each PE's operand memory.
    pub fn words(&self) -> usize {
        (2 + self.fixed.len() + (self.residuals - 1) * RESIDUAL.len()) * self.elements
    }

    /// Where `vector` stands; none if no product reads it.
    pub fn place(&self, vector: Vector) -> Option<Place> {
        if vector == Vector::Stress || self.reuses_stress == Some(vector) {
            return Some(Place::StressBank);
        }
        let slot = self.fixed.iter().position(|&other| other == vector)?;
        Some(Place::Fixed((2 + slot) * self.elements))
    }

    /// `(first word, vectors)` of every slot.
    pub fn slots(&self) -> Vec<(usize, Vec<Vector>)> {
        let stress: Vec<Vector> = std::iter::once(Vector::Stress).chain(self.reuses_stress).collect();
        let banks = [stress.clone(), stress];
        let again = RESIDUAL.iter().take(if self.residuals > 1 { RESIDUAL.len() } else { 0 });
        let slots = banks.into_iter().chain(self.fixed.iter().chain(again).map(|&vector| vec![vector]));
        slots.enumerate().map(|(slot, vectors)| (slot * self.elements, vectors)).collect()
    }
}
