//! `golden calibrate`: the constants of the joint estimator.

use std::error::Error;
use std::path::Path;

use golden::calibrate::{Work, calibrate};
use golden::choose::rebase_scenes;
use golden::design::{Design, Family, Filter, is_name};
use golden::output::write_together;
use golden::progress::Progress;
use serde::Serialize;

use super::{Resolved, folder};

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    resolved: &'a Path,
    family: Family,
    gain: f64,
    tangential: [f64; 2],
    half_window: Option<[usize; 2]>,
    weights: usize,
}

/// Calibrates the design in `path` and writes the resolved design to `out`.
///
/// A family of contacts takes the place of the one that the design names.
pub fn run(path: &Path, out: &Path, family: Option<Family>, work: Work, json: bool) -> Result<(), Box<dyn Error>> {
    let mut design = Design::load_unfitted(path)?;
    if let Some(name) = name_of(out) {
        design.name = name;
    }
    if let Some(family) = family {
        design.algorithm.joint.family = family;
    }
    let family = design.algorithm.joint.family;
    let settings = work.settings(family, design.algorithm.joint.grid)?;
    let resolved = Resolved::new(&design, path, out)?;
    let progress = Progress::new();
    progress.counted_in("steps", "calibrating", settings.work(family) as u64);
    *design.algorithm.joint = calibrate(&design, &settings, &mut |_| progress.step())?;
    drop(progress);
    if let Filter::F3 { scenes, .. } = &mut design.algorithm.filter {
        *scenes = rebase_scenes(scenes, folder(path), folder(out));
    }
    let remark =
        format!("Resolved by `golden calibrate`, seed {}: the constants of the joint estimator.", settings.seed);
    write_together(&resolved.contents(&design, &remark))?;

    let constants = &design.algorithm.joint;
    let correction = constants.correction.as_ref();
    let report = Report {
        design: &design.name,
        resolved: out,
        family: constants.family,
        gain: constants.gain,
        tangential: constants.tangential,
        half_window: correction.map(|correction| correction.half_window),
        weights: correction.map_or(0, |found| found.hidden.iter().chain(&found.output).map(Vec::len).sum()),
    };
    if json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{}: calibrated design in {}", report.design, out.display());
        say!("  family      {}", report.family);
        say!("  gain        {:.4}", report.gain);
        say!("  tangential  {:.4} mu + {:.4} mu |mu|^2", report.tangential[0], report.tangential[1]);
        if let Some([x, y]) = report.half_window {
            say!("  correction  {} weights, window {} x {} taxels", report.weights, 2 * x + 1, 2 * y + 1);
        }
    }
    Ok(())
}

/// The name of a design in a file: a design of its own, beside whose hardware that of the first one stays. Nothing if the
/// file is called what no module can be.
pub(super) fn name_of(file: &Path) -> Option<String> {
    let name = file.file_stem()?.to_str()?.replace('-', "_");
    is_name(&name).then_some(name)
}
