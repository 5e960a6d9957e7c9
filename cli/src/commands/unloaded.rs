//! `sptfra check --unloaded`: offset, noise and drift from a recording without load.

use std::path::Path;

use golden::check::{Beyond, beyond};
use golden::design::{Design, Expected, MAX_NOISE};
use golden::numbers::counted;
use golden::output::write_whole;
use golden::resolved::{folder, keep_apart};
use golden::rest::AtRest;
use serde::Serialize;

use super::recording::Recording;
use crate::message::{self, Message, say};

/// Frames without load, and those of typical contacts.
#[derive(Clone, Copy)]
pub struct Frames<'a> {
    pub unloaded: &'a [Vec<f64>],
    pub loaded: Option<&'a [Vec<f64>]>,
}

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    frames: usize,
    #[serde(flatten)]
    rest: &'a AtRest,
    beyond: Beyond,
    #[serde(skip_serializing_if = "Option::is_none")]
    calibration: Option<&'a Path>,
    /// The noise over the largest reading of a typical contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    noise_of_contacts: Option<f64>,
    /// At this noise, or the design's.
    #[serde(skip_serializing_if = "Option::is_none")]
    expected_error: Option<Expected>,
}

/// Reports what each taxel reads unloaded, and writes the calibration that takes it off.
pub fn run(
    path: &Path,
    design: &Design,
    recording: &Recording,
    Frames { unloaded: frames, loaded }: Frames<'_>,
    out: Option<&Path>,
    json: bool,
) -> message::Result {
    let named = |error| format!("{}: {error}", design.name);
    let rest = AtRest::of(design, frames).map_err(named)?;
    let noise_of_contacts = loaded.map(|loaded| share(design, &rest, loaded)).transpose()?;
    let mut faults = Vec::new();
    if let Some(out) = out.filter(|_| rest.touched) {
        faults.push(format!(
            "{}: not written; take everything off the sensor and record it anew. If it does read this without load, --json has \
             the offset of each taxel, of which to make lines gain,offset",
            out.display()
        ));
    }
    let out = out.filter(|_| !rest.touched);
    if let Some(out) = out {
        let mut inputs = Design::inputs_at(path)?;
        inputs.push(recording.file.to_path_buf());
        keep_apart(out, &inputs)?;
        let calibration = rest.calibration(design, frames).map_err(named)?;
        write_whole(out, calibration.to_csv().as_bytes())?;
    }
    for warning in &rest.warnings {
        eprintln!("warning: {warning}");
    }
    let beyond = beyond(design, frames);
    let report = Report {
        design: &design.name,
        frames: frames.len(),
        rest: &rest,
        beyond,
        calibration: out,
        noise_of_contacts,
        expected_error: design
            .expected_error_at(noise_of_contacts.map_or(design.input.noise, shown))
            .map(|expected| if rest.goes_on() { expected.of_single_frames() } else { expected }),
    };
    if json {
        return Ok(Message { text: serde_json::to_string_pretty(&report)? + "\n", faults });
    }
    let mut text = String::new();
    let counts = if design.input.counts() { "counts" } else { "Pa" };
    say!(text, "{}: {} of {} without load", design.name, counted(frames.len(), "frame"), recording.file.display());
    say!(
        text,
        "In {counts}: the median taxel varies by {:.2} and drifts by {:.2}; all of them with --json",
        rest.noise,
        rest.drift
    );
    for (kind, taxels) in [("Dead", &rest.dead), ("Stuck", &rest.stuck), ("Noisy", &rest.noisy)] {
        if !taxels.is_empty() {
            say!(text, "{kind}: {taxels:?}");
        }
    }
    if beyond.readings > 0 {
        say!(text, "{beyond}");
    }
    match noise_of_contacts {
        Some(share) => say!(text, "[sensor] noise = {}  # of the largest reading of a typical contact", shown(share)),
        None if rest.noise_of_full_scale > 0.0 => say!(
            text,
            "[sensor] noise = {}  # for contacts that reach full_scale_pa; for yours, name their frames with --loaded",
            shown(rest.noise_of_full_scale)
        ),
        None => (),
    }
    if let Some(expected) = &report.expected_error {
        let of = if noise_of_contacts.is_some() { "" } else { " This noise is the design's." };
        say!(text, "{expected}{of}");
    }
    say!(text, "[algorithm] noise_floor_pa = {:.1}  # three standard deviations", ceil(rest.noise_floor_pa));
    if let Some(out) = out {
        let same = folder(out) == folder(path);
        let name = out.file_name().filter(|_| same).map_or_else(|| out.into(), Into::<std::path::PathBuf>::into);
        say!(
            text,
            "[sensor] calibration = {:?}  # written; the file is found from the design's folder",
            name.display().to_string()
        );
    }
    Ok(Message { text, faults })
}

/// The noise as a share of what typical contacts read.
fn share(design: &Design, rest: &AtRest, loaded: &[Vec<f64>]) -> Result<f64, String> {
    let share = rest.noise_of(design, loaded).map_err(|error| format!("--loaded: {error}"))?;
    if share > MAX_NOISE {
        return Err(format!(
            "--loaded: the noise is {:.0} % of a typical contact's largest reading, above the {} % of sensor.noise; press harder",
            100.0 * share,
            100.0 * MAX_NOISE
        ));
    }
    Ok(share)
}

/// Rounded up to a tenth, and not to 0.
fn ceil(pascals: f64) -> f64 {
    (10.0 * pascals).ceil().max(1.0) / 10.0
}

/// With two digits, rounded up.
fn shown(share: f64) -> f64 {
    let unit = 10_f64.powi(share.log10().floor() as i32 - 1);
    let digits = (share / unit).ceil();
    // So that 0.00024 is no 0.00024000000000000003.
    format!("{:e}", digits * unit).parse::<f64>().map_or(share, |value| (value * 1e9).round() / 1e9).max(1e-9)
}
