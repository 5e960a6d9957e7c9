//! A folder with one file a point, each written whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use golden::output::write_whole;
use hdl_gen::write::io_error;

use super::SweepError;
use super::point::{Point, Verified};

/// Folder of the points in that of a sweep.
const POINTS: &str = "points";

/// Results on disk.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
}

impl Store {
    /// The store in the folder of a sweep, made if it is not there.
    ///
    /// # Errors
    /// [`SweepError::Folder`] if it cannot be made.
    pub fn open(folder: &Path) -> Result<Self, SweepError> {
        let folder = folder.join(POINTS);
        fs::create_dir_all(&folder).map_err(io_error(&folder, "make the folder"))?;
        Ok(Self { folder })
    }

    /// Where a point is.
    pub fn path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }

    /// Whether a point is there, verified as is wanted. One that no hardware has needs no more than it has. A file that
    /// cannot be read is as good as none, since it will be written anew.
    pub fn has(&self, key: &str, wanted: Verified) -> bool {
        self.get(key).is_ok_and(|point| point.key == key && (point.verified >= wanted || point.refusal.is_some()))
    }

    /// Writes a point.
    ///
    /// # Errors
    /// [`SweepError::Write`] if the file cannot be written.
    pub fn put(&self, point: &Point) -> Result<(), SweepError> {
        let path = self.path(&point.key);
        let text =
            serde_json::to_string_pretty(point).map_err(|error| SweepError::at(path.display().to_string(), error))?;
        Ok(write_whole(&path, (text + "\n").as_bytes())?)
    }

    /// Reads a point.
    ///
    /// # Errors
    /// [`SweepError::Folder`] and [`SweepError::At`] with the file.
    pub fn get(&self, key: &str) -> Result<Point, SweepError> {
        let path = self.path(key);
        let bytes = fs::read(&path).map_err(io_error(&path, "read the point"))?;
        serde_json::from_slice(&bytes).map_err(|error| SweepError::at(path.display().to_string(), error))
    }
}
