//! `hdl-gen generate`: the output folder.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use golden::design::Design;
use hdl_gen::emit::boards::Board;
use hdl_gen::emit::{Extras, emit_with};
use hdl_gen::inspection::{excess_on, warnings};
use hdl_gen::plan::Plan;
use hdl_gen::write::{check_folder, write_folder};

use golden::progress::Progress;

/// A user's own board, from its file.
fn own_board(path: &Path) -> Result<Board, Box<dyn Error>> {
    let text = fs::read_to_string(path).map_err(|error| {
        format!("{}: {error}; give the path of a board's file, such as hdl-gen/boards/zcu102.toml", path.display())
    })?;
    Ok(Board::from_toml(&text, path)?)
}

/// Writes the folder of the design in file `path`, for the user's own `boards` too, on lanes that
/// meet `target_us` if there is one, with nets marked if `debug`; returns what to tell the user.
pub fn generate(
    path: &Path,
    out: Option<PathBuf>,
    boards: &[PathBuf],
    (target_us, debug): (Option<f64>, bool),
    progress: &Progress,
) -> Result<String, Box<dyn Error>> {
    let design = Design::load(path)?;
    let own = boards.iter().map(|board| own_board(board)).collect::<Result<Vec<_>, _>>()?;
    for (at, Board { name, .. }) in own.iter().enumerate() {
        if own[..at].iter().any(|before| before.name == *name) {
            return Err(format!("--board: two files are named {name}, which is the board's name; rename one").into());
        }
    }
    let folder = out.unwrap_or_else(|| Path::new("rtl-out").join(&design.name));
    // Before the work rather than after it.
    check_folder(&folder)?;
    let plan = super::planned(&design, path, progress, target_us, Plan::new)?;
    progress.stage("Verilog and ROM files".to_owned());
    let files = emit_with(&plan, &Extras { boards: &own, debug })?;
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
    Ok(format!(
        "{}: {} files, {kibibytes} KiB\n\
         {} taxels, {}: latency {} cycles, interval {} cycles, {} DSP, {} RAMB36\n{warnings}",
        folder.display(),
        files.len(),
        plan.taxels(),
        super::inspect::count(plan.design.hardware.lanes, "lane"),
        timeline.latency_cycles,
        timeline.interval_cycles,
        plan.resources.dsp,
        plan.resources.bram36,
    ))
}
