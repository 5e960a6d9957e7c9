//! `sptfra generate`: the folder with the hardware.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use golden::design::Design;
use golden::numbers::counted;
use golden::progress::Progress;
use hdl_gen::emit::boards::Board;
use hdl_gen::emit::{Options, Prefix, emit_for};
use hdl_gen::inspection::{excess_on, warnings};
use hdl_gen::plan::luts::logic;
use hdl_gen::write::{check_folder, write_folder};

use crate::arguments::{Target, design_file};
use crate::message;

/// Generates RTL, ROM files, flows for simulators and synthesis, and metadata.json.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra generate designs/sensor1-fast.toml --out hardware")]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Folder to write [default: rtl-out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// File of your own board, for block design and device tree.
    ///
    /// Its keys are those of hdl-gen/boards/zcu102.toml.
    #[arg(long = "board", value_name = "FILE")]
    boards: Vec<PathBuf>,
    /// Prefix of the library's modules, for two cores of different versions in one project.
    #[arg(long, value_name = "NAME_")]
    prefix: Option<Prefix>,
    #[command(flatten)]
    target: Target,
    /// Mark nets for a logic analyser in the FPGA, and write the script that attaches it.
    #[arg(long)]
    debug: bool,
}

/// A user's own board, from its file.
fn own_board(path: &Path) -> Result<Board, Box<dyn Error>> {
    let text = fs::read_to_string(path).map_err(|error| {
        format!("{}: {error}; give the path of a board's file, such as hdl-gen/boards/zcu102.toml", path.display())
    })?;
    Ok(Board::from_toml(&text, path)?)
}

/// Writes the folder, for the user's own boards too.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, out, boards, prefix, target, debug } = args;
    let progress = Progress::new();
    let design = Design::load(path)?;
    let own = boards.iter().map(|board| own_board(board)).collect::<Result<Vec<_>, _>>()?;
    for (at, Board { name, .. }) in own.iter().enumerate() {
        if own[..at].iter().any(|before| before.name == *name) {
            return Err(format!("--board: two files are named {name}, which is the board's name; rename one").into());
        }
    }
    let folder = out.clone().unwrap_or_else(|| Path::new("rtl-out").join(&design.name));
    // Before the work rather than after it.
    check_folder(&folder)?;
    let plan = super::inspect::planned(&design, path, target, &progress)?;
    progress.stage("Verilog and ROM files".to_owned());
    let files = emit_for(&plan, &Options { boards: own.clone(), prefix: prefix.clone(), debug: *debug })?;
    let kibibytes = files.values().map(Vec::len).sum::<usize>() / 1024;
    progress.stage(format!("writing {kibibytes} KiB"));
    write_folder(&folder, &files)?;
    let timeline = &plan.timeline;
    let part = &plan.design.hardware.part;
    let mut warned = warnings(&plan);
    for board in &own {
        if !board.has(part) {
            let Board { title, part: of, .. } = board;
            warned.push(format!("the {title} has a {of}, the design is for {part}: set hardware.part to the board's"));
        } else if Board::of_device(part).is_none() {
            warned.extend(excess_on(&plan, board));
        }
    }
    let warnings: String = warned.iter().map(|warning| format!("warning: {warning}\n")).collect();
    let about = logic(&plan).map_or_else(String::new, |logic| format!("about {logic}\n"));
    let shown = folder.display();
    Ok(format!(
        "{shown}: {} files, {kibibytes} KiB\n\
         {} taxels, {}: latency {} cycles, interval {} cycles, {} DSP, {} RAMB36\n\
         {about}{warnings}\
         next: {shown}/README.md has ports and words\n      \
         sptfra run {} --frames FRAMES.csv simulates your frames\n      \
         vivado -mode batch -source {shown}/vivado/synth.tcl synthesizes\n",
        files.len(),
        plan.taxels(),
        counted(plan.design.hardware.lanes, "lane"),
        timeline.latency_cycles,
        timeline.interval_cycles,
        plan.resources.dsp,
        plan.resources.bram36,
        path.display(),
    )
    .into())
}
