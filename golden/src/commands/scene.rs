//! `golden scene`: frames with known forces.

use std::error::Error;
use std::path::Path;

use golden::design::Design;
use golden::output::{print_text, write_whole};
use golden::progress::Progress;
use golden::scene::{Kind, Scene};
use golden::{forces, frames, geometry};
use serde::Serialize;

use super::{is_standard, keep_apart};

#[derive(Serialize)]
struct SceneReport<'a> {
    frames: usize,
    taxels: usize,
    frames_file: &'a Path,
    forces_file: &'a Path,
    sensor_file: &'a Path,
}

/// What is random of contacts of a kind.
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

/// Makes the frames of `scene`, those of a kind of contacts, or the standing ones of `design`, in `out`, and their forces and
/// sensor beside it; for `-` prints the frames under a remark with their sensor.
pub fn run(
    scene: Option<&Path>,
    design: Option<&Path>,
    kind: Option<(Kind, RandomContacts)>,
    out: &Path,
    json: bool,
) -> Result<(), Box<dyn Error>> {
    let to_a_pipe = is_standard(out);
    if to_a_pipe && json {
        return Err("--json and --out - both write to standard output; name a file, or leave --json out".into());
    }
    let (forces_file, sensor_file) = (forces::reference_path(out), geometry::beside(out));
    let inputs: Vec<&Path> = [scene, design].into_iter().flatten().collect();
    if !to_a_pipe {
        for file in [out, &forces_file, &sensor_file] {
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
    if forces_file == out {
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
        for frame in &mut stresses {
            design.deliver(frame);
        }
    }
    if to_a_pipe {
        return Ok(print_text(&(geometry::remark(&sensor) + &frames::to_text(&stresses)))?);
    }
    frames::write_frames(out, &stresses)?;
    if json {
        let report = SceneReport {
            frames: stresses.len(),
            taxels: sensor.taxels(),
            frames_file: out,
            forces_file: &forces_file,
            sensor_file: &sensor_file,
        };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{} frames of {} taxels in {}", stresses.len(), sensor.taxels(), out.display());
        say!("their true forces in {}", forces_file.display());
        say!("their sensor, {}, in {}", sensor, sensor_file.display());
    }
    Ok(())
}
