//! The fit of LUTs and flip-flops: its tables are those of the counts, and it has an estimate for each design.

use std::fs;
use std::path::PathBuf;

use golden::design::Design;
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::logic;
use xtask::luts::{COUNTS, FITTED, counted, fit, missing};

use crate::support::workspace;

fn plan(design: &Design) -> Plan {
    Plan::new(design).unwrap_or_else(|error| panic!("{}: {error}", design.name))
}

#[test]
fn the_fit_is_that_of_the_counts() {
    let table = |path| fs::read_to_string(workspace(path)).expect("readable");
    let fit = fit(&counted(&workspace(""), None).expect("tables and designs"));
    assert_eq!(fit.counts, table(COUNTS), "`make luts` writes {COUNTS} anew");
    assert_eq!(fit.fitted, table(FITTED), "`make luts` writes {FITTED} anew");
    let idle = |line: &&str| line.ends_with(",0.0,0.0");
    assert_eq!(fit.fitted.lines().find(idle), None, "a feature that costs nothing");
}

#[test]
fn a_file_that_is_missing_or_has_no_such_columns_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let message = || missing(folder.path()).expect_err("no table");
    let named = format!("{}: ", folder.path().join(COUNTS).display());
    assert!(message().starts_with(&named) && message().contains("restore it"), "{}", message());
    fs::create_dir(folder.path().join("results")).expect("a folder");
    fs::write(folder.path().join(COUNTS), "# LUTs\ndesign,module,lut,ff\n").expect("written");
    assert_eq!(message(), format!("{named}there is no column hash; restore the table"));
}

#[test]
fn each_design_has_an_estimate() {
    let mut without = Vec::new();
    for folder in ["designs", "golden/tests/designs"] {
        let files = fs::read_dir(workspace(folder)).expect("a folder").map(|file| file.expect("a file").path());
        for file in files.filter(|file| file.extension().is_some_and(|ending| ending == "toml")) {
            let design = Design::load(&file).expect("a design");
            if logic(&plan(&design)).is_none() {
                without.push(file);
            }
        }
    }
    assert_eq!(without, Vec::<PathBuf>::new(), "a feature of these is in no counted design");
}
