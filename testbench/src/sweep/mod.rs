//! `sptfra sweep`: speed against error, one point a variant of a design and a scene.
//!
//! The way of the data: [`grid`] (which points) → [`evaluate`] (one point) → [`store`] (a file each) → [`csv_file`].

pub mod csv_file;
pub mod distributed;
pub mod evaluate;
pub mod grid;
pub mod page;
pub mod point;
pub mod store;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use golden::design::{DesignError, Sensor, text_of};
use golden::frames::FrameError;
use golden::output::OutputError;
use golden::scene::{Contact, Kind, Scene, SceneError, SceneFrame, Shear};
use hdl_gen::write::WriteError;
use rayon::prelude::*;
use serde::Deserialize;

use crate::frame_set::FrameSet;
use golden::progress::Progress;

use evaluate::Proof;
use grid::Job;
use point::{Point, Verified};
use store::Store;

/// Why a sweep has no result.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A design or scene file is wrong.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// The standing scene of a sensor cannot be computed.
    #[error(transparent)]
    StandingScene(#[from] SceneError),
    /// There is nothing to compute.
    #[error(
        "no point is left: no combination of these plans, filters, lanes and estimators exists (the grid search needs \
         the reduced plan, and a design that has it); leave one of the options out"
    )]
    NoPoints,
    /// Frames or forces cannot be written.
    #[error(transparent)]
    Frames(#[from] FrameError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] OutputError),
    /// A file or folder cannot be used.
    #[error(transparent)]
    Folder(#[from] WriteError),
    /// What is wrong with a point, a scene or a file.
    #[error("{label}: {source}")]
    At {
        /// Which.
        label: String,
        /// Why, and what to do.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl SweepError {
    fn at(label: impl Into<String>, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::At { label: label.into(), source: source.into() }
    }
}

/// Friction of the contacts of kinds that have none of their own.
const FRICTION: f64 = 0.5;
/// First seed of a kind's contacts: those of the calibrations' own are others.
const FIRST_SEED: u64 = 1000;

/// So many frames of each kind of contact, kind by kind.
///
/// # Errors
/// [`SceneError`] if they cannot be computed for this geometry.
pub fn frames_of_kinds(sensor: &Sensor, frames: u64) -> Result<Vec<(Kind, Vec<SceneFrame>)>, SceneError> {
    let of = |kind: Kind| kind.frames(sensor, FRICTION, FIRST_SEED..FIRST_SEED + frames).map(|frames| (kind, frames));
    Kind::all().map(of).collect()
}

/// Frames with known forces.
#[derive(Clone, Debug)]
pub struct SweepScene {
    /// The file's name without its ending; `standing` for a sensor's own, `kinds` for contacts of all kinds.
    pub name: String,
    /// The file's text, or what stands for it, which is part of the points' keys.
    pub text: String,
    /// The sensor.
    pub sensor: Sensor,
    /// The contacts that each frame has; none where each has a single one of its own.
    pub contacts: Vec<Contact>,
    /// The frames with their true forces.
    pub made: Vec<SceneFrame>,
    /// The same: stresses in Pa, and the true forces.
    pub frames: FrameSet,
}

impl SweepScene {
    /// Whether the sum of forces tells how well each contact was found: of contacts that are pushed against each other most of
    /// it is gone, and an answer of zero is nearly right. One contact is no sum.
    pub fn tells(&self) -> bool {
        let [_, _, ..] = self.contacts.as_slice() else { return true };
        let push = |contact: &Contact| match contact.traction.shear {
            Shear::Held { share } => share * contact.friction * contact.normal_force_n,
            _ => contact.friction * contact.normal_force_n,
        };
        let pushed: f64 = self.contacts.iter().map(push).sum();
        let truth = self.frames.truth.as_deref().unwrap_or_default();
        truth.iter().all(|truth| truth.force[0].hypot(truth.force[1]) >= 0.5 * pushed)
    }

    /// Reads a scene file and computes its frames.
    ///
    /// # Errors
    /// [`SweepError::At`] with the file.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let text = text_of(path)?;
        let origin = path.display().to_string();
        let scene = Scene::from_toml(&text, &origin)?;
        let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        Self::of(name, text, scene, origin).map_err(|error| SweepError::at(path.display().to_string(), error))
    }

    /// The standing scene of a sensor.
    ///
    /// # Errors
    /// [`SceneError`] if it cannot be computed for this geometry.
    pub fn standing(sensor: &Sensor) -> Result<Self, SceneError> {
        let name = "standing".to_owned();
        Self::of(name.clone(), name, Scene::standing(sensor), "the simulated contact".to_owned())
    }

    fn of(name: String, text: String, scene: Scene, origin: String) -> Result<Self, SceneError> {
        let made = scene.frames()?;
        let Scene { sensor, contacts, .. } = scene.clone();
        let frames = FrameSet { scene: Some(scene), ..FrameSet::of_frames(&made, origin) };
        Ok(Self { name, text, sensor, contacts, made, frames })
    }

    /// So many frames of each kind of contact, with one contact each.
    ///
    /// # Errors
    /// [`SceneError`] if they cannot be computed for this geometry.
    pub fn kinds(sensor: &Sensor, frames: u64) -> Result<Self, SceneError> {
        let made: Vec<SceneFrame> =
            frames_of_kinds(sensor, frames)?.into_iter().flat_map(|(_, frames)| frames).collect();
        let all = FrameSet::of_frames(&made, "contacts of all kinds");
        let text = format!("kinds, {frames} frames of each");
        Ok(Self { name: "kinds".to_owned(), text, sensor: sensor.clone(), contacts: Vec::new(), made, frames: all })
    }
}

/// How far the RTL itself is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Simulate {
    /// Nowhere: the integer model, bit-exact to the RTL, answers for it.
    #[default]
    None,
    /// The designs as they were given.
    Base,
    /// Every point.
    All,
}

/// What there is to do.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The points in order.
    pub jobs: Vec<Job>,
    /// The scenes that they name by number.
    pub scenes: Vec<SweepScene>,
    /// Which of them go through the RTL.
    pub simulate: Simulate,
    /// Folder with reports of `sptfra run --json`, `KEY.json` each, that stand for the simulation of their points.
    pub runs: Option<PathBuf>,
    /// Frames of each kind of contact in the page's table of kinds; without it for 0.
    pub kinds: u64,
}

/// What a sweep came to.
#[derive(Clone, Debug)]
pub struct Outcomes {
    /// All points in order.
    pub points: Vec<Point>,
    /// How many of them were computed now; the others were there.
    pub computed: usize,
}

impl Sweep {
    /// What a point is the result of.
    pub fn job(&self, key: &str) -> Option<&Job> {
        self.jobs.iter().find(|job| job.key == key)
    }

    /// How a point is to be verified at least.
    fn wanted(&self, job: &Job) -> Verified {
        match self.simulate {
            Simulate::All => Verified::Rtl,
            Simulate::Base if job.base => Verified::Rtl,
            _ if self.report_of(&job.key).is_some() => Verified::Rtl,
            _ => Verified::Model,
        }
    }

    /// Computes the points that the store does not have, on all cores, and reads all of them back.
    ///
    /// Every point is written as soon as it is there, so that a sweep that was stopped goes on from there.
    ///
    /// # Errors
    /// The first [`SweepError`] in the order of the points, after all others were tried.
    pub fn run(&self, store: &Store, progress: &Progress) -> Result<Outcomes, SweepError> {
        let missing: Vec<&Job> = self.jobs.iter().filter(|job| !store.has(&job.key, self.wanted(job))).collect();
        progress.counted_in("points", "sweeping", missing.len() as u64);
        // Verilator uses all cores by itself.
        let compiler = Mutex::new(());
        let results: Vec<Result<(), SweepError>> = missing
            .par_iter()
            .map(|job| {
                let point = self.compute(job, &compiler)?;
                store.put(&point)?;
                progress.step();
                Ok(())
            })
            .collect();
        results.into_iter().collect::<Result<Vec<()>, _>>()?;
        let points = self.jobs.iter().map(|job| store.get(&job.key)).collect::<Result<_, _>>()?;
        Ok(Outcomes { points, computed: missing.len() })
    }

    fn compute(&self, job: &Job, compiler: &Mutex<()>) -> Result<Point, SweepError> {
        let proof = match self.report_of(&job.key) {
            Some(report) => Proof::Report(report),
            None if self.wanted(job) == Verified::Rtl => Proof::Simulation(compiler),
            None => Proof::None,
        };
        evaluate::evaluate(job, &self.scenes[job.scene], &proof)
    }
}
