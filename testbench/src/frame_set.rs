//! The frames of a run, and their true forces where they are known.

use std::path::Path;

use golden::design::Sensor;
use golden::forces::read_outcomes;
use golden::frames::{FrameError, read_frames};
use golden::metrics::Outcome;
use golden::scene::{Scene, SceneError};

/// Frames of one sensor.
#[derive(Clone, Debug)]
pub struct FrameSet {
    /// Where they come from, for people.
    pub origin: String,
    /// Stresses in Pa, one frame of m taxels each.
    pub stress: Vec<Vec<f64>>,
    /// True forces, one for each frame.
    pub truth: Option<Vec<Outcome>>,
}

impl FrameSet {
    /// The standing set of ground-truth frames for a sensor.
    ///
    /// # Errors
    /// [`SceneError`] if the scene cannot be computed for this geometry.
    pub fn standing(sensor: &Sensor) -> Result<Self, SceneError> {
        let frames = Scene::standing(sensor).frames()?;
        let truth = frames.iter().map(Outcome::from).collect();
        let stress = frames.into_iter().map(|frame| frame.stress).collect();
        Ok(Self { origin: "the sensor's standing scene".to_owned(), stress, truth: Some(truth) })
    }

    /// Frames from a CSV file, with true forces from another if there is one.
    ///
    /// # Errors
    /// [`FrameError`], with file, line and column.
    pub fn load(frames: &Path, reference: Option<&Path>, sensor: &Sensor) -> Result<Self, FrameError> {
        let stress = read_frames(frames, sensor.taxels())?;
        let truth = reference.map(|path| read_outcomes(path, stress.len())).transpose()?;
        Ok(Self { origin: frames.display().to_string(), stress, truth })
    }
}
