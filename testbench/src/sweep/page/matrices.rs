//! Pictures of the matrices: magnitude, sparsity, and what each filter of each costs (Figures 5, 8, 9 and 11).

use std::fmt::Write;

use golden::choose::{Candidate, Choice};
use golden::design::MatrixFilter;
use golden::filter::apply;
use golden::matrices::{Matrices, MatrixName};

use crate::svg::{INK, Svg};

/// From small to large, readable in both themes and by those who see no colours.
const RAMP: [&str; 9] =
    ["#1b1036", "#3b1c63", "#5c2a7e", "#80378a", "#a5478a", "#c95c7d", "#e67a67", "#f6a35c", "#fcd97d"];
/// Decades below the largest entry that the ramp covers.
const DECADES: f64 = 4.5;
/// None of the colours here is that of a kind of points in the front.
const KEPT: &str = RAMP[4];
const DROPPED: &str = "#8884";
/// Rows of `C33inv` drawn as lines: a corner, an edge, the middle.
const LINE_COLOURS: [&str; 3] = [RAMP[3], RAMP[7], INK];

/// A picture with its words.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Figure {
    /// SVG.
    pub svg: String,
    /// Below it.
    pub caption: String,
}

/// The magnitudes of all 13 matrices, logarithmic, each relative to its largest entry.
pub fn magnitudes(matrices: &Matrices) -> Vec<Figure> {
    MatrixName::ALL
        .into_iter()
        .map(|name| {
            let dense = matrices.dense(name);
            let largest = dense.amax().max(f64::MIN_POSITIVE);
            let level = |row: usize, column: usize| {
                let below = -(dense[(row, column)].abs() / largest).log10();
                let step = (RAMP.len() - 1) as f64 * (1.0 - below / DECADES);
                step.round().clamp(0.0, (RAMP.len() - 1) as f64) as usize
            };
            let svg = pixels(dense.nrows(), &RAMP, 0, level, &format!("Magnitudes of {name}"));
            Figure { svg, caption: format!("{} {}", symbol(name), scientific(largest)) }
        })
        .collect()
}

/// The colours of [`magnitudes`] with what they mean, from large to small.
pub fn ramp_legend() -> Vec<(String, &'static str)> {
    let decade = |step: usize| DECADES * (1.0 - step as f64 / (RAMP.len() - 1) as f64);
    (0..RAMP.len()).rev().step_by(2).map(|step| (format!("{:.0e}", 10_f64.powf(-decade(step))), RAMP[step])).collect()
}

/// What a filter keeps of `C33inv`.
pub fn sparsity(matrices: &Matrices, filters: &[MatrixFilter]) -> Vec<Figure> {
    let dense = matrices.dense(MatrixName::C33inv);
    filters
        .iter()
        .map(|&filter| {
            let kept = apply(&dense, filter);
            let mut keeps = vec![false; dense.len()];
            for (row, column, _) in kept.triplet_iter() {
                keeps[row * dense.ncols() + column] = true;
            }
            let level = |row: usize, column: usize| usize::from(keeps[row * dense.ncols() + column]);
            let svg = pixels(dense.nrows(), &[DROPPED, KEPT], 0, level, &format!("Entries of C33inv kept by {filter}"));
            let name = filter.to_string().replace("f1 l=", "F1 L = ").replace("f2 p=", "F2 p = ");
            Figure { svg, caption: format!("{name}: {} kept", crate::figures::grouped(kept.nnz() as u64)) }
        })
        .collect()
}

/// Rows of `C33inv` of a sensor with so many columns, for a taxel at a corner, at an edge and in the middle.
pub fn rows(matrices: &Matrices, columns: usize) -> String {
    let dense = matrices.dense(MatrixName::C33inv);
    let lines = dense.nrows() / columns;
    let taxels = [(0, 0), (columns / 2, 0), (columns / 2, lines / 2)];
    let (width, height) = (760.0, 220.0);
    let (low, high) = (dense.min(), dense.max());
    let span = (high - low).max(f64::MIN_POSITIVE);
    let y = |value: f64| 14.0 + (high - value) / span * (height - 50.0);
    let x = |column: usize| 10.0 + column as f64 / (dense.ncols() - 1) as f64 * (width - 20.0);
    let mut svg = Svg::new(width, height, "Rows of the inverse of C33");
    svg.grid((10.0, y(0.0)), (width - 10.0, y(0.0)));
    for ((ix, iy), colour) in taxels.into_iter().zip(LINE_COLOURS) {
        let row = iy * columns + ix;
        let places: Vec<(f64, f64)> = (0..dense.ncols()).map(|column| (x(column), y(dense[(row, column)]))).collect();
        svg.line(&places, colour, "");
    }
    for (number, ((ix, iy), colour)) in taxels.into_iter().zip(LINE_COLOURS).enumerate() {
        let place = (width - 12.0, 28.0 + 17.0 * number as f64);
        svg.text(place, "end", colour, &format!("row of taxel ({ix}, {iy})"));
    }
    svg.text((width / 2.0, height - 8.0), "middle", INK, "column");
    svg.finish()
}

/// A square picture of `side` by `side` cells whose colour is that of their level; `ground` is the level that is not
/// drawn cell by cell.
fn pixels(side: usize, colours: &[&str], ground: usize, level: impl Fn(usize, usize) -> usize, label: &str) -> String {
    let mut paths = vec![String::new(); colours.len()];
    for row in 0..side {
        let mut column = 0;
        while column < side {
            let of = level(row, column);
            let end = (column + 1..side).find(|&next| level(row, next) != of).unwrap_or(side);
            if of != ground {
                // Writing to a String cannot fail.
                let _ = write!(paths[of], "M{column} {row}h{}", end - column);
            }
            column = end;
        }
    }
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 -.5 {side} {side}\" role=\"img\" aria-label=\"{label}\" \
         shape-rendering=\"crispEdges\"><path d=\"M0 -.5h{side}v{side}h-{side}z\" fill=\"{}\"/>",
        colours[ground]
    );
    for (path, colour) in paths.iter().zip(colours).filter(|(path, _)| !path.is_empty()) {
        let _ = write!(svg, "<path d=\"{path}\" stroke=\"{colour}\"/>");
    }
    svg + "</svg>\n"
}

/// A filter that multiplies the error of friction by more is none to take, however few entries it keeps.
const WORTH: f64 = 2.0;

/// `e_mu * Nnz` in thousands for every filter of every matrix; the least of a matrix in purple, full
/// where its error is one to live with.
pub fn costs(choice: &Choice) -> String {
    const CELL: (f64, f64) = (42.0, 24.0);
    const NAMES: f64 = 62.0;
    let count = choice.candidates.len() / MatrixName::ALL.len();
    let width = NAMES + CELL.0 * count as f64 + 4.0;
    let height = 46.0 + CELL.1 * MatrixName::ALL.len() as f64;
    let mut svg = Svg::new(width, height + 18.0, "Error of friction times entries kept, for each matrix and filter")
        .with_names_at((4.0, height + 12.0));
    for (number, candidate) in choice.candidates[..count].iter().enumerate() {
        let (kind, value) = match candidate.filter {
            MatrixFilter::F1 { l } => ("L", l as f64),
            MatrixFilter::F2 { p } => ("p", p),
            MatrixFilter::None => ("", 0.0),
        };
        let x = NAMES + CELL.0 * (number as f64 + 0.5);
        svg.sized_text((x, 36.0), "middle", "currentColor", 11, &format!("{kind} {value}"));
    }
    let ones = choice.candidates[..count].iter().filter(|one| matches!(one.filter, MatrixFilter::F1 { .. })).count();
    for (name, from, to) in [("F1", 0, ones), ("F2", ones, count)] {
        let x = NAMES + CELL.0 * f64::midpoint(from as f64, to as f64);
        svg.text((x, 16.0), "middle", "currentColor", name);
    }
    for (row, candidates) in choice.candidates.chunks(count).enumerate() {
        let y = 44.0 + CELL.1 * row as f64;
        svg.text((NAMES - 8.0, y + 16.0), "end", "currentColor", &symbol(candidates[0].matrix));
        cost_row(&mut svg, candidates, choice.e_mu_unfiltered, (NAMES, y), CELL);
    }
    svg.finish()
}

fn cost_row(
    svg: &mut Svg,
    candidates: &[Candidate],
    unfiltered: f64,
    (left, y): (f64, f64),
    (width, height): (f64, f64),
) {
    const LEAST: &str = RAMP[3];
    let costs = || candidates.iter().map(|candidate| candidate.cost);
    let (low, high) = (costs().fold(f64::INFINITY, f64::min), costs().fold(0.0, f64::max));
    for (column, candidate) in candidates.iter().enumerate() {
        let x = left + width * column as f64;
        let share = if high > low { (candidate.cost - low) / (high - low) } else { 0.0 };
        let taken = candidate.chosen && candidate.e_mu <= WORTH * unfiltered;
        let (colour, opacity) = if taken { (LEAST, 1.0) } else { (INK, 0.06 + 0.5 * share) };
        let (place, sides) = ((x, y), (width - 1.5, height - 1.5));
        let Candidate { matrix, filter, nnz, e_mu, .. } = candidate;
        let name = format!("{} {filter}, e_µ {e_mu:.2} %, {nnz} entries kept", symbol(*matrix));
        svg.named_rectangle(place, sides, (colour, opacity), &name);
        if candidate.chosen && !taken {
            svg.frame(place, sides, LEAST);
        }
        let ink = if taken { "#ffffff" } else { "currentColor" };
        svg.sized_text((x + width / 2.0, y + 15.5), "middle", ink, 11, &thousands(candidate.cost));
    }
}

fn thousands(cost: f64) -> String {
    let value = cost / 1000.0;
    if value < 100.0 { format!("{value:.1}") } else { format!("{value:.0}") }
}

/// A matrix' name with its subscripts in Unicode.
pub fn symbol(name: MatrixName) -> String {
    if name == MatrixName::C33inv {
        return "C₃₃⁻¹".to_owned();
    }
    name.to_string().chars().map(|c| c.to_digit(10).map_or(c, |d| char::from_u32(0x2080 + d).unwrap_or(c))).collect()
}

fn scientific(value: f64) -> String {
    format!("≤ {value:.1e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_is_full_where_its_error_is_one_to_live_with() {
        let candidate = |(number, matrix): (usize, MatrixName)| {
            // Twice the error without a filter, and a little more.
            let e_mu = if number < 5 { 2.0 } else { 2.1 };
            Candidate { matrix, filter: MatrixFilter::F1 { l: 10 }, nnz: 90, e_mu, cost: 90.0 * e_mu, chosen: true }
        };
        let candidates = MatrixName::ALL.into_iter().enumerate().map(candidate).collect();
        let choice = Choice { candidates, frames: 1, e_mu_unfiltered: 1.0, e_mu_chosen: 3.0, nnz_chosen: 1170 };
        let svg = costs(&choice);
        let count = |part: &str| svg.matches(part).count();
        let least = RAMP[3];
        assert_eq!((count(&format!("fill=\"{least}\"")), count(&format!("stroke=\"{least}\""))), (5, 8));
    }
}
