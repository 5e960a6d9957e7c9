//! The reference scenes of a design file.

use std::path::{Component, Path, PathBuf};

use crate::design::{Design, Filter};
use crate::resolved::folder;
use crate::scene::{Scene, SceneError, SceneFrame};

/// Computes the frames of the reference scenes of a design; their paths are relative to `folder`, that of the design
/// file.
///
/// # Errors
///
/// A design without any, or a scene that is wrong, in words.
pub fn reference_frames(design: &Design, folder: &Path) -> Result<Vec<SceneFrame>, String> {
    let name = &design.name;
    let Filter::F3 { scenes, .. } = &design.algorithm.filter else {
        return Err(format!(
            "{name}: the filter is not f3, so there is nothing to choose; write \
             filter = {{ kind = \"f3\", scenes = [\"SCENE.toml\"] }} under [algorithm]"
        ));
    };
    if scenes.is_empty() {
        return Err(format!(
            "{name}: the filter f3 names no scenes to choose by; write scenes = [\"SCENE.toml\"] beside its kind, relative to \
             the design file"
        ));
    }
    let mut frames = Vec::new();
    for scene in scenes {
        let path = folder.join(scene);
        // The path is part of some messages already.
        let failed = |error: SceneError| match error {
            SceneError::File(error) => format!("reference scene {error}"),
            SceneError::TooFine { .. } => format!("reference scene {}: {error}", path.display()),
        };
        let scene = Scene::load(&path).map_err(failed)?;
        if scene.sensor != design.sensor {
            return Err(format!(
                "reference scene {}: its [sensor] is not that of the design {name}; give a scene with the same columns, rows, \
                 pitch_mm and depth_mm",
                path.display()
            ));
        }
        frames.extend(scene.frames().map_err(failed)?);
    }
    Ok(frames)
}

/// Has a design of the file `from` name its reference scenes from the folder of the file `to`.
pub fn rebase(design: &mut Design, from: &Path, to: &Path) {
    if let Filter::F3 { scenes, .. } = &mut design.algorithm.filter {
        *scenes = rebase_scenes(scenes, folder(from), folder(to));
    }
}

/// Rewrites paths of scenes that are relative to the folder `from` so that they lead to the same files from `to`.
fn rebase_scenes(scenes: &[String], from: &Path, to: &Path) -> Vec<String> {
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
