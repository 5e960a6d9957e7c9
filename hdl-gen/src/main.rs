//! The `hdl-gen` command: `new`, `inspect`, `generate`, and its manual.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
