//! `sptfra build`: a simulated core for programs.

use std::path::PathBuf;

use crate::arguments::design_file;
use crate::message;
use golden::design::Design;
use hdl_gen::plan::Plan;

use testbench::co_simulation;

/// Compiles a design's RTL into a shared object and prints its path.
///
/// `drivers/simulated` gives drivers, and the programs above them, the registers and memory of that core. The shared
/// object stays in the cache while it is used.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  core=$(sptfra build designs/small-control.toml)")]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
}

/// Compiles a core and returns where it is.
pub fn run(arguments: &Args) -> message::Result {
    let plan = Plan::new(&Design::load(&arguments.design)?)?;
    let built = co_simulation::build(&plan)?;
    Ok(format!("{}\n", built.library.display()).into())
}
