//! `testbench mutants`.

use std::path::PathBuf;

use clap::Args;
use golden::design::Design;

use super::{Said, SeededArguments, shown};
use golden::progress::Progress;
use testbench::mutants::{Explained, Options, mutants};

#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    common: SeededArguments,
    /// Mutants to make.
    #[arg(long, default_value_t = 50)]
    count: usize,
    /// Survivors with their reasons (TOML, as testbench/survivors.toml); any other one is then an error.
    #[arg(long)]
    explained: Option<PathBuf>,
}

/// Makes mutants of a design.
pub fn run(arguments: &Arguments) -> super::Result {
    let SeededArguments { design, seed, json } = &arguments.common;
    let explained = arguments.explained.as_deref().map(Explained::load).transpose()?;
    let strict = explained.is_some();
    let options = Options { count: arguments.count, seed: *seed, explained: explained.unwrap_or_default() };
    let report = mutants(&Design::load(design)?, &options, &Progress::new())?;
    let unexplained = report.survivors().count();
    let faults = (strict && unexplained > 0).then(|| format!("{unexplained} survivors have no explanation"));
    Ok(Said { text: shown(&report, *json, ToString::to_string)?, faults: faults.into_iter().collect() })
}
