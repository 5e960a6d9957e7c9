//! What a bank says of dead taxels: which they are and the weights of the others, in as many places as there is room.

use crate::plan::dead::DeadPlan;

/// A map of dead taxels, with the room that it has in a bank.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeadMap {
    /// Dead taxels for which there is room; 0: banks say nothing of them.
    pub room: usize,
    /// The dead taxels and their weights, no more than there is room for.
    pub dead: DeadPlan,
}

impl DeadMap {
    /// Words of a bank that a map takes.
    pub fn length(room: usize, taxels: usize) -> usize {
        if room == 0 { 0 } else { 1 + room * (1 + taxels) }
    }

    /// How many there are, and the weights' shift.
    pub fn head(&self) -> u32 {
        self.dead.taxels.len() as u32 | self.dead.shift << 8
    }

    /// The numbers of the dead taxels, then zeros.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.dead.taxels.iter().map(|&taxel| taxel as u32).chain(std::iter::repeat(0)).take(self.room)
    }

    /// The weight of a taxel in the sum of a place; 0 in one without a dead taxel.
    pub fn weight(&self, place: usize, taxel: usize) -> i32 {
        self.dead.weights.get(place).map_or(0, |weights| weights[taxel])
    }

    /// The words in their order: count and shift, numbers, then the weights of each taxel.
    pub fn words(&self, taxels: usize) -> Vec<u32> {
        if self.room == 0 {
            return Vec::new();
        }
        let weights = (0..taxels).flat_map(|taxel| (0..self.room).map(move |place| self.weight(place, taxel)));
        std::iter::once(self.head()).chain(self.numbers()).chain(weights.map(i32::cast_unsigned)).collect()
    }
}
