//! `sptfra scene`: frames with known forces.

use std::path::{Path, PathBuf};

use golden::design::Design;
use golden::output::write_whole;
use golden::progress::Progress;
use golden::resolved::keep_apart;
use golden::scene::{Kind, Scene};
use golden::{forces, frames, geometry};
use serde_json::{Value, json};

use super::recording::is_standard;
use crate::arguments::{design_file, rows_file, word, words_of};
use crate::message::{self, json_or};

const EXAMPLE: &str = "Example:\n  sptfra scene scenes/sensor1-hertz.toml --out frames.csv\n  sptfra scene --design pad --kind held --out held.csv";

const SCENE_FILE: &str = include_str!("../help/scene.txt");

/// Makes frames of stress from contacts with known forces.
///
/// The frames go to FRAMES.csv, one a line, and the true forces to FRAMES.forces.csv, in the columns of `sptfra solve`.
/// FRAMES.sensor.toml names their sensor: `solve`, `check`, `run` and `view` refuse them for a design of another one.
///
/// With --design alone: a round contact in the middle of the design's sensor, friction 0.5, in 36 directions. With --kind
/// too: contacts that the calibration may not have seen, to test an estimator on.
#[derive(clap::Args)]
#[command(after_help = EXAMPLE, after_long_help = format!("{EXAMPLE}\n\n{}", SCENE_FILE.trim_end()))]
pub struct Args {
    /// Scene file (TOML).
    #[arg(required_unless_present = "design")]
    scene: Option<PathBuf>,
    /// Design file (TOML) whose sensor the frames are for; in counts, if it counts.
    #[arg(long, value_name = "DESIGN.toml", value_parser = design_file())]
    design: Option<PathBuf>,
    /// Contacts of a kind in place of a scene, anywhere on the sensor, in any direction.
    #[arg(long, value_parser = word::<Kind>(), requires = "design", conflicts_with = "scene")]
    #[arg(hide_possible_values = true, long_help = format!("Contacts of a kind in place of a scene, anywhere on the sensor, in any direction: {}", words_of::<Kind>().join(", ")))]
    kind: Option<Kind>,
    #[command(flatten)]
    random: RandomContacts,
    /// Where to write the frames (CSV, or .npy by its ending); `-`: standard output.
    ///
    /// Standard output has the frames alone.
    #[arg(long, value_name = "FRAMES.csv", value_parser = rows_file())]
    out: PathBuf,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// The random choice of contacts of a kind.
#[derive(Clone, Copy, clap::Args)]
pub struct RandomContacts {
    /// Number of frames of --kind.
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=100_000), requires = "kind")]
    count: u64,
    /// Friction of contacts of --kind; mixed ones have their own.
    #[arg(long, value_name = "MU", default_value_t = 0.5, value_parser = friction, requires = "kind")]
    friction: f64,
    /// First of the seeds of --kind, one a frame.
    #[arg(long, value_name = "SEED", default_value_t = 1, value_parser = clap::value_parser!(u64).range(..1 << 32), requires = "kind")]
    seed: u64,
}

fn friction(text: &str) -> Result<f64, String> {
    let friction: f64 = text.parse().map_err(|_| "a number, such as 0.5".to_owned())?;
    if (0.0..=2.0).contains(&friction) { Ok(friction) } else { Err("from 0 to 2".to_owned()) }
}

/// Makes the frames with their forces and sensor beside them; for `-` the frames alone, under a comment with their
/// sensor.
pub fn run(args: &Args) -> message::Result {
    let Args { scene, design, kind, random, out, json } = args;
    let (scene, design, kind) = (scene.as_deref(), design.as_deref(), kind.map(|kind| (kind, *random)));
    let to_a_pipe = is_standard(out);
    if to_a_pipe && *json {
        return Err("--json and --out - both write to standard output; name a file, or leave --json out".into());
    }
    let (forces_file, sensor_file) = (forces::reference_path(out), geometry::beside(out));
    let inputs: Vec<&Path> = [scene, design].into_iter().flatten().collect();
    if !to_a_pipe {
        for file in [out.as_path(), &forces_file, &sensor_file] {
            keep_apart(file, &inputs)?;
        }
    }
    let design = design.map(Design::load).transpose()?;
    let (sensor, made) = {
        let _progress = Progress::of("computing the stress");
        if let (Some((kind, RandomContacts { count, friction, seed })), Some(design)) = (kind, &design) {
            (design.sensor.clone(), kind.frames(&design.sensor, friction, seed..seed + count)?)
        } else {
            let scene = Scene::for_design(scene, design.as_ref())?;
            (scene.sensor.clone(), scene.frames()?)
        }
    };
    if forces_file == *out {
        return Err(
            format!("{}: the true forces would overwrite the frames; choose another name", out.display()).into()
        );
    }
    if !to_a_pipe {
        // The forces first: a frame file always has its forces and its sensor beside it.
        forces::write_reference(&forces_file, &made)?;
        write_whole(&sensor_file, geometry::to_toml(&sensor).as_bytes())?;
    }
    let mut stresses: Vec<Vec<f64>> = made.into_iter().map(|frame| frame.stress).collect();
    if let Some(design) = &design {
        design.deliver_in_order(&mut stresses);
    }
    if to_a_pipe {
        return Ok((geometry::remark(&sensor) + &frames::to_text(&stresses)).into());
    }
    frames::write_frames(out, &stresses)?;
    let (frames, taxels) = (stresses.len(), sensor.taxels());
    let [out, forces, of_sensor] = [out, &forces_file, &sensor_file].map(|file| file.to_string_lossy());
    let report = json!({
        "frames": frames,
        "taxels": taxels,
        "frames_file": out,
        "forces_file": forces,
        "sensor_file": of_sensor,
    });
    let text = |_: &Value| {
        format!(
            "{frames} frames of {taxels} taxels in {out}\ntheir true forces in {forces}\n\
             their sensor, {sensor}, in {of_sensor}\n"
        )
    };
    Ok(json_or(&report, *json, text)?.into())
}
