//! Puts an emitted design on disk: the whole folder or nothing, and nothing of the user's is touched.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::emit::FileMap;

mod swap;

/// Lists what the generator wrote into a folder, so that it can tell its own files from the user's: a SHA-256 and a
/// path a line, as `sha256sum --check` reads it.
pub const MANIFEST: &str = ".hdl-gen-manifest";

const HISTORY: &str = "hdl-gen did not write";

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

fn io_error(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> WriteError {
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

/// How the names of the folders begin in which a folder is built: no other's begin like that.
fn staging_prefix(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default();
    format!(".hdl-gen-{}-", &digest(name.as_encoded_bytes())[..12])
}

/// Removes the folders that generators left as they were killed. Whoever holds the lock knows that nobody builds there.
fn remove_left(parent: &Path, prefix: &str) {
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

/// Whether [`write_folder`] would replace `folder`: it is not there, or each file in it is as the generator wrote it.
///
/// # Errors
/// [`WriteError`] if not.
pub fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let _lock = lock(parent_of(folder), File::lock_shared);
    check(folder)
}

fn parent_of(folder: &Path) -> &Path {
    folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Keeps other generators out of a folder until it is dropped, or the process ends: one that looks while another
/// swaps would take one's manifest for a list of the other's files. Where a folder cannot be locked, nothing is kept.
fn lock(parent: &Path, lock: impl Fn(&File) -> io::Result<()>) -> Option<File> {
    let folder = File::open(parent).ok()?;
    lock(&folder).ok()?;
    Some(folder)
}

fn check(folder: &Path) -> Result<(), WriteError> {
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
/// folder that holds nothing and is none of its, and what is known about it. Nothing after it is looked at: the folder may be somebody's home.
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
                "was changed after hdl-gen wrote it"
            }
        };
        return Ok(Some((file, history)));
    }
    Ok(None)
}

/// SHA-256 in hexadecimal.
fn digest(contents: &[u8]) -> String {
    Sha256::digest(contents).iter().map(|byte| format!("{byte:02x}")).collect()
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
        let error = write_folder(&folder, &files(&["rtl/c.v"])).unwrap_err().to_string();
        assert!(error.contains("rtl/mine.v, which hdl-gen did not write"), "{error}");
        assert_eq!(fs::read_to_string(folder.join("rtl/mine.v")).unwrap(), "mine");
        assert!(folder.join("rtl/a.v").exists() && !folder.join("rtl/c.v").exists());
    }

    #[test]
    fn leaves_the_users_empty_folders_alone() {
        let place = tempfile::tempdir().unwrap();
        for (mine, named) in [("mine", "mine/"), ("rtl/empty", "rtl/empty/"), ("a/b", "a/b/")] {
            let folder = place.path().join(mine.replace('/', "-"));
            write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
            fs::create_dir_all(folder.join(mine)).unwrap();
            let error = write_folder(&folder, &files(&["rtl/c.v"])).unwrap_err().to_string();
            assert!(error.contains(&format!("holds {named}, which hdl-gen did not write")), "{error}");
            assert!(folder.join(mine).is_dir() && folder.join("rtl/a.v").exists());
        }
    }

    #[test]
    fn what_a_killed_one_left_is_removed() {
        let place = tempfile::tempdir().unwrap();
        let of = |name: &str, staged: &str| {
            let prefix = staging_prefix(&place.path().join(name));
            let left = place.path().join(prefix + "abcdef").join(staged);
            fs::create_dir_all(&left).unwrap();
            fs::write(left.join("a.v"), "half").unwrap();
            left
        };
        let folder = place.path().join("out");
        let [half, other] = [("out", "new"), ("out-two", "new")].map(|(name, staged)| of(name, staged));
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        assert!(!half.parent().unwrap().exists(), "half a design");
        assert!(other.exists(), "another output's");
        // The only copy of a former design, and one into which a file came meanwhile.
        for staged in ["old", "new"] {
            let kept = of("out", staged);
            fs::write(kept.join(MANIFEST), "").unwrap();
            write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
            assert!(kept.join("a.v").exists(), "{staged}");
            fs::remove_dir_all(kept.parent().unwrap()).unwrap();
        }
    }

    #[test]
    fn leaves_the_users_changes_alone() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
        fs::write(folder.join("rtl/b.v"), "better").unwrap();
        let error = write_folder(&folder, &files(&["rtl/b.v"])).unwrap_err().to_string();
        assert!(error.contains("rtl/b.v, which was changed after"), "{error}");
        assert_eq!(fs::read_to_string(folder.join("rtl/b.v")).unwrap(), "better");
        assert!(folder.join("rtl/a.v").exists());
    }

    #[test]
    fn takes_a_folder_that_is_empty_or_lacks_files() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        fs::create_dir(&folder).unwrap();
        write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
        fs::remove_file(folder.join("rtl/b.v")).unwrap();
        write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
        assert!(folder.join("rtl/b.v").exists());
    }

    #[cfg(unix)]
    #[test]
    fn follows_a_link_and_leaves_it() {
        let place = tempfile::tempdir().unwrap();
        let (real, link) = (place.path().join("real"), place.path().join("link"));
        fs::create_dir(&real).unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_folder(&link, &files(&["rtl/a.v"])).unwrap();
        assert!(link.is_symlink() && real.join("rtl/a.v").exists());
    }

    #[test]
    fn a_write_that_fails_midway_leaves_the_old_folder() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        // A file where a later one needs a folder.
        let error = write_folder(&folder, &files(&["rtl/c.v", "rtl/c.v/d.v"])).unwrap_err().to_string();
        assert!(error.contains("rtl/c.v"), "{error}");
        assert!(folder.join("rtl/a.v").exists() && !folder.join("rtl/c.v").exists());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside the folder");
    }

    /// A reader looks all the time while the folder changes hands.
    #[cfg(target_os = "linux")]
    #[test]
    fn there_is_no_moment_without_a_folder() {
        use std::sync::atomic::{AtomicBool, Ordering};

        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["id", "old"])).unwrap();
        let over = AtomicBool::new(false);
        let looks = std::thread::scope(|scope| {
            let reader = scope.spawn(|| {
                let mut looks = 0;
                while !over.load(Ordering::Relaxed) {
                    assert_eq!(fs::read_to_string(folder.join("id")).ok().as_deref(), Some("id"), "look {looks}");
                    looks += 1;
                }
                looks
            });
            for round in 0..200 {
                write_folder(&folder, &files(&["id", if round % 2 == 0 { "new" } else { "old" }])).unwrap();
            }
            over.store(true, Ordering::Relaxed);
            reader.join().unwrap()
        });
        assert!(looks > 100, "{looks}");
    }

    #[test]
    fn several_at_once_do_not_mix() {
        let place = tempfile::tempdir().unwrap();
        for round in 0..30 {
            let folder = place.path().join(format!("out{}", round % 3));
            let sets: Vec<FileMap> =
                (0..4).map(|writer| files(&[&format!("a/{writer}"), &format!("b/{writer}")])).collect();
            std::thread::scope(|scope| {
                for set in &sets {
                    scope.spawn(|| write_folder(&folder, set).unwrap());
                }
            });
            let found: Vec<String> = ["a", "b"]
                .map(|part| {
                    let mut names = fs::read_dir(folder.join(part)).unwrap();
                    let name = names.next().unwrap().unwrap().file_name().into_string().unwrap();
                    assert!(names.next().is_none());
                    name
                })
                .to_vec();
            assert_eq!(found[0], found[1], "files of one writer");
            check_folder(&folder).unwrap();
        }
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 3, "nothing is left beside the folders");
    }

    #[test]
    fn a_file_that_came_in_meanwhile_is_given_back() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        let staging = tempfile::tempdir_in(place.path()).unwrap();
        let fresh = staging.path().join("new");
        fs::create_dir(&fresh).unwrap();
        // After the check and before the swap.
        fs::write(folder.join("mine"), "mine").unwrap();
        let error = swap::into_place(&fresh, &folder, staging).unwrap_err().to_string();
        assert!(error.contains("mine, which hdl-gen did not write"), "{error}");
        assert!(folder.join("mine").exists() && folder.join("rtl/a.v").exists());
    }

    #[test]
    fn the_manifest_lists_every_file() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("out");
        write_folder(&folder, &files(&["abc", "rtl/a.v"])).unwrap();
        let manifest = fs::read_to_string(folder.join(MANIFEST)).unwrap();
        let first = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  abc";
        assert_eq!((manifest.lines().next(), manifest.lines().count()), (Some(first), 2));
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
