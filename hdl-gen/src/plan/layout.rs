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

/// The operand memories' contents, in slots of m words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OperandLayout {
    taxels: usize,
    /// Vectors with a slot of their own, after the two banks of the stress.
    fixed: Vec<Vector>,
    /// The vector that takes the stress's place once no product reads the stress any more.
    reuses_stress: Option<Vector>,
}

impl OperandLayout {
    /// Two banks of stress, so that one frame arrives while another is worked on; then every other operand in the
    /// order of first use. One of them needs no slot of its own.
    pub fn new(products: &[Product], taxels: usize) -> Self {
        let last_reader = products.iter().rposition(|product| product.operand == Vector::Stress);
        let comes_later = |vector: Vector| {
            let producer = products.iter().position(|product| product.result == vector);
            producer > last_reader
        };
        let mut layout = Self { taxels, fixed: Vec::new(), reuses_stress: None };
        for operand in products.iter().map(|product| product.operand) {
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

    /// Words of each lane's operand memory.
    pub fn words(&self) -> usize {
        (2 + self.fixed.len()) * self.taxels
    }

    /// Where `vector` stands; none if no product reads it.
    pub fn place(&self, vector: Vector) -> Option<Place> {
        if vector == Vector::Stress || self.reuses_stress == Some(vector) {
            return Some(Place::StressBank);
        }
        let slot = self.fixed.iter().position(|&other| other == vector)?;
        Some(Place::Fixed((2 + slot) * self.taxels))
    }

    /// `(first word, vectors)` of every slot.
    pub fn slots(&self) -> Vec<(usize, Vec<Vector>)> {
        let stress: Vec<Vector> = std::iter::once(Vector::Stress).chain(self.reuses_stress).collect();
        let banks = [stress.clone(), stress];
        let slots = banks.into_iter().chain(self.fixed.iter().map(|&vector| vec![vector]));
        slots.enumerate().map(|(slot, vectors)| (slot * self.taxels, vectors)).collect()
    }
}
