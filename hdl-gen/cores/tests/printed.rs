//! The Verilog in `hdl-gen/rtl` is what the descriptions print.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use hdl_cores::print_all;

/// What rewrites the files.
const RENEW: &str = "UPDATE_EXPECTED=1 cargo test -p hdl-cores";

fn rtl() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl")
}

#[test]
fn the_files_are_what_the_descriptions_print() {
    let renew = env::var_os("UPDATE_EXPECTED").is_some();
    for core in print_all().expect("every core is printed") {
        let file = rtl().join(core.path);
        if renew {
            fs::write(&file, core.verilog).expect("writable");
        } else {
            let found = fs::read_to_string(&file).unwrap_or_default();
            assert!(found == core.verilog, "hdl-gen/rtl/{} is not what its description prints: {RENEW}", core.path);
        }
    }
}

/// The files that a design takes are the printed ones, all of them.
#[test]
fn hdl_gen_has_every_core() {
    use hdl_gen::cores::{Multiplier, files};
    let taken: BTreeSet<&str> = [Multiplier::Whole, Multiplier::Split]
        .into_iter()
        .flat_map(files)
        .map(|core| {
            assert!(core.verilog.contains(&format!("\nmodule {} (\n", core.module)), "{}", core.module);
            core.verilog
        })
        .collect();
    let printed = print_all().expect("every core is printed");
    assert_eq!(taken, printed.iter().map(|core| core.verilog.as_str()).collect());
}
