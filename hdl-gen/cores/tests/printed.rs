//! The Verilog in `hdl-gen/rtl` is what the descriptions print.

use std::path::{Path, PathBuf};
use std::{env, fs};

use hdl_cores::print_all;
use hdl_gen::cores::Multiplier;
use hdl_gen::emit::rtl::library;

/// What rewrites the files.
const RENEW: &str = "UPDATE_EXPECTED=1 cargo test -p sptfra-hdl-cores --test printed";

fn rtl() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl")
}

fn renews() -> bool {
    env::var_os("UPDATE_EXPECTED").is_some()
}

#[test]
fn the_files_are_what_the_descriptions_print() {
    for core in print_all().expect("every core is printed") {
        let file = rtl().join(core.path);
        if renews() {
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
    if renews() {
        // It was compiled with the files before.
        return;
    }
    for core in print_all().expect("every core is printed") {
        let library = library(Multiplier::Whole);
        let file = core.path.rsplit('/').next().and_then(|file| file.strip_suffix(".v"));
        let taken = file.and_then(|module| library.get(module));
        assert!(taken == Some(&core.verilog.as_str()), "a design does not get what {} holds", core.path);
    }
}
