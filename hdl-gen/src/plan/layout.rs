//! Layout of the lanes' operand memories: which vector stands where.

use super::product::{Product, Vector};

/// Where a vector stands in every lane's operand memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// From this word on.
    Fixed(usize),
    /// In the bank of the frame's stress: word 0 or word m, alternating from frame to frame.
    StressBank,
}

/// The operand memories' contents, in slots of as many words as a vector has elements (taxels, or quads where vectors
/// are folded).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperandLayout {
    elements: usize,
    /// Vectors with a slot of their own, after the two banks of the stress.
    fixed: Vec<Vector>,
    /// The vector that takes the stress's place once no product reads the stress any more.
    reuses_stress: Option<Vector>,
}

impl OperandLayout {
    /// Two banks of stress, so that one frame arrives while another is worked on; then every other operand in
    /// the order of first use, those that a product reads together side by side. One of them needs no slot of its own.
    pub fn new(products: &[Product], elements: usize) -> Self {
        let last_reader = products.iter().rposition(|product| product.operands.contains(&Vector::Stress));
        // Programs of several frames take turns, so that the stress of the next one may be there already.
        let one_frame = products.iter().all(|product| product.program == 0 && product.lead.is_none());
        let comes_later = |vector: Vector| {
            let producer = products.iter().position(|product| product.result == vector);
            one_frame && producer > last_reader
        };
        let mut layout = Self { elements, fixed: Vec::new(), reuses_stress: None };
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
        layout
    }

    /// Elements of a vector.
    pub fn elements(&self) -> usize {
        self.elements
    }

    /// Words of each lane's operand memory.
    pub fn words(&self) -> usize {
        (2 + self.fixed.len()) * self.elements
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
        let slots = banks.into_iter().chain(self.fixed.iter().map(|&vector| vec![vector]));
        slots.enumerate().map(|(slot, vectors)| (slot * self.elements, vectors)).collect()
    }
}
