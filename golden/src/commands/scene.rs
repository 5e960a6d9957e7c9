//! `golden scene`: frames with known forces.

use std::error::Error;
use std::path::Path;

use golden::scene::Scene;
use golden::{forces, frames};
use serde::Serialize;

use super::{Stage, keep_apart};

#[derive(Serialize)]
struct SceneReport<'a> {
    frames: usize,
    taxels: usize,
    frames_file: &'a Path,
    forces_file: &'a Path,
}

/// Makes the frames of `scene` in `out`, and their forces beside it.
pub fn run(scene: &Path, out: &Path, json: bool) -> Result<(), Box<dyn Error>> {
    let forces_file = forces::reference_path(out);
    keep_apart(out, &[scene])?;
    keep_apart(&forces_file, &[scene])?;
    let scene = Scene::load(scene)?;
    let made = {
        let _stage = Stage::new("computing the stress");
        scene.frames()?
    };
    if forces_file == out {
        return Err(
            format!("{}: the true forces would overwrite the frames; choose another name", out.display()).into()
        );
    }
    // The forces first: a frame file always has its forces beside it.
    forces::write_reference(&forces_file, &made)?;
    let stresses: Vec<Vec<f64>> = made.into_iter().map(|frame| frame.stress).collect();
    frames::write_frames(out, &stresses)?;
    if json {
        let report = SceneReport {
            frames: stresses.len(),
            taxels: scene.sensor.taxels(),
            frames_file: out,
            forces_file: &forces_file,
        };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{} frames of {} taxels in {}", stresses.len(), scene.sensor.taxels(), out.display());
        say!("their true forces in {}", forces_file.display());
    }
    Ok(())
}
