//! The reference scenes of a design file.

use std::path::{Component, Path, PathBuf};

use super::TuneFilterError;
use crate::design::{Design, Filter};
use crate::scene::{Scene, SceneFrame};

/// Computes the frames of the reference scenes of a design; their paths are relative to `folder`, that of the design
/// file.
///
/// # Errors
///
/// [`TuneFilterError::OtherFilter`] and [`TuneFilterError::NoScenes`] for a design without any,
/// [`TuneFilterError::Scene`] and [`TuneFilterError::OtherSensor`] for scenes that are wrong.
pub fn reference_frames(design: &Design, folder: &Path) -> Result<Vec<SceneFrame>, TuneFilterError> {
    let name = || design.name.clone();
    let Filter::F3 { scenes, .. } = &design.algorithm.filter else {
        return Err(TuneFilterError::OtherFilter { name: name() });
    };
    if scenes.is_empty() {
        return Err(TuneFilterError::NoScenes { name: name() });
    }
    let mut frames = Vec::new();
    for scene in scenes {
        let path = folder.join(scene);
        let failed = |source| TuneFilterError::Scene { path: path.clone(), source };
        let scene = Scene::load(&path).map_err(failed)?;
        if scene.sensor != design.sensor {
            return Err(TuneFilterError::OtherSensor { path, name: name() });
        }
        frames.extend(scene.frames().map_err(failed)?);
    }
    Ok(frames)
}

/// Rewrites paths of scenes that are relative to the folder `from` so that they lead to the same files from `to`.
pub fn rebase_scenes(scenes: &[String], from: &Path, to: &Path) -> Vec<String> {
    let (Ok(from), Ok(to)) = (from.canonicalize(), to.canonicalize()) else { return scenes.to_vec() };
    if from == to {
        return scenes.to_vec();
    }
    scenes
        .iter()
        .map(|scene| {
            let target = normal(&from.join(scene));
            // From the last folder that both have in common, up and down again.
            let common = target.components().zip(to.components()).take_while(|(a, b)| a == b).count();
            let up = to.components().skip(common).map(|_| Component::ParentDir);
            let path: PathBuf = up.chain(target.components().skip(common)).collect();
            path.to_string_lossy().into_owned()
        })
        .collect()
}

/// A path without `.` and `..`; its folders are no links, or are taken for what they point at.
fn normal(path: &Path) -> PathBuf {
    if let (Some(Ok(folder)), Some(name)) = (path.parent().map(Path::canonicalize), path.file_name()) {
        return folder.join(name);
    }
    path.to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn scenes_are_found_from_another_folder() {
        let root = tempfile::TempDir::new().unwrap();
        for folder in ["designs/tried", "scenes"] {
            fs::create_dir_all(root.path().join(folder)).unwrap();
        }
        let [designs, tried] = ["designs", "designs/tried"].map(|folder| root.path().join(folder));
        let scenes = ["../scenes/a.toml".to_owned(), "b.toml".to_owned()];
        assert_eq!(rebase_scenes(&scenes, &designs, &designs.join("../designs")), scenes);
        let moved = rebase_scenes(&scenes, &designs, &tried);
        assert_eq!(moved, ["../../scenes/a.toml", "../b.toml"]);
        assert_eq!(rebase_scenes(&moved, &tried, &designs), scenes);
        assert_eq!(rebase_scenes(&scenes, &designs, root.path()), ["scenes/a.toml", "designs/b.toml"]);
    }
}
