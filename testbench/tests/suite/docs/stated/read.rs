//! Reading what a page states.

use std::fs;
use std::path::PathBuf;

use golden::design::{Design, Filter};
use serde_json::Value;

use super::{NO_DESIGNS, OF_OTHERS, VARIED};
use crate::support::{shipped, workspace};

/// Names of figures in sentences.
const NAMES: [&str; 7] = ["latency", "interval", "rate", "us", "dsp", "bram", "mW"];

/// A figure of a design by the name that sentences have for it.
pub fn figure(predicted: &Value, name: &str) -> f64 {
    let of = |value: &Value| value.as_f64().expect("a number");
    let [latency, interval] = ["latency_cycles", "interval_cycles"].map(|key| of(&predicted[key]));
    let fabric_nj = of(&predicted["energy_estimate"]["fabric_nj"]);
    match name {
        "latency" => latency,
        "us" => latency / MHZ,
        "interval" => interval,
        "rate" => 1e6 * MHZ / interval,
        "dsp" => of(&predicted["dsp"]),
        "bram" => of(&predicted["bram36"]),
        // The latter at a thousand frames a second.
        "µJ" | "mW" => fabric_nj / 1e3,
        "W" => 1e-9 * fabric_nj * 1e6 * MHZ / interval,
        other => unreachable!("no figure is called {other}"),
    }
}

/// What all pages assume, and all shipped designs say.
const MHZ: f64 = 125.0;

/// The figure that a column of a table states, by its header.
fn of_column(header: &str) -> Option<&'static str> {
    Some(match header {
        "latency" | "latency, 16 lanes" => "latency",
        "at 125 MHz" => "us",
        "interval" => "interval",
        "frames/s" | "frames a second at 125 MHz" => "rate",
        "DSP" => "dsp",
        "RAMB36" | "BRAM" => "bram",
        "energy a frame, estimated" => "µJ",
        "dynamic power at its full rate, 125 MHz" => "W",
        _ => return None,
    })
}

/// The number that a text begins with and how many digits it has after the point, and its length in the text.
fn number_of_length(text: &str) -> Option<((f64, usize), usize)> {
    let end = text.find(|letter: char| !letter.is_ascii_digit() && !matches!(letter, ',' | '.')).unwrap_or(text.len());
    let digits = text[..end].trim_end_matches([',', '.']);
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some(((digits.replace(',', "").parse().ok()?, decimals), digits.len()))
}

/// Whether a stated number is the figure, rounded to the digits that it has.
pub fn is((stated, decimals): (f64, usize), found: f64) -> bool {
    (stated - found).abs() <= 0.5001 * 10f64.powi(-(decimals as i32))
}

/// A design that a page states figures of: where, whether it is as the place says, and of which figures.
pub struct Claim {
    pub place: String,
    pub design: Design,
    /// By their names, as they are stated.
    pub figures: Vec<(&'static str, (f64, usize))>,
}

pub fn pages() -> Vec<(String, String)> {
    let docs = fs::read_dir(workspace("docs")).expect("docs").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect();
    files.push(workspace("README.md"));
    files.sort();
    let name = |path: &PathBuf| path.file_name().expect("a name").to_string_lossy().into_owned();
    files.iter().map(|path| (name(path), fs::read_to_string(path).expect("readable"))).collect()
}

fn cells(row: &str) -> Vec<&str> {
    row.trim().trim_matches('|').split('|').map(str::trim).collect()
}

/// The shipped design that a cell names: ``…`sensor1-fast`…``, or its file.
fn named(cell: &str) -> Option<Design> {
    let words = cell.split('`').skip(1).step_by(2);
    let stems = words.map(|word| word.trim_start_matches("designs/").trim_end_matches(".toml"));
    stems.filter(|stem| workspace(&format!("designs/{stem}.toml")).is_file()).map(shipped).next()
}

fn filter(text: &str) -> Filter {
    let value = text.split(" = ").nth(1).and_then(|value| value.parse::<f64>().ok());
    match (text.get(..2), value) {
        (Some("f1"), Some(l)) => Filter::F1 { l: l as usize },
        (Some("f2"), Some(p)) => Filter::F2 { p },
        _ => Filter::None,
    }
}

fn of_row(page: &str, header: &[&str], row: &str) -> Vec<Claim> {
    let cells = cells(row);
    let place = format!("{page}: {row}");
    let varied =
        VARIED.iter().find(|(file, begin, ..)| *file == page && row.trim_start_matches(['|', ' ']).starts_with(begin));
    let design = match varied {
        Some((_, _, stem, change)) => {
            let mut design = shipped(stem);
            change(&mut design);
            design
        }
        None => named(cells[0]).unwrap_or_else(|| panic!("{place}: name the design that these figures are of")),
    };
    let columns = || header.iter().zip(&cells);
    let stated = |cell: &str| {
        let (number, _) =
            number_of_length(cell.trim_matches('*')).unwrap_or_else(|| panic!("{place}: {cell} is no figure"));
        number
    };
    if header.contains(&"32 bits") {
        // Latency / interval, DSP, RAMB36, for each width of the streams.
        let widths = columns().filter_map(|(header, cell)| Some((header.strip_suffix(" bits")?.parse().ok()?, cell)));
        let claims = widths.map(|(stream_bits, cell): (u32, _)| {
            let mut design = design.clone();
            design.hardware.stream_bits = stream_bits;
            let parts = cell.split([' ', '/']).filter(|part| !part.is_empty());
            let figures = ["latency", "interval", "dsp", "bram"].into_iter().zip(parts.map(stated)).collect();
            Claim { place: place.clone(), design, figures }
        });
        return claims.collect();
    }
    let mut design = design;
    for (header, cell) in columns() {
        match *header {
            "filter" => design.algorithm.filter = filter(cell),
            "lanes" => assert!(is(stated(cell), design.hardware.lanes as f64), "{place}: other lanes"),
            _ => (),
        }
    }
    let figures = columns().filter_map(|(header, cell)| Some((of_column(header)?, stated(cell)))).collect();
    vec![Claim { place, design, figures }]
}

/// All rows of a page's tables that state figures of designs.
pub fn of_tables(page: &str, text: &str) -> Vec<Claim> {
    let mut claims = Vec::new();
    let lines: Vec<&str> = text.lines().collect();
    for at in (1..lines.len()).filter(|&at| lines[at].starts_with("|---")) {
        let header = cells(lines[at - 1]);
        let states = header.iter().any(|header| of_column(header).is_some()) || header.contains(&"32 bits");
        if !states || NO_DESIGNS.iter().any(|first| header[0].starts_with(first)) {
            continue;
        }
        let rows = lines[at + 1..].iter().take_while(|row| row.starts_with('|'));
        let ours = rows.filter(|row| !OF_OTHERS.iter().any(|begin| row.starts_with(&format!("| {begin}"))));
        claims.extend(ours.flat_map(|row| of_row(page, &header, row)));
    }
    claims
}

/// What the words of a sentence state of a design; the figures become `#` in the page.
pub fn of_sentence(page: &str, text: &mut String, design: Design, words: &str) -> Claim {
    let place = format!("{page}: {words}");
    let begin = words.split('{').next().expect("a beginning");
    let found = |at: usize| {
        let (mut here, mut figures, mut spans) = (at, Vec::new(), Vec::new());
        for (index, part) in words.split(['{', '}']).enumerate() {
            if index % 2 == 0 {
                here += text[here..].starts_with(part).then_some(part.len())?;
            } else {
                let (stated, length) = number_of_length(&text[here..])?;
                figures.push((NAMES.into_iter().find(|name| *name == part).expect("a figure"), stated));
                spans.push(here..here + length);
                here += length;
            }
        }
        Some((figures, spans))
    };
    // Where the sentence begins with its figure, anywhere.
    let starts = (0..text.len()).filter(|&at| text.is_char_boundary(at) && text[at..].starts_with(begin));
    let (figures, spans) = { starts }.find_map(found).unwrap_or_else(|| panic!("{place}: is no more in the page"));
    for span in spans.into_iter().rev() {
        text.replace_range(span, "#");
    }
    Claim { place, design, figures }
}
