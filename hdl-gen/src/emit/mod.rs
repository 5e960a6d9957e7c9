//! Emission: a plan in, a map from relative path to bytes out. Nothing here touches the disk.

pub mod boards;
mod debug;
mod flows;
mod linux;
mod mcsr;
mod metadata;
mod origin;
mod prefix;
mod readme;
mod registers;
mod roms;
pub mod rtl;
mod sim;
mod template;
mod top;

use std::collections::BTreeMap;

use golden::scene::SceneError;
use thiserror::Error;

use crate::cores::Multiplier;
use crate::plan::Plan;

use boards::Board;

pub use prefix::{Prefix, PrefixError};

pub use metadata::{ProductEntry, insert_options, nnz, predicted, products};

/// Relative path, with forward slashes, to contents.
pub type FileMap = BTreeMap<String, Vec<u8>>;

/// Why a plan could not be printed. Each is a defect of the generator, not of the design.
#[derive(Debug, Error)]
pub enum EmitError {
    /// A template does not fit its data.
    #[error("template {template}: {source}; please report this design")]
    Template {
        /// The template.
        template: String,
        /// What the engine says.
        source: tera::Error,
    },
    /// A board's file is not what it should be.
    #[error("boards: {0}; please report this")]
    Board(#[from] toml::de::Error),
    /// The testbench has no frames.
    #[error("frames of the testbench: {0}")]
    Scene(#[from] SceneError),
}

/// Version of the generator, as printed into every file.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Prints every file of the design's folder: `rtl/`, `rom/`, `sim/`, `mcsr/`, `vivado/`, `linux/`, `control/`, file
/// lists, `README.md`, `metadata.json`, `design.toml` and the files that it names.
///
/// # Errors
/// [`EmitError`] if a template and its data do not fit each other.
pub fn emit(plan: &Plan) -> Result<FileMap, EmitError> {
    emit_for(plan, &Options::default())
}

/// What a folder has besides what its design says.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The user's own boards, which the scripts know too.
    pub boards: Vec<Board>,
    /// Before the names of the library's modules; none: they keep their own.
    pub prefix: Option<Prefix>,
    /// Whether nets are marked for a logic analyser in the FPGA, with the script that attaches it.
    pub debug: bool,
}

/// As [`emit`], with options.
///
/// # Errors
/// As [`emit`].
pub fn emit_for(plan: &Plan, options: &Options) -> Result<FileMap, EmitError> {
    let boards: Vec<Board> = Board::all()?.into_iter().chain(options.boards.iter().cloned()).collect();
    let mut files = FileMap::new();
    let design = plan.design.to_toml();
    let hash = plan.design.hash();
    let mut modules = vec![top::render(plan, options.debug)?];
    modules.extend(registers::render(plan, &hash)?);
    let multiplier = Multiplier::of_part(&plan.design.hardware.part);
    let used = rtl::used_by(modules.iter().map(|(_, text)| text.as_str()), &top::without(plan), multiplier);
    modules.extend(used.into_iter().map(|(module, text)| (module.to_owned(), text.to_owned())));
    files.extend(modules.into_iter().map(|(module, text)| (format!("rtl/{module}.v"), text.into_bytes())));
    roms::insert(plan, &mut files);
    sim::insert(plan, &mut files)?;
    mcsr::insert(plan, &mut files);
    registers::insert(plan, &hash, &mut files)?;
    files.insert("design.toml".to_owned(), design.into_bytes());
    for (name, content) in plan.design.files() {
        files.insert(name.to_owned(), content.into_bytes());
    }
    // After every file that a list or script names.
    flows::insert(plan, &hash, (&boards, options.debug), &mut files)?;
    linux::insert(plan, &boards, &mut files)?;
    readme::insert(plan, &hash, &mut files)?;
    origin::insert(&plan.design.name, &hash, &mut files);
    prefix::stamp(&mut files);
    if let Some(prefix) = &options.prefix {
        prefix::rename(&mut files, prefix);
    }
    let metadata = metadata::metadata(plan, &hash, &files);
    files.insert("metadata.json".to_owned(), metadata.into_bytes());
    Ok(files)
}
