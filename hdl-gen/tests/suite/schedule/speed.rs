//! How busy the lanes are, and what more of them bring.

use golden::design::MAX_LANES;
use hdl_gen::estimators::Cells;
use hdl_gen::plan::Plan;
use hdl_gen::plan::product::{Coefficients, Epilogue};
use hdl_gen::timing::Timeline;

use crate::support::{design_text, designs, plan, small_reduced};

#[test]
fn dense_matrices_keep_all_lanes_busy() {
    for lanes in [1, 2, 7, 16, 64] {
        let more = format!("[algorithm]\nplan = \"paper\"\n[hardware]\nlanes = {lanes}");
        let plan = plan(&design_text("d", [10, 10], [4.0, 2.0], 3.0, &more));
        for (product, window) in plan.products.iter().zip(&plan.schedule.windows) {
            let entries = plan.matrices[product.matrix].nnz() as u64;
            assert_eq!(window.length, entries.div_ceil(lanes), "{lanes} lanes");
        }
        assert!(plan.schedule.busy_fraction() >= 0.9, "{lanes} lanes: {}", plan.schedule.busy_fraction());
    }
}

/// A quarter of the taxels, a quarter of the lanes, rows a quarter as long; what is left to wait for is the separated
/// result, two cycles each.
#[test]
fn dense_blocks_keep_all_pes_busy() {
    for pes in [1, 2, 4, 16] {
        for outputs in ["field", "resultants"] {
            let more =
                format!("[algorithm]\nplan = \"reduced\"\noutputs = \"{outputs}\"\n[hardware]\nlanes = {}", 4 * pes);
            let plan = plan(&design_text("d", [10, 10], [4.0, 2.0], 3.0, &more));
            assert_eq!((plan.elements(), plan.channels(), plan.pes()), (25, 4, pes));
            for (product, window) in plan.products.iter().zip(&plan.schedule.windows) {
                let preload = product.preload.map_or(0, |preload| plan.matrices[preload.matrix].nnz());
                let entries = (preload + plan.matrices[product.matrix].nnz()) as u64;
                assert_eq!(window.macs, entries);
                let few = product.coefficients == Coefficients::Friction || product.epilogue == Epilogue::Part;
                if !few {
                    assert_eq!(window.length, entries.div_ceil(pes as u64), "{pes} PEs: {product:?}");
                }
            }
        }
    }
}

#[test]
fn more_lanes_are_never_slower_on_the_papers_sensor() {
    let filter = "filter = { kind = \"f1\", l = 40 }";
    for (kind, lanes) in
        [("paper", &[1, 2, 4, 8, 16, 32, 64][..]), ("reduced", &[4, 8, 16, 32, 64]), ("reduced", &[12, 20, 40, 60])]
    {
        let mut before = u64::MAX;
        for lanes in lanes {
            let more = format!("[algorithm]\nplan = \"{kind}\"\n{filter}\n[hardware]\nlanes = {lanes}");
            let plan = plan(&design_text("d", [10, 10], [4.0, 2.0], 3.0, &more));
            let timeline = &plan.timeline;
            assert!(timeline.latency_cycles < before && timeline.interval_cycles <= timeline.latency_cycles);
            before = timeline.latency_cycles;
            let Cells { cells, elements } = plan.estimator.block().cells(&plan.design.sensor);
            let (groups, of_group) = (cells / plan.channels(), plan.elements());
            assert!(groups * elements >= of_group && (groups - 1) * elements < of_group);
        }
    }
}

/// Frames take turns in how long they take, by as many as five with some lanes: whatever the turn, a frame is not done
/// sooner on average than the lanes have issued its products.
#[test]
fn no_interval_is_shorter_than_what_the_lanes_issue() {
    for design in ["sensor1-fast", "sensor1-clipped-wide"] {
        let mut design = designs::design(design);
        for lanes in (16..=MAX_LANES).step_by(4) {
            design.hardware.lanes = lanes;
            let Timeline { interval_cycles, spmv_cycles, .. } = Plan::new(&design).expect("a plan").timeline;
            assert!(
                interval_cycles >= spmv_cycles,
                "{}, {lanes} lanes: {interval_cycles} < {spmv_cycles}",
                design.name
            );
        }
    }
}

/// Best for the latency under load and best for the interval differ in what goes first, not in a frame alone.
#[test]
fn the_optimum_of_a_frame_alone_is_the_same() {
    let of = |optimise: &str| small_reduced(&format!("lanes = 4\noptimise = \"{optimise}\"")).timeline;
    let (latency, interval) = (of("latency"), of("throughput"));
    assert_eq!(latency.latency_cycles, interval.latency_cycles);
    assert!(latency.interval_cycles >= interval.interval_cycles);
}
