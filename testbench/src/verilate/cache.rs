//! The folder of finished builds: look up, publish atomically, forget what is broken, abandoned or long unused.

use std::env;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};
use tempfile::TempDir;

use super::{BuildError, hex};

/// More entries than this and the ones longest unused go: random designs in tests would fill the disk.
const MOST_ENTRIES: usize = 400;
/// Held while folders of builders come or go.
const BUILDERS: &str = "builders";
/// An entry this young is never removed: another process may be about to load it.
const SAFE_AGE: Duration = Duration::from_hours(1);
/// Changes its modification time with each use of the entry; whoever builds an entry holds a lock on it.
const USED: &str = "used";
/// Digest of all other files of an entry, written last.
const SEAL: &str = "seal";
/// Folders whose entry is not finished yet.
const UNFINISHED: &str = "building-";

/// `verilated` in cargo's target folder; of a program that is away from the workspace it was built in, such as an installed
/// Python package, `sptfra/verilated` among the user's caches.
pub fn default_cache() -> PathBuf {
    let folder = |name: &str| env::var_os(name).filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let workspace = || Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|root| root.is_dir());
    let caches = || folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")));
    folder("CARGO_TARGET_DIR")
        .or_else(|| workspace().map(|root| root.join("target")))
        .or_else(|| caches().map(|caches| caches.join("sptfra")))
        .unwrap_or_else(|| "target".into())
        .join("verilated")
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

    /// The entry's folder, if there is one and it is whole. One that is not, after a full disk or a crash of the
    /// machine, is removed: to load it would end the process.
    pub fn get(&self, key: &str) -> Option<PathBuf> {
        let place = self.place(key);
        if !is_whole(&place) {
            // Whole by now if another process has built it meanwhile.
            self.exclusive(BUILDERS, || if is_whole(&place) { Ok(()) } else { self.discard(&place) }).ok()?;
        }
        // Only the age of the entry hangs on this, so a read-only cache is no reason to stop.
        File::create(place.join(USED)).ok();
        place.is_dir().then_some(place)
    }

    /// Out of the way at once, then gone.
    fn discard(&self, place: &Path) -> Result<(), BuildError> {
        if place.is_dir() {
            let grave = self.unfinished()?;
            fs::rename(place, grave.path().join("entry")).map_err(BuildError::io("remove", place))?;
        }
        Ok(())
    }

    fn unfinished(&self) -> Result<TempDir, BuildError> {
        let folder = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(&self.folder);
        folder.map_err(BuildError::io("create a folder in", &self.folder))
    }

    /// Lets `fill` build the entry in a folder of its own, then moves that into place.
    pub fn publish(
        &self,
        key: &str,
        fill: impl FnOnce(&Path) -> Result<(), BuildError>,
    ) -> Result<PathBuf, BuildError> {
        // The lock ends with the process, however that ends.
        let (unfinished, _lock) = self.exclusive(BUILDERS, || {
            self.remove_abandoned();
            let folder = self.unfinished()?;
            let file = File::create(folder.path().join(USED)).map_err(BuildError::io("write to", folder.path()))?;
            file.lock().map_err(BuildError::io("lock a file in", folder.path()))?;
            Ok((folder, file))
        })?;
        let path = unfinished.path();
        fill(path)?;
        let seal = digest(path).and_then(|digest| fs::write(path.join(SEAL), digest));
        seal.map_err(BuildError::io("write to", path))?;
        let place = self.place(key);
        match fs::rename(path, &place) {
            Ok(()) => {
                // Gone under its old name: there is nothing left to clean up.
                let _ = unfinished.keep();
            }
            // Another process was faster. Same key, same contents: use its entry.
            Err(_) if is_whole(&place) => {}
            Err(error) => return Err(BuildError::io("publish", &place)(error)),
        }
        self.prune();
        Ok(place)
    }

    /// Removes what interrupted builders left: folders on which nobody has a lock. To be called by one at a time.
    fn remove_abandoned(&self) {
        for path in self.entries().filter(|path| is_unfinished(path)) {
            let abandoned = match File::open(path.join(USED)) {
                Ok(file) => file.try_lock().is_ok(),
                // By a version that had no lock, or published just now.
                Err(_) => age(&path).is_some_and(|age| age > SAFE_AGE),
            };
            if abandoned {
                fs::remove_dir_all(path).ok();
            }
        }
    }

    /// Runs one caller at a time across processes.
    pub fn exclusive<T>(&self, name: &str, work: impl FnOnce() -> Result<T, BuildError>) -> Result<T, BuildError> {
        let path = self.folder.join(format!("{name}.lock"));
        let file = File::create(&path).map_err(BuildError::io("create", &path))?;
        file.lock().map_err(BuildError::io("lock", &path))?;
        work()
    }

    fn entries(&self) -> impl Iterator<Item = PathBuf> {
        let paths = fs::read_dir(&self.folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        paths.filter(|path| path.is_dir())
    }

    /// A failure to tidy up is no failure to build.
    fn prune(&self) {
        let finished = self.entries().filter(|path| !is_unfinished(path));
        let mut aged: Vec<(Duration, PathBuf)> = finished.filter_map(|path| Some((age(&path)?, path))).collect();
        aged.sort();
        for (_, path) in aged.into_iter().skip(MOST_ENTRIES).filter(|(age, _)| *age > SAFE_AGE) {
            fs::remove_dir_all(path).ok();
        }
    }
}

fn is_unfinished(entry: &Path) -> bool {
    entry.file_name().is_some_and(|name| name.to_string_lossy().starts_with(UNFINISHED))
}

/// Time since the last use of an entry.
fn age(entry: &Path) -> Option<Duration> {
    // A build that was interrupted early has no such file; its folder's own time serves.
    let used = fs::metadata(entry.join(USED)).or_else(|_| fs::metadata(entry)).ok()?;
    SystemTime::now().duration_since(used.modified().ok()?).ok()
}

/// Whether an entry is there with all its files as they were when it was published.
fn is_whole(entry: &Path) -> bool {
    let seal = fs::read_to_string(entry.join(SEAL));
    seal.is_ok_and(|seal| digest(entry).is_ok_and(|digest| digest == seal))
}

/// Of names and contents of an entry's files.
fn digest(entry: &Path) -> io::Result<String> {
    let mut files = Vec::new();
    let mut folders = vec![entry.to_owned()];
    while let Some(folder) = folders.pop() {
        for found in fs::read_dir(folder)? {
            let path = found?.path();
            (if path.is_dir() { &mut folders } else { &mut files }).push(path);
        }
    }
    files.retain(|path| ![USED, SEAL].iter().any(|name| *path == entry.join(name)));
    files.sort();
    let mut digest = Sha256::new();
    for path in files {
        digest.update(path.strip_prefix(entry).unwrap_or(&path).as_os_str().as_encoded_bytes());
        let contents = fs::read(&path)?;
        digest.update(contents.len().to_le_bytes());
        digest.update(contents);
    }
    Ok(hex(&digest.finalize()))
}
