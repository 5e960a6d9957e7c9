//! What to do about a file that cannot be read: a name that is nearly that of another file is most likely misspelt.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Likeness from which on a name is offered: 1 is the same, and a letter more or less in ten is about 0.95.
const ALIKE: f64 = 0.9;
/// Where the project's own files lie.
const FOLDERS: [&str; 3] = ["designs", "scenes", "data"];

/// Endings of designs and scenes.
pub const DESIGNS: &[&str] = &["toml"];
/// Endings of frames and forces.
pub const FRAMES: &[&str] = &["csv", "npy", "tsv", "txt"];

/// What follows the semicolon of a message about a file that could not be read; `endings` are those of what was wanted.
pub fn remedy(path: &Path, source: &io::Error, endings: &[&str]) -> String {
    if source.kind() != io::ErrorKind::NotFound {
        return "check the path and the permissions".to_owned();
    }
    match likely(path, endings) {
        Some(likely) => format!("is {} meant?", likely.display()),
        None => "check the path".to_owned(),
    }
}

/// The file of a kind that is wanted, or of the one that was named, in the same folder or where such files lie, whose name
/// is most like the one given.
fn likely(path: &Path, endings: &[&str]) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let is_of_kind = |file: &Path| {
        let ending = file.extension().and_then(OsStr::to_str).map(str::to_lowercase);
        ending.is_some_and(|ending| endings.contains(&ending.as_str()) || path.extension() == Some(OsStr::new(&ending)))
    };
    let own = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folders = own.into_iter().map(Path::to_path_buf).chain([PathBuf::new()]).chain(FOLDERS.map(PathBuf::from));
    let mut best: Option<(f64, PathBuf)> = None;
    for folder in folders {
        for file in files(&folder).into_iter().filter(|file| is_of_kind(file)) {
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
        for name in ["sensor1-fast.gtkw", "sensor1-fast.toml", "sensor1-fast.toml", "frames.csv", "frames.html"] {
            fs::write(folder.path().join(name), "").expect("writable");
        }
        let missing = io::Error::from(io::ErrorKind::NotFound);
        let said = |name: &str| remedy(&folder.path().join(name), &missing, DESIGNS);
        // Without an ending the file of a trace is as like as the design.
        for name in ["sensor1-fats.toml", "sensor1_fast", "sensor1-fas", "Sensor1-fast.toml", "sensor-fast.toml"] {
            assert_eq!(
                said(name),
                format!("is {} meant?", folder.path().join("sensor1-fast.toml").display()),
                "{name}"
            );
        }
        let frames = format!("is {} meant?", folder.path().join("frames.csv").display());
        assert_eq!(said("frame.csv"), frames, "a file that a design names");
        for name in ["frame.csv", "frame", "frames.cvs"] {
            assert_eq!(remedy(&folder.path().join(name), &missing, FRAMES), frames, "{name}");
        }
        assert_eq!(said("elbow.toml"), "check the path");
        let refused = io::Error::from(io::ErrorKind::PermissionDenied);
        let file = folder.path().join("sensor1-fats.toml");
        assert_eq!(remedy(&file, &refused, DESIGNS), "check the path and the permissions");
    }
}
