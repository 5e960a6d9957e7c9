//! Files written whole or not at all.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::design::Design;
use crate::resolved::folder;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot write the file: {source}; choose another place or make room", path.display())]
pub struct OutputError {
    path: PathBuf,
    source: io::Error,
}

/// Prints a text as it is to standard output. A reader that has gone away, as after `| head`, is no error.
///
/// # Errors
///
/// When standard output cannot be written, for instance a full disk behind it.
pub fn print_text(text: &str) -> io::Result<()> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Writes `content` to `path`, in place of what was there.
///
/// The content first goes to a temporary file in the same folder, so that a crash or a full disk leaves either the
/// old file or the new one, never a part. A pipe or a device, such as `/dev/stdout`, is written straight; a reader of it
/// that has gone away is no error.
///
/// # Errors
///
/// When the folder does not exist or cannot be written, or `path` is a folder.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), OutputError> {
    replace(path, content).map_err(|source| OutputError { path: path.to_path_buf(), source })
}

/// As [`write_whole`], of a file that is not there yet.
///
/// # Errors
///
/// [`io::ErrorKind::AlreadyExists`] if it is, or that the folder cannot be written.
pub fn write_new(path: &Path, content: &[u8]) -> io::Result<()> {
    Ok(temporary(path, content)?.persist_noclobber(path).map(drop)?)
}

/// Writes the rows of a measured table in place of the old ones, below the names of its columns. Its lines of comment say
/// what the rows are and stay; that of the designs is made anew, each with its name and hash.
///
/// # Errors
///
/// As [`write_whole`].
pub fn renew_table(path: &Path, designs: &[(String, Design)], columns: &str, rows: &str) -> Result<(), OutputError> {
    const DESIGNS: &str = "# designs: ";
    let old = std::fs::read_to_string(path).unwrap_or_default();
    let about = old.lines().take_while(|line| line.starts_with('#')).filter(|line| !line.starts_with(DESIGNS));
    let mut text: String = about.flat_map(|line| [line, "\n"]).collect();
    if !designs.is_empty() {
        let hashes: Vec<String> = designs.iter().map(|(name, design)| format!("{name} {}", design.hash())).collect();
        text.extend([DESIGNS, &hashes.join(", "), "\n"]);
    }
    write_whole(path, format!("{text}{columns}\n{rows}").as_bytes())
}

/// Writes several files, each in place of what was there: all of them or none.
///
/// Every content goes to a temporary file first; where the last step of one fails, those before it get their old content
/// back. Put a file that names others last: a crash between two files then leaves one that is whole, if not that of the
/// others.
///
/// # Errors
///
/// As [`write_whole`], for any of them.
pub fn write_together(files: &[(PathBuf, String)]) -> Result<(), OutputError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        |source| OutputError { path, source }
    };
    let staged = files
        .iter()
        .map(|(path, content)| stage(path, content.as_bytes()).map_err(failed(path)))
        .collect::<Result<Vec<_>, _>>()?;
    let mut replaced: Vec<(PathBuf, Option<Vec<u8>>)> = Vec::new();
    for ((path, content), staged) in files.iter().zip(staged) {
        let (file, target) = match staged {
            Staged::File(file, target) => (file, target),
            Staged::Stream(stream) => {
                write_straight(stream, content.as_bytes()).map_err(failed(path))?;
                continue;
            }
        };
        let before = if target.exists() { std::fs::read(&target).map(Some) } else { Ok(None) };
        let done = before.and_then(|before| {
            file.persist(&target)?;
            replaced.push((target, before));
            Ok(())
        });
        if let Err(source) = done {
            for (target, before) in replaced {
                // What fails now failed while there was something to save; the first failure is the one to report.
                let _ = match before {
                    Some(before) => replace(&target, &before),
                    None => std::fs::remove_file(&target),
                };
            }
            return Err(failed(path)(source));
        }
    }
    Ok(())
}

fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    match stage(path, content)? {
        Staged::File(file, target) => file.persist(target).map(|_| ()).map_err(io::Error::from),
        Staged::Stream(stream) => write_straight(stream, content),
    }
}

fn write_straight(mut stream: File, content: &[u8]) -> io::Result<()> {
    match stream.write_all(content) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// What is ready for the last step.
enum Staged {
    /// A temporary file that holds the content, and its target.
    File(NamedTempFile, PathBuf),
    /// A pipe or a device, which no file can replace: nothing is written yet.
    Stream(File),
}

/// Writes a temporary file that is ready to take the place of the target, or opens what is no file.
fn stage(path: &Path, content: &[u8]) -> io::Result<Staged> {
    let target = match path.metadata() {
        Ok(there) if there.is_dir() => return Err(io::Error::other("it is a folder")),
        // A link keeps pointing where it does.
        Ok(there) if there.is_file() => path.canonicalize()?,
        // A pipe behind /dev/stdout has no path of its own.
        Ok(_) => return File::options().write(true).open(path).map(Staged::Stream),
        Err(_) => path.to_path_buf(),
    };
    Ok(Staged::File(temporary(&target, content)?, target))
}

/// A temporary file beside the target that holds the content.
fn temporary(target: &Path, content: &[u8]) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".golden-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask decides; a temporary file would otherwise be private.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder(target))?;
    file.write_all(content)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_keeps_what_is_said_of_its_rows() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("errors.csv");
        std::fs::write(&path, "# about\n# designs: gone 0\n# more\na,b\n1,2\n# 3,4\n").expect("writable");
        let text = "format = 3\nname = \"pad\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
                    [algorithm]\nestimator = \"line\"\ncount_contacts = false\n";
        let pad = Design::from_toml(text, "pad.toml").expect("a design");
        let hash = pad.hash();
        renew_table(&path, &[("pad".to_owned(), pad)], "c,d", "5,6\n").expect("writable");
        let found = std::fs::read_to_string(&path).expect("there");
        assert_eq!(found, format!("# about\n# more\n# designs: pad {hash}\nc,d\n5,6\n"));
        renew_table(&path, &[], "c,d", "7,8\n").expect("writable");
        assert_eq!(std::fs::read_to_string(&path).expect("there"), "# about\n# more\nc,d\n7,8\n");
    }

    #[test]
    fn together_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let [weights, new, design] = ["weights", "new", "design"].map(|name| folder.path().join(name));
        std::fs::write(&weights, "old").expect("writable");
        let files = |last: &Path| {
            [(&weights, "a"), (&new, "b"), (&last.to_path_buf(), "c")]
                .map(|(path, content)| (path.clone(), content.to_owned()))
        };
        // A folder is found out before anything is replaced, a name that is too long only when all before it is done.
        for last in [folder.path().to_path_buf(), folder.path().join("n".repeat(300))] {
            let error = write_together(&files(&last)).expect_err("no such file can be").to_string();
            assert!(error.contains(&last.display().to_string()), "{error}");
            assert_eq!(std::fs::read_to_string(&weights).expect("there"), "old");
            assert!(!new.exists());
        }
        write_together(&files(&design)).expect("all can be written");
        assert_eq!([weights, new, design].map(|path| std::fs::read_to_string(path).expect("there")), ["a", "b", "c"]);
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 3, "no temporary file is left");
    }
}
