//! `sptfra calibrate`: the constants of a design, from simulated contacts or recordings.

use std::path::PathBuf;

use golden::calibrate::{ERROR_FRAMES, Settings, calibrate, state_errors};
use golden::design::{Design, Estimator, JointConstants, StandardError, TrainingSet};
use golden::output::write_together;
use golden::progress::Progress;
use golden::resolved::Resolved;
use golden::tune_filter::rebase;
use serde_json::{Value, json};

use super::calibrate_recorded::{self, Recordings};
use crate::arguments::{design_file, name_of, word};
use crate::message::{self, json_or, say};

const EXAMPLE: &str = "Example:\n  sptfra calibrate pad --out pad-calibrated.toml\n  sptfra calibrate pad --frames weights.csv --forces weights.forces.csv --out pad-fitted.toml";

/// With these, nothing is trained.
const RECORDED: [&str; 3] = ["frames", "uniform", "constant_load"];

const CALIBRATE_FILES: &str = include_str!("../help/calibrate.txt");

/// Fits a design's constants to simulated contacts or to recordings.
///
/// Without --frames and --uniform: the standard error, and the constants of the grid search (`estimator = "joint"`).
/// Makes random contacts on a bonded layer, from the seed alone. Fits to their known forces a gain, two constants of the
/// friction, and the weights of the correction, then the standard error and the error to be expected by noise. The weights
/// go to RESOLVED.weights.csv beside RESOLVED.toml: both are written, or none.
///
/// With --frames and --forces: the scale of a count (a curve, a gain for all taxels, and the taxels' own), and the
/// constants of friction where tangential forces are known. Reports what the recording determines, with errors at places
/// that were left out, and what it does not, which stays as the design has it. With --uniform and --pressures: gains and
/// curve from a bladder's pressure. With --constant-load: creep from a weight that stays. All may be given.
#[derive(clap::Args)]
#[command(after_help = EXAMPLE, after_long_help = format!("{EXAMPLE}\n\n{}", CALIBRATE_FILES.trim_end()))]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Where to write the design with the constants (TOML).
    #[arg(long, value_name = "RESOLVED.toml")]
    out: PathBuf,
    #[command(flatten)]
    recordings: Recordings,
    /// Seed of the contacts and of the training.
    #[arg(long, default_value_t = 1, conflicts_with_all = RECORDED)]
    seed: u64,
    /// Training set [default: the design's]
    ///
    /// `sliding`: round contacts. `general`: contacts of any shape, tilted, held.
    #[arg(long, value_name = "SET", value_parser = word::<TrainingSet>(), conflicts_with_all = RECORDED)]
    training_set: Option<TrainingSet>,
    /// Hidden units of the correction [default: 128, sliding 64, --quick 24]
    ///
    /// 0 is a design without a correction.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=256), conflicts_with_all = RECORDED)]
    hidden: Option<u16>,
    /// Take a tenth of the time, to try it: the error may be twice as large.
    #[arg(long, conflicts_with_all = RECORDED)]
    quick: bool,
    /// Take about ten times the time: as exact with half of the hidden units.
    #[arg(long, conflicts_with_all = RECORDED, conflicts_with = "quick")]
    thorough: bool,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Calibrates a design and writes the resolved one.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, out, recordings, seed, training_set, hidden, quick, thorough, json } = args;
    if recordings.given() {
        return calibrate_recorded::run(path, out, recordings, *json);
    }
    let mut design = Design::load_unfitted(path)?;
    if let Some(name) = name_of(out) {
        design.name = name;
    }
    if let Some(training_set) = training_set {
        design.algorithm.joint.training_set = *training_set;
    }
    let training_set = design.algorithm.joint.training_set;
    let settings = Settings::of(training_set, *seed, hidden.map(usize::from), *quick, *thorough)?;
    let resolved = Resolved::new(&design, path, out)?;
    let progress = Progress::new();
    // The line search has a standard error only.
    let has_constants = design.algorithm.estimator == Estimator::Joint;
    let work = if has_constants { settings.work() } else { 0 };
    progress.counted_in("steps", "calibrating", (work + ERROR_FRAMES) as u64);
    if has_constants {
        *design.algorithm.joint = calibrate(&design, &settings, &mut || progress.step())?;
    }
    state_errors(&mut design, settings.seed, &mut || progress.step())?;
    drop(progress);
    rebase(&mut design, path, out);
    let remark = format!("Resolved by `sptfra calibrate`, seed {}.", settings.seed);
    write_together(&resolved.contents(&design, &remark))?;

    let JointConstants { gain, friction_correction, correction, .. } = design.algorithm.joint.as_ref();
    let half_window = correction.as_ref().map(|correction| correction.half_window);
    let weights: usize =
        correction.iter().flat_map(|found| found.hidden.iter().chain(&found.output)).map(Vec::len).sum();
    let (standard_error, expected) = (design.algorithm.standard_error, design.expected_error());
    let report = json!({
        "design": design.name,
        "resolved": out.to_string_lossy(),
        "training_set": training_set,
        "gain": gain,
        "friction_correction": friction_correction,
        "half_window": half_window,
        "weights": weights,
        "standard_error": standard_error,
        "expected_error": expected,
    });
    let text = |_: &Value| {
        let mut text = String::new();
        say!(text, "{}: calibrated design in {}", design.name, out.display());
        if has_constants {
            say!(text, "  training set  {training_set}");
        }
        say!(text, "  noise       {} % of the largest reading", (1e4 * design.input.noise).round() / 100.0);
        if has_constants {
            say!(text, "  gain        {gain:.4}");
            let [c1, c3] = friction_correction;
            let sign = if *c3 < 0.0 { '-' } else { '+' };
            say!(text, "  friction    {c1:.4} mu {sign} {:.4} mu |mu|^2", c3.abs());
        }
        if let Some([x, y]) = half_window {
            say!(text, "  correction  {weights} weights, window {} x {} taxels", 2 * x + 1, 2 * y + 1);
        }
        if let Some(StandardError { model, noise, border }) = standard_error {
            say!(text, "  standard error  model {model}, noise {noise}, border {border}");
        }
        if let Some(expected) = &expected {
            say!(text, "{expected}");
        }
        text
    };
    Ok(json_or(&report, *json, text)?.into())
}
