//! A report as a page of text.

use std::fmt::Write;

use golden::metrics::ERROR_NAMES;

use crate::report::{Published, Report};
use crate::trial::Timing;

const LEFT: usize = 26;
const COLUMN: usize = 15;

/// The whole page, without colours: it reads the same in a file.
pub fn render(report: &Report) -> String {
    let mut page = Page::default();
    page.line(&report.design);
    page.line(&report.description);
    page.line(&format!("{} frames from {} · {}", report.frames, report.frames_from, report.simulator));
    speed(&mut page, report);
    streams(&mut page, report);
    registers(&mut page, report);
    accuracy(&mut page, report);
    verdict(&mut page, report);
    page.text
}

fn speed(page: &mut Page, report: &Report) {
    let published = report.published;
    let other = |show: &dyn Fn(Published) -> String| published.as_ref().copied().map_or_else(String::new, show);
    let heading = if published.is_some() { "published" } else { "" };
    page.heading("Speed and size", &["simulated", "predicted", heading]);
    let predicted = &report.predicted;
    let clock = |cycles: u64| decimals(cycles as f64 / report.clock_mhz, 2);
    page.row(
        "latency, cycles",
        &[
            grouped(report.latency_cycles),
            grouped(predicted.latency_cycles),
            other(&|them| grouped(them.latency_cycles)),
        ],
    );
    page.row(
        "latency, µs",
        &[
            clock(report.latency_cycles),
            clock(predicted.latency_cycles),
            other(&|them| decimals(1000.0 * them.milliseconds, 2)),
        ],
    );
    page.row("interval, cycles", &[grouped(report.interval_cycles), grouped(predicted.interval_cycles)]);
    page.row("interval, µs", &[clock(report.interval_cycles), clock(predicted.interval_cycles)]);
    let rate = |cycles: u64| grouped((report.clock_mhz * 1e6 / cycles.max(1) as f64) as u64);
    page.row("frames per second", &[rate(report.interval_cycles), rate(predicted.interval_cycles)]);
    page.row("lanes busy in SpMV", &[String::new(), format!("{} %", decimals(100.0 * report.lanes_busy, 1))]);
    page.row("DSP48E2", &[String::new(), grouped(predicted.dsp as u64), other(&|them| them.dsp.to_string())]);
    page.row("BRAM36", &[String::new(), decimals(predicted.bram36, 1), other(&|them| them.bram36.to_string())]);
    page.row("ROM, bits", &[String::new(), grouped(report.rom_bits)]);
    page.row("MACs a frame", &[String::new(), grouped(report.macs)]);
}

fn streams(page: &mut Page, report: &Report) {
    page.heading("RTL against the model", &["cycles", "words", "differ"]);
    for mode in &report.modes {
        let differ = if mode.bit_exact { "0, bit-exact".to_owned() } else { grouped(mode.mismatches) };
        page.row(mode.mode, &[grouped(mode.cycles), grouped(mode.words), differ]);
    }
    // A wrong word is mostly wrong in every mode: the first one's list says it all, `--json` has the others.
    if let Some(mode) = report.modes.iter().find(|mode| !mode.bit_exact) {
        page.line(&format!("  first differences, {}:", mode.mode));
        for mismatch in &mode.first_mismatches {
            page.line(&format!("    {mismatch}"));
        }
    }
}

fn registers(page: &mut Page, report: &Report) {
    let Some(registers) = &report.registers else { return };
    let wrong = registers.wrong.len();
    let differ = if wrong == 0 { "0, all right".to_owned() } else { grouped(wrong as u64) };
    page.heading("Register bank", &["accesses", "differ"]);
    page.row("AXI4-Lite", &[grouped(registers.accesses as u64), differ]);
    for line in &registers.wrong {
        page.line(&format!("    {line}"));
    }
}

fn accuracy(page: &mut Page, report: &Report) {
    page.heading("Error against f64", &["largest", "relative to"]);
    page.row("resultants", &[format!("{:.2e}", report.error.resultant_max), "|F_z|".to_owned()]);
    page.row("force field", &[format!("{:.2e}", report.error.field_max), "max |f_z|".to_owned()]);
    if let Some(errors) = &report.true_force_errors {
        page.heading("Error against true forces", &["largest, %", "std. error, %"]);
        for (name, spread) in ERROR_NAMES.iter().zip(errors.spreads()) {
            page.row(name, &[decimals(spread.max, 2), decimals(spread.standard_error, 2)]);
        }
    }
    page.heading("Frames by status", &["frames"]);
    for (name, count) in report.status_counts.present() {
        page.row(name, &[grouped(count as u64)]);
    }
}

fn verdict(page: &mut Page, report: &Report) {
    page.rule("");
    let times = report.published.map_or_else(String::new, |them| {
        let factor = 1000.0 * them.milliseconds / report.microseconds.latency;
        format!(", {} times as fast as published", grouped(factor.round() as u64))
    });
    if report.bit_exact {
        page.line(&format!("Bit-exact in all {} stream modes{times}.", report.modes.len()));
    } else {
        page.line(&format!("NOT BIT-EXACT: {} words differ from the model.", grouped(report.mismatches)));
    }
    if let [trace, gtkwave, surfer] = &report.traces[..] {
        page.line(&format!(
            "Waveforms in {}: gtkwave {}, or surfer --command-file {}",
            trace.display(),
            gtkwave.display(),
            surfer.display()
        ));
    }
    match report.timing {
        Timing::AsPredicted => {}
        Timing::WithinBound => {
            page.line("Zeros were passed over: the predicted cycles are those of a frame without any.");
        }
        Timing::Wrong => page.line("WRONG CYCLES: latency and interval are not the predicted ones."),
    }
}

#[derive(Default)]
struct Page {
    text: String,
}

impl Page {
    fn line(&mut self, text: &str) {
        self.text.push_str(text.trim_end());
        self.text.push('\n');
    }

    fn rule(&mut self, columns: &str) {
        let width = LEFT + 3 * COLUMN;
        let rest = width.saturating_sub(columns.chars().count());
        self.line(&format!("{columns}{}", "─".repeat(rest)));
    }

    fn heading(&mut self, title: &str, columns: &[&str]) {
        self.text.push('\n');
        self.row_with("", title, columns.iter().copied());
        self.rule("");
    }

    fn row(&mut self, name: &str, cells: &[String]) {
        self.row_with("  ", name, cells.iter().map(String::as_str));
    }

    fn row_with<'a>(&mut self, indent: &str, name: &str, cells: impl Iterator<Item = &'a str>) {
        let left = format!("{indent}{name}");
        let mut line = format!("{left:<LEFT$}");
        for cell in cells {
            // Writing to a String cannot fail.
            let _ = write!(line, "{cell:>COLUMN$}");
        }
        self.line(&line);
    }
}

/// `1234567` as `1,234,567`.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Rounded, the whole part grouped. For values that are not negative.
pub(crate) fn decimals(value: f64, places: usize) -> String {
    if !value.is_finite() {
        return "∞".to_owned();
    }
    let text = format!("{value:.places$}");
    match text.split_once('.') {
        Some((whole, fraction)) => format!("{}.{fraction}", whole.parse().map_or_else(|_| whole.to_owned(), grouped)),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 7_335_000].map(grouped), ["0", "999", "1,000", "7,335,000"]);
        assert_eq!(decimals(58680.0, 2), "58,680.00");
        assert_eq!(decimals(0.045, 1), "0.0");
        assert_eq!(decimals(f64::INFINITY, 1), "∞");
    }

    #[test]
    fn columns_are_aligned() {
        let mut page = Page::default();
        page.heading("Title", &["a", "b"]);
        page.row("µs", &["1".to_owned(), "2".to_owned()]);
        let ends: Vec<usize> = page.text.lines().skip(1).map(|line| line.chars().count()).collect();
        assert_eq!(ends, [LEFT + 2 * COLUMN, LEFT + 3 * COLUMN, LEFT + 2 * COLUMN]);
    }
}
