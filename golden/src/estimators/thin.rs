//! How thin a layer an estimator can do with.

/// A depth below which the forces are wrong by more than a few percent. Each estimator's is in its own folder: of 200 unseen
/// round contacts at each depth (`docs/explanation/accuracy.md`, "Thin layers").
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Thin {
    /// Depth over the coarser pitch.
    pub(crate) limit: f64,
    /// What is wrong below it, and what to do.
    pub(crate) remedy: String,
}
