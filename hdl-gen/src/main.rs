//! The `hdl-gen` command: `new`, `inspect`, `generate`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
