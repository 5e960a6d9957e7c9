//! The frames of a run, and their true forces where they are known.

use std::path::Path;

use golden::design::{Design, Sensor};
use golden::forces::{self, read_outcomes};
use golden::frames::{FrameError, Frames, Layout, read_recording};
use golden::geometry;
use golden::metrics::Outcome;
use golden::scene::{Scene, SceneError, SceneFrame};

use crate::field_plot::Truth;

/// Frames of one sensor.
#[derive(Clone, Debug)]
pub struct FrameSet {
    /// Where they come from, for people.
    pub origin: String,
    /// What the stream carries, one frame of m taxels each: stresses in Pa, or counts if the design says so.
    pub stress: Vec<Vec<f64>>,
    /// True forces, one for each frame.
    pub truth: Option<Vec<Outcome>>,
    /// What is to be known of the file that they are from.
    pub remark: Option<String>,
    /// The scene that the frames are of, where that is known: it knows each taxel's true force.
    pub scene: Option<Scene>,
}

impl FrameSet {
    /// Frames of a simulated contact, with known forces: those of [`Scene::standing`].
    ///
    /// # Errors
    /// [`SceneError`] if the scene cannot be computed for this geometry.
    pub fn standing(sensor: &Sensor) -> Result<Self, SceneError> {
        Self::of_scene(&Scene::standing(sensor), "the simulated contact")
    }

    /// The frames of a scene.
    ///
    /// # Errors
    /// [`SceneError`] if it cannot be computed.
    pub fn of_scene(scene: &Scene, origin: impl Into<String>) -> Result<Self, SceneError> {
        Ok(Self { scene: Some(scene.clone()), ..Self::of_frames(&scene.frames()?, origin) })
    }

    /// Frames whose forces are known.
    pub fn of_frames(frames: &[SceneFrame], origin: impl Into<String>) -> Self {
        let truth = Some(frames.iter().map(Outcome::from).collect());
        let stress = frames.iter().map(|frame| frame.stress.clone()).collect();
        Self { origin: origin.into(), stress, truth, remark: None, scene: None }
    }

    /// What is known of the forces of a frame.
    pub fn truth_of(&self, frame: usize) -> Option<Truth> {
        let force = self.truth.as_ref()?.get(frame)?.force;
        Some(Truth { force, field: self.scene.as_ref().and_then(|scene| scene.surface(frame)) })
    }

    /// The same frames as the design's sensor delivers them: in counts, whole ones, if it counts.
    #[must_use]
    pub fn as_delivered(mut self, design: &Design) -> Self {
        design.deliver_in_order(&mut self.stress);
        self
    }

    /// Frames for a design from a file whose values stand as `layout` says, with true forces from another
    /// file if there is one.
    ///
    /// # Errors
    /// [`FrameError`], with file, line and column, or for frames that are known to be another sensor's.
    pub fn load(
        frames: &Path,
        layout: impl Into<Layout>,
        reference: Option<&Path>,
        design: &Design,
    ) -> Result<Self, FrameError> {
        geometry::compare(frames, &design.name, &design.sensor)?;
        let recording = read_recording(frames, design, layout)?;
        if let Some(reference) = reference {
            forces::compare_sensor(reference, &design.name, &design.sensor)?;
        }
        let outcomes = |path| recording.lines_of(|count| read_outcomes(path, count));
        let truth = reference.map(outcomes).transpose()?;
        let Frames { frames: stress, remark, .. } = recording;
        Ok(Self { origin: frames.display().to_string(), stress, truth, remark, scene: None })
    }
}
