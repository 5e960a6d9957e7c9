//! Constants of `hdl_gen::plan::luts`: those that the committed tables give.

use std::fs;

use hdl_gen::plan::luts::{ERROR_PERCENT, FITTED};
use xtask::luts::{fit, read};

use crate::support::workspace;

#[test]
fn constants_and_errors_are_those_of_the_tables() {
    let table = |path| fs::read_to_string(workspace(path)).expect("readable");
    let luts = table("results/luts.csv");
    let [parts, whole] = [&luts, &table("results/cells.csv")].map(|table| read(table).expect("a table"));
    let fit = fit((&whole, &workspace("designs")), (&parts, &workspace("xtask/designs"))).expect("designs");
    assert_eq!(fit.fitted, FITTED, "copy what `make luts` prints to hdl-gen/src/plan/luts.rs");
    assert_eq!(fit.error_percent, ERROR_PERCENT, "copy what `make luts` prints to hdl-gen/src/plan/luts.rs");
    assert_eq!(fit.table, luts, "`make luts` writes results/luts.csv anew");
}
