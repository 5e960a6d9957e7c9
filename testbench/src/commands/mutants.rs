//! `testbench mutants`.

use clap::Args;
use golden::design::Design;

use super::{SeededArguments, shown};
use testbench::mutants::{Options, mutants};
use testbench::progress::Progress;

#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    common: SeededArguments,
    /// Mutants to make.
    #[arg(long, default_value_t = 50)]
    count: usize,
}

/// Makes mutants of a design.
pub fn run(arguments: &Arguments) -> super::Result {
    let SeededArguments { design, seed, json } = &arguments.common;
    let options = Options { count: arguments.count, seed: *seed };
    let report = mutants(&Design::load(design)?, &options, &Progress::new())?;
    Ok(shown(&report, *json, ToString::to_string)?.into())
}
