//! Emitted RTL to a loadable shared object, by Verilator and the C++ compiler, with a cache on disk.
//!
//! An entry of the cache is a folder named by the SHA-256 of everything that goes into it: RTL, ROM files, wrapper,
//! tool versions, flags. It is built beside its place and moved there whole, so a half-built entry is never seen and
//! two processes that build the same design do not disturb each other.

mod cache;
mod compile;
mod translation;

use std::collections::BTreeMap;
use std::io;
use std::path::{Component, Path, PathBuf};

use sha2::{Digest, Sha256};
use thiserror::Error;

pub use cache::default_cache;
pub use compile::{cxx_optimisation, one_unit};
pub use translation::translation;

use crate::dut::{Dut, DutError};
use crate::tools::{self, ToolError};
use compile::Toolchain;

/// Folder of the Verilog files in a generated design.
const RTL_FOLDER: &str = "rtl/";
/// Folder of the ROM files in a generated design.
const ROM_FOLDER: &str = "rom/";

/// What the simulation writes of its signals. Tracing costs speed and is a build of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trace {
    /// Nothing.
    #[default]
    Off,
    /// Value change dump: text, large, read by everything.
    Vcd,
    /// Compressed; needs the headers and libraries of zlib and LZ4.
    Fst,
    /// No waveform: how often each net changed, for an estimate of power.
    Saif,
}

impl Trace {
    /// FST where it can be built, else VCD.
    pub fn best() -> Self {
        if compile::fst_libraries_present() { Self::Fst } else { Self::Vcd }
    }

    /// The usual ending of the file's name, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Fst => "fst",
            Self::Saif => "saif",
            Self::Vcd | Self::Off => "vcd",
        }
    }
}

/// The Verilog and ROM files of one design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RtlSources {
    /// The top module, with the ports and the parameter `ROM_DIR` of a generated core.
    pub top: String,
    /// Relative path to contents: `rtl/*.v` and `rom/*`.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl RtlSources {
    /// The part of a generated design that decides what the hardware does; reports and scripts are left out.
    pub fn new(top: impl Into<String>, generated: &BTreeMap<String, Vec<u8>>) -> Self {
        let files = generated
            .iter()
            .filter(|(path, _)| path.starts_with(RTL_FOLDER) || path.starts_with(ROM_FOLDER))
            .map(|(path, bytes)| (path.clone(), bytes.clone()))
            .collect();
        Self { top: top.into(), files }
    }

    fn verilog(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str).filter(|path| {
            path.starts_with(RTL_FOLDER) && Path::new(path).extension().is_some_and(|ending| ending == "v")
        })
    }
}

/// Why a design could not be built.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A tool is missing.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// A source's path leads outside its folder.
    #[error("source file name `{0}` is not a plain relative path")]
    SourcePath(String),
    /// There is no Verilog file.
    #[error("design `{0}` has no Verilog file in {RTL_FOLDER}")]
    NoVerilog(String),
    /// A tool does not run, or rejected its input.
    #[error("{0}")]
    Failed(String),
    /// A file or folder could not be used.
    #[error("cannot {action} {}: {source}", .path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// Why it failed.
        source: io::Error,
    },
    /// The finished build cannot be loaded.
    #[error(transparent)]
    Dut(#[from] DutError),
}

impl BuildError {
    fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}

/// A design in the cache, ready to be loaded any number of times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Built {
    /// The shared object.
    pub library: PathBuf,
    /// False if it was there already and nothing was compiled.
    pub compiled: bool,
    /// What it can trace.
    pub trace: Trace,
}

impl Built {
    /// A core before its first clock edge. Registers without reset or initial value start with bits drawn from `seed`,
    /// so a missing reset shows up as a mismatch and does so again in the next run.
    ///
    /// # Errors
    /// [`DutError`] if the shared object cannot be loaded or a ROM file cannot be read.
    pub fn load(&self, seed: u32) -> Result<Dut, DutError> {
        Dut::load(&self.library, seed)
    }
}

/// Builds designs into a cache folder.
#[derive(Clone, Debug)]
pub struct Verilate {
    cache: PathBuf,
    trace: Trace,
}

impl Default for Verilate {
    fn default() -> Self {
        Self::new(default_cache())
    }
}

impl Verilate {
    /// With its cache in the given folder, which is created when needed.
    pub fn new(cache: impl Into<PathBuf>) -> Self {
        Self { cache: cache.into(), trace: Trace::Off }
    }

    /// With signals traced.
    #[must_use]
    pub fn with_trace(self, trace: Trace) -> Self {
        Self { trace, ..self }
    }

    /// Builds the design, unless the cache has it.
    ///
    /// # Errors
    /// [`BuildError`]: a missing tool, RTL that Verilator rejects, or a cache folder that cannot be written.
    pub fn build(&self, sources: &RtlSources) -> Result<Built, BuildError> {
        check(sources)?;
        let cache = cache::Cache::open(&self.cache)?;
        let toolchain = Toolchain::find(self.trace)?;
        let key = key(sources, &toolchain.identity(), cache.folder());
        let library = |entry: &Path| entry.join(compile::LIBRARY);
        if let Some(entry) = cache.get(&key) {
            return Ok(Built { library: library(&entry), compiled: false, trace: self.trace });
        }
        let runtime = compile::Runtime::new(&toolchain, &cache)?;
        let place = cache.place(&key);
        let entry = cache.publish(&key, |folder| {
            write_sources(sources, folder)?;
            compile::design(&toolchain, &runtime, sources, folder, &place.join(ROM_FOLDER))
        })?;
        Ok(Built { library: library(&entry), compiled: true, trace: self.trace })
    }
}

fn check(sources: &RtlSources) -> Result<(), BuildError> {
    let plain = |path: &str| Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
    if let Some(path) = sources.files.keys().find(|path| !plain(path)) {
        return Err(BuildError::SourcePath(path.clone()));
    }
    if sources.verilog().next().is_none() {
        return Err(BuildError::NoVerilog(sources.top.clone()));
    }
    Ok(())
}

/// The cache folder is part of the key because the ROM files' absolute path is compiled in.
fn key(sources: &RtlSources, toolchain: &str, cache: &Path) -> String {
    let mut hash = Sha256::new();
    let mut add = |bytes: &[u8]| {
        hash.update((bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    add(toolchain.as_bytes());
    add(cache.as_os_str().as_encoded_bytes());
    add(sources.top.as_bytes());
    for (path, bytes) in &sources.files {
        add(path.as_bytes());
        add(bytes);
    }
    hex(&hash.finalize())
}

fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn write_sources(sources: &RtlSources, folder: &Path) -> Result<(), BuildError> {
    for (path, bytes) in &sources.files {
        let file = folder.join(path);
        if let Some(parent) = file.parent() {
            std::fs::create_dir_all(parent).map_err(BuildError::io("create", parent))?;
        }
        std::fs::write(&file, bytes).map_err(BuildError::io("write", &file))?;
    }
    Ok(())
}

/// Verilator's version, for reports.
///
/// # Errors
/// [`BuildError`] if it is not installed or does not run.
pub fn verilator_version() -> Result<String, BuildError> {
    // The wheel's program does not know its own release; the package's metadata does.
    if let Some(release) = tools::verilator_release()? {
        return Ok(format!("Verilator {release}"));
    }
    let said = compile::version(tools::verilator()?, "Verilator", "run `make tools` to install it anew")?;
    Ok(said.trim().to_owned())
}
