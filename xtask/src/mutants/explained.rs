//! Survivors that somebody has looked into.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;

use super::Mutation;

/// Changes of which it is known why no comparison can notice them, or why none does. As a file: a TOML table
/// `[[survivor]]` for each, with the keys `file`, `before`, `after` (as `cargo xtask mutants` prints them) and `why`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Explained {
    #[serde(default)]
    survivor: Vec<Survivor>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Survivor {
    file: String,
    before: String,
    after: String,
    why: String,
}

/// Why a file of explanations cannot be used.
#[derive(Debug, Error)]
pub enum ExplainedError {
    /// It cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is not as it should be.
    #[error("{}: {source}", .path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: Box<toml::de::Error>,
    },
}

impl Explained {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ExplainedError`] with the file, and the line where there is one.
    pub fn load(path: &Path) -> Result<Self, ExplainedError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| ExplainedError::Read { path: path.to_owned(), source })?;
        toml::from_str(&text).map_err(|source| ExplainedError::Form { path: path.to_owned(), source: Box::new(source) })
    }

    /// Why this change is not noticed, if that is known. The line's number does not count: lines move.
    pub fn why(&self, mutation: &Mutation) -> Option<&str> {
        let known =
            |of: &&Survivor| of.file == mutation.file && of.before == mutation.before && of.after == mutation.after;
        self.survivor.iter().find(known).map(|survivor| survivor.why.as_str())
    }
}

#[cfg(test)]
mod tests {
    use hdl_gen::cores::Multiplier;
    use hdl_gen::emit::rtl::library;

    use super::*;

    /// One whose line is gone explains nothing.
    #[test]
    fn the_lines_of_survivors_stand_in_the_library() {
        let explained = Explained::load(Path::new("survivors.toml")).expect("a list of survivors");
        let library = library(Multiplier::Whole);
        let module = |file: &str| library.get(file.strip_prefix("rtl/")?.strip_suffix(".v")?).copied();
        let known: Vec<_> = explained.survivor.iter().filter_map(|of| Some((of, module(&of.file)?))).collect();
        assert!(known.len() > 50);
        for (Survivor { file, before, after, .. }, text) in known {
            assert!(text.lines().any(|line| line.trim() == before) && before != after, "{file}: {before}");
        }
    }
}
