//! A report as a page of text. Without colours: it reads the same in a file.

use golden::metrics::{ERROR_NAMES, ErrorSummary};

use super::report::{Published, Report};
use crate::figures::{decimals, grouped};
use golden::table::{Table, rule};

/// Width of the names, and of each of the values beside them.
const NAMES: usize = 26;
const VALUES: usize = 15;
/// Columns of values: the same in every section, so that their rules have one length.
const COLUMNS: usize = 3;

/// The whole page.
pub fn render(report: &Report) -> String {
    let Report { design, description, frames, frames_from, simulator, .. } = report;
    let mut page = format!("{design}\n{description}\n{frames} frames from {frames_from} · {simulator}\n");
    speed(&mut page, report);
    streams(&mut page, report);
    registers(&mut page, report);
    accuracy(&mut page, report);
    verdict(&mut page, report);
    page
}

fn section(page: &mut String, title: &str, columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) {
    let blank = std::iter::repeat_n("", COLUMNS - columns.len());
    let header = [title].into_iter().chain(columns.iter().copied()).chain(blank);
    *page += "\n";
    *page += &Table::new(header).with(rows).text(NAMES, VALUES);
}

fn line(page: &mut String, text: &str) {
    *page += text.trim_end();
    page.push('\n');
}

fn row(name: &str, values: impl IntoIterator<Item = String>) -> Vec<String> {
    [name.to_owned()].into_iter().chain(values).collect()
}

fn speed(page: &mut String, report: &Report) {
    let published = report.published;
    let other = |show: &dyn Fn(Published) -> String| published.map_or_else(String::new, show);
    let predicted = &report.predicted;
    let clock = |cycles: u64| decimals(cycles as f64 / report.clock_mhz, 2);
    let rate = |cycles: u64| grouped((report.clock_mhz * 1e6 / cycles.max(1) as f64).round() as u64);
    let both = |simulated, predicted, show: &dyn Fn(u64) -> String| [show(simulated), show(predicted)];
    let latency = |show| both(report.latency_cycles, predicted.latency_cycles, show);
    let interval = |show| both(report.interval_cycles, predicted.interval_cycles, show);
    let with = |[simulated, predicted]: [String; 2], other| [simulated, predicted, other];
    let only = |predicted: String| [String::new(), predicted];
    let count = |count: Option<u32>| count.map_or_else(String::new, |count| count.to_string());
    let rows = [
        row("latency, cycles", with(latency(&grouped), other(&|them| grouped(them.latency_cycles)))),
        row("latency, µs", with(latency(&clock), other(&|them| decimals(1000.0 * them.milliseconds, 2)))),
        row("interval, cycles", interval(&grouped)),
        row("interval, µs", interval(&clock)),
        row("frames per second", interval(&rate)),
        row("lanes busy in SpMV", only(format!("{} %", decimals(100.0 * report.lanes_busy, 1)))),
        row(report.dsp_block, with(only(grouped(predicted.dsp as u64)), other(&|them| count(them.dsp)))),
        row("BRAM36", with(only(decimals(predicted.bram36, 1)), other(&|them| count(them.bram36)))),
        row("ROM, bits", only(grouped(report.rom_bits))),
        row("MACs a frame", only(grouped(report.macs))),
    ];
    let heading = if published.is_some() { "published" } else { "" };
    section(page, "Speed and size", &["simulated", "predicted", heading], rows);
    if let Some(them) = published {
        line(page, &format!("  published: {}", them.what));
    }
}

fn streams(page: &mut String, report: &Report) {
    let rows = report.modes.iter().map(|mode| {
        let differ = if mode.bit_exact { "0, bit-exact".to_owned() } else { grouped(mode.mismatches) };
        row(mode.mode, [grouped(mode.cycles), grouped(mode.words), differ])
    });
    section(page, "RTL against the model", &["cycles", "words", "differ"], rows);
    // A wrong word is mostly wrong in every mode: the first one's list says it all, `--json` has the others.
    if let Some(mode) = report.modes.iter().find(|mode| !mode.bit_exact) {
        line(page, &format!("  first differences, {}:", mode.mode));
        for mismatch in &mode.first_mismatches {
            line(page, &format!("    {mismatch}"));
        }
    }
}

fn registers(page: &mut String, report: &Report) {
    let Some(registers) = &report.registers else { return };
    let wrong = registers.wrong.len();
    let differ = if wrong == 0 { "0, all right".to_owned() } else { grouped(wrong as u64) };
    let rows = [row("AXI4-Lite", [grouped(registers.accesses as u64), differ])];
    section(page, "Register bank", &["accesses", "differ"], rows);
    for wrong in &registers.wrong {
        line(page, &format!("    {wrong}"));
    }
}

fn accuracy(page: &mut String, report: &Report) {
    let largest = |name: &str, error: f64, of: &str| row(name, [format!("{error:.2e}"), of.to_owned()]);
    let rows = [
        largest("resultants", report.error.resultant_max, "|F_z|"),
        largest("force field", report.error.field_max, "max |f_z|"),
    ];
    section(page, "Error against f64", &["largest", "relative to"], rows);
    if let Some(errors) = &report.true_force_errors {
        let spreads = ERROR_NAMES.iter().zip(errors.spreads());
        let papers = report.paper_errors.as_ref().map(ErrorSummary::spreads);
        let rows = spreads.enumerate().map(|(at, (name, spread))| {
            let paper = papers.iter().map(|papers| papers[at].max);
            row(name, [spread.max, spread.standard_error].into_iter().chain(paper).map(|of| decimals(of, 2)))
        });
        let headings = ["largest, %", "std. error, %", "paper's, %"];
        let shown = if papers.is_some() { 3 } else { 2 };
        section(page, "Error against true forces", &headings[..shown], rows);
        if papers.is_some() {
            line(page, "  paper's: largest error of its line search without a filter, in f64");
        }
    }
    let counts = report.status_counts.present();
    let rows = counts.into_iter().map(|(name, count)| row(&name, [grouped(count as u64)]));
    section(page, "Frames by status", &["frames"], rows);
}

fn verdict(page: &mut String, report: &Report) {
    *page += &rule(NAMES + COLUMNS * VALUES);
    let times = report.published.map_or_else(String::new, |them| {
        let factor = 1000.0 * them.milliseconds / report.microseconds.latency;
        format!(", {} times as fast as {}", grouped(factor.round() as u64), them.what)
    });
    if report.bit_exact {
        line(page, &format!("Bit-exact in all {} stream modes{times}.", report.modes.len()));
    } else {
        line(page, &format!("NOT BIT-EXACT: {} words differ from the model.", grouped(report.mismatches)));
    }
    if let [trace, gtkwave, surfer] = &report.traces[..] {
        line(
            page,
            &format!(
                "Waveforms in {}: gtkwave {}, or surfer --command-file {}",
                trace.display(),
                gtkwave.display(),
                surfer.display()
            ),
        );
    }
    if let [activity] = &report.traces[..] {
        line(page, &format!("Activity of the nets in {}, for vivado/power.tcl.", activity.display()));
    }
    if report.timing == "wrong" {
        line(page, "WRONG CYCLES: latency and interval are not the predicted ones.");
    }
}
