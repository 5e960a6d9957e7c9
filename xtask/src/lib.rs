//! What only developers run: benchmarks, corner cases, mutants, stress, studies, cell counts.

pub mod bench;
pub mod corner_cases;
pub mod luts;
pub mod mutants;
pub mod stress;
pub mod studies;

/// The beginning of a design whose method and scaling need no constants.
pub(crate) const PLAIN_DESIGN: &str =
    concat!("format = 3\nbase = \"", env!("CARGO_MANIFEST_DIR"), "/../golden/tests/plain.toml\"\n");
