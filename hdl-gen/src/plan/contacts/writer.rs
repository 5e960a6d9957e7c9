//! Writes a program instruction by instruction.

use golden::bodies::MOST;

use super::instructions::{Instruction, Place, What};

/// The program under way.
#[derive(Default)]
pub(super) struct Writer(Vec<Instruction>);

impl Writer {
    pub(super) fn here(&self) -> u8 {
        self.0.len() as u8
    }

    pub(super) fn push(&mut self, what: What, to: Place, a: Place, b: Place) {
        self.0.push(Instruction::Do { what, to, a, b, magnitude: false });
    }

    pub(super) fn push_with_magnitude(&mut self, what: What, to: Place, a: Place, b: Place) {
        self.0.push(Instruction::Do { what, to, a, b, magnitude: true });
    }

    pub(super) fn take(&mut self, to: Place, from: Place) {
        self.push(What::Move, to, from, from);
    }

    /// A jump to a place that is known: no more bodies are kept than have a page.
    pub(super) fn jump(&mut self, target: u8) {
        self.0.push(Instruction::Jump { fewer: MOST as u8 + 1, target });
    }

    /// A jump to a place that comes later.
    pub(super) fn jump_on(&mut self, fewer: u8) -> usize {
        self.0.push(Instruction::Jump { fewer, target: 0 });
        self.0.len() - 1
    }

    pub(super) fn land(&mut self, jump: usize) {
        if let Instruction::Jump { fewer, .. } = self.0[jump] {
            self.0[jump] = Instruction::Jump { fewer, target: self.here() };
        }
    }

    /// One that does not put a result in a place.
    pub(super) fn add(&mut self, instruction: Instruction) {
        self.0.push(instruction);
    }

    pub(super) fn end(&mut self) {
        self.0.push(Instruction::End);
    }

    /// All of them.
    pub(super) fn finish(self) -> Vec<Instruction> {
        self.0
    }
}
