//! Nets that a logic analyser in the FPGA should see: marked in the core's Verilog where the design says `debug = true`.

use crate::plan::Plan;

/// Nets of the core in the order of the probes, each a wire with a line of its own. They are the handshakes of both
/// streams, the lanes' programs and results, answers and status.
const NETS: &str = "in_tvalid in_tready in_tlast frame_ready frame_done frame_flags start issued \
    result_y result_u result_g result_kept result_force result_last coefficients_complete answer_valid \
    out_tvalid out_tready out_tlast out_tdata";

/// What Vivado keeps a net for.
const MARK: &str = "(* mark_debug = \"true\" *)";
/// Samples that an analyser may have, powers of two between these.
const LEAST_SAMPLES: u64 = 1024;
const MOST_SAMPLES: u64 = 16_384;

/// Those of [`NETS`] that are zero in all of a plan's cycles. Of the others that tell results some bits may be.
pub fn always_zero(plan: &Plan) -> &'static [&'static str] {
    match (plan.channels() > 1, plan.has_field()) {
        (true, true) => &[],
        (true, false) => &["result_kept", "result_force"],
        (false, _) => &["result_force"],
    }
}

/// The net of [`NETS`] that a line declares, alone or with a value, unless it is one of `zero`.
fn declared(line: &str, zero: &[&str]) -> Option<&'static str> {
    let mut words = line.split_whitespace();
    if words.next()? != "wire" {
        return None;
    }
    let name = words.find(|word| *word != "signed" && !word.starts_with('['))?.trim_end_matches(';');
    NETS.split_whitespace().find(|net| *net == name && !zero.contains(net))
}

/// The nets of a core that are marked, or would be, in the order of the probes: all but those that are [`always_zero`].
pub fn nets(core: &str, zero: &[&str]) -> Vec<&'static str> {
    let there: Vec<&str> = core.lines().filter_map(|line| declared(line, zero)).collect();
    NETS.split_whitespace().filter(|net| there.contains(net)).collect()
}

/// The core with a mark above each of its [`nets`].
pub fn marked(core: &str, zero: &[&str]) -> String {
    let mark = |line: &str| match declared(line, zero) {
        Some(_) => format!("    {MARK}\n{line}\n"),
        None => format!("{line}\n"),
    };
    core.lines().map(mark).collect()
}

/// Samples of an analyser that sees a frame from its first beat to its answer, as far as there is memory for it.
pub fn samples(latency_cycles: u64) -> u64 {
    latency_cycles.next_power_of_two().clamp(LEAST_SAMPLES, MOST_SAMPLES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wires_of_these_names_are_marked_and_nothing_else() {
        let core = "module m (\n    output wire out_tdata_2\n);\n    wire in_tvalid;\n    wire [2:0] start;\n    \
                    wire signed [4:0] out_tdata; // words\n    reg issued;\n    assign in_tready = start[0];\n";
        assert_eq!(nets(core, &[]), ["in_tvalid", "start", "out_tdata"]);
        let marked = marked(core, &[]);
        assert_eq!(marked.matches(MARK).count(), 3);
        assert!(marked.contains("    (* mark_debug = \"true\" *)\n    wire [2:0] start;\n"), "{marked}");
        assert_eq!(marked.replace("    (* mark_debug = \"true\" *)\n", ""), core);
    }

    #[test]
    fn a_result_that_the_plan_does_not_have_has_no_probe() {
        let core = "    wire result_y;\n    wire [2:0] result_force;\n";
        assert_eq!(nets(core, &[]), ["result_y", "result_force"]);
        assert_eq!(nets(core, &["result_force"]), ["result_y"]);
        assert_eq!(marked(core, &["result_force"]).matches(MARK).count(), 1);
    }

    #[test]
    fn a_whole_frame_fits_unless_it_takes_too_much_memory() {
        assert_eq!([10, 1024, 1640, 9000, 70_000].map(samples), [1024, 1024, 2048, 16_384, 16_384]);
    }
}
