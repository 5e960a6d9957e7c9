//! The folder of finished builds: look up, publish atomically, forget what was not used for long.

use std::env;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::BuildError;

/// More entries than this and the ones longest unused go: random designs in tests would fill the disk.
const MOST_ENTRIES: usize = 400;
/// An entry this young is never removed: another process may be about to load it.
const SAFE_AGE: Duration = Duration::from_hours(1);
/// Changes its modification time with each use of the entry.
const USED: &str = "used";

/// `verilated` in cargo's target folder.
pub fn default_cache() -> PathBuf {
    let target = env::var_os("CARGO_TARGET_DIR").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let workspace = || Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|root| root.is_dir());
    target.or_else(|| workspace().map(|root| root.join("target"))).unwrap_or_else(|| "target".into()).join("verilated")
}

/// An open cache folder.
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    pub fn open(folder: &Path) -> Result<Self, BuildError> {
        fs::create_dir_all(folder).map_err(BuildError::io("create", folder))?;
        let folder = fs::canonicalize(folder).map_err(BuildError::io("find", folder))?;
        Ok(Self { folder })
    }

    /// Absolute.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where an entry is once it is published.
    pub fn place(&self, key: &str) -> PathBuf {
        self.folder.join(key)
    }

    /// The entry's folder, if there is one. Being there means being complete.
    pub fn get(&self, key: &str) -> Option<PathBuf> {
        let place = self.place(key);
        // Only the age of the entry hangs on this, so a read-only cache is no reason to stop.
        File::create(place.join(USED)).ok();
        place.is_dir().then_some(place)
    }

    /// Lets `fill` build the entry in a folder of its own, then moves that into place.
    pub fn publish(
        &self,
        key: &str,
        fill: impl FnOnce(&Path) -> Result<(), BuildError>,
    ) -> Result<PathBuf, BuildError> {
        let unfinished = tempfile::Builder::new()
            .prefix("building-")
            .tempdir_in(&self.folder)
            .map_err(BuildError::io("create a folder in", &self.folder))?;
        fill(unfinished.path())?;
        File::create(unfinished.path().join(USED)).map_err(BuildError::io("write to", unfinished.path()))?;
        let place = self.place(key);
        match fs::rename(unfinished.path(), &place) {
            Ok(()) => {
                // Gone under its old name: there is nothing left to clean up.
                let _ = unfinished.keep();
            }
            // Another process was faster. Same key, same contents: use its entry.
            Err(_) if place.is_dir() => {}
            Err(error) => return Err(BuildError::io("publish", &place)(error)),
        }
        self.prune();
        Ok(place)
    }

    /// Runs one caller at a time across processes.
    pub fn exclusive<T>(&self, name: &str, work: impl FnOnce() -> Result<T, BuildError>) -> Result<T, BuildError> {
        let path = self.folder.join(format!("{name}.lock"));
        let file = File::create(&path).map_err(BuildError::io("create", &path))?;
        file.lock().map_err(BuildError::io("lock", &path))?;
        work()
    }

    /// A failure to tidy up is no failure to build.
    fn prune(&self) {
        let Ok(entries) = fs::read_dir(&self.folder) else {
            return;
        };
        let now = SystemTime::now();
        let mut aged: Vec<(Duration, PathBuf)> = entries
            .filter_map(|entry| {
                let path = entry.ok()?.path();
                let age = last_use(&path).ok().and_then(|time| now.duration_since(time).ok())?;
                (path.is_dir()).then_some((age, path))
            })
            .collect();
        aged.sort();
        for (_, path) in aged.into_iter().skip(MOST_ENTRIES).filter(|(age, _)| *age > SAFE_AGE) {
            fs::remove_dir_all(path).ok();
        }
    }
}

fn last_use(entry: &Path) -> io::Result<SystemTime> {
    // A build that was interrupted has no such file; its folder's own time serves.
    fs::metadata(entry.join(USED)).or_else(|_| fs::metadata(entry))?.modified()
}
