//! `cargo xtask mutants`: copies of the RTL with a fault.

use sptfra::message::{self, Message, json_or};
use std::path::PathBuf;

use golden::design::Design;

use super::SeededArgs;
use golden::progress::Progress;
use xtask::mutants::{Explained, Options, mutants};

/// Makes copies of the RTL with one fault each and lists those that the comparison does not notice.
///
/// Without --explained no figure decides the exit code.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    common: SeededArgs,
    /// Mutants to make.
    #[arg(long, default_value_t = 50)]
    count: usize,
    /// Survivors with their reasons (TOML, as xtask/survivors.toml); any other one is then an error.
    #[arg(long)]
    explained: Option<PathBuf>,
}

/// Makes mutants of a design.
pub fn run(arguments: &Args) -> message::Result {
    let SeededArgs { design, seed, json } = &arguments.common;
    let explained = arguments.explained.as_deref().map(Explained::load).transpose()?;
    let strict = explained.is_some();
    let options = Options { count: arguments.count, seed: *seed, explained: explained.unwrap_or_default() };
    let report = mutants(&Design::load(design)?, &options, &Progress::new())?;
    let unexplained = report.survivors().count();
    let faults = (strict && unexplained > 0).then(|| format!("{unexplained} survivors have no explanation"));
    Ok(Message { text: json_or(&report, *json, ToString::to_string)?, faults: faults.into_iter().collect() })
}
