//! Tables 1 and 3 of the paper beside the points of a sweep.

use golden::design::{Estimator, PlanKind};
use golden::matrices::MatrixName;
use golden::metrics::ErrorSummary;

use super::matrices::symbol;
use super::paper::{TABLE_1, TABLE_3};
use crate::figures::grouped;
use crate::sweep::point::{Point, paper_sensor};
use golden::table::{Cell, Table};

/// Widths and lanes of the shipped designs, by which points are looked up.
const BASE: (u32, u32, usize) = (18, 27, 16);

/// The line search's point of a filter and a plan, in the usual widths and lanes, on one scene.
pub fn find<'a>(points: &[&'a Point], filter: &str, plan: PlanKind) -> Option<&'a Point> {
    all_by(points, filter, plan, Estimator::Line).next()
}

/// The same for each calibration of an estimator.
fn all_by<'a>(
    points: &[&'a Point],
    filter: &str,
    plan: PlanKind,
    estimator: Estimator,
) -> impl Iterator<Item = &'a Point> {
    points.iter().copied().filter(move |point| {
        (point.filter.as_str(), point.plan, point.estimator) == (filter, plan, estimator)
            && (point.coefficient_bits, point.data_bits, point.lanes) == BASE
    })
}

/// Table 1: entries by filter and matrix, the paper's and ours; `None` for a sensor that is not the paper's.
pub fn table_1(points: &[&Point]) -> Option<Table> {
    let number = paper_sensor(&points.first()?.sensor)?;
    let mut header = vec!["filter".to_owned(), String::new()];
    header.extend(MatrixName::ALL.map(symbol));
    header.push("mean µ".to_owned());
    let mut rows = Vec::new();
    for row in TABLE_1.iter().filter(|row| row.sensor == number) {
        let mut paper = vec![Cell::new(row.name, "name"), Cell::new("paper", "paper")];
        paper.extend(row.nnz.map(|count| Cell::new(grouped(count as u64), "paper")));
        paper.push(Cell::new(format!("{:.2}", row.mean_mu), "paper"));
        rows.push(paper);
        let Some(point) = find(points, row.filter, PlanKind::Paper) else { continue };
        let mut ours = vec![Cell::new("", "name"), Cell::new("ours", "")];
        for (name, printed) in MatrixName::ALL.into_iter().zip(row.nnz) {
            let count = point.nnz.get(&name.to_string()).copied().unwrap_or_default();
            ours.push(Cell::new(grouped(count as u64), if count == printed { "same" } else { "" }));
        }
        ours.push(Cell::new(format!("{:.2}", point.mean_mu), ""));
        rows.push(ours);
    }
    Some(Table::new(header).with(rows))
}

/// The header of tables of errors and times.
fn header_3() -> Vec<String> {
    let names = ["e_Fx", "e_Fy", "e_Fz", "e_µ", "e_φ"];
    let mut header = vec!["hardware".to_owned(), "time".to_owned()];
    header.extend(names.map(|name| format!("max {name}")));
    header.extend(names.map(|name| format!("SE {}", name.trim_start_matches("e_"))));
    header.push("verified".to_owned());
    header
}

/// The rows of designs without a filter, in the usual widths and lanes.
fn unfiltered(points: &[&Point]) -> Vec<Vec<Cell>> {
    let line = find(points, "none", PlanKind::Reduced).map(|point| ("reduced plan, line, no filter".to_owned(), point));
    let joint = all_by(points, "none", PlanKind::Reduced, Estimator::Joint)
        .map(|point| (format!("reduced plan, {}", point.estimator_title()), point));
    line.into_iter().chain(joint).map(|(name, point)| of_point(&name, point, "ours")).collect()
}

/// Errors and times of our designs without a filter; `None` without such points.
pub fn on_kinds(points: &[&Point]) -> Option<Table> {
    let rows = unfiltered(points);
    (!rows.is_empty()).then(|| Table::new(header_3()).with(rows))
}

/// Table 3: errors and times, the paper's and ours; `None` for a sensor that is not the paper's.
pub fn table_3(points: &[&Point]) -> Option<Table> {
    let number = paper_sensor(&points.first()?.sensor)?;
    let mut rows = Vec::new();
    for row in TABLE_3.iter().filter(|row| row.sensor == number) {
        let time = format!("{:.2} ms", row.milliseconds);
        let mut paper = vec![Cell::new(format!("{}, paper", row.name), "paper"), Cell::new(time, "paper")];
        paper.extend(row.max.iter().chain(&row.standard_error).map(|error| Cell::new(format!("{error:.2}"), "paper")));
        paper.push(Cell::new(if row.software { "software" } else { "" }, "paper"));
        rows.push(paper);
        if let Some(point) = find(points, row.filter, PlanKind::Paper) {
            if row.software {
                rows.push(errors("f64 solver, line, no filter", &point.solver_errors, "", "software"));
            } else {
                rows.push(of_point(&format!("paper's plan, line, {}", point.filter_title()), point, ""));
            }
        }
    }
    rows.extend(unfiltered(points));
    Some(Table::new(header_3()).with(rows))
}

fn of_point(name: &str, point: &Point, class: &'static str) -> Vec<Cell> {
    let mut row = errors(name, &point.errors, class, point.verified.title());
    if let Some(hardware) = &point.hardware {
        row[1] = Cell::new(format!("{:.1} µs", hardware.latency_us), class);
    }
    row
}

fn errors(name: &str, errors: &ErrorSummary, class: &'static str, verified: &str) -> Vec<Cell> {
    let spreads = errors.spreads();
    let mut row = vec![Cell::new(name, class), Cell::new("", class)];
    row.extend(spreads.iter().map(|spread| Cell::new(format!("{:.2}", spread.max), class)));
    row.extend(spreads.iter().map(|spread| Cell::new(format!("{:.2}", spread.standard_error), class)));
    row.push(Cell::new(verified, class));
    row
}

/// Lanes against speed and size of one filter and plan.
pub fn lanes(points: &[&Point]) -> Table {
    let header = [
        "plan",
        "filter",
        "estimator",
        "lanes",
        "latency",
        "interval",
        "frames/s",
        "DSP",
        "RAMB36",
        "ROM, kbit",
        "entries",
    ];
    let mut rows: Vec<(&Point, [String; 11])> = Vec::new();
    for point in points.iter().filter(|point| (point.coefficient_bits, point.data_bits) == (BASE.0, BASE.1)) {
        let Some(hardware) = &point.hardware else { continue };
        let of_lanes = |other: &&&Point| {
            (&other.plan, &other.filter, other.calibration) == (&point.plan, &point.filter, point.calibration)
        };
        let mut varied: Vec<usize> = points.iter().filter(of_lanes).map(|other| other.lanes).collect();
        varied.sort_unstable();
        varied.dedup();
        if varied.len() < 2 {
            continue;
        }
        let rate = 1e6 / hardware.interval_us;
        let cells = [
            point.plan.to_string(),
            point.filter_title(),
            point.estimator_title(),
            point.lanes.to_string(),
            format!("{} ({:.1} µs)", grouped(hardware.latency_cycles), hardware.latency_us),
            grouped(hardware.interval_cycles),
            grouped(rate.round() as u64),
            hardware.dsp.to_string(),
            format!("{:.1}", hardware.bram36),
            grouped(hardware.rom_bits / 1000),
            grouped(point.nnz_total as u64),
        ];
        rows.push((*point, cells));
    }
    rows.sort_by(|(a, _), (b, _)| {
        let of = |point: &Point| {
            let (paper, joint) = (point.plan == PlanKind::Paper, point.estimator == Estimator::Joint);
            (paper, point.filter.clone(), joint, point.estimator_title(), point.lanes)
        };
        of(a).cmp(&of(b))
    });
    rows.dedup_by(|a, b| a.1 == b.1);
    Table::new(header).with(rows.into_iter().map(|(_, cells)| cells))
}
