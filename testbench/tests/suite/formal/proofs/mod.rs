//! What is proved of which designs, and the broken copies whose proofs must fail.

pub mod blocks;
mod designs;
pub mod handshakes;

use golden::design::Design;

/// A module, a text in it, and what takes its place.
pub type Broken = (&'static str, &'static str, &'static str);

/// What is proved of which part of which design.
pub struct Proof {
    pub name: &'static str,
    pub harness: &'static str,
    /// The 4 × 3 design, changed.
    pub design: fn(&mut Design),
    /// What is defined for the harness, which may have other ways for other designs.
    pub defines: &'static [&'static str],
    /// The module that the harness instantiates, and its parameters, as `chparam` takes them.
    pub top: &'static str,
    pub parameters: &'static str,
    /// Files of `formal/` that take the place of generated modules.
    pub models: &'static [(&'static str, &'static str)],
    /// Whose outputs may be anything in any cycle: instances by the pattern of their module, then wires by name.
    pub free: &'static [&'static str],
    pub free_wires: &'static [&'static str],
    /// Cycles that an induction step assumes to be right.
    pub induction: &'static str,
    /// Texts that are others here than in the generated design.
    pub altered: &'static [Broken],
    /// Copies that break a property.
    pub broken: &'static [Broken],
}

/// All of them.
pub fn proofs() -> impl Iterator<Item = &'static Proof> {
    blocks::PROOFS.iter().chain(handshakes::PROOFS)
}
