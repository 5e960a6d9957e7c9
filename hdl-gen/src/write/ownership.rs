//! Whose the files in a folder are: the generator's, as its manifest lists them, or the user's.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::{MANIFEST, WriteError, io_error};

const HISTORY: &str = "`sptfra generate` did not write";

/// Whether `folder` may be replaced: it is not there, or each file in it is as the generator wrote it.
pub(super) fn check(folder: &Path) -> Result<(), WriteError> {
    if !folder.exists() {
        return Ok(());
    }
    if !folder.is_dir() {
        return Err(WriteError::NotAFolder(folder.to_owned()));
    }
    let manifest = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
    let owned: BTreeMap<&str, &str> =
        manifest.lines().filter_map(|line| line.split_once("  ")).map(|(digest, name)| (name, digest)).collect();
    let parents = owned.keys().copied().flat_map(|name| Path::new(name).ancestors().skip(1)).collect();
    match foreign_below(folder, folder, &Owned { files: owned, parents })? {
        Some((file, history)) => Err(WriteError::Foreign { folder: folder.to_owned(), file, history }),
        None => Ok(()),
    }
}

/// What a manifest names.
struct Owned<'a> {
    /// Digests by the path.
    files: BTreeMap<&'a str, &'a str>,
    /// Folders with files in them.
    parents: BTreeSet<&'a Path>,
}

/// The first file below `folder`, relative to `root` with forward slashes, that is not as the manifest says, or the first
/// folder that holds nothing and is none of its, and what is known about it. Nothing after it is looked at: the folder may
/// be somebody's home.
fn foreign_below(root: &Path, folder: &Path, owned: &Owned<'_>) -> Result<Option<(String, &'static str)>, WriteError> {
    let mut entries: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_error(folder, "list the folder"))? {
        entries.push(entry.map_err(io_error(folder, "list the folder"))?.path());
    }
    entries.sort();
    for path in entries {
        let relative = path.strip_prefix(root).unwrap_or(&path);
        let file = relative.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
        if path.is_dir() && !path.is_symlink() {
            let found = foreign_below(root, &path, owned)?;
            if found.is_some() {
                return Ok(found);
            }
            if !owned.parents.contains(relative) {
                return Ok(Some((file + "/", HISTORY)));
            }
            continue;
        }
        let history = match owned.files.get(file.as_str()) {
            _ if file == MANIFEST => continue,
            None => HISTORY,
            Some(&expected) => {
                let contents = fs::read(&path).map_err(io_error(&path, "read the file"))?;
                if digest(&contents) == expected {
                    continue;
                }
                "was changed after `sptfra generate` wrote it"
            }
        };
        return Ok(Some((file, history)));
    }
    Ok(None)
}

/// SHA-256 in hexadecimal.
pub(super) fn digest(contents: &[u8]) -> String {
    Sha256::digest(contents).iter().map(|byte| format!("{byte:02x}")).collect()
}
