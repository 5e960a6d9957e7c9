//! What the figures were measured on. No names and no paths: a page of figures goes into a repository.

use std::{fs, thread};

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

/// The most memory that this process had since [`forget_peak_memory`], in bytes; only Linux tells.
pub(super) fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = peak.trim().trim_end_matches("kB").trim_end().parse().ok()?;
    Some(1024 * kilobytes)
}

/// Begins anew with the present memory. Where the system refuses, the peak stays that of the whole process.
pub(super) fn forget_peak_memory() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}
