//! What the emitted Verilog checks of itself in simulation: the schedule's promises. A broken schedule is noticed where
//! it breaks, not only by the words that come out.

use crate::support::faults::{broken, some_faults};
use crate::support::{by_plan, in_parallel, planned, shipped};
use golden::design::{Design, Estimator, Outputs, PlanKind};
use testbench::co_simulation::timeout;
use testbench::stream::{Traffic, exchange};

/// Frames that are sent.
const FRAMES: usize = 8;

/// What the simulation says of a design with a fault.
fn said_of(design: &Design, module: &str, from: &str, to: &str) -> String {
    let plan = planned(design);
    let built = broken(&plan, module, from, to);
    let taxels = plan.taxels();
    let packet =
        |frame: usize| (0..taxels).map(|taxel| (-1e4 - 50.0 * ((taxel * frame) % 7) as f32).to_bits()).collect();
    let packets: Vec<Vec<u32>> = (0..FRAMES).map(packet).collect();
    let traffic = Traffic::new(&packets, timeout(&plan));
    let mut core = built.load(1).expect("loaded");
    exchange(&mut core, &traffic, |_| ()).err().map_or_else(String::new, |error| error.to_string())
}

/// A register's assignment that comes a cycle late.
fn late(register: &str, value: &str) -> String {
    format!(" begin : late reg held; {register} <= held; held = {value}; end")
}

#[test]
fn a_broken_schedule_stops_the_simulation_where_it_breaks() {
    let paper = || by_plan(shipped("small"), PlanKind::Paper, Outputs::Field);
    let reduced = || by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    let resultants = || by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants);
    let joint = || {
        let mut design = reduced();
        design.algorithm.estimator = Estimator::Joint;
        design
    };
    let late_settled = late("settled", "(state == MEASURE)");
    let late_centroid = late("done", "divide_done");
    let cases = [
        // The collector does not keep up with the lanes.
        (paper(), "sptfra_spmv_collector", "slot_known && !separated", "slot_known && separated", "spmv_pe.v"),
        (reduced(), "sptfra_spmv_collector", "slot_known && !separated", "slot_known && separated", "spmv_pe.v"),
        // A program begins before the one before has put out its results.
        (
            reduced(),
            "sptfra_program_scheduler",
            "wire free = !busy || issued;",
            "wire free = 1'b1;",
            "spmv_collector.v",
        ),
        // The line does not take the sums.
        (reduced(), "sptfra_line", "sums_take <= (state == SUMS) && sums_complete;", "sums_take <= 1'b0;", "_co.v"),
        (paper(), "sptfra_line", "sums_take <= (state == SUMS) && sums_complete;", "sums_take <= 1'b0;", "_co.v"),
        // Op and the estimator take more or fewer cycles than the plan says.
        (reduced(), "sptfra_summary", "(step == 6'd27) begin", "(step == 6'd28) begin", "sptfra_check_latency.v"),
        (reduced(), "sptfra_search", "wait_count == 2'd3", "wait_count == 2'd2", "sptfra_check_latency.v"),
        // A block takes longer than the plan says.
        (
            reduced(),
            "sptfra_unfold",
            "STAGES = (CHANNELS == 4) ? 5 : 1;",
            "STAGES = (CHANNELS == 4) ? 6 : 2;",
            "check_latency.v",
        ),
        (
            paper(),
            "sptfra_unfold",
            "STAGES = (CHANNELS == 4) ? 5 : 1;",
            "STAGES = (CHANNELS == 4) ? 6 : 2;",
            "check_latency.v",
        ),
        (
            reduced(),
            "sptfra_we",
            "assign write_next = valid[3] || valid[4];",
            "assign write_next = valid[3];",
            "check_latency.v",
        ),
        (paper(), "sptfra_we", "write_valid <= taxel_y;", "write_valid <= taxel_y && !write_valid;", "check_latency.v"),
        (reduced(), "sptfra_co", "(sums_count == 3'd6);", "(sums_count == 3'd5);", "check_latency.v"),
        (paper(), "sptfra_coefficients", "is_g_3 <= is_g_2;", "is_g_3 <= is_g_1;", "check_latency.v"),
        (
            reduced(),
            "sptfra_spmv_collector",
            "shifted_valid <= taken_valid;",
            "shifted_valid <= taking;",
            "check_latency.v",
        ),
        (reduced(), "sptfra_line", "(step == 4'd14)", "(step == 4'd15)", "check_latency.v"),
        (joint(), "sptfra_cean", "settled <= (state == MEASURE);", &late_settled, "check_latency.v"),
        (joint(), "sptfra_grid_search", "row_valid <= giving;", "row_valid <= lasts[STAGES];", "check_latency.v"),
        (joint(), "sptfra_grid_centroid", "done <= divide_done;", &late_centroid, "check_latency.v"),
        (joint(), "sptfra_friction", "running && (step == 5'd17);", "running && (step == 5'd16);", "check_latency.v"),
        (shipped("sensor1-fast"), "sptfra_network", "== SUMMING[4:0])", "== SUMMING[4:0] + 5'd1)", "check_latency.v"),
        (
            reduced(),
            "sptfra_fold",
            "lasts[READ_TO_WRITTEN] && advance",
            "lasts[READ_TO_WRITTEN-1] && advance",
            "check_latency.v",
        ),
        // More frames are begun than Op has places for.
        (resultants(), "sptfra_program_scheduler", "(u_held != 2'd2) && ", "", "_co.v"),
    ];
    let cases = some_faults(cases, |(_, module, from, ..)| (module, from));
    let said = in_parallel(&cases, |(design, module, from, to, _)| said_of(design, module, from, to));
    for ((design, module, from, _, place), said) in cases.iter().zip(said) {
        let stopped = said.contains(place) && said.contains("$stop");
        assert!(stopped, "{}, {module} without {from:?}: {said:?}", design.name);
    }
}
