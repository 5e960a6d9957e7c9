//! What Verilator makes of a design, without the compiler: modules are the same in all designs, and Verilator leaves out
//! what a design has not, so that sources of one translation are one piece of hardware.

use std::fs;

use sha2::{Digest, Sha256};

use super::compile::{self, Toolchain};
use super::{BuildError, RtlSources, Trace, hex, write_sources};

/// Digest of the C++ that Verilator makes of the sources. What is read at run time, the ROM files, is no part of it.
///
/// # Errors
/// [`BuildError`] if Verilator does not take the sources, or there is no room for them.
pub fn translation(sources: &RtlSources) -> Result<String, BuildError> {
    let folder = tempfile::tempdir().map_err(BuildError::io("make a folder in", &std::env::temp_dir()))?;
    write_sources(sources, folder.path())?;
    let generated = folder.path().join("cpp");
    // One name for the ROMs' folder, wherever the sources lie.
    compile::translate(&Toolchain::find(Trace::Off)?, sources, folder.path(), &generated, "rom".as_ref())?;
    let mut hash = Sha256::new();
    for file in compile::sorted_cpp(&generated)? {
        let text = fs::read_to_string(&file).map_err(BuildError::io("read", &file))?;
        // Messages name the file that they stand in by its path.
        hash.update(text.replace(&*folder.path().to_string_lossy(), ""));
    }
    Ok(hex(&hash.finalize()))
}
