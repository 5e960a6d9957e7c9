//! What the figures were measured on. No names and no paths: a page of figures goes into a repository.

use std::thread;

use serde::Serialize;

/// A machine as far as it explains the times.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Such as `x86_64`.
    pub architecture: &'static str,
    /// Cores that this process may use.
    pub cores: usize,
    /// How the commands were compiled: `release` or `dev`.
    pub profile: &'static str,
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        Self {
            architecture: std::env::consts::ARCH,
            cores: thread::available_parallelism().map_or(1, usize::from),
            profile: if cfg!(debug_assertions) { "dev" } else { "release" },
        }
    }
}
