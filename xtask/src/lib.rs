//! What only developers run: benchmarks, corner cases, mutants, stress, cell counts.

pub mod bench;
pub mod confidence;
pub mod corner_cases;
pub mod markdown;
pub mod mutants;
pub mod noise;
pub mod stress;
