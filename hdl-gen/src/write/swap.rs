//! A finished folder takes the place of another: in one step where the system can exchange two names.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use tempfile::TempDir;

use super::{WriteError, check, io_error};

/// Moves `fresh`, which lies in `staging`, to `target`. What was there goes with `staging`.
///
/// # Errors
/// [`WriteError`]; `target` then is what it was, or, if even that failed, the message says where.
pub fn into_place(fresh: &Path, target: &Path, staging: TempDir) -> Result<(), WriteError> {
    if !target.exists() {
        return fs::rename(fresh, target).map_err(io_error(target, "create the folder"));
    }
    match exchange(fresh, target) {
        Ok(()) => check_replaced(fresh, target),
        Err(error) if error.kind() == ErrorKind::Unsupported => by_two_renames(fresh, target, staging),
        Err(error) => Err(io_error(target, "replace the folder")(error)),
    }
}

/// Looks at what was replaced once more: a file that came in after the first look is not lost with it.
fn check_replaced(replaced: &Path, target: &Path) -> Result<(), WriteError> {
    check(replaced).map_err(|error| match exchange(replaced, target) {
        Ok(()) => match error {
            WriteError::Foreign { file, history, .. } => {
                WriteError::Foreign { folder: target.to_owned(), file, history }
            }
            other => other,
        },
        Err(source) => io_error(target, "put back the folder")(source),
    })
}

/// Two names exchange what they stand for.
///
/// # Errors
/// [`ErrorKind::Unsupported`] where the system or the file system cannot.
#[cfg(target_os = "linux")]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;

    renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE).map_err(|errno| match errno {
        Errno::NOSYS | Errno::INVAL | Errno::NOTSUP => ErrorKind::Unsupported.into(),
        errno => errno.into(),
    })
}

/// Other systems have no such call, or another one.
#[cfg(not(target_os = "linux"))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

/// For an instant there is no folder.
fn by_two_renames(fresh: &Path, target: &Path, staging: TempDir) -> Result<(), WriteError> {
    let old = staging.path().join("old");
    fs::rename(target, &old).map_err(io_error(target, "replace the folder"))?;
    let Err(source) = fs::rename(fresh, target) else {
        return Ok(());
    };
    if fs::rename(&old, target).is_err() {
        let kept = staging.keep().join("old");
        return Err(WriteError::Displaced { folder: target.to_owned(), kept, source });
    }
    Err(io_error(target, "create the folder")(source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_an_exchange_two_renames_do() {
        let place = tempfile::tempdir().unwrap();
        let staging = tempfile::tempdir_in(place.path()).unwrap();
        let (fresh, target) = (staging.path().join("new"), place.path().join("out"));
        for folder in [&fresh, &target] {
            fs::create_dir(folder).unwrap();
        }
        fs::write(fresh.join("id"), "new").unwrap();
        by_two_renames(&fresh, &target, staging).unwrap();
        assert!(target.join("id").exists());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside the folder");
    }

    #[test]
    fn a_folder_that_cannot_move_leaves_the_old_one() {
        let place = tempfile::tempdir().unwrap();
        let staging = tempfile::tempdir_in(place.path()).unwrap();
        let target = place.path().join("out");
        fs::create_dir(&target).unwrap();
        assert!(by_two_renames(&staging.path().join("nothing"), &target, staging).is_err());
        assert!(target.exists());
    }
}
