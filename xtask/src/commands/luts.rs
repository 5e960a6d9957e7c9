//! `cargo xtask luts`: the fit of LUTs and flip-flops.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use golden::output::write_whole;
use sptfra::message::{self, Message};
use xtask::luts::{COUNTS, FITTED, counted, files, fit, missing};

/// Fits LUTs and flip-flops to Yosys' counts: writes results/luts.csv, and hdl-gen/src/plan/luts.csv, which is compiled in.
///
/// `make luts` does it all. Run it at the top of the checkout. A design that results/luts.csv has is not counted again.
#[derive(clap::Args)]
pub struct Args {
    /// Folder with Yosys' statistics of designs in xtask/designs/counted.toml, NAME.stat.json.
    folder: PathBuf,
    /// Write the files of designs that have no counts there instead, and print their places.
    #[arg(long)]
    designs: bool,
}

/// Fits.
pub fn run(Args { folder, designs }: &Args) -> message::Result {
    let root = Path::new("");
    let missing = missing(root)?;
    if *designs {
        fs::create_dir_all(folder)?;
        let mut places = String::new();
        for design in &missing {
            for (name, content) in files(design) {
                write_whole(&folder.join(name), content.as_bytes())?;
            }
            let place = folder.join(format!("{}.toml", design.name));
            writeln!(places, "{}", place.display())?;
        }
        return Ok(places.into());
    }
    let fit = fit(&counted(root, Some(folder))?);
    write_whole(Path::new(COUNTS), fit.counts.as_bytes())?;
    write_whole(Path::new(FITTED), fit.fitted.as_bytes())?;
    let left: Vec<String> =
        self::missing(root)?.into_iter().map(|design| format!("no counts of {}", design.name)).collect();
    Ok(Message { text: fit.fitted, faults: left })
}
