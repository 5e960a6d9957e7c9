//! `sptfra check --unloaded`: offset, noise and drift from a recording without load.

use std::path::Path;

use golden::check::{Beyond, beyond};
use golden::design::{Design, Expected, Input, MAX_NOISE, MeasuredNoise};
use golden::numbers::counted;
use golden::output::write_whole;
use golden::resolved::{folder, keep_apart};
use golden::unloaded::Unloaded;
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
    measured: &'a Unloaded,
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
    let measured = Unloaded::of(design, frames).map_err(named)?;
    let of_contacts = loaded.map(|loaded| noise_of(design, &measured, loaded)).transpose()?;
    let noise_of_contacts = of_contacts.map(MeasuredNoise::share);
    let mut faults = Vec::new();
    if let Some(out) = out.filter(|_| measured.touched) {
        faults.push(format!(
            "{}: not written; take everything off the sensor and record it anew. If it does read this without load, --json has \
             the offset of each taxel, of which to make lines gain,offset",
            out.display()
        ));
    }
    let out = out.filter(|_| !measured.touched);
    if let Some(out) = out {
        let mut inputs = Design::inputs_at(path)?;
        inputs.push(recording.file.to_path_buf());
        keep_apart(out, &inputs)?;
        let calibration = measured.calibration(design, frames).map_err(named)?;
        write_whole(out, calibration.to_csv().as_bytes())?;
    }
    for warning in &measured.warnings {
        eprintln!("warning: {warning}");
    }
    let beyond = beyond(design, frames);
    let report = Report {
        design: &design.name,
        frames: frames.len(),
        measured: &measured,
        beyond,
        calibration: out,
        noise_of_contacts,
        expected_error: design
            .expected_error_at(noise_of_contacts.map_or(design.input.noise, shown))
            .map(|expected| if measured.goes_on() { expected.of_single_frames() } else { expected }),
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
        measured.noise,
        measured.drift
    );
    for (kind, taxels) in [("Dead", &measured.dead), ("Stuck", &measured.stuck), ("Noisy", &measured.noisy)] {
        if !taxels.is_empty() {
            say!(text, "{kind}: {taxels:?}");
        }
    }
    if beyond.readings > 0 {
        say!(text, "{beyond}");
    }
    if let Some(expected) = &report.expected_error {
        let of = if noise_of_contacts.is_some() { "" } else { " This noise is the design's." };
        say!(text, "{expected}{of}");
    }
    let full_scale = MeasuredNoise { deviation: measured.noise_pa, largest: design.hardware.full_scale_pa };
    let noise = match of_contacts {
        Some(noise) => Some((noise, "of typical contacts")),
        None => (measured.noise_pa > 0.0)
            .then_some((full_scale, "of contacts at full scale; for yours, name their frames with --loaded")),
    };
    if noise.is_some() || out.is_some() {
        say!(text, "[sensor]");
    }
    if let Some((noise, of)) = noise {
        say!(text, "noise = {}  # {of}", key(&design.input, noise));
    }
    if let Some(out) = out {
        let same = folder(out) == folder(path);
        let name = out.file_name().filter(|_| same).map_or_else(|| out.into(), Into::<std::path::PathBuf>::into);
        let name = name.display().to_string();
        say!(text, "calibration = {name:?}  # written; the file is found from the design's folder");
    }
    say!(text, "[algorithm]");
    say!(text, "noise_floor_pa = {:.1}  # three standard deviations", ceil(measured.noise_floor_pa));
    Ok(Message { text, faults })
}

/// The noise in pascals, beside what typical contacts read.
fn noise_of(design: &Design, measured: &Unloaded, loaded: &[Vec<f64>]) -> Result<MeasuredNoise, String> {
    let noise = measured.noise_of(design, loaded).map_err(|error| format!("--loaded: {error}"))?;
    let share = noise.share();
    if share > MAX_NOISE {
        return Err(format!(
            "--loaded: the noise is {:.0} % of a typical contact's largest reading, above the {} % of sensor.noise; press harder",
            100.0 * share,
            100.0 * MAX_NOISE
        ));
    }
    Ok(MeasuredNoise { largest: noise.largest.min(design.hardware.full_scale_pa), ..noise })
}

/// The value of `sensor.noise` in the units of frames; with a curve the share, as a count is unlike at each stress.
fn key(input: &Input, MeasuredNoise { deviation, largest }: MeasuredNoise) -> String {
    if input.curve.is_some() {
        return shown(deviation / largest).to_string();
    }
    let unit = input.pa_per_count.unwrap_or(1.0).abs();
    format!("{{ deviation = {}, largest = {} }}", shown(deviation / unit), digits(largest / unit, 3, f64::floor))
}

/// Rounded up to a tenth, and not to 0.
fn ceil(pascals: f64) -> f64 {
    (10.0 * pascals).ceil().max(1.0) / 10.0
}

/// With two digits, rounded up.
fn shown(value: f64) -> f64 {
    digits(value, 2, f64::ceil)
}

/// With so many digits, rounded by `pick`, and not to 0.
fn digits(value: f64, count: i32, pick: fn(f64) -> f64) -> f64 {
    let unit = 10_f64.powi(value.log10().floor() as i32 + 1 - count);
    // So that 0.00024 is no 0.00024000000000000003, and 1000 does not become 999.
    let near = |value: f64| (value * 1e9).round() / 1e9;
    near(pick(near(value / unit)) * unit).max(1e-9)
}
