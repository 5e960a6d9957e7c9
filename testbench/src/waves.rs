//! Saved views beside a trace: clock, handshakes, frames and programs, for `GTKWave` and for Surfer.
//!
//! A view names a signal only if the emitted Verilog declares it, so that it fits every design.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use golden::output::{OutputError, write_whole};

use crate::verilate::RtlSources;

/// The simulation's root scope.
const ROOT: &str = "top";
/// Trace flags of `GTKWave`: a comment, a bit, a hexadecimal vector.
const COMMENT: &str = "@200";
const BIT: &str = "@28";
const VECTOR: &str = "@22";

/// Signals of the top, by heading, in the order of the page.
const OF_TOP: [(&str, &str); 4] = [
    ("clock", "aclk aresetn"),
    ("stream_in", "s_axis_tvalid s_axis_tready s_axis_tlast s_axis_tdata"),
    ("stream_out", "m_axis_tvalid m_axis_tready m_axis_tlast m_axis_tdata"),
    (
        "registers",
        "s_axi_ctrl_awvalid s_axi_ctrl_awready s_axi_ctrl_awaddr s_axi_ctrl_wvalid s_axi_ctrl_wready s_axi_ctrl_wdata \
         s_axi_ctrl_bvalid s_axi_ctrl_bready s_axi_ctrl_arvalid s_axi_ctrl_arready s_axi_ctrl_araddr s_axi_ctrl_rvalid \
         s_axi_ctrl_rready s_axi_ctrl_rdata interrupt resetting discarding frames_in frames_out frames_bad",
    ),
];

/// Signals of the core; each design has some of them.
const OF_CORE: [(&str, &str); 3] = [
    (
        "frames",
        "frame_ready frame_done frame_bad_length frame_not_finite direction_valid coefficients_complete sums_complete \
         sums_take answer_valid answer_take u_released friction_known field_complete field_release",
    ),
    ("programs", "start issued bank"),
    (
        "results",
        "stress_valid result_y result_u result_g result_kept result_force result_row result_last taxel_y taxel_u \
         taxel_force taxel_row weights_valid we_write co_write",
    ),
];

/// A signal of a view.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Signal {
    /// With its scopes, dots between.
    path: String,
    /// `[31:0]`, or nothing for a bit.
    range: String,
}

/// Writes `TRACE.gtkw` and `TRACE.sucl` in place of the trace's ending; their paths.
///
/// # Errors
/// [`OutputError`] if a file cannot be written.
pub fn write(trace: &Path, sources: &RtlSources) -> Result<[PathBuf; 2], OutputError> {
    let groups = groups(sources);
    let name = trace.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let [gtkwave, surfer] = ["gtkw", "sucl"].map(|ending| trace.with_extension(ending));
    write_whole(&gtkwave, render_gtkwave(&name, &groups).as_bytes())?;
    write_whole(&surfer, render_surfer(&name, &groups).as_bytes())?;
    Ok([gtkwave, surfer])
}

/// The signals that the design has, by heading.
fn groups(sources: &RtlSources) -> Vec<(&'static str, Vec<Signal>)> {
    let text = |module: &str| {
        let file = sources.files.get(&format!("rtl/{module}.v"));
        file.map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    };
    let top = &sources.top;
    let outside = text(top).unwrap_or_default();
    // With a register bank the core is an instance in the top.
    let (inside, scope) = match text(&format!("{top}_core")) {
        Some(text) => (text, format!("{ROOT}.{top}.core")),
        None => (outside.clone(), format!("{ROOT}.{top}")),
    };
    let outer = format!("{ROOT}.{top}");
    let all = [(outside, outer, &OF_TOP[..]), (inside, scope, &OF_CORE[..])];
    let mut groups = Vec::new();
    for (text, scope, headings) in all {
        let declared = declared(&text);
        for &(heading, names) in headings {
            let found = names.split_whitespace().filter_map(|name| {
                let range = declared.get(name)?.clone();
                Some(Signal { path: format!("{scope}.{name}"), range })
            });
            let signals: Vec<Signal> = found.collect();
            if !signals.is_empty() {
                groups.push((heading, signals));
            }
        }
    }
    groups
}

/// Name and range of every net, register and port that a line declares, as the emitter prints them. Ranges
/// are numbers, as in a trace; one that is not to be known leaves its signal out.
fn declared(verilog: &str) -> BTreeMap<&str, String> {
    let mut found = BTreeMap::new();
    let mut constants = BTreeMap::new();
    for line in verilog.lines() {
        let mut words = line.split_whitespace().peekable();
        if words.next_if_eq(&"localparam").is_some() {
            if let (Some(name), Some("="), Some(text)) = (words.next(), words.next(), words.next()) {
                constants.extend(value(text.trim_end_matches(';'), &constants).map(|value| (name, value)));
            }
            continue;
        }
        let is_port = words.next_if(|word| ["input", "output"].contains(word)).is_some();
        if words.next_if(|word| ["wire", "reg"].contains(word)).is_none() {
            continue;
        }
        words.next_if_eq(&"signed");
        let range = words.next_if(|word| word.starts_with('[')).map(|range| numbers(range, &constants));
        let Some(range) = range.unwrap_or_else(|| Some(String::new())) else { continue };
        // Nets of one kind may share a line; a port's comma ends its own.
        for name in words {
            found.insert(name.trim_end_matches([',', ';']), range.clone());
            if is_port || !name.ends_with(',') {
                break;
            }
        }
    }
    found
}

/// A range such as `[WIDTH-1:0]` in numbers.
fn numbers(range: &str, constants: &BTreeMap<&str, u64>) -> Option<String> {
    let (high, low) = range.strip_prefix('[')?.strip_suffix(']')?.split_once(':')?;
    Some(format!("[{}:{}]", value(high, constants)?, value(low, constants)?))
}

/// A sum of products of numbers and constants.
fn value(text: &str, constants: &BTreeMap<&str, u64>) -> Option<u64> {
    if let Some(at) = text.rfind(['+', '-']) {
        let (left, right) = (value(&text[..at], constants)?, value(&text[at + 1..], constants)?);
        return if text[at..].starts_with('+') { left.checked_add(right) } else { left.checked_sub(right) };
    }
    match text.split_once('*') {
        Some((left, right)) => value(left, constants)?.checked_mul(value(right, constants)?),
        None => text.parse().ok().or_else(|| constants.get(text).copied()),
    }
}

fn render_gtkwave(trace: &str, groups: &[(&str, Vec<Signal>)]) -> String {
    let mut lines = vec![format!("[dumpfile] \"{trace}\""), "[timestart] 0".to_owned(), "[size] 1600 900".to_owned()];
    for (heading, signals) in groups {
        lines.extend([COMMENT.to_owned(), format!("-{heading}")]);
        for Signal { path, range } in signals {
            let flag = if range.is_empty() { BIT } else { VECTOR };
            lines.extend([flag.to_owned(), format!("{path}{range}")]);
        }
    }
    lines.join("\n") + "\n"
}

fn render_surfer(trace: &str, groups: &[(&str, Vec<Signal>)]) -> String {
    let mut lines = vec![format!("load_file {trace}")];
    for (heading, signals) in groups {
        lines.push(format!("divider_add {heading}"));
        lines.extend(signals.iter().map(|signal| format!("variable_add {}", signal.path)));
    }
    lines.push("zoom_fit".to_owned());
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_found_with_their_ranges() {
        let text = "    input  wire [31:0] a,\n    output wire        b\n    wire signed [26:0] c;\n    reg d;\n\
                    \x20   wire e = !d;\n    assign f = e;\n    // wire g;\n";
        let found = declared(text);
        let expected = [("a", "[31:0]"), ("b", ""), ("c", "[26:0]"), ("d", ""), ("e", "")];
        assert_eq!(found.into_iter().collect::<Vec<_>>(), expected.map(|(name, range)| (name, range.to_owned())));
    }

    #[test]
    fn ranges_are_those_of_the_trace() {
        let text = "localparam WIDTH = 5; // bits\nlocalparam ALL = 4*WIDTH;\nwire [WIDTH-1:0] a;\nreg [ALL+2:0] b;\n\
                    wire [9*40-1:0] c;\nwire [OTHER-1:0] d;\n";
        let expected = [("a", "[4:0]"), ("b", "[22:0]"), ("c", "[359:0]")];
        let found = declared(text);
        assert_eq!(found.into_iter().collect::<Vec<_>>(), expected.map(|(name, range)| (name, range.to_owned())));
    }

    #[test]
    fn only_what_the_design_has_is_named() {
        let file = |text: &str| text.as_bytes().to_vec();
        let files = [
            ("rtl/t.v".to_owned(), file("module t (\n    input wire aclk,\n    output wire interrupt\n);\n")),
            ("rtl/t_core.v".to_owned(), file("    wire [2:0] start;\n")),
        ];
        let sources = RtlSources { top: "t".to_owned(), files: files.into_iter().collect() };
        let groups = groups(&sources);
        let gtkwave = "[dumpfile] \"t.vcd\"\n[timestart] 0\n[size] 1600 900\n@200\n-clock\n@28\ntop.t.aclk\n@200\n\
                       -registers\n@28\ntop.t.interrupt\n@200\n-programs\n@22\ntop.t.core.start[2:0]\n";
        assert_eq!(render_gtkwave("t.vcd", &groups), gtkwave);
        let surfer = "load_file t.vcd\ndivider_add clock\nvariable_add top.t.aclk\ndivider_add registers\n\
                      variable_add top.t.interrupt\ndivider_add programs\nvariable_add top.t.core.start\nzoom_fit\n";
        assert_eq!(render_surfer("t.vcd", &groups), surfer);
    }
}
