//! Files written whole or not at all.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot write the file: {source}; choose another place or make room", path.display())]
pub struct OutputError {
    path: PathBuf,
    source: io::Error,
}

/// Prints a line to standard output. A reader that has gone away, as after `| head`, is no error.
///
/// # Errors
///
/// When standard output cannot be written, for instance a full disk behind it.
pub fn print_line(text: std::fmt::Arguments<'_>) -> io::Result<()> {
    match writeln!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Prints a text as it is to standard output, in the manner of [`print_line`].
///
/// # Errors
///
/// As [`print_line`].
pub fn print_text(text: &str) -> io::Result<()> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Writes `content` to `path`, in place of what was there.
///
/// The content first goes to a temporary file in the same folder, so that a crash or a full disk leaves either the
/// old file or the new one, never a part.
///
/// # Errors
///
/// When the folder does not exist or cannot be written, or `path` is something else than a file.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), OutputError> {
    replace(path, content).map_err(|source| OutputError { path: path.to_path_buf(), source })
}

fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let target = if path.exists() {
        // A link keeps pointing where it does, and a device is not replaced by a file.
        let target = path.canonicalize()?;
        if !target.metadata()?.is_file() {
            return Err(io::Error::other("it exists and is no regular file"));
        }
        target
    } else {
        path.to_path_buf()
    };
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".golden-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask decides; a temporary file would otherwise be private.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(content)?;
    file.persist(target)?;
    Ok(())
}
