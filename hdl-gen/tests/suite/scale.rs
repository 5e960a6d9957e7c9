//! The largest sensor: 32 by 32 taxels, nothing filtered.

use golden::design::Design;
use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::QuantisedMatrix;
use hdl_gen::timing::Timeline;

use crate::support::design_text;

const TAXELS: usize = 1024;
const ENTRIES: usize = TAXELS * TAXELS;

/// Of a file, or of all banks of a ROM.
fn lines(files: &FileMap, name: &str) -> usize {
    let is_it =
        |path: &str| path == name || path.starts_with("rom/bank") && path[10..].strip_prefix('_') == Some(&name[4..]);
    let found = files.iter().filter(|(path, _)| is_it(path));
    found.map(|(_, contents)| std::str::from_utf8(contents).unwrap().lines().count()).sum()
}

/// Its plan, whose lanes do nothing but multiply.
fn planned(lanes: usize) -> Plan {
    let more = format!("[algorithm]\nplan = \"paper\"\n[hardware]\nlanes = {lanes}");
    let text = design_text("whole", [32, 32], [4.0, 2.0], 3.0, &more);
    let plan = Plan::new(&Design::from_toml(&text, "whole.toml").unwrap()).unwrap();
    let cycles = (ENTRIES / lanes) as u64;
    for window in &plan.schedule.windows {
        assert!((cycles..cycles + 20).contains(&window.length), "{lanes} lanes: {}", window.length);
    }
    assert!((16 * cycles..16 * cycles + 100).contains(&plan.timeline.spmv_cycles));
    assert!(plan.timeline.latency_cycles < plan.timeline.spmv_cycles + 70_000);
    assert!(plan.schedule.busy_fraction() > 0.999);
    plan
}

#[test]
fn the_largest_sensor_has_a_plan_with_one_lane() {
    planned(1);
}

/// Files of 350 MB, whose bytes the number of lanes only spreads.
#[test]
fn the_largest_sensor_has_hardware_with_sixteen_lanes() {
    let lanes = 16;
    let files = emit(&planned(lanes)).unwrap();
    assert_eq!(lines(&files, "rom/whole_values_pe00.mem"), 14 * ENTRIES / lanes);
    assert_eq!(lines(&files, "rom/whole_columns_pe00.mem"), 14 * ENTRIES / lanes);
    assert_eq!(lines(&files, "rom/whole_slots.mem"), 16 * TAXELS);
    assert_eq!(lines(&files, "mcsr/13_C33.txt"), 7 + TAXELS);
    // Five digits and a line end for a coefficient, three and one for its column: no more text than needed.
    assert_eq!(files["rom/whole_values_pe00.mem"].len(), 14 * ENTRIES / lanes * 6);
    assert_eq!(files["rom/whole_columns_pe00.mem"].len(), 14 * ENTRIES / lanes * 4);
    assert!(files.values().map(Vec::len).sum::<usize>() < 350_000_000);
}

/// A mat beyond the size at which a dense matrix could be held thirteen times over: its files are written, and each
/// lane has its share of the entries.
#[test]
#[ignore = "twenty seconds: part of `make test-long`"]
fn a_mat_of_4096_taxels_has_hardware() {
    // With the estimator of new designs: its points see a taxel a cycle, while the lanes take eight.
    let more = "[algorithm]\nplan = \"reduced\"\nkernel = \"cell\"\nfilter = { kind = \"f2\", p = 1.0 }\n\
                estimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\n[hardware]\nlanes = 64";
    let text = design_text("mat", [64, 64], [28.0, 28.0], 8.0, more);
    let plan = Plan::new(&Design::from_toml(&text, "mat.toml").unwrap()).unwrap();
    let Timeline { search_cycles, interval_cycles, .. } = plan.timeline;
    assert!(search_cycles > 4096 && search_cycles < interval_cycles / 7, "{search_cycles}, {interval_cycles}");
    let files = emit(&plan).unwrap();
    let words: Vec<usize> = (0..16).map(|lane| lines(&files, &format!("rom/mat_values_pe{lane:02}.mem"))).collect();
    let entries: usize = plan.matrices.iter().map(QuantisedMatrix::nnz).sum();
    assert!(words.iter().all(|&count| count == plan.schedule.word_depth()), "{words:?}");
    // A sixteenth each, but for the last rows of each product. The friction product's codes are shared.
    assert!((0.95..1.2).contains(&(16.0 * words[0] as f64 / entries as f64)), "{} words, {entries} entries", words[0]);
    // Ten matrices of 1024 folded rows, the sums, the friction's codes; a filter per row is not the mirror image of one
    // per column, so that nothing is mirrored.
    assert_eq!(plan.matrices.len(), 12);
    assert!(entries < 10 * TAXELS * TAXELS / 4, "{entries}");
}
