//! The place beside an output folder where the next one is built, and who may build there.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use super::MANIFEST;
use super::ownership::{check, digest};

/// How the names of the folders begin in which a folder is built: no other's begin like that.
pub(super) fn staging_prefix(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default();
    format!(".sptfra-{}-", &digest(name.as_encoded_bytes())[..12])
}

/// Removes the folders that generators left as they were killed. Whoever holds the lock knows that nobody builds there.
pub(super) fn remove_left(parent: &Path, prefix: &str) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let path = entry.path();
        let is_named = entry.file_name().to_str().is_some_and(|name| name.starts_with(prefix));
        if !is_named || !entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            continue;
        }
        let built = path.join("new");
        // Before the swap it has no manifest or its own files, after it those of the former design: all but what came in
        // meanwhile. A former design that was moved there, and not back, stays.
        let is_own = !built.join(MANIFEST).exists() || check(&built).is_ok();
        if is_own && !path.join("old").exists() {
            // The design is in place: that of an earlier one is left is no failure of this.
            let _ = fs::remove_dir_all(&path);
        }
    }
}

/// The folder that holds `folder`.
pub(super) fn parent_of(folder: &Path) -> &Path {
    folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Keeps other generators out of a folder until it is dropped, or the process ends: one that looks while another
/// swaps would take one's manifest for a list of the other's files. Where a folder cannot be locked, nothing is kept.
pub(super) fn lock(parent: &Path, lock: impl Fn(&File) -> io::Result<()>) -> Option<File> {
    let folder = File::open(parent).ok()?;
    lock(&folder).ok()?;
    Some(folder)
}
