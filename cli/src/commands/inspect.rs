//! `sptfra inspect`: a design's figures before anything is written.

use std::error::Error;
use std::path::{Path, PathBuf};

use golden::design::{Algorithm, Design, Overrun, PlanKind};
use golden::numbers::counted;
use golden::progress::Progress;
use golden::table::Table;
use hdl_gen::emit::products;
use hdl_gen::format::short;
use hdl_gen::inspection::{contacts, doubled, excess, figures, narrow, shares};
use hdl_gen::plan::Plan;
use hdl_gen::plan::energy::Energy;
use hdl_gen::plan::luts::logic;
use hdl_gen::plan::savings::savings;

use crate::arguments::{Target, design_file};
use crate::message::{self, say};

/// Shows a design's geometry, nonzeros, cycles, memories and multipliers.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra inspect designs/sensor1-fast.toml --json")]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Condition number of A Aᵀ above which noise of a thousandth of the stress is no longer a small error of the force.
const ILL_CONDITIONED: f64 = 1e4;
/// Second lines stand under the values of the first.
const INDENT: &str = "               ";
/// Matrix names in one line of the table.
const MATRICES_PER_LINE: usize = 7;

/// Plans the design and reports it.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, json, target } = args;
    let plan = planned(&Design::load(path)?, path, target, &Progress::new())?;
    Ok(if *json { serde_json::to_string_pretty(&figures(&plan))? + "\n" } else { text_report(&plan) }.into())
}

/// The plan of the design of file `path`.
pub(super) fn planned(
    design: &Design,
    path: &Path,
    Target { target_us }: &Target,
    progress: &Progress,
) -> Result<Plan, Box<dyn Error>> {
    progress.stage(format!("matrices and plan of {} taxels", design.sensor.taxels()));
    let plan = target_us.map_or_else(|| Plan::new(design), |target_us| Plan::meeting(design, target_us));
    plan.map_err(|error| format!("{}: {error}", path.display()).into())
}

fn text_report(plan: &Plan) -> String {
    let mut text = String::new();
    say!(text, "{}", plan.design.name);
    sensor(&mut text, plan);
    matrices(&mut text, plan);
    reductions(&mut text, plan);
    work(&mut text, plan);
    speed(&mut text, plan);
    text += &plan.estimator.block().report(&plan.design);
    resources(&mut text, plan);
    energy(&mut text, plan);
    numbers(&mut text, plan);
    text
}

/// Adds a table, behind an empty line.
fn append(text: &mut String, table: &Table) {
    *text += "\n";
    *text += &table.text(0, 0);
}

fn sensor(out: &mut String, plan: &Plan) {
    let sensor = &plan.design.sensor;
    let [x, y] = sensor.pitch_mm;
    say!(out, "\nSensor");
    say!(
        out,
        "  geometry     {} x {} = {} taxels, pitch {x} x {y} mm, depth {} mm",
        sensor.columns,
        sensor.rows,
        plan.taxels(),
        sensor.depth_mm
    );
    let Algorithm { plan: kind, estimator, outputs, .. } = &plan.design.algorithm;
    say!(out, "  design       plan {kind}, estimator {estimator}, outputs {outputs}");
    if let Some(contacts) = contacts(plan) {
        say!(out, "  contacts     {contacts}");
    }
    say!(
        out,
        "  streams      {} bits a beat, samples {}",
        plan.design.hardware.stream_bits,
        plan.design.hardware.samples
    );
    if let Some(curve) = &plan.design.input.curve
        && let Some(first) = curve.exact_from()
    {
        // Three digits of a small one, whole counts of others.
        let digits = usize::from(first < 100.0);
        let last = curve.largest_count();
        say!(out, "  curve        power law, exact from {first:.digits$} counts on, saturated from {last:.0} on");
    }
    let condition = &plan.condition;
    let thin = plan.design.thin_layer();
    let verdict = if condition.aat > ILL_CONDITIONED {
        format!(
            "ill-conditioned: the depth is {:.2} pitches; a smaller one forgives more noise",
            sensor.depth_mm / x.min(y)
        )
    } else if thin.is_some() {
        "no noise is amplified, but the layer is too thin, see below".to_owned()
    } else {
        "well conditioned".to_owned()
    };
    say!(out, "  condition    C33 {}, A A^T {}: {verdict}", short(condition.c33), short(condition.aat));
    if let Some(expected) = plan.design.expected_error() {
        let expected = expected.to_string().replacen(" (median", &format!("\n{INDENT}(median"), 1);
        say!(out, "  error        {expected}");
    } else {
        say!(out, "  error        unknown; `sptfra calibrate` finds it and writes it into the design");
    }
    say!(out, "  kernel       {}", plan.estimator.block().kernel_advice(&plan.design, INDENT));
    if let Some((layer, remedy)) = thin.as_deref().and_then(|thin| thin.split_once(": ")) {
        say!(out, "  thin         {layer}:\n{INDENT}{remedy}");
    }
}

fn matrices(out: &mut String, plan: &Plan) {
    let all = plan.taxels() * plan.taxels();
    let kept: usize = plan.nnz.0.iter().map(|&(_, count)| count).sum();
    let share = 100.0 * kept as f64 / (all * plan.nnz.0.len()) as f64;
    let filter = &plan.design.algorithm.filter;
    let whose = match plan.design.algorithm.plan {
        PlanKind::Paper => "Matrices",
        PlanKind::Reduced => "Matrices of the paper's plan",
    };
    say!(out, "\n{whose}, filter = {filter}: {share:.1} % of {all} entries each");
    for chunk in plan.nnz.0.chunks(MATRICES_PER_LINE) {
        let names: String = chunk.iter().map(|(name, _)| format!("{name:>9}")).collect();
        let counts: String = chunk.iter().map(|(_, count)| format!("{count:>9}")).collect();
        say!(out, "  {names}\n  {counts}");
    }
}

fn reductions(out: &mut String, plan: &Plan) {
    let steps = savings(plan);
    let Some(first) = steps.first() else { return };
    let mut table = Table::new(["Reductions", "MACs a frame", "share", "coefficients in ROM"]);
    for step in &steps {
        let share = format!("{:.1} %", 100.0 * step.macs as f64 / first.macs as f64);
        table.row([step.step.to_owned(), step.macs.to_string(), share, step.coefficients.to_string()]);
    }
    append(out, &table);
}

fn work(out: &mut String, plan: &Plan) {
    let mut table = Table::new(["Products", "entries", "cycles", "busy", "result"]).ending_in_words();
    for product in products(plan) {
        table.row([
            format!("{} of {}", product.matrix, product.operand),
            product.nnz.to_string(),
            product.issue_cycles.to_string(),
            format!("{:.1} %", 100.0 * product.busy),
            product.result,
        ]);
    }
    append(out, &table);
}

fn speed(out: &mut String, plan: &Plan) {
    let clock = plan.design.hardware.clock_mhz;
    let timeline = &plan.timeline;
    let busy = 100.0 * plan.schedule.busy_fraction();
    let rate = clock * 1e6 / timeline.interval_cycles as f64;
    let faster = match plan.design.hardware.overrun {
        Overrun::Stall => "",
        Overrun::Drop => "; of faster ones some are dropped",
    };
    let header = [format!("Speed at {clock} MHz"), "cycles".to_owned(), "us".to_owned(), String::new()];
    let mut table = Table::new(header).ending_in_words();
    for (what, cycles, remark) in [
        ("latency", timeline.latency_cycles, "first beat in to last beat out".to_owned()),
        ("interval", timeline.interval_cycles, format!("between frames, {rate:.0} frames a second{faster}")),
        ("products", timeline.spmv_cycles, format!("{} busy {busy:.1} %", counted(plan.design.hardware.lanes, "lane"))),
        (
            "search",
            timeline.search_cycles,
            counted(plan.estimator.block().cells(&plan.design.sensor).cells, "evaluation cell"),
        ),
    ] {
        table.row([what.to_owned(), cycles.to_string(), format!("{:.2}", cycles as f64 / clock), remark]);
    }
    append(out, &table);
}

fn resources(out: &mut String, plan: &Plan) {
    let resources = &plan.resources;
    let part = &plan.design.hardware.part;
    say!(out, "\nResources, predicted");
    let (dsp, block) = (resources.dsp, resources.dsp_block.name());
    let share =
        shares(plan).map_or_else(String::new, |[dsp, bram36]| format!(": {dsp:.1} and {bram36:.1} % of {part}"));
    say!(out, "  {dsp} {block}, {} RAMB36, {} bits of ROM{share}", resources.bram36, resources.rom_bits);
    if let Some(logic) = logic(plan) {
        say!(out, "  about {logic}");
    }
    for told in [excess(plan), doubled(plan)].into_iter().flatten() {
        say!(out, "  {told}");
    }
    let mut table = Table::new(["Memories", "block", "how many", "words", "bits", "RAMB36"]);
    for memory in &resources.memories {
        table.row([
            memory.name.to_owned(),
            memory.block.to_owned(),
            memory.count.to_string(),
            memory.depth.to_string(),
            memory.width.to_string(),
            memory.all_bram36().to_string(),
        ]);
    }
    append(out, &table);
}

fn energy(out: &mut String, plan: &Plan) {
    let energy = Energy::of(plan);
    let rate = plan.design.hardware.clock_mhz * 1e6 / plan.timeline.interval_cycles as f64;
    let (microjoules, watts) = (energy.fabric_nj / 1e3, energy.watts(rate));
    say!(
        out,
        "\nEnergy, estimated: {microjoules:.1} uJ a frame, {watts:.2} W at {rate:.0} frames a second, without static power"
    );
    say!(out, "  from counted products and memory accesses; nothing of it was measured");
}

fn numbers(out: &mut String, plan: &Plan) {
    let hardware = &plan.design.hardware;
    say!(
        out,
        "\nNumbers: {}-bit coefficients, {}-bit vectors, 48-bit sums; no stress within full scale overflows them",
        hardware.coefficient_bits,
        hardware.data_bits
    );
    for (what, unit, format) in [
        ("stress b", "Pa", plan.formats.stress),
        ("weights |w|", "N", plan.formats.weight),
        ("g", "N", plan.formats.g),
        ("u", "Pa", plan.formats.u),
    ] {
        let step = format!("2^{}", format.lsb);
        let worst = short(format.bound as f64 * format.step());
        say!(out, "  {what:<12} steps of {step:<6} {unit:<2}   worst case {worst} {unit}");
    }
    if plan.scales_frames() {
        let octaves = 63 - plan.formats.stress.bound.leading_zeros();
        say!(
            out,
            "  range        each frame's own: forces are up to 2^{octaves} times as fine where all of it is faint"
        );
    }
    if let Some(narrow) = narrow(plan) {
        say!(out, "  {narrow}");
    }
}
