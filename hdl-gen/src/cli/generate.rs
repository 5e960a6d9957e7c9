//! `hdl-gen generate`: the output folder.

use std::error::Error;
use std::path::{Path, PathBuf};

use golden::design::Design;
use hdl_gen::emit::emit;
use hdl_gen::inspection::warnings;
use hdl_gen::write::{check_folder, write_folder};

use golden::progress::Progress;

/// Writes the folder of the design in file `path`; returns what to tell the user.
pub fn generate(path: &Path, out: Option<PathBuf>, progress: &Progress) -> Result<String, Box<dyn Error>> {
    let design = Design::load(path)?;
    let folder = out.unwrap_or_else(|| Path::new("rtl-out").join(&design.name));
    // Before the work rather than after it.
    check_folder(&folder)?;
    let plan = super::plan(&design, path, progress)?;
    progress.stage("Verilog and ROM files".to_owned());
    let files = emit(&plan)?;
    let kibibytes = files.values().map(Vec::len).sum::<usize>() / 1024;
    progress.stage(format!("writing {kibibytes} KiB"));
    write_folder(&folder, &files)?;
    let timeline = &plan.timeline;
    let warnings: String = warnings(&plan).iter().map(|warning| format!("warning: {warning}\n")).collect();
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
