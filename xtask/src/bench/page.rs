//! The figures as a page of Markdown, with the command behind each.

use super::cells::Cells;
use super::cycles::{Kind, LANES, Point};
use super::filters::Filtered;
use super::generation::Generation;
use super::simulation_rate::Rate;
use super::solver::SolverRate;
use super::{Figures, generation, simulation_rate};
use crate::markdown::Page;
use golden::table::Table;
use testbench::figures::{decimals, grouped, or_dash};
use testbench::simulate::Cycles;

/// The whole page. `command` is the `cargo xtask bench` command that measured; `plot` is the picture's place, as seen
/// from the page.
pub fn render(figures: &Figures, command: &str, plot: Option<&str>) -> String {
    let machine = &figures.machine;
    let mut page = Page("# Benchmarks\n".to_owned());
    page.line(&format!(
        "Written by `make bench`; do not edit. Times and rates are of one run on {} {} cores, {} profile; each is the \
         median of its repetitions, and other work on the machine makes it worse. Cycles and cells do not depend on \
         the machine. The commands are in `target/release` after `cargo build --release`.",
        machine.cores, machine.architecture, machine.profile
    ));
    solver(&mut page, &figures.solver);
    generated(&mut page, &figures.generation, command);
    simulated(&mut page, &figures.simulation, command);
    cycles(&mut page, &figures.cycles, command, plot);
    filters(&mut page, &figures.filters, command);
    cells(&mut page, &figures.cells);
    page.0
}

fn solver(page: &mut Page, rows: &[SolverRate]) {
    let Some(first) = rows.first() else { return };
    page.heading("Frames a second of the f64 solver");
    page.line(&format!(
        "On one core, for a user's PC: frame after frame, as a sensor delivers them, and in batches, as from a file; \
         and in batches on all {} cores. Median of {} repetitions; setting up (matrices, filter) happens once. The ratio \
         is to the first line, frame after frame, and on all cores to one core in batches.",
        first.cores, first.repetitions
    ));
    let cells = rows.iter().map(|row| {
        let ratio = |rate: f64| decimals(rate / first.one_by_one.frames_per_second, 2);
        let [one, many] = [row.one_by_one.frames_per_second, row.in_batches.frames_per_second];
        vec![
            format!("`{}`", row.design),
            row.plan.to_string(),
            grouped(row.taxels as u64),
            decimals(row.setup_s, 2),
            grouped(one.round() as u64),
            ratio(one),
            grouped(many.round() as u64),
            ratio(many),
            grouped(row.on_all_cores.frames_per_second.round() as u64),
            decimals(row.on_all_cores.frames_per_second / many, 2),
        ]
    });
    page.table(
        &Table::new([
            "design",
            "plan",
            "taxels",
            "set up, s",
            "frame by frame, 1/s",
            "ratio",
            "in batches, 1/s",
            "ratio",
            "on all cores, 1/s",
            "ratio",
        ])
        .with(cells),
    );
    for row in rows {
        let Some(numpy) = row.numpy_frames_per_second else { continue };
        let golden = row.in_batches.frames_per_second;
        page.line(&format!(
            "`{}` in numpy, on one BLAS thread, with the same products and the same search (`tools/bench_numpy.py`): {} \
             frames a second in batches; {} times as many here.",
            row.design,
            grouped(numpy.round() as u64),
            decimals(golden / numpy, 1)
        ));
    }
    let files: Vec<&str> = rows.iter().map(|row| row.file.as_str()).collect();
    page.command(&format!("cargo xtask solver {}", files.join(" ")));
}

fn generated(page: &mut Page, rows: &[Generation], command: &str) {
    page.heading("Time to generate hardware");
    page.line(&format!(
        "From the checked design to its plan, and from the plan to all files, in memory. Median of {} repetitions. \
         Square sensors have the pitch and depth of the paper's sensor 1, the largest grid those of the mat. Memory \
         is the most that the process had meanwhile, files included.",
        generation::REPETITIONS
    ));
    let cells = rows.iter().map(|row| {
        vec![
            row.design.clone(),
            grouped(row.taxels as u64),
            decimals(row.plan_s, 3),
            decimals(row.emit_s, 3),
            decimals(row.plan_s + row.emit_s, 3),
            decimals(row.bytes as f64 / 1e6, 1),
            or_dash(row.memory.map(|bytes| bytes as f64), |bytes| decimals(bytes / 1e6, 0)),
        ]
    });
    page.table(
        &Table::new(["design", "taxels", "plan, s", "files, s", "together, s", "files, MB", "memory, MB"]).with(cells),
    );
    page.command(command);
}

fn simulated(page: &mut Page, rows: &[Rate], command: &str) {
    page.heading("Speed of the simulation");
    page.line(&format!(
        "Verilator's code with the streams' driver, free-running, on one core. Median of {} repetitions, slowest and \
         fastest beside it. `sptfra run` simulates its four stream modes on cores of their own.",
        simulation_rate::REPETITIONS
    ));
    let cells = rows.iter().map(|row| {
        vec![
            format!("`{}`", row.design),
            row.lanes.to_string(),
            grouped(row.cycles_per_second.round() as u64),
            grouped(row.range[0].round() as u64),
            grouped(row.range[1].round() as u64),
            decimals(row.frames_per_second, 1),
        ]
    });
    page.table(
        &Table::new(["design", "lanes", "cycles a second", "slowest", "fastest", "frames a second"]).with(cells),
    );
    page.command(command);
}

fn cycles(page: &mut Page, points: &[Point], command: &str, plot: Option<&str>) {
    page.heading("Cycles of a frame");
    let simulated: Vec<&Point> = points.iter().filter(|point| point.simulated.is_some()).collect();
    let exact = simulated.iter().filter(|point| point.simulated == Some(point.predicted)).count();
    page.line(&format!(
        "Latency (first word in to last word out of a frame alone) and interval (between frames back to back) of \
         square sensors with the pitch and depth of the paper's sensor 1, force field included. Predicted by the \
         plan; those in **bold** were simulated too, and {exact} of {} gave exactly the predicted cycles. The tests \
         demand that of every design they simulate.",
        simulated.len()
    ));
    if let Some(plot) = plot {
        page.line(&format!("![Latency against the number of taxels]({plot})"));
        page.line(
            "Without a filter the work of a large sensor grows like m² / lanes; with F2 like the entries kept over \
             the lanes: the dotted lines, multiply-accumulates over lanes. Small sensors take what the search, the \
             input and the output take.",
        );
    }
    page.line(
        "The first three tables have the line search. The joint one takes a network too where a sensor has been \
         calibrated; [estimators.md](estimators.md#step-by-step) has what that adds, step by step.",
    );
    for kind in Kind::ALL {
        page.line(&format!("Latency / interval, {}:", kind.title()));
        let mut header = vec!["taxels".to_owned(), "MACs a frame".to_owned()];
        header.extend(LANES.map(|lanes| format!("{lanes} lanes")));
        let of_kind: Vec<&Point> = points.iter().filter(|point| point.kind == kind).collect();
        let rows = of_kind.chunk_by(|one, other| one.side == other.side).map(|row| {
            let first = row[0];
            let mut cells = vec![format!("{0} × {0}", first.side), grouped(first.macs)];
            cells.extend(row.iter().map(|point| cell(point)));
            cells
        });
        page.table(&Table::new(header).with(rows));
    }
    page.command(command);
}

fn filters(page: &mut Page, rows: &[Filtered], command: &str) {
    if rows.is_empty() {
        return;
    }
    page.heading("Filters on folded blocks");
    page.line(
        "The reductions are exact, a filter is not. Largest differences from the same plan without one, in f64, over \
         the sensor's standing scene: of a taxel's force, over the frame's largest normal force; of the friction \
         vector. The resultants do not depend on the filter but through the friction. Cycles and RAMB36 by the plan.",
    );
    let cells = rows.iter().map(|row| {
        vec![
            format!("`{}`", row.design),
            row.filter.clone(),
            grouped(row.macs),
            grouped(row.latency),
            grouped(row.interval),
            decimals(row.bram36, 1),
            decimals(100.0 * row.field_error, 2),
            decimals(row.friction_error, 4),
        ]
    });
    page.table(
        &Table::new(["design", "filter", "MACs a frame", "latency", "interval", "RAMB36", "force, %", "friction"])
            .with(cells),
    );
    page.command(command);
}

fn both(cycles: Cycles) -> String {
    format!("{} / {}", grouped(cycles.latency), grouped(cycles.interval))
}

/// The predicted cycles, bold if they were simulated: then they were the same.
fn cell(point: &Point) -> String {
    point.simulated.map_or_else(|| both(point.predicted), |simulated| format!("**{}**", both(simulated)))
}

fn cells(page: &mut Page, designs: &[Cells]) {
    if designs.is_empty() {
        return;
    }
    page.heading("Cells by Yosys");
    page.line(
        "`synth_xilinx -family xcup`, not flattened, beside the generator's prediction in `metadata.json`. No \
         placement and no clock: Vivado has not been run. DSP48E2 and RAMB36 (a RAMB18 counts one half) are what the \
         prediction is about. What to know about the rest:",
    );
    page.line(
        "* **LUT and FF are too high.** For this family Yosys packs no register into a DSP48E2 or a block RAM, so \
         that the pipeline registers around each multiplier, which the DSP has inside, stand in the fabric; and its \
         48-bit accumulator is an adder of LUTs.\n\
         * **Small memories are LUTs**, where that is cheaper by Yosys' weights; the prediction uses the same \
         weights. LUTs as RAM and as shift registers are in the LUT column. Vivado has weights of its own, so a \
         memory near the limit may go the other way there, half a RAMB36 at a time.\n\
         * **rest**: stream buffers, control, registers between the blocks, and blocks without multipliers and block \
         RAM.",
    );
    for cells in designs {
        let verdict = match cells.not_as_predicted() {
            names if names.is_empty() => "every block as predicted".to_owned(),
            names => format!("not as predicted: {}", names.join(", ")),
        };
        page.line(&format!("`{}`, {verdict}:", cells.design));
        page.table(&cells.table("block"));
    }
    let commands: Vec<String> = designs.iter().map(|cells| format!("tools/synth.sh {}", cells.file)).collect();
    page.command(&commands.join("\n"));
}
