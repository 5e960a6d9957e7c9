//! The hard cases as cells, and as a page of text.

use golden::design::Estimator;
use serde::Serialize;

use super::cases::NOISE;
use super::judge::{Judged, Row};
use crate::markdown::Page;
use golden::table::{Cell, Table};
use testbench::figures::{or_dash, percent, scientific};

/// Style of what must not be.
const BAD: &str = "bad";

/// The cases about one thing, by one estimator.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// Its heading.
    pub title: String,
    /// Case by case.
    pub table: Table,
    /// Why rows have no hardware.
    pub refusals: Vec<String>,
}

/// Names of the columns of the line search's tables.
const LINE_HEADER: [&str; 21] = [
    "case",
    "cond C33",
    "cond AAᵀ",
    "backward f64",
    "f32",
    "fixed",
    "wide",
    "e_F∥ f64",
    "f32",
    "fixed",
    "e_Fz f64",
    "f32",
    "fixed",
    "field f32",
    "fixed",
    "wide",
    "at its µ f32",
    "fixed",
    "wide",
    "RTL",
    "status",
];
/// Names of the columns of the grid search's: its matrices are those of the line search, and so are its backward
/// errors, but for the gain.
const JOINT_HEADER: [&str; 11] = [
    "case",
    "e_F∥ f64",
    "fixed",
    "e_Fz f64",
    "fixed",
    "field fixed",
    "wide",
    "at its µ fixed",
    "wide",
    "RTL",
    "status",
];

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
    let of = |wanted: &'static str, estimator| {
        let own: Vec<&Row> = rows.iter().filter(|row| title(row) == wanted && row.estimator == estimator).collect();
        let is_line = estimator == Estimator::Line;
        let table = if is_line {
            Table::new(LINE_HEADER).with(own.iter().map(|row| line_cells(row)))
        } else {
            Table::new(JOINT_HEADER).with(own.iter().map(|row| joint_cells(row)))
        };
        (!own.is_empty()).then(|| Group {
            title: format!("{wanted}, {} search", if is_line { "line" } else { "grid" }),
            table: table.ending_in_words(),
            // The grid search needs the same matrices: it is refused for the same reason.
            refusals: if is_line { refusals(&own) } else { Vec::new() },
        })
    };
    titles
        .into_iter()
        .flat_map(|title| [Estimator::Line, Estimator::Joint].map(|estimator| of(title, estimator)))
        .flatten()
        .collect()
}

fn line_cells(row: &Row) -> Vec<Cell> {
    let all = [&row.f64, &row.f32, &row.fixed];
    let each = |value: fn(&Judged) -> Option<f64>, show: fn(f64) -> String| {
        all.map(|judged| or_dash(judged.as_ref().and_then(value), show))
    };
    let conditions = [row.condition_c33, row.condition_aat].map(|condition| or_dash(condition, scientific));
    let figures = conditions
        .into_iter()
        .chain(each(|judged| judged.backward, scientific))
        .chain([or_dash(row.wide.as_ref().and_then(|judged| judged.backward), scientific)])
        .chain(each(|judged| judged.tangential, percent))
        .chain(each(|judged| judged.normal, percent));
    cells(row, figures, &[&row.f32, &row.fixed, &row.wide])
}

fn joint_cells(row: &Row) -> Vec<Cell> {
    let each = |value: fn(&Judged) -> Option<f64>| {
        [&row.f64, &row.fixed].map(|judged| or_dash(judged.as_ref().and_then(value), percent))
    };
    let figures = each(|judged| judged.tangential).into_iter().chain(each(|judged| judged.normal));
    cells(row, figures, &[&row.fixed, &row.wide])
}

/// The case, its figures, errors of the field in these arithmetics, RTL, status.
fn cells(row: &Row, figures: impl Iterator<Item = String>, arithmetics: &[&Option<Judged>]) -> Vec<Cell> {
    let each = |value: fn(&Judged) -> Option<f64>| {
        arithmetics.iter().map(move |judged| or_dash(judged.as_ref().and_then(value), scientific))
    };
    let field = each(|judged| judged.against_f64).chain(each(|judged| judged.at_its_friction));
    let rtl = match row.rtl_is_model {
        Some(true) => "= model".into(),
        Some(false) => Cell::new("DIFFERS", BAD),
        None => "–".into(),
    };
    let mut cells: Vec<Cell> = [row.case.clone()].into_iter().chain(figures).chain(field).map(Cell::from).collect();
    cells.extend([rtl, status(row)]);
    cells
}

/// The status of the hardware's frames, or why there is none.
fn status(row: &Row) -> Cell {
    let words = |judged: &Judged| {
        let class = if judged.silent > 0 { BAD } else { "" };
        let mut words: Vec<String> = judged.status.iter().map(|(name, count)| format!("{count} {name}")).collect();
        if judged.silent > 0 {
            words.push(format!("{} SILENTLY WRONG", judged.silent));
        }
        Cell::new(words.join(", "), class)
    };
    match (&row.fixed, &row.refusal) {
        (Some(judged), _) => words(judged),
        (None, Some(_)) => Cell::new("refused", BAD),
        (None, None) => Cell::default(),
    }
}

/// The refusals of rows, each once.
fn refusals(rows: &[&Row]) -> Vec<String> {
    let mut reasons: Vec<String> =
        rows.iter().filter_map(|row| Some(format!("{}: {}", row.case, row.refusal.as_ref()?))).collect();
    reasons.dedup();
    reasons
}

/// The table as a page of Markdown, group by group; with the picture of depths, if it has a name.
pub fn markdown(rows: &[Row], plot: Option<&str>) -> String {
    let mut page = Page("# Hard cases\n".to_owned());
    page.line(
        "Written by `make corner-cases`; do not edit. Sensors, contacts and frames at the \
         limits, solved in f64, in float32, and by the hardware of 18 × 27 bits, without a filter; by the line \
         estimator and, in tables of their own, by the joint one. If nothing else is said: sensor 1, a Hertz contact \
         of 7 mm and 6 N in its middle, µ = 0.5, on a bonded layer of ν = 0.49, in 12 directions; under depth over \
         pitch 10 × 10 taxels of 4 × 4 mm and a contact of 10 mm; contacts of other kinds are 12 of each, anywhere within \
         the grid, of 3 N.",
    );
    page.line(
        "* **cond**: 2-norm condition numbers of C33 and A Aᵀ.\n\
         * **backward**: `|A f − b| / (|A| |f| + |b|)`, the largest.\n\
         * **e_F∥, e_Fz**: largest errors of the tangential and the normal resultant in % of the true normal force. \
         They are those of the estimator and the kernel where f64 has them too. Of the two contacts they are the errors of \
         each over its own normal force, the length of that along the surface, by f64 with `contacts = 2`. \
         All else in these rows is of hardware, which counts the contacts, marks the frame and solves it as one contact. \
         The forces of the two next to cancel each other.\n\
         * **wide**: the hardware of 27 × 35 bits, two multipliers a lane, with `scaling = \"per_frame\"`; its RTL is simulated \
         elsewhere. See [as exact as float32](choosing.md#as-exact-as-float32) for who wants it and where it ends.\n\
         * **field**: largest difference of a taxel's force to that of f64, relative to the largest |f_z|. **At its µ**: the \
         same where f64 takes the friction that was found, so that the estimator's own 16 fraction bits do not show.\n\
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
    if let Some(plot) = plot {
        page.line(&format!("![Errors over depth by pitch, with {} % of noise, in f64]({plot})", 100.0 * NOISE));
    }
    page.line(
        "A reading of the full scale is \"saturated\": nobody can tell it from a clipped one. So a converter that \
         clips is seen if `full_scale_pa` is its last value. What no status tells: dead taxels that the design does not \
         name, which look like taxels without stress, and offsets that nobody has tared: `sptfra check` finds both.",
    );
    page.line(
        "Rows with `scaling = \"per_frame\"` have that key of the design file: each frame is scaled by its own largest stress, and \
         a faint contact is solved as exactly as a strong one.",
    );
    page.line(
        "The grid search has the constants of the shipped designs where the sensor is theirs: sensor 1, and \
         h/s = 0.75, which is sensor 2. The others have those that `sptfra new` fits, the gain and two of friction, \
         also on layers of less than half a pitch by points, where it takes the kernel \"cell\": `sptfra calibrate` would \
         halve their errors. Backward errors and float32 are those of the matrices, which the \
         estimators share: see the line's tables.",
    );
    for group in groups(rows) {
        page.heading(&group.title);
        page.table(&group.table);
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
        "kind" => "Contacts of other kinds",
        "direction" => "Directions",
        "sensor" => "The sensor's errors",
        "range" => "Ends of the range",
        "frame" => "Frames without an answer",
        _ => "Depth over pitch",
    }
}

/// The tables for people.
pub fn text(rows: &[Row]) -> String {
    let texts = groups(rows).into_iter().map(|Group { title, table, refusals }| {
        let refused: String = refusals.iter().map(|refusal| format!("\nrefused, {refusal}\n")).collect();
        format!("{title}\n\n{}{refused}", table.text(0, 0))
    });
    texts.collect::<Vec<_>>().join("\n")
}
