//! What several topics need: designs.

#[allow(dead_code, reason = "shared with the tests of the other crates")]
#[path = "../../../golden/tests/suite/designs.rs"]
pub mod designs;

use golden::design::Design;
use hdl_gen::plan::Plan;
use proptest::prelude::*;

/// The beginning of a design file whose method and scaling need no constants.
const PLAIN: &str = concat!("format = 3\nbase = \"", env!("CARGO_MANIFEST_DIR"), "/../golden/tests/plain.toml\"\n");

/// A design file's text with every optional key left out but those of `more`, which may open tables.
pub fn design_text(name: &str, size: [usize; 2], pitch_mm: [f64; 2], depth_mm: f64, more: &str) -> String {
    format!(
        "{PLAIN}name = \"{name}\"\n[sensor]\ncolumns = {}\nrows = {}\npitch_mm = {pitch_mm:?}\ndepth_mm = {depth_mm:?}\n\
         {more}\n",
        size[0], size[1]
    )
}

/// The plan of a design file's text.
pub fn plan(text: &str) -> Plan {
    Plan::new(&Design::from_toml(text, "test.toml").unwrap()).unwrap()
}

/// A 4 by 3 design by the paper's plan with the given `[hardware]` keys.
pub fn small_plan(hardware: &str) -> Plan {
    small("paper", hardware)
}

/// The same by the reduced plan.
pub fn small_reduced(hardware: &str) -> Plan {
    small("reduced", hardware)
}

fn small(kind: &str, hardware: &str) -> Plan {
    let more = format!("[algorithm]\nplan = \"{kind}\"\n[hardware]\n{hardware}");
    plan(&design_text("pad", [4, 3], [4.0, 2.0], 3.0, &more))
}

fn any_filter(taxels: usize) -> impl Strategy<Value = String> {
    prop_oneof![
        Just("{ kind = \"none\" }".to_owned()),
        (1..taxels - 1).prop_map(|l| format!("{{ kind = \"f1\", l = {l} }}")),
        (1.0..90.0_f64).prop_map(|p| format!("{{ kind = \"f2\", p = {p:?} }}")),
    ]
}

/// Texts of designs by the paper's plan: 2 by 2 to 8 by 8 taxels, well conditioned, with any filter, widths and lane
/// count.
pub fn any_paper_design() -> impl Strategy<Value = String> {
    let geometry = (2_usize..=8, 2_usize..=8, 1.0..6.0_f64, 1.0..6.0_f64, 0.1..1.2_f64);
    let hardware = (1_usize..=64, 8_u32..=18, 20_u32..=27, 1.0e3..1.0e6_f64);
    (geometry, hardware).prop_flat_map(move |(geometry, hardware)| {
        let (columns, rows, x, y, ratio) = geometry;
        let (lanes, coefficient_bits, data_bits, full_scale) = hardware;
        any_filter(columns * rows).prop_map(move |filter| {
            let more = format!(
                "[algorithm]\nplan = \"paper\"\nfilter = {filter}\n[hardware]\nlanes = {lanes}\n\
                 coefficient_bits = {coefficient_bits}\ndata_bits = {data_bits}\nfull_scale_pa = {full_scale:?}"
            );
            design_text("any", [columns, rows], [x, y], ratio * x.min(y), &more)
        })
    })
}

/// Texts of designs by the reduced plan: 2 by 2 to 9 by 9 taxels, sides even and odd, with any filter; one in three is
/// square in sides and pitch, where one matrix serves both directions.
pub fn any_reduced_design() -> impl Strategy<Value = String> {
    let geometry = (2_usize..=9, 2_usize..=9, 1.0..6.0_f64, 1.0..6.0_f64, 0.1..1.2_f64, 0..3);
    // Words of one multiplier a lane, and of two.
    let widths = prop_oneof![3 => (8_u32..=18, 20_u32..=27), 1 => (8_u32..=27, 29_u32..=35)];
    let hardware = (1_usize..=16, widths, 1.0e3..1.0e6_f64);
    let keys = (prop_oneof![Just("field"), Just("resultants")], prop_oneof![Just("throughput"), Just("latency")]);
    (geometry, hardware, keys).prop_flat_map(move |(geometry, hardware, (outputs, optimise))| {
        let (columns, mut rows, x, mut y, ratio, square) = geometry;
        if square == 0 {
            (rows, y) = (columns, x);
        }
        let (fours, (coefficient_bits, data_bits), full_scale) = hardware;
        any_filter(columns * rows).prop_map(move |filter| {
            let more = format!(
                "[algorithm]\nplan = \"reduced\"\nfilter = {filter}\noutputs = \"{outputs}\"\n[hardware]\n\
                 lanes = {}\ncoefficient_bits = {coefficient_bits}\ndata_bits = {data_bits}\n\
                 full_scale_pa = {full_scale:?}\noptimise = \"{optimise}\"",
                4 * fours
            );
            design_text("any", [columns, rows], [x, y], ratio * x.min(y), &more)
        })
    })
}

/// Texts of designs by either plan.
pub fn any_design() -> impl Strategy<Value = String> {
    prop_oneof![any_paper_design(), any_reduced_design()]
}
