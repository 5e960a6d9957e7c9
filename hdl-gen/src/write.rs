//! Puts an emitted design on disk: the whole folder or nothing, and nothing of the user's is touched.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::emit::FileMap;

/// Lists what the generator wrote into a folder, so that it can tell its own files from the user's.
pub const MANIFEST: &str = ".hdl-gen-manifest";

/// Why a folder was not written. In each case it is as it was before.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The operating system refused.
    #[error("{path}: cannot {action}: {source}; choose another folder with --out")]
    Io {
        /// File or folder.
        path: PathBuf,
        /// What was tried.
        action: &'static str,
        /// The reason.
        source: io::Error,
    },
    /// Something that the generator did not write is in the way.
    #[error("{folder}: holds {file}, which hdl-gen did not write; move it away or choose another folder with --out")]
    Foreign {
        /// The output folder.
        folder: PathBuf,
        /// The first such file, relative to the folder.
        file: String,
    },
    /// The output path is a file.
    #[error("{0}: is not a folder; choose another with --out")]
    NotAFolder(PathBuf),
}

/// Writes `files` as the whole contents of `folder`.
///
/// Everything goes into a new folder beside it first, which then takes its place: whoever looks sees the old
/// design or the new one, never a mixture. An existing folder is replaced only if each of its files was written
/// by the generator.
///
/// # Errors
/// [`WriteError`]; the folder then is unchanged.
pub fn write_folder(folder: &Path, files: &FileMap) -> Result<(), WriteError> {
    check_owned(folder)?;
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let io = |path: &Path, action| {
        let path = path.to_owned();
        move |source| WriteError::Io { path, action, source }
    };
    fs::create_dir_all(parent).map_err(io(parent, "create the folder"))?;
    let staging =
        tempfile::Builder::new().prefix(".hdl-gen-").tempdir_in(parent).map_err(io(parent, "create a folder in it"))?;
    let fresh = staging.path().join("new");
    let mut manifest = String::new();
    for (name, contents) in files {
        let path = fresh.join(name);
        let directory = path.parent().unwrap_or(&fresh);
        fs::create_dir_all(directory).map_err(io(directory, "create the folder"))?;
        fs::write(&path, contents).map_err(io(&path, "write the file"))?;
        manifest.push_str(name);
        manifest.push('\n');
    }
    let path = fresh.join(MANIFEST);
    fs::write(&path, manifest).map_err(io(&path, "write the file"))?;
    let old = staging.path().join("old");
    let replaces = folder.exists();
    if replaces {
        fs::rename(folder, &old).map_err(io(folder, "replace the folder"))?;
    }
    if let Err(source) = fs::rename(&fresh, folder) {
        if replaces {
            fs::rename(&old, folder).map_err(io(folder, "put the old folder back"))?;
        }
        return Err(io(folder, "create the folder")(source));
    }
    Ok(())
}

/// Refuses a folder with files that no manifest of the generator lists.
fn check_owned(folder: &Path) -> Result<(), WriteError> {
    if !folder.exists() {
        return Ok(());
    }
    if !folder.is_dir() {
        return Err(WriteError::NotAFolder(folder.to_owned()));
    }
    let manifest = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
    let owned: std::collections::BTreeSet<&str> = manifest.lines().collect();
    for file in files_below(folder, folder)? {
        if file != MANIFEST && !owned.contains(file.as_str()) {
            return Err(WriteError::Foreign { folder: folder.to_owned(), file });
        }
    }
    Ok(())
}

/// Paths of all files below `folder`, relative to `root`, with forward slashes, sorted.
fn files_below(root: &Path, folder: &Path) -> Result<Vec<String>, WriteError> {
    let failed = |source| WriteError::Io { path: folder.to_owned(), action: "list the folder", source };
    let mut entries: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        entries.push(entry.map_err(failed)?.path());
    }
    entries.sort();
    let mut files = Vec::new();
    for path in entries {
        if path.is_dir() && !path.is_symlink() {
            files.extend(files_below(root, &path)?);
        } else {
            let relative = path.strip_prefix(root).unwrap_or(&path);
            let parts: Vec<_> = relative.iter().map(|part| part.to_string_lossy()).collect();
            files.push(parts.join("/"));
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[&str]) -> FileMap {
        names.iter().map(|name| ((*name).to_owned(), name.as_bytes().to_vec())).collect()
    }

    #[test]
    fn replaces_its_own_files_and_leaves_no_old_ones() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["rtl/a.v", "rom/b.mem"])).unwrap();
        write_folder(&folder, &files(&["rtl/c.v"])).unwrap();
        assert!(folder.join("rtl/c.v").exists() && !folder.join("rtl/a.v").exists());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside the folder");
    }

    #[test]
    fn leaves_the_users_files_alone() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        fs::write(folder.join("rtl/mine.v"), "mine").unwrap();
        let error = write_folder(&folder, &files(&["rtl/c.v"])).unwrap_err();
        assert!(error.to_string().contains("rtl/mine.v"), "{error}");
        assert_eq!(fs::read_to_string(folder.join("rtl/mine.v")).unwrap(), "mine");
        assert!(folder.join("rtl/a.v").exists() && !folder.join("rtl/c.v").exists());
    }

    #[test]
    fn says_when_the_place_is_no_folder() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("file");
        fs::write(&path, "").unwrap();
        assert!(matches!(write_folder(&path, &files(&["a"])), Err(WriteError::NotAFolder(_))));
        let below = path.join("deeper");
        assert!(matches!(write_folder(&below, &files(&["a"])), Err(WriteError::Io { .. })));
    }
}
