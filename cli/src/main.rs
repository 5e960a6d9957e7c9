//! The `sptfra` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(sptfra::run(std::env::args_os()))
}
