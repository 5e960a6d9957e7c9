//! The estimate of a frame's energy: what it counts, and what the docs say of the shipped designs.

use std::fs;
use std::path::Path;

use golden::design::Design;
use hdl_gen::plan::Plan;
use hdl_gen::plan::energy::Energy;
use hdl_gen::plan::savings::savings;

use crate::support::plan;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace")
}

fn shipped(name: &str) -> Plan {
    let path = root().join("designs").join(format!("{name}.toml"));
    Plan::new(&Design::load(&path).expect("right")).expect("a plan")
}

/// By hand: what a multiplier and a memory do in an interval, at what they take.
#[test]
fn products_and_accesses_are_counted() {
    let plan = shipped("sensor1-reduced");
    let energy = Energy::of(&plan);
    assert_eq!(energy.lane_products, savings(&plan).last().expect("steps").macs as u64);
    let lanes = plan.design.hardware.lanes;
    let cycles = plan.timeline.interval_cycles;
    assert_eq!(energy.other_products, (plan.resources.dsp - lanes) as u64 * cycles);
    let bits: u64 = plan.resources.memories.iter().map(|memory| memory.count as u64 * u64::from(memory.width)).sum();
    assert_eq!(energy.memory_bits, bits * cycles);
    // 18 x 27 bits of 32 x 32, and a sum of 48.
    let product = 3.1 * (18.0 * 27.0) / 1024.0 + 0.1 * 48.0 / 32.0;
    let picojoules =
        product * (energy.lane_products + energy.other_products) as f64 + 10.0 / 64.0 * energy.memory_bits as f64;
    assert!((energy.chip_nj - picojoules / 1e3).abs() < 0.06, "{energy:?}");
    assert!((energy.fabric_nj - 14.0 * picojoules / 1e3).abs() < 0.06, "{energy:?}");
    assert!((energy.watts(1e6) - energy.fabric_nj / 1e3).abs() < 1e-12);
}

/// A design that passes over zeros is estimated by a frame that has none: all products, in the longest interval.
#[test]
fn zeros_that_may_be_skipped_are_counted() {
    let mut design = shipped("sensor1-reduced").design;
    let [all, skipping] = [false, true].map(|skip_zeros| {
        design.hardware.skip_zeros = skip_zeros;
        let plan = Plan::new(&design).expect("a plan");
        (Energy::of(&plan), plan.timeline.interval_cycles)
    });
    assert_eq!(all.0.lane_products, skipping.0.lane_products);
    assert!(skipping.1 >= all.1 && skipping.0.memory_bits >= all.0.memory_bits, "{all:?} {skipping:?}");
}

/// Fewer bits, fewer products and no field take less.
#[test]
fn less_work_takes_less() {
    let of = |algorithm: &str, hardware: &str| {
        let text = format!(
            "name = \"d\"\n[sensor]\ncolumns = 4\nrows = 4\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n[algorithm]\n{algorithm}\n\
             [hardware]\nlanes = 4\n{hardware}\n"
        );
        Energy::of(&plan(&text)).chip_nj
    };
    let all = of("plan = \"reduced\"", "");
    assert!(of("plan = \"reduced\"", "coefficient_bits = 12") < all);
    assert!(of("plan = \"reduced\"\noutputs = \"resultants\"", "") < all);
    assert!(of("plan = \"paper\"", "") > all);
}

#[test]
fn the_docs_have_the_figures_of_the_shipped_designs() {
    let page = fs::read_to_string(root().join("docs/choosing.md")).expect("readable");
    let table = page.split("| energy a frame, estimated |").nth(1).expect("a table");
    let rows: Vec<&str> = table.lines().skip(2).take_while(|line| line.starts_with('|')).collect();
    // All designs but those that are for tests, or for one tool.
    let small = ["odd", "small", "small-bodies", "small-control", "small-joint", "small-scanner"];
    let others = [&small[..], &["timing", "timing-joint", "timing-points"]].concat();
    for entry in fs::read_dir(root().join("designs")).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name").to_owned();
        if path.extension().is_some_and(|ending| ending == "toml") && !others.contains(&&*name) {
            assert!(rows.iter().any(|row| row.starts_with(&format!("| `{name}` |"))), "no row of {name}");
        }
    }
    for row in rows {
        let name = row.split('`').nth(1).expect("a design");
        let plan = shipped(name);
        let energy = Energy::of(&plan);
        let rate = plan.design.hardware.clock_mhz * 1e6 / plan.timeline.interval_cycles as f64;
        let expected = format!("| `{name}` | {:.1} µJ | {:.2} W |", energy.fabric_nj / 1e3, energy.watts(rate));
        assert_eq!(row, expected);
    }
}
