//! `sptfra calibrate` from recordings with measured forces or pressures.

use std::path::{Path, PathBuf};

use golden::calibrate::recorded::{
    Measured, Recorded, RecordedError, creep, fit_forces, fit_uniform, read_forces, read_pressures,
};
use golden::check::check;
use golden::creep::Creep;
use golden::design::Design;
use golden::matrices::Matrices;
use golden::numbers::counted;
use golden::output::write_together;
use golden::progress::Progress;
use golden::resolved::{Resolved, keep_apart};
use golden::tune_filter::rebase;
use serde::Serialize;
use testbench::calibration_page::page;

use super::recording::{LayoutArguments, Recording, warn};
use crate::arguments::name_of;
use crate::message::{self, json_or, say};

/// Rounds of fits at most: what counts mean tells creep, and readings without creep tell what counts mean.
const ROUNDS: usize = 10;
/// They end when readings without creep change by less than this share of the largest.
const SETTLED: f64 = 1e-3;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Recordings with measured forces or pressures.
#[derive(clap::Args, Debug)]
pub struct Recordings {
    /// Frames of contacts, as for `sptfra solve`.
    #[arg(long, value_name = "FRAMES.csv", requires = "forces")]
    frames: Option<PathBuf>,
    /// Forces measured with them (CSV or .npy), one line a frame.
    #[arg(long, value_name = "FORCES.csv", requires = "frames")]
    forces: Option<PathBuf>,
    /// Frames under uniform pressure, from a bladder over all taxels.
    #[arg(long, value_name = "FRAMES.csv", requires = "pressures")]
    uniform: Option<PathBuf>,
    /// Pressures measured with them (CSV or .npy), one line a frame.
    #[arg(long, value_name = "P.csv", requires = "uniform")]
    pressures: Option<PathBuf>,
    /// Unloaded frames, then a weight that stays, with times: measures creep.
    ///
    /// The times are a column. --labels and --columns are those of all recordings.
    #[arg(long, value_name = "FRAMES.csv")]
    constant_load: Option<PathBuf>,
    #[command(flatten)]
    layout: LayoutArguments,
    /// Where to write a page with plots (HTML, complete in itself).
    #[arg(long, value_name = "PAGE.html")]
    page: Option<PathBuf>,
}

impl Recordings {
    /// Whether there is anything recorded.
    pub fn given(&self) -> bool {
        self.frames.is_some()
            || self.uniform.is_some()
            || self.constant_load.is_some()
            || self.page.is_some()
            || self.layout.given()
    }
}

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    resolved: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    uniform: Option<&'a Recorded>,
    #[serde(skip_serializing_if = "Option::is_none")]
    forces: Option<&'a Recorded>,
    #[serde(skip_serializing_if = "Option::is_none")]
    creep: Option<creep::Fitted>,
    next: String,
}

/// Fits the design in `path` to recordings and writes it to `out`.
pub fn run(path: &Path, out: &Path, recordings: &Recordings, json: bool) -> message::Result {
    let Recordings { frames, forces, uniform, pressures, constant_load, layout, page: page_file } = recordings;
    if frames.is_none() && uniform.is_none() && constant_load.is_none() {
        return Err("--labels, --columns, --skip-lines, --skip-bad and --page are for recordings: give --frames and \
             --forces, --uniform and --pressures, or --constant-load"
            .into());
    }
    if page_file.is_some() && frames.is_none() && uniform.is_none() {
        return Err("--page shows loads and gains: give --frames and --forces, or --uniform and --pressures".into());
    }
    let mut design = Design::load(path)?;
    let resolved = Resolved::anew(path, out)?;
    let inputs: Vec<&Path> =
        [frames, forces, uniform, pressures, constant_load].into_iter().flatten().map(AsRef::as_ref).collect();
    let outputs = resolved.all();
    for output in outputs.iter().chain(page_file) {
        keep_apart(output, &inputs)?;
    }
    if let Some(page_file) = page_file
        && outputs.contains(page_file)
    {
        return Err(format!("{}: named for both the design and the page; choose two names", page_file.display()).into());
    }
    if let Some(name) = name_of(out) {
        design.name = name;
    }
    let progress = Progress::of("fitting");
    let mut given = [
        Pressed::read(uniform.as_ref().zip(pressures.as_ref()), layout, &design, read_pressures)?,
        Pressed::read(frames.as_ref().zip(forces.as_ref()), layout, &design, read_forces)?,
    ];
    let weight = constant_load.as_ref().map(|file| Weight::read(file, layout, &design)).transpose()?;
    let find_creep = |design: &Design| weight.as_ref().map(|weight| weight.creep(design)).transpose();
    let own = design.input.creep.take();
    let mut found_creep = find_creep(&design)?;
    let mut fitted = (design.clone(), [None, None]);
    let mut settled = false;
    for _ in 0..ROUNDS {
        let creep = found_creep.map(|found| found.creep).or(own);
        settled = true;
        for pressed in given.iter_mut().flatten() {
            settled &= !pressed.free(creep, &fitted.0)?;
        }
        if settled {
            break;
        }
        fitted = fit(&design, &given)?;
        found_creep = find_creep(&fitted.0)?;
    }
    if let (Some(weight), Some(found)) = (&weight, &found_creep) {
        found.check().map_err(|problem| format!("{}: {problem}", weight.file.display()))?;
    }
    let (mut design, mut results) = fitted;
    for (pressed, found) in given.iter().zip(&results) {
        if let (Some(pressed), Some(found)) = (pressed, found) {
            let missing = found.refuse_missing(&pressed.measured);
            missing.map_err(|problem| format!("{}: {problem}", pressed.file.display()))?;
        }
    }
    if let Some(found) = results.iter_mut().flatten().last().filter(|_| !settled) {
        found.remarks.push(format!(
            "creep and what counts mean still change after {ROUNDS} rounds of fits: calibrate {} again with these recordings",
            out.display()
        ));
    }
    // As the design reads them now: sign, unit and tare are what was fitted. A bladder loads every taxel.
    let findings = given[1].as_ref().map(|pressed| check(&design, &pressed.freed, Matrices::of(&design).ok().as_ref()));
    design.input.creep = found_creep.map(|found| found.creep).or(own);
    drop(progress);
    warn(&findings.unwrap_or_default());
    rebase(&mut design, path, out);
    let mut contents = resolved.contents(&design, "Calibrated by `sptfra calibrate` from recordings.");
    if let Some(page_file) = page_file {
        contents.insert(0, (page_file.clone(), page(&design, results.each_ref().map(Option::as_ref))));
    }
    write_together(&contents)?;
    let [uniform, forces] = &results;
    let report = Report {
        design: &design.name,
        resolved: out,
        uniform: uniform.as_ref(),
        forces: forces.as_ref(),
        creep: found_creep,
        next: next(out, recordings),
    };
    Ok(json_or(&report, json, text)?.into())
}

/// The command to run next.
fn next(out: &Path, recordings: &Recordings) -> String {
    match &recordings.frames {
        Some(frames) => {
            let layout = recordings.layout.options();
            format!(
                "sptfra solve {} --frames {}{layout} --out {}",
                out.display(),
                frames.display(),
                out.with_extension("forces.csv").display()
            )
        }
        None if recordings.constant_load.is_some() => {
            format!("sptfra solve {} --frames FRAMES.csv --out FORCES.csv", out.display())
        }
        None => {
            format!("sptfra calibrate {} --frames FRAMES.csv --forces FORCES.csv --out CHECKED.toml", out.display())
        }
    }
}

/// Frames of contacts or of uniform pressure, and what was measured with them.
struct Pressed<'a> {
    file: &'a Path,
    frames: Vec<Vec<f64>>,
    /// Seconds from frame to frame, or why they are unknown; nothing without times.
    interval: Option<std::result::Result<f64, String>>,
    measured: Measured,
    /// The frames without creep.
    freed: Vec<Vec<f64>>,
}

impl<'a> Pressed<'a> {
    fn read(
        files: Option<(&'a PathBuf, &PathBuf)>,
        layout: &LayoutArguments,
        design: &Design,
        table: impl Fn(&Path) -> std::result::Result<Measured, RecordedError>,
    ) -> Result<Option<Self>> {
        let Some((file, measured)) = files else { return Ok(None) };
        let recording = Recording { file, layout: layout.layout() }.read_all(design)?;
        let table = table(measured)?;
        let has_times = recording.times.is_some() && table.times.is_some();
        let table = match &recording.times {
            Some(times) if has_times => table.at(times),
            _ => Ok(table.without_skipped(&recording)),
        };
        let measured = table.map_err(|problem| format!("{}: {problem}", measured.display()))?;
        let interval = recording.times.as_ref().map(|_| creep::interval_of(&recording));
        Ok(Some(Self { file, frames: recording.frames, interval, measured, freed: Vec::new() }))
    }

    /// Takes creep off the frames as a design reads them; whether that changes what it was before.
    fn free(&mut self, creep: Option<Creep>, design: &Design) -> Result<bool> {
        let mut freed = self.frames.clone();
        if let Some(creep) = creep {
            // The recording may have another rate than the frames to come.
            let interval = self.interval.clone().transpose();
            let interval = interval.map_err(|problem| format!("{}: {problem}", self.file.display()))?;
            let rate = interval.map_or(creep.frames_per_second, |interval| 1.0 / interval);
            creep::remove_creep(&Creep { frames_per_second: rate, ..creep }, design, &mut freed);
        }
        let largest = freed.iter().flatten().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let mut pairs = freed.iter().flatten().zip(self.freed.iter().flatten());
        let changed = self.freed.is_empty() || pairs.any(|(now, before)| (now - before).abs() > SETTLED * largest);
        self.freed = freed;
        Ok(changed)
    }
}

/// The design with what is found from uniform pressure and from contacts.
fn fit(design: &Design, given: &[Option<Pressed<'_>>; 2]) -> Result<(Design, [Option<Recorded>; 2])> {
    let mut design = design.clone();
    let mut results = [None, None];
    for (place, fit) in [fit_uniform, fit_forces].into_iter().enumerate() {
        let Some(Pressed { freed, measured, .. }) = &given[place] else { continue };
        let found = fit(&design, freed, measured)?;
        design = found.design.clone();
        results[place] = Some(found);
    }
    Ok((design, results))
}

/// A recording of a weight that stays.
struct Weight<'a> {
    file: &'a Path,
    frames: Vec<Vec<f64>>,
    /// From frame to frame.
    seconds: f64,
}

impl<'a> Weight<'a> {
    fn read(file: &'a Path, layout: &LayoutArguments, design: &Design) -> Result<Self> {
        let recording = Recording { file, layout: layout.layout() }.read_all(design)?;
        let seconds = creep::interval_of(&recording).map_err(|problem| format!("{}: {problem}", file.display()))?;
        Ok(Self { file, frames: recording.frames, seconds })
    }

    /// The creep that a design finds in it.
    fn creep(&self, design: &Design) -> Result<creep::Fitted> {
        let sums: Vec<f64> = self.frames.iter().map(|frame| design.stress_of(frame).iter().sum()).collect();
        Ok(creep::fit(&sums, self.seconds).map_err(|problem| format!("{}: {problem}", self.file.display()))?)
    }
}

fn text(report: &Report<'_>) -> String {
    let mut text = String::new();
    say!(text, "{}: calibrated design in {}", report.design, report.resolved.display());
    for (what, found) in [("uniform pressure", report.uniform), ("contacts", report.forces)] {
        let Some(found) = found else { continue };
        match found.holds.len() {
            0 => say!(text, "from {what}: {}", counted(found.contacts, "contact")),
            holds => say!(text, "from {what}: {}, {}", counted(holds, "hold"), counted(found.contacts, "contact")),
        }
        for (title, lines) in [
            ("determined", &found.determined),
            ("not determined", &found.undetermined),
            ("to be known", &found.remarks),
        ] {
            if !lines.is_empty() {
                say!(text, "  {title}");
            }
            for line in lines {
                say!(text, "    {line}");
            }
        }
    }
    if let Some(creep::Fitted { creep, held_s, rise, residual_share, .. }) = &report.creep {
        say!(text, "from constant load: the readings rise by {:.1} % in {held_s:.1} s", 100.0 * rise);
        say!(
            text,
            "  creep       strength {:.3}, time constant {:.2} s at {} frames a second; corrected, readings vary by {:.1} % of their mean",
            creep.strength,
            creep.seconds,
            creep.frames_per_second,
            100.0 * residual_share
        );
    }
    say!(text, "next: {}", report.next);
    text
}
