//! `golden scene`: frames with known forces.

use std::error::Error;
use std::path::Path;

use golden::design::Design;
use golden::output::write_whole;
use golden::progress::Progress;
use golden::scene::Scene;
use golden::{forces, frames, geometry};
use serde::Serialize;

use super::keep_apart;

#[derive(Serialize)]
struct SceneReport<'a> {
    frames: usize,
    taxels: usize,
    frames_file: &'a Path,
    forces_file: &'a Path,
    sensor_file: &'a Path,
}

/// Makes the frames of `scene`, or the standing ones of `design`, in `out`, and their forces and sensor beside it.
pub fn run(scene: Option<&Path>, design: Option<&Path>, out: &Path, json: bool) -> Result<(), Box<dyn Error>> {
    let (forces_file, sensor_file) = (forces::reference_path(out), geometry::beside(out));
    let inputs: Vec<&Path> = [scene, design].into_iter().flatten().collect();
    for file in [out, &forces_file, &sensor_file] {
        keep_apart(file, &inputs)?;
    }
    let design = design.map(Design::load).transpose()?;
    let scene = Scene::for_design(scene, design.as_ref())?;
    let made = {
        let _progress = Progress::of("computing the stress");
        scene.frames()?
    };
    if forces_file == out {
        return Err(
            format!("{}: the true forces would overwrite the frames; choose another name", out.display()).into()
        );
    }
    // The forces first: a frame file always has its forces and its sensor beside it.
    forces::write_reference(&forces_file, &made)?;
    write_whole(&sensor_file, geometry::to_toml(&scene.sensor).as_bytes())?;
    let mut stresses: Vec<Vec<f64>> = made.into_iter().map(|frame| frame.stress).collect();
    if let Some(design) = &design {
        for frame in &mut stresses {
            design.deliver(frame);
        }
    }
    frames::write_frames(out, &stresses)?;
    if json {
        let report = SceneReport {
            frames: stresses.len(),
            taxels: scene.sensor.taxels(),
            frames_file: out,
            forces_file: &forces_file,
            sensor_file: &sensor_file,
        };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{} frames of {} taxels in {}", stresses.len(), scene.sensor.taxels(), out.display());
        say!("their true forces in {}", forces_file.display());
        say!("their sensor, {}, in {}", scene.sensor, sensor_file.display());
    }
    Ok(())
}
