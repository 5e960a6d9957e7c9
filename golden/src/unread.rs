//! What to do about a file that cannot be read: a name that is nearly that of another file is most likely misspelt.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Likeness from which on a name is offered: 1 is the same, and a letter more or less in ten is about 0.95.
const ALIKE: f64 = 0.9;
/// Where the project's own files lie.
const FOLDERS: [&str; 3] = ["designs", "scenes", "data"];

/// What follows the semicolon of a message about a file that could not be read.
pub fn remedy(path: &Path, source: &io::Error) -> String {
    if source.kind() != io::ErrorKind::NotFound {
        return "check the path and the permissions".to_owned();
    }
    match likely(path) {
        Some(likely) => format!("is {} meant?", likely.display()),
        None => "check the path".to_owned(),
    }
}

/// The file of the same kind, in the same folder or where such files lie, whose name is most like the one given.
fn likely(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let own = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folders = own.into_iter().map(Path::to_path_buf).chain([PathBuf::new()]).chain(FOLDERS.map(PathBuf::from));
    let mut best: Option<(f64, PathBuf)> = None;
    for folder in folders {
        for file in files(&folder) {
            let Some(other) = file.file_name().and_then(OsStr::to_str) else { continue };
            let likeness = likeness(name, other);
            let better = best.as_ref().is_none_or(|(most, _)| likeness > *most);
            if likeness >= ALIKE && better && file.is_file() {
                best = Some((likeness, file));
            }
        }
    }
    best.map(|(_, file)| file)
}

/// Of two file names, one of which may lack its ending; `-` and `_` are the same.
fn likeness(name: &str, other: &str) -> f64 {
    let plain = |name: &str| name.replace('-', "_").to_lowercase();
    let ending = Path::new(other).extension().and_then(OsStr::to_str).unwrap_or("");
    let whole = if Path::new(name).extension().is_some() { name.to_owned() } else { format!("{name}.{ending}") };
    strsim::jaro_winkler(&plain(&whole), &plain(other))
}

/// In the order of their names, so that of two alike it is always the same.
fn files(folder: &Path) -> Vec<PathBuf> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(here) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries.filter_map(Result::ok).map(|entry| folder.join(entry.file_name())).collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_is_told() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["sensor1-fast.toml", "sensor1-joint.toml", "frames.csv"] {
            fs::write(folder.path().join(name), "").expect("writable");
        }
        let missing = io::Error::from(io::ErrorKind::NotFound);
        let said = |name: &str| remedy(&folder.path().join(name), &missing);
        for name in ["sensor1-fats.toml", "sensor1_fast", "Sensor1-fast.toml", "sensor-fast.toml"] {
            assert_eq!(
                said(name),
                format!("is {} meant?", folder.path().join("sensor1-fast.toml").display()),
                "{name}"
            );
        }
        assert_eq!(said("frame.csv"), format!("is {} meant?", folder.path().join("frames.csv").display()));
        assert_eq!(said("elbow.toml"), "check the path");
        let refused = io::Error::from(io::ErrorKind::PermissionDenied);
        assert_eq!(remedy(&folder.path().join("sensor1-fats.toml"), &refused), "check the path and the permissions");
    }
}
