//! `cargo xtask noise`: errors against the noise of a reading.

use std::path::PathBuf;

use golden::design::Design;
use golden::output::write_whole;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::noise;

use super::named;

/// Writes errors of designs against the noise of a reading, or against smoothing, on round sliding contacts, as CSV.
#[derive(clap::Args)]
pub struct Args {
    /// Design files (TOML).
    #[arg(required = true, value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Average frames by each value of sensor.smoothing.
    #[arg(long)]
    smoothing: bool,
    /// Where to write the table.
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
}

/// Writes the table.
pub fn run(arguments: &Args) -> message::Result {
    let designs = named(&arguments.designs)?;
    let text = if arguments.smoothing { smoothing(&designs)? } else { noise::csv(&designs)? };
    write_whole(&arguments.out, text.as_bytes())?;
    Ok(format!("{}: {} designs\n", arguments.out.display(), designs.len()).into())
}

fn smoothing(designs: &[(String, Design)]) -> Result<String, Box<dyn std::error::Error>> {
    let with_bound = |(name, design): &(String, Design)| {
        let bound = noise::bound(design)
            .ok_or_else(|| format!("{name}: no bound is known; name designs of the paper's sensors"))?;
        Ok::<_, String>((name.clone(), design.clone(), bound))
    };
    Ok(noise::smoothing_csv(&designs.iter().map(with_bound).collect::<Result<Vec<_>, _>>()?)?)
}
