//! The hard cases as cells, and as a page of text.

use super::judge::{Judged, Row};
use crate::markdown::Page;

/// Names of the columns of [`cells`].
pub const HEADER: [&str; 14] = [
    "case",
    "cond C33",
    "cond AAᵀ",
    "backward f64",
    "f32",
    "fixed",
    "e_F∥ f64",
    "f32",
    "fixed",
    "e_Fz f64",
    "f32",
    "fixed",
    "field",
    "status",
];

/// A row's cells.
pub fn cells(row: &Row) -> [String; HEADER.len()] {
    let all = [&row.f64, &row.f32, &row.fixed];
    let each = |value: fn(&Judged) -> Option<f64>, show: fn(f64) -> String| {
        all.map(|judged| judged.as_ref().and_then(value).map_or_else(|| "–".to_owned(), show))
    };
    let [b64, b32, b_fixed] = each(|judged| judged.backward, scientific);
    let [t64, t32, t_fixed] = each(|judged| judged.tangential, percent);
    let [n64, n32, n_fixed] = each(|judged| judged.normal, percent);
    let condition = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), scientific);
    let field = row.fixed.as_ref().and_then(|judged| judged.against_f64).map_or_else(|| "–".to_owned(), scientific);
    let [c33, aat] = [row.condition_c33, row.condition_aat].map(condition);
    [row.case.clone(), c33, aat, b64, b32, b_fixed, t64, t32, t_fixed, n64, n32, n_fixed, field, status(row)]
}

/// The status of the hardware's frames, or why there is none.
fn status(row: &Row) -> String {
    let words = |judged: &Judged| {
        let mut words: Vec<String> = judged.status.iter().map(|(name, count)| format!("{count} {name}")).collect();
        if judged.silent > 0 {
            words.push(format!("{} SILENTLY WRONG", judged.silent));
        }
        words.join(", ")
    };
    match (&row.fixed, &row.refusal) {
        (Some(judged), _) => words(judged),
        (None, Some(_)) => "refused".to_owned(),
        (None, None) => String::new(),
    }
}

/// The refusals of a table, each once.
pub fn refusals(rows: &[Row]) -> Vec<String> {
    let mut reasons: Vec<String> =
        rows.iter().filter_map(|row| Some(format!("{}: {}", row.case, row.refusal.as_ref()?))).collect();
    reasons.dedup();
    reasons
}

/// The table as a page of Markdown, group by group.
pub fn markdown(rows: &[Row]) -> String {
    let mut page = Page("# Hard cases\n".to_owned());
    page.line(
        "Written by `testbench hard --page docs/hard-cases.md`; do not edit. Sensors, contacts and frames at the limits, \
         solved in f64, in float32, and by the integer model of the hardware (18 × 27 bits; the tests run \
         frames of every case of sensor 1, and of a deep sensor, through the RTL too). The estimator is the line \
         estimator, without a filter. If nothing else is said: sensor 1, a Hertz contact of 7 mm and 6 N in its middle, \
         µ = 0.5, on a bonded layer of ν = 0.49, in 12 directions; under depth over pitch 10 × 10 taxels of 4 × 4 mm and \
         a contact of 10 mm.",
    );
    page.line(
        "* **cond**: 2-norm condition numbers of C33 and A Aᵀ.\n\
         * **backward**: `|A f − b| / (|A| |f| + |b|)`, the largest.\n\
         * **e_F∥, e_Fz**: largest errors of the tangential and the normal resultant in % of the true normal force. \
         They are those of the estimator and the kernel where f64 has them too.\n\
         * **field**: largest difference of a taxel's force, fixed point to f64, relative to the largest |f_z|.\n\
         * **status**: of the hardware's frames. No case has a NaN, an overflow, or a resultant beyond four times what \
         the stress would mean as a pressure, without a bit that says so: the command would fail, and so would a test.",
    );
    page.line(
        "Sensors of h/s ≥ 1.5 want `regularisation`; here `{ noise = 0.002 }`. It leaves shallow sensors as they are and \
         keeps deep ones within a few percent, where without it 0.2 % of noise makes forces of several times the true \
         ones; a design as ill-conditioned as that is refused.",
    );
    page.line(
        "Two things no status tells: a taxel that reads exactly the full scale is within it, so that a converter that \
         clips is seen only if `full_scale_pa` is at least one of its steps below its end; and dead taxels look like \
         taxels without stress.",
    );
    for group in rows.chunk_by(|one, other| title(one) == title(other)) {
        page.heading(title(&group[0]));
        page.table(&HEADER, group.iter().map(|row| cells(row).to_vec()));
        for refusal in refusals(group) {
            page.line(&format!("Refused, {refusal}."));
        }
    }
    page.0
}

/// What a row is about, for a heading.
pub fn title(row: &Row) -> &'static str {
    match row.group {
        "size" => "Size",
        "contact" => "Contacts",
        "direction" => "Directions",
        "sensor" => "The sensor's errors",
        "range" => "Ends of the range",
        "frame" => "Frames without an answer",
        _ => "Depth over pitch",
    }
}

/// The table for people.
pub fn text(rows: &[Row]) -> String {
    let lines: Vec<[String; HEADER.len()]> =
        std::iter::once(HEADER.map(str::to_owned)).chain(rows.iter().map(cells)).collect();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..HEADER.len()).map(width).collect();
    let mut text = String::new();
    for line in &lines {
        let mut row = String::new();
        for (column, (cell, &width)) in line.iter().zip(&widths).enumerate() {
            let padding = " ".repeat(width - cell.chars().count());
            let left = column == 0 || column == HEADER.len() - 1;
            let [first, second] = if left { [cell.as_str(), &padding] } else { [padding.as_str(), cell] };
            row.extend([first, second, "  "]);
        }
        text += row.trim_end();
        text.push('\n');
    }
    for refusal in refusals(rows) {
        text += &("\nrefused, ".to_owned() + &refusal + "\n");
    }
    text
}

fn scientific(value: f64) -> String {
    if value != 0.0 && !(0.1..1000.0).contains(&value.abs()) { format!("{value:.0e}") } else { format!("{value:.1}") }
}

fn percent(value: f64) -> String {
    if value < 1000.0 { format!("{value:.1}") } else { format!("{value:.0e}") }
}
