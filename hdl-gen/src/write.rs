//! Puts an emitted design on disk: the whole folder or nothing, and nothing of the user's is touched.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use self::ownership::{check, digest};
use self::staging::{lock, parent_of, remove_left, staging_prefix};
use crate::emit::FileMap;

mod ownership;
mod staging;
mod swap;

/// Lists what the generator wrote into a folder, so that it can tell its own files from the user's: a SHA-256 and a
/// path a line, as `sha256sum --check` reads it.
pub const MANIFEST: &str = ".sptfra-manifest";

/// Why a folder was not written. In each case it is as it was before.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The operating system refused.
    #[error("{}: cannot {action}: {source}; choose another folder with --out", path.display())]
    Io {
        /// File or folder.
        path: PathBuf,
        /// What was tried.
        action: &'static str,
        /// The reason.
        source: io::Error,
    },
    /// Something that the generator did not write, or not like that, is in the way.
    #[error(
        "{}: holds {file}, which {history}; move it away or choose another folder with --out", folder.display()
    )]
    Foreign {
        /// The output folder.
        folder: PathBuf,
        /// The first such file, relative to the folder.
        file: String,
        /// What is known about it.
        history: &'static str,
    },
    /// The output path is a file.
    #[error("{}: is there already and no folder; choose another with --out", .0.display())]
    NotAFolder(PathBuf),
    /// The new folder did not get its place, nor the old one its place back.
    #[error("{}: cannot be replaced: {source}; its former contents are in {}", folder.display(), kept.display())]
    Displaced {
        /// The output folder.
        folder: PathBuf,
        /// Where the old one is now.
        kept: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

/// What the operating system refused, with what was tried on what.
pub fn io_error(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> WriteError {
    let path = path.to_owned();
    move |source| WriteError::Io { path, action, source }
}

/// Writes `files` as the whole contents of `folder`.
///
/// Everything goes into a new folder beside it first, which then takes its place: whoever looks sees the old
/// design or the new one, never a mixture, and on Linux at no moment none. Of several that write at once, one comes
/// last. An existing folder is replaced only if each of its files is as the generator wrote it. What an earlier call for
/// the same folder left beside it, as it was killed, is removed.
///
/// # Errors
/// [`WriteError`]; the folder then is unchanged.
pub fn write_folder(folder: &Path, files: &FileMap) -> Result<(), WriteError> {
    // A link keeps pointing where it does.
    let target = if folder.exists() {
        folder.canonicalize().map_err(io_error(folder, "follow the path"))?
    } else {
        folder.to_owned()
    };
    let parent = parent_of(&target);
    fs::create_dir_all(parent).map_err(io_error(parent, "create the folder"))?;
    let lock = lock(parent, File::lock);
    check(folder)?;
    let prefix = staging_prefix(&target);
    let staging = tempfile::Builder::new()
        .prefix(&prefix)
        .tempdir_in(parent)
        .map_err(io_error(parent, "create a folder in it"))?;
    let fresh = staging.path().join("new");
    let mut manifest = String::new();
    for (name, contents) in files {
        let path = fresh.join(name);
        let directory = path.parent().unwrap_or(&fresh);
        // Messages name the place where the file would have been, not the one beside it.
        fs::create_dir_all(directory).map_err(io_error(&target.join(name), "create the folder"))?;
        fs::write(&path, contents).map_err(io_error(&target.join(name), "write the file"))?;
        manifest += &(digest(contents) + "  " + name + "\n");
    }
    fs::write(fresh.join(MANIFEST), manifest).map_err(io_error(&target.join(MANIFEST), "write the file"))?;
    swap::into_place(&fresh, &target, staging)?;
    if lock.is_some() {
        remove_left(parent, &prefix);
    }
    Ok(())
}

/// Whether [`write_folder`] would replace `folder`: it is not there, or each file in it is as the generator wrote it.
///
/// # Errors
/// [`WriteError`] if not.
pub fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let _lock = lock(parent_of(folder), File::lock_shared);
    check(folder)
}

#[cfg(test)]
mod tests;
