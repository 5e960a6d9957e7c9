//! The files that a design names: the calibration of its counts, their curve, and the weights of its estimator.

use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::Design;

/// Name of the calibration file beside a resolved design.
pub const CALIBRATION_FILE: &str = "calibration.csv";
/// Name of the file of the curve's points beside a resolved design.
pub const CURVE_FILE: &str = "curve.csv";
/// Name of the file of weights beside a resolved design.
pub const WEIGHTS_FILE: &str = "weights.csv";

/// Where the files are that a design names.
#[derive(Clone, Copy)]
pub(crate) enum FileSource<'a> {
    /// Relative to this folder.
    Folder(&'a Path),
    /// Name and content, in memory.
    Memory(&'a [(&'a str, String)]),
}

impl<'a> FileSource<'a> {
    /// The files beside a design file.
    pub(crate) fn folder_of(design: &'a Path) -> Self {
        Self::Folder(design.parent().unwrap_or(Path::new("")))
    }

    /// The place of a file, for messages.
    pub(crate) fn path(self, name: &str) -> PathBuf {
        match self {
            Self::Folder(folder) => folder.join(name),
            Self::Memory(_) => PathBuf::from(name),
        }
    }

    /// The content of a file.
    pub(crate) fn read(self, name: &str) -> io::Result<String> {
        match self {
            Self::Folder(_) => std::fs::read_to_string(self.path(name)),
            Self::Memory(files) => files
                .iter()
                .find_map(|(found, content)| (*found == name).then(|| content.clone()))
                .ok_or_else(|| io::ErrorKind::NotFound.into()),
        }
    }
}

impl Design {
    /// The files that [`Design::to_toml`] names, by name, to be written beside it: none for most designs.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let calibration = self.input.calibration.as_ref().map(|calibration| (CALIBRATION_FILE, calibration.to_csv()));
        let points = self.input.curve.as_ref().filter(|curve| curve.law.is_none());
        let points = points.map(|curve| (CURVE_FILE, curve.to_csv()));
        let correction = self.algorithm.constants().and_then(|constants| constants.correction.as_ref());
        let weights = correction.map(|correction| (WEIGHTS_FILE, correction.to_csv()));
        calibration.into_iter().chain(points).chain(weights).collect()
    }

    /// The hash that names a design in its Verilog, registers and measured tables: the first 16 hexadecimal digits of the
    /// SHA-256 of the resolved design and its files.
    pub fn hash(&self) -> String {
        let files = self.files().into_iter().map(|(_, content)| content);
        let mut hash = sha256(&files.fold(self.to_toml(), |text, content| text + &content));
        hash.truncate(16);
        hash
    }
}

/// The SHA-256 sum in hexadecimal digits, as `sha256sum` prints it.
pub(crate) fn sha256(content: &str) -> String {
    Sha256::digest(content).iter().map(|byte| format!("{byte:02x}")).collect()
}
