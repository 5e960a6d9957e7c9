//! `cargo xtask mutants`: does the testbench notice? Many copies of a design, each with one small fault, go through the
//! comparison that every design goes through; those that pass it are listed.

mod explained;
mod sites;

use std::fmt;

use golden::design::Design;
use golden::scene::SceneError;
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

pub use explained::{Explained, ExplainedError};
pub use sites::{Kind, Mutation, all};

use crate::stress::{BATCH, run_batch};
use golden::progress::Progress;
use testbench::co_simulation::{CoSimulation, CoSimulationError, Verdict, planned, rtl_sources};
use testbench::frame_set::FrameSet;
use testbench::stream_words::packets;
use testbench::verilate::{BuildError, Built, RtlSources, Verilate, translation};

/// Batches of `cargo xtask stress` after the standing frames.
const STRESS_BATCHES: u64 = 3;

/// How many, and which.
#[derive(Clone, Debug)]
pub struct Options {
    /// Mutants to make; those that no tool accepts, or that are the same hardware, do not count.
    pub count: usize,
    /// Decides which.
    pub seed: u64,
    /// Survivors that need no second look.
    pub explained: Explained,
}

/// What became of a mutant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// Verilator does not accept it.
    Rejected,
    /// Verilator makes the same of it as of the design: the line is left out there, or the change means nothing.
    Same,
    /// The comparison said so.
    Caught(String),
    /// Nobody noticed, and it is known why.
    Explained(String),
    /// Nobody noticed.
    Survived,
}

impl Fate {
    /// Whether the mutant is another hardware, so that there was something to notice.
    pub fn counts(&self) -> bool {
        !matches!(self, Self::Rejected | Self::Same)
    }
}

/// A mutant and its fate.
#[derive(Clone, Debug, Serialize)]
pub struct Mutant {
    /// What is wrong with it.
    pub mutation: Mutation,
    /// What became of it.
    pub fate: Fate,
}

/// All mutants of a design.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The design's name.
    pub design: String,
    /// See [`Options`].
    pub seed: u64,
    /// In the order in which they were made.
    pub mutants: Vec<Mutant>,
}

impl Report {
    /// Those that were not caught, without an explanation.
    pub fn survivors(&self) -> impl Iterator<Item = &Mutation> {
        self.mutants.iter().filter(|mutant| mutant.fate == Fate::Survived).map(|mutant| &mutant.mutation)
    }

    /// How many of a kind were simulated, and how many of them were not caught.
    pub fn of_kind(&self, kind: Kind) -> (usize, usize) {
        let made = || self.mutants.iter().filter(|mutant| mutant.mutation.kind == kind && mutant.fate.counts());
        let caught = made().filter(|mutant| matches!(mutant.fate, Fate::Caught(_))).count();
        (made().count(), made().count() - caught)
    }

    fn count(&self, of: impl Fn(&Fate) -> bool) -> usize {
        self.mutants.iter().filter(|mutant| of(&mutant.fate)).count()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            out,
            "{}, seed {}: {} mutants, {} caught, {} survived, of which {} are explained; {} more did not build, and of \
             {} Verilator makes the same as of the design",
            self.design,
            self.seed,
            self.count(Fate::counts),
            self.count(|fate| matches!(fate, Fate::Caught(_))),
            self.count(|fate| matches!(fate, Fate::Survived | Fate::Explained(_))),
            self.count(|fate| matches!(fate, Fate::Explained(_))),
            self.count(|fate| *fate == Fate::Rejected),
            self.count(|fate| *fate == Fate::Same),
        )?;
        for kind in Kind::ALL {
            let (made, survived) = self.of_kind(kind);
            writeln!(out, "{:>12} {made:>4} made {survived:>4} survived", format!("{kind:?}").to_lowercase())?;
        }
        for Mutant { mutation, fate } in &self.mutants {
            match fate {
                Fate::Survived => writeln!(out, "survived: {mutation}")?,
                Fate::Explained(why) => writeln!(out, "explained: {mutation}: {why}")?,
                _ => {}
            }
        }
        Ok(())
    }
}

/// Why there is no report.
#[derive(Debug, Error)]
pub enum MutantsError {
    /// The design as generated cannot be planned or built.
    #[error(transparent)]
    CoSimulation(#[from] CoSimulationError),
    /// The standing frames cannot be made.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no folder for the builds.
    #[error("cannot make a temporary folder: {0}; set TMPDIR to a folder that can be written")]
    Folder(std::io::Error),
    /// The design as generated is wrong already.
    #[error("the design fails without a fault: {0}")]
    Unsound(String),
}

/// Makes mutants and tries each.
///
/// # Errors
/// [`MutantsError`] if the design itself cannot be built, or fails.
pub fn mutants(design: &Design, options: &Options, progress: &Progress) -> Result<Report, MutantsError> {
    progress.stage("planning");
    let plan = planned(design)?;
    let sources = rtl_sources(&plan)?;
    let ordeal = Ordeal::new(&plan, &sources, options)?;
    if let Some(reason) = ordeal.complaint(&sources).map_err(CoSimulationError::from)? {
        return Err(MutantsError::Unsound(reason));
    }
    progress.counted("mutants", options.count as u64);
    let mut queue = drawn(&sources, options.seed).into_iter();
    let mut mutants: Vec<Mutant> = Vec::new();
    loop {
        // Those that do not count are replaced by the next ones.
        let counted = mutants.iter().filter(|mutant| mutant.fate.counts()).count();
        let next: Vec<Mutation> = queue.by_ref().take(options.count - counted).collect();
        if next.is_empty() {
            break;
        }
        mutants.par_extend(next.into_par_iter().map(|mutation| {
            let fate = ordeal.fate(&mutation);
            if fate.counts() {
                progress.step();
            }
            Mutant { mutation, fate }
        }));
    }
    Ok(Report { design: plan.design.name.clone(), seed: options.seed, mutants })
}

/// Every possible mutation, at random, the kinds in turn.
fn drawn(sources: &RtlSources, seed: u64) -> Vec<Mutation> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut found = sites::all(sources);
    found.shuffle(&mut random);
    let mut turns: Vec<(usize, Mutation)> = Vec::with_capacity(found.len());
    let mut counts = [0; Kind::ALL.len()];
    for mutation in found {
        let kind = mutation.kind as usize;
        turns.push((counts[kind], mutation));
        counts[kind] += 1;
    }
    turns.sort_by_key(|(turn, mutation)| (*turn, mutation.kind));
    turns.into_iter().map(|(_, mutation)| mutation).collect()
}

/// Contacts as a sensor without tension reads them, from no friction to that of the frames: a frame is mixed with the one that
/// slides the other way.
fn without_tension(stress: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let half = stress.len() / 2;
    let mixed = |(index, share): (usize, f64)| -> Vec<f64> {
        let pair = stress[index].iter().zip(&stress[index + half]);
        pair.map(|(one, other)| (share * one + (1.0 - share) * other).min(0.0)).collect()
    };
    (0..half).zip([0.5, 0.6, 0.7, 0.8, 0.9, 1.0]).map(mixed).collect()
}

/// What every mutant goes through: the co-simulation that every design goes through, then stress.
struct Ordeal<'a> {
    simulation: CoSimulation<'a>,
    sources: &'a RtlSources,
    /// Of the sources.
    translation: String,
    options: &'a Options,
    /// Where the mutants are built; away with them afterwards.
    cache: tempfile::TempDir,
}

impl<'a> Ordeal<'a> {
    fn new(plan: &'a Plan, sources: &'a RtlSources, options: &'a Options) -> Result<Self, MutantsError> {
        let mut frames = FrameSet::standing(&plan.design.sensor)?;
        frames.stress.extend(without_tension(&frames.stress));
        let frames = frames.as_delivered(&plan.design);
        let cache = tempfile::tempdir().map_err(MutantsError::Folder)?;
        let translation = translation(sources).map_err(CoSimulationError::from)?;
        let simulation = CoSimulation::new(plan, packets(plan.streams(), &frames.stress), options.seed as u32);
        Ok(Self { simulation, sources, translation, options, cache })
    }

    fn fate(&self, mutation: &Mutation) -> Fate {
        let mutant = mutation.apply(self.sources);
        // ROM files are read at run time.
        if mutation.kind != Kind::Rom {
            match translation(&mutant) {
                Err(_) => return Fate::Rejected,
                Ok(same) if same == self.translation => return Fate::Same,
                Ok(_) => {}
            }
        }
        match self.complaint(&mutant) {
            Err(_) => Fate::Rejected,
            Ok(Some(reason)) => Fate::Caught(reason),
            Ok(None) => {
                let known = self.options.explained.why(mutation);
                known.map_or(Fate::Survived, |why| Fate::Explained(why.to_owned()))
            }
        }
    }

    /// What is wrong with a design; nothing if it passes.
    fn complaint(&self, sources: &RtlSources) -> Result<Option<String>, BuildError> {
        let built = Verilate::new(self.cache.path()).build(sources)?;
        let judged = self.simulation.simulate(&built, None, &|| ()).map_err(|error| error.to_string());
        let passed = judged.and_then(Verdict::right);
        let stressed = passed.and_then(|_| (0..STRESS_BATCHES).try_for_each(|batch| self.stress(&built, batch)));
        Ok(stressed.err())
    }

    fn stress(&self, built: &Built, batch: u64) -> Result<(), String> {
        let core = built.load((self.options.seed ^ batch) as u32).map_err(|error| error.to_string())?;
        run_batch(self.simulation.plan, core, batch, BATCH, self.options.seed, &|| ())
            .map(drop)
            .map_err(|error| error.to_string())
    }
}
