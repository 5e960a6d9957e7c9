//! Which scene frames are made of: one of a file, or the standing one of a design's sensor.

use std::path::Path;

use super::{Scene, SceneError};
use crate::design::Design;

/// Why there is no scene to make frames of.
#[derive(Debug, thiserror::Error)]
pub enum ChoiceError {
    /// The scene of the file.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene of another sensor than the design's, or neither a scene nor a design, in words.
    #[error("{0}")]
    Wrong(String),
}

impl Scene {
    /// The scene of the file, which must be one of the design's sensor if there is a design; without a file that sensor's
    /// standing scene.
    ///
    /// # Errors
    ///
    /// [`ChoiceError`].
    pub fn for_design(file: Option<&Path>, design: Option<&Design>) -> Result<Self, ChoiceError> {
        match (file, design) {
            (Some(file), None) => Ok(Self::load(file)?),
            (Some(file), Some(design)) => {
                let scene = Self::load(file)?;
                if scene.sensor == design.sensor {
                    return Ok(scene);
                }
                Err(ChoiceError::Wrong(format!(
                    "{}: the scene has {}, the design {} has {}; write the design's values under [sensor] in the scene, or \
                     leave the scene out for a contact that suits the design",
                    file.display(),
                    scene.sensor,
                    design.name,
                    design.sensor
                )))
            }
            (None, Some(design)) => Ok(Self::standing(&design.sensor)),
            (None, None) => Err(ChoiceError::Wrong(
                "nothing to make frames of; name a scene file, or a design with --design".to_owned(),
            )),
        }
    }
}
