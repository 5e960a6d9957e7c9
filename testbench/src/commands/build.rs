//! `testbench build`.

use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;
use hdl_gen::plan::Plan;

use testbench::trial;

#[derive(Args)]
pub struct Arguments {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
}

/// Compiles a core and says where it is.
pub fn run(arguments: &Arguments) -> super::Result {
    let plan = Plan::new(&Design::load(&arguments.design)?)?;
    let built = trial::build(&plan)?;
    Ok(format!("{}\n", built.library.display()).into())
}
