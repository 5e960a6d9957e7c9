//! `sptfra check`: faults of a recording.

use std::path::PathBuf;

use golden::check::{beyond, check, is_unloaded};
use golden::design::Design;
use golden::matrices::Matrices;
use golden::numbers::counted;
use golden::progress::Progress;
use serde_json::json;

use super::recording::{LayoutArguments, Recording, is_standard};
use super::unloaded;
use crate::arguments::design_file;
use crate::message::{self, Message, say};

/// Checks a recording before its forces are trusted.
///
/// Reports the likely cause and the key to change, a line each. It finds wrong units, wrong signs, a missing tare, broken
/// taxels, taxels in another order, crosstalk, missing tension and readings at the end of the converter. Then comes the share
/// that lies beyond the calibration. The exit code is 0 only if nothing is found.
///
/// With `--unloaded`: offset, noise and drift of each taxel from a recording without load, and warnings.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  sptfra check pad --frames frames.csv\n  sptfra check pad --frames unloaded.csv --unloaded --loaded frames.csv --out tare.csv"
)]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Frames (CSV or .npy), as for `sptfra solve`.
    #[arg(long, value_name = "FRAMES.csv")]
    frames: PathBuf,
    #[command(flatten)]
    layout: LayoutArguments,
    /// Nothing presses in the frames: report offsets, noise, drift and dead taxels.
    ///
    /// The report has the keys that suit the noise.
    #[arg(long)]
    unloaded: bool,
    /// Frames of typical contacts, recorded like the others.
    ///
    /// `sensor.noise` is relative to their largest readings.
    #[arg(long, value_name = "FRAMES.csv", requires = "unloaded")]
    loaded: Option<PathBuf>,
    /// Where to write the calibration that removes the offsets.
    ///
    /// It has lines gain,offset, for `sensor.calibration`.
    #[arg(long, value_name = "CALIBRATION.csv", requires = "unloaded")]
    out: Option<PathBuf>,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Checks the frames of a file; an error if anything is found.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, frames, layout, unloaded, loaded, out, json } = args;
    let recording = &Recording { file: frames, layout: layout.layout() };
    if is_standard(recording.file) {
        return Err("--frames -: this looks at all frames of a recording; write them into a file first".into());
    }
    let design = Design::load(path)?;
    let frames = recording.read(&design)?;
    if *unloaded {
        let of = |file| Recording { file, layout: layout.layout() }.read(&design);
        let loaded = loaded.as_deref().map(of).transpose()?;
        let frames = unloaded::Frames { unloaded: &frames, loaded: loaded.as_deref() };
        return unloaded::run(path, &design, recording, frames, out.as_deref(), *json);
    }
    let beyond = beyond(&design, &frames);
    let matrices = {
        let _progress = Progress::of("matrices");
        Matrices::of(&design).map_err(|error| format!("{}: {error}", design.name))?
    };
    let findings = check(&design, &frames, Some(&matrices));
    let file = recording.file.display();
    let mut text = String::new();
    if *json {
        let report = json!({ "design": design.name, "frames": frames.len(), "findings": findings, "beyond": beyond });
        text += &(serde_json::to_string_pretty(&report)? + "\n");
    } else {
        for finding in &findings {
            say!(text, "{finding}");
        }
        if findings.is_empty() {
            say!(text, "{}: {} of {file}, nothing suspicious", design.name, counted(frames.len(), "frame"));
            if is_unloaded(&design, &frames) {
                let floor = design.algorithm.noise_floor_pa;
                say!(text, "Nothing presses: tare and noise are within algorithm.noise_floor_pa = {floor}");
            }
        }
        if findings.is_empty() || beyond.readings > 0 {
            say!(text, "{beyond}");
        }
    }
    let things = match findings.len() {
        0 => return Ok(text.into()),
        1 => "one thing".to_owned(),
        count => format!("{count} things"),
    };
    let fault = format!("{file}: {things} to look at before the forces are trusted");
    Ok(Message { text, faults: vec![fault] })
}
