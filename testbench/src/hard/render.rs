//! The hard cases as cells, and as a page of text.

use super::judge::{Judged, Row};
use crate::markdown::Page;

/// The rows of one table.
#[derive(Clone, Debug)]
pub struct Group {
    /// Its heading.
    pub title: String,
    /// Names of the columns.
    pub header: Vec<&'static str>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// Why rows have no hardware.
    pub refusals: Vec<String>,
}

/// Names of the columns of the line estimator's tables.
const LINE_HEADER: [&str; 15] = [
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
    "RTL",
    "status",
];
/// Names of the columns of the joint estimator's: its matrices are those of the line estimator, and so are its backward
/// errors, but for the gain.
const JOINT_HEADER: [&str; 8] = ["case", "e_F∥ f64", "fixed", "e_Fz f64", "fixed", "field", "RTL", "status"];

/// The tables: by what the cases are about, and for each estimator one.
pub fn groups(rows: &[Row]) -> Vec<Group> {
    let mut titles: Vec<&str> = rows.iter().map(title).collect();
    let mut seen = Vec::new();
    titles.retain(|title| {
        !seen.contains(title) && {
            seen.push(*title);
            true
        }
    });
    let of = |wanted: &'static str, estimator: &str| {
        let own: Vec<&Row> = rows.iter().filter(|row| title(row) == wanted && row.estimator == estimator).collect();
        let is_line = estimator == "line";
        (!own.is_empty()).then(|| Group {
            title: if is_line { wanted.to_owned() } else { format!("{wanted}, {estimator} estimator") },
            header: if is_line { LINE_HEADER.to_vec() } else { JOINT_HEADER.to_vec() },
            rows: own.iter().map(|row| if is_line { line_cells(row) } else { joint_cells(row) }).collect(),
            // The joint estimator needs the same matrices: it is refused for the same reason.
            refusals: if is_line { refusals(&own) } else { Vec::new() },
        })
    };
    titles.into_iter().flat_map(|title| ["line", "joint"].map(|estimator| of(title, estimator))).flatten().collect()
}

fn or_dash(value: Option<f64>, show: fn(f64) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), show)
}

fn line_cells(row: &Row) -> Vec<String> {
    let all = [&row.f64, &row.f32, &row.fixed];
    let each = |value: fn(&Judged) -> Option<f64>, show: fn(f64) -> String| {
        all.map(|judged| or_dash(judged.as_ref().and_then(value), show))
    };
    let mut cells = vec![row.case.clone()];
    cells.extend([row.condition_c33, row.condition_aat].map(|condition| or_dash(condition, scientific)));
    cells.extend(each(|judged| judged.backward, scientific));
    cells.extend(each(|judged| judged.tangential, percent));
    cells.extend(each(|judged| judged.normal, percent));
    cells.extend(hardware_cells(row));
    cells
}

fn joint_cells(row: &Row) -> Vec<String> {
    let each = |value: fn(&Judged) -> Option<f64>| {
        [&row.f64, &row.fixed].map(|judged| or_dash(judged.as_ref().and_then(value), percent))
    };
    let mut cells = vec![row.case.clone()];
    cells.extend(each(|judged| judged.tangential));
    cells.extend(each(|judged| judged.normal));
    cells.extend(hardware_cells(row));
    cells
}

/// Error of the field, RTL, status.
fn hardware_cells(row: &Row) -> [String; 3] {
    let field = or_dash(row.fixed.as_ref().and_then(|judged| judged.against_f64), scientific);
    let rtl = match row.rtl_is_model {
        Some(true) => "= model",
        Some(false) => "DIFFERS",
        None => "–",
    };
    [field, rtl.to_owned(), status(row)]
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

/// The refusals of rows, each once.
fn refusals(rows: &[&Row]) -> Vec<String> {
    let mut reasons: Vec<String> =
        rows.iter().filter_map(|row| Some(format!("{}: {}", row.case, row.refusal.as_ref()?))).collect();
    reasons.dedup();
    reasons
}

/// The table as a page of Markdown, group by group.
pub fn markdown(rows: &[Row]) -> String {
    let mut page = Page("# Hard cases\n".to_owned());
    page.line(
        "Written by `testbench hard --page docs/hard-cases.md`; do not edit. Sensors, contacts and frames at the \
         limits, solved in f64, in float32, and by the hardware of 18 × 27 bits, without a filter; by the line \
         estimator and, in tables of their own, by the joint one. If nothing else is said: sensor 1, a Hertz contact \
         of 7 mm and 6 N in its middle, µ = 0.5, on a bonded layer of ν = 0.49, in 12 directions; under depth over \
         pitch 10 × 10 taxels of 4 × 4 mm and a contact of 10 mm.",
    );
    page.line(
        "* **cond**: 2-norm condition numbers of C33 and A Aᵀ.\n\
         * **backward**: `|A f − b| / (|A| |f| + |b|)`, the largest.\n\
         * **e_F∥, e_Fz**: largest errors of the tangential and the normal resultant in % of the true normal force. \
         They are those of the estimator and the kernel where f64 has them too.\n\
         * **field**: largest difference of a taxel's force, fixed point to f64, relative to the largest |f_z|.\n\
         * **RTL**: whether the RTL, all frames of the case simulated in all stream modes, gives the integer model's \
         words, from which the figures of the hardware are, in the cycles of the plan. The command would fail else.\n\
         * **status**: of the hardware's frames. No case has a NaN, an overflow, or a resultant beyond four times what \
         the stress would mean as a pressure, without a bit that says so: the command would fail, and so would a test.",
    );
    page.line(
        "Sensors of h/s ≥ 1.5 want `regularisation`; here `{ noise = 0.002 }`. It leaves shallow sensors as they are \
         and keeps deep ones within a few percent, where without it 0.2 % of noise makes forces of several times the \
         true ones; a design as ill-conditioned as that is refused.",
    );
    page.line(
        "A reading of the full scale is \"saturated\": nobody can tell it from a clipped one. So a converter that \
         clips is seen if `full_scale_pa` is its last value. What no status tells: dead taxels, which look like taxels \
         without stress.",
    );
    page.line(
        "The joint estimator has the constants of the shipped designs where the sensor is theirs: sensor 1, and \
         h/s = 0.75, which is sensor 2. The others have those that `hdl-gen new` fits, the gain and two of friction: \
         `golden calibrate` would halve their errors. Backward errors and float32 are those of the matrices, which the \
         estimators share: see the line's tables.",
    );
    for group in groups(rows) {
        page.heading(&group.title);
        page.table(&group.header, group.rows.into_iter());
        for refusal in group.refusals {
            page.line(&format!("Refused, {refusal}."));
        }
    }
    page.0
}

/// What a row is about, for a heading.
fn title(row: &Row) -> &'static str {
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

/// The tables for people.
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for Group { title, header, rows, refusals } in groups(rows) {
        let header: Vec<String> = header.into_iter().map(str::to_owned).collect();
        let lines: Vec<&Vec<String>> = std::iter::once(&header).chain(&rows).collect();
        let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or_default();
        let widths: Vec<usize> = (0..header.len()).map(width).collect();
        if !text.is_empty() {
            text.push('\n');
        }
        text += &(title + "\n\n");
        for line in &lines {
            let mut row = String::new();
            for (column, (cell, &width)) in line.iter().zip(&widths).enumerate() {
                let padding = " ".repeat(width - cell.chars().count());
                let left = column == 0 || column == header.len() - 1;
                let [first, second] = if left { [cell.as_str(), &padding] } else { [padding.as_str(), cell] };
                row.extend([first, second, "  "]);
            }
            text += row.trim_end();
            text.push('\n');
        }
        for refusal in refusals {
            text += &("\nrefused, ".to_owned() + &refusal + "\n");
        }
    }
    text
}

fn scientific(value: f64) -> String {
    if value != 0.0 && !(0.1..1000.0).contains(&value.abs()) { format!("{value:.0e}") } else { format!("{value:.1}") }
}

fn percent(value: f64) -> String {
    if value < 1000.0 { format!("{value:.1}") } else { format!("{value:.0e}") }
}
