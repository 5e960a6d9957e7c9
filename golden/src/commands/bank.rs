//! `golden bank`: what a board loads into a bank of its calibration.

use std::error::Error;
use std::path::Path;

use golden::bank;
use golden::design::Design;
use golden::output::write_whole;
use serde::Serialize;

use super::keep_apart;

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    bank: &'a Path,
    taxels: usize,
    replaced: &'a [usize],
}

/// Writes the bank of the design in `path` to `out`.
pub fn run(path: &Path, out: &Path, json: bool) -> Result<(), Box<dyn Error>> {
    let named = Design::files_named_in(path)?;
    keep_apart(out, &[path].into_iter().chain(named.iter().map(AsRef::as_ref)).collect::<Vec<_>>())?;
    let design = Design::load(path)?;
    let text = bank::to_csv(&design)?;
    write_whole(out, text.as_bytes())?;
    let replaced: &[usize] = if design.input.room == 0 { &[] } else { &design.input.dead };
    let taxels = design.sensor.taxels();
    if json {
        let report = Report { design: &design.name, bank: out, taxels, replaced };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        let dead = match replaced {
            [] => "no taxel replaced".to_owned(),
            replaced => format!("taxels {replaced:?} replaced"),
        };
        say!("{}: {taxels} gains and offsets, {dead}: {}", design.name, out.display());
        say!("next: load_calibration(\"{}\") of the board's driver", out.display());
    }
    Ok(())
}
