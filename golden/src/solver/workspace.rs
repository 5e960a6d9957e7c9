//! Solving frame after frame without asking for memory each time.

use std::sync::Arc;

use nalgebra::DVector;

use super::batch::{self, BatchFrame};
use super::reading::{FrameInput, Past, Reading};
use super::separate::{Counted, Separations};
use super::{Estimators, OfPlan, Products, Slips, Solution, Solver, SolverError, Status};
use crate::estimators::{Contact, FrictionScratch, Inputs};
use crate::parity::{COMPONENTS, Orbits};
use crate::products::batch::{Blocks, FRAMES};
use crate::products::{Engine, PaperMatrices, ProductList, RealFrame, Stored};
use crate::reduced::ReducedMatrices;

/// Memory for solving frames with one solver; see [`Solver::workspace`].
#[derive(Clone, Debug)]
pub struct Workspace {
    orbits: Orbits,
    /// Forces along each axis that a frame is solved for.
    forces: usize,
    b: DVector<f64>,
    friction: FrictionScratch,
    products: Scratch,
    /// The contacts of frames that have several.
    separations: Separations,
    /// Of each frame that is solved together with others, its contacts.
    counted: Vec<Counted>,
    /// What slipped in the last frame.
    slips: Slips,
    /// What the frames solved leave to the next ones.
    pub(super) past: Past,
    /// For several frames at once, made when first used.
    batches: Batches,
}

/// Frames that are decoded, without creep, and averaged.
pub(super) struct Decoded {
    taxels: usize,
    stress: Vec<f64>,
    /// Of each frame its status, and the noise left in it.
    marks: Vec<(Status, f64)>,
}

impl Decoded {
    /// The frames, to be solved.
    pub(super) fn frames(&self) -> Vec<FrameInput<'_>> {
        let frames = self.stress.chunks(self.taxels).zip(&self.marks);
        frames.map(|(stress, &(status, noise_left))| FrameInput::Decoded(stress, status, noise_left)).collect()
    }
}

/// Memory for batches of either plan.
#[derive(Clone, Debug, Default)]
struct Batches {
    paper: Option<Box<BatchFrame<1>>>,
    reduced: Option<Box<BatchFrame<COMPONENTS>>>,
}

#[derive(Clone, Debug)]
enum Scratch {
    Paper(Box<RealFrame<f64, PaperMatrices, 1>>),
    Reduced(Box<RealFrame<f64, ReducedMatrices, COMPONENTS>>),
}

impl Solver {
    /// Memory for [`Solver::solve_into`] and [`Solver::solve_batch`]; each thread needs its own.
    pub fn workspace(&self) -> Workspace {
        Workspace {
            orbits: *self.matrices.orbits(),
            forces: self.solved_length(),
            b: DVector::zeros(self.taxels()),
            friction: FrictionScratch::default(),
            products: match &self.products {
                Products::Paper(paper) => Scratch::Paper(Box::new(paper.engine.frame())),
                Products::Reduced(reduced) => Scratch::Reduced(Box::new(reduced.engine.frame())),
            },
            separations: Separations::default(),
            counted: Vec::new(),
            slips: Slips::default(),
            past: Past::default(),
            batches: Batches::default(),
        }
    }

    /// As [`Solver::solve`], into a solution that is there already: after the first frame no memory is asked for,
    /// unless contacts are separated.
    ///
    /// The workspace is that of this solver; that of another geometry or plan is replaced. Frames solved with one workspace
    /// follow each other: whether a frame slips depends on the one before, as do creep and averages.
    ///
    /// # Errors
    ///
    /// As [`Solver::solve`]; the solution is then that of before.
    pub fn solve_into(
        &self,
        workspace: &mut Workspace,
        frame: &[f64],
        solution: &mut Solution,
    ) -> Result<(), SolverError> {
        self.fit(workspace);
        let status = self.reader.decode(frame, workspace.b.as_mut_slice())?;
        let noise_left = self.reader.follow(&mut workspace.past, status, workspace.b.as_mut_slice());
        let reading = self.reader.judge(status, &workspace.b, noise_left);
        self.solve_reading(workspace, &reading, solution);
        Ok(())
    }

    fn solve_reading(&self, workspace: &mut Workspace, reading: &Reading, solution: &mut Solution) {
        let mut counted = Counted::default();
        match *reading {
            Reading::Nothing(status) => solution.reset(status, self.field_length()),
            Reading::Contact { contact, status } => {
                solution.reset(status, self.solved_length());
                self.solve_alone(workspace, contact, solution);
                let mut separations = std::mem::take(&mut workspace.separations);
                separations.clear();
                counted =
                    self.count_contacts(&mut separations, (&workspace.b, status, contact.noise_left), (0, solution));
                self.separate(&mut separations, std::slice::from_mut(solution), |parts, solutions| {
                    for ((b, contact), solution) in parts.iter().zip(solutions) {
                        workspace.b.copy_from(b);
                        self.solve_alone(workspace, *contact, solution);
                    }
                });
                workspace.separations = separations;
            }
        }
        self.finish(workspace, counted, solution);
    }

    /// What follows from the forces of a frame.
    fn finish(&self, workspace: &mut Workspace, counted: Counted, solution: &mut Solution) {
        self.note_contacts(counted, solution);
        if self.field_length() == 0 {
            solution.field.iter_mut().for_each(Vec::clear);
        }
        if let Some(gain) = self.estimators.friction.gain() {
            solution.scale(gain);
        }
        self.note_slip(&mut workspace.slips, &mut solution.status, solution.mu, &mut solution.records);
    }

    /// Finds the forces of the workspace's stress as those of one contact.
    fn solve_alone(&self, workspace: &mut Workspace, contact: Contact, solution: &mut Solution) {
        let Workspace { b, friction: scratch, products, .. } = workspace;
        let b = b.as_slice();
        match (&self.products, products) {
            (Products::Paper(paper), Scratch::Paper(frame)) => {
                solve(&paper.engine, frame, (b, contact), &self.estimators, scratch, solution);
            }
            (Products::Reduced(reduced), Scratch::Reduced(frame)) => {
                solve(&reduced.engine, frame, (b, contact), &self.estimators, scratch, solution);
            }
            // `fit` has seen to it that there is no other case.
            _ => {}
        }
    }

    /// The inputs of an estimator; `None` for a frame without an answer.
    pub(crate) fn inputs<'a>(
        &self,
        workspace: &'a mut Workspace,
        frame: &[f64],
    ) -> Result<Option<Inputs<'a>>, SolverError> {
        self.fit(workspace);
        let Workspace { b, products, .. } = workspace;
        let Reading::Contact { contact, .. } = self.reader.read(FrameInput::Values(frame), b)? else { return Ok(None) };
        let b = b.as_slice();
        Ok(match (&self.products, products) {
            (Products::Paper(paper), Scratch::Paper(frame)) => Some(inputs(&paper.engine, frame, b, contact)),
            (Products::Reduced(reduced), Scratch::Reduced(frame)) => Some(inputs(&reduced.engine, frame, b, contact)),
            // As above.
            _ => None,
        })
    }

    /// Solves many frames. Without a strong filter they share the products, which is faster the larger the sensor; the
    /// results then differ from those of [`Solver::solve`] by rounding.
    ///
    /// # Errors
    ///
    /// As [`Solver::solve`], for any of the frames.
    pub fn solve_batch<F: AsRef<[f64]>>(
        &self,
        workspace: &mut Workspace,
        frames: &[F],
        solutions: &mut Vec<Solution>,
    ) -> Result<(), SolverError> {
        self.fit(workspace);
        if !self.reader.follows() {
            let inputs: Vec<FrameInput<'_>> = frames.iter().map(|frame| FrameInput::Values(frame.as_ref())).collect();
            return self.solve_frames(workspace, &inputs, solutions);
        }
        let decoded = self.decoded(&mut workspace.past, frames.iter().map(AsRef::as_ref))?;
        self.solve_frames(workspace, &decoded.frames(), solutions)
    }

    /// Decodes frames that follow each other: without creep, and averaged.
    pub(super) fn decoded<'a>(
        &self,
        past: &mut Past,
        frames: impl Iterator<Item = &'a [f64]>,
    ) -> Result<Decoded, SolverError> {
        let taxels = self.taxels();
        let mut decoded = Decoded { taxels, stress: Vec::new(), marks: Vec::new() };
        for frame in frames {
            let begin = decoded.stress.len();
            decoded.stress.resize(begin + taxels, 0.0);
            let stress = &mut decoded.stress[begin..];
            let status = self.reader.decode(frame, stress)?;
            let noise_left = self.reader.follow(past, status, stress);
            decoded.marks.push((status, noise_left));
        }
        Ok(decoded)
    }

    /// As [`Solver::solve_batch`], of frames that are decoded.
    pub(super) fn solve_frames(
        &self,
        workspace: &mut Workspace,
        frames: &[FrameInput<'_>],
        solutions: &mut Vec<Solution>,
    ) -> Result<(), SolverError> {
        self.fit(workspace);
        solutions.resize_with(frames.len(), || Solution::zeros(Status::default(), 0));
        let orbits = self.matrices.orbits();
        match &self.products {
            Products::Paper(paper) if batch::pays_whole(&paper.engine.stored().filtered, orbits.taxels()) => {
                let OfPlan { engine, blocks } = &**paper;
                let whole = || Arc::new(Blocks::whole(&engine.list, &engine.stored().filtered, &self.matrices));
                let blocks = blocks.get_or_init(whole);
                let mut batch = made(workspace.batches.paper.take(), &engine.list, blocks);
                let result = self.solve_together(workspace, &mut batch, frames, solutions);
                workspace.batches.paper = Some(batch);
                result
            }
            Products::Reduced(reduced) if batch::pays_folded(reduced.engine.stored(), orbits) => {
                let OfPlan { engine, blocks } = &**reduced;
                let blocks = blocks.get_or_init(|| Arc::new(Blocks::folded(&engine.list, engine.stored(), orbits)));
                let mut batch = made(workspace.batches.reduced.take(), &engine.list, blocks);
                let result = self.solve_together(workspace, &mut batch, frames, solutions);
                workspace.batches.reduced = Some(batch);
                result
            }
            _ => {
                let mut pairs = frames.iter().zip(solutions);
                pairs.try_for_each(|(&frame, solution)| {
                    let reading = self.reader.read(frame, &mut workspace.b)?;
                    self.solve_reading(workspace, &reading, solution);
                    Ok(())
                })
            }
        }
    }

    /// Solves many frames with shared products.
    fn solve_together<const W: usize>(
        &self,
        workspace: &mut Workspace,
        batch: &mut BatchFrame<W>,
        frames: &[FrameInput<'_>],
        solutions: &mut [Solution],
    ) -> Result<(), SolverError> {
        for (frames, solutions) in frames.chunks(FRAMES).zip(solutions.chunks_mut(FRAMES)) {
            batch.clear();
            for (index, (&frame, solution)) in frames.iter().zip(&mut *solutions).enumerate() {
                match self.reader.read(frame, &mut workspace.b)? {
                    Reading::Nothing(status) => solution.reset(status, self.field_length()),
                    Reading::Contact { contact, status } => {
                        solution.reset(status, self.solved_length());
                        batch.push(index, contact, workspace.b.as_slice());
                    }
                }
            }
            batch.solve(&self.estimators, &mut workspace.friction, solutions);
            let Workspace { b, friction, separations, counted, .. } = &mut *workspace;
            separations.clear();
            counted.clear();
            for (index, (&frame, solution)) in frames.iter().zip(&mut *solutions).enumerate() {
                counted.push(Counted::default());
                // Its stress, and its status before it was solved, once more: they are kept of no frame.
                if self.finder.is_some()
                    && let Reading::Contact { contact, status } = self.reader.read(frame, b)?
                {
                    let of_frame = (&*b, status, contact.noise_left);
                    counted[index] = self.count_contacts(separations, of_frame, (index, solution));
                }
            }
            self.separate(separations, solutions, |parts, solutions| {
                for (parts, solutions) in parts.chunks(FRAMES).zip(solutions.chunks_mut(FRAMES)) {
                    batch.clear();
                    for (index, (b, contact)) in parts.iter().enumerate() {
                        batch.push(index, *contact, b.as_slice());
                    }
                    batch.solve(&self.estimators, friction, solutions);
                }
            });
            for (index, solution) in solutions.iter_mut().enumerate() {
                self.finish(workspace, workspace.counted[index], solution);
            }
        }
        Ok(())
    }

    /// Replaces a workspace made for another sensor or plan.
    fn fit(&self, workspace: &mut Workspace) {
        let same_plan = matches!(
            (&self.products, &workspace.products),
            (Products::Paper(_), Scratch::Paper(_)) | (Products::Reduced(_), Scratch::Reduced(_))
        );
        let orbits = self.matrices.orbits();
        if !same_plan || workspace.orbits != *orbits || workspace.forces != self.solved_length() {
            *workspace = self.workspace();
        }
    }
}

/// Finds the forces for the stress `b` (pascals, length m).
fn solve<S: Stored<W>, const W: usize>(
    engine: &Engine<f64, S, W>,
    frame: &mut RealFrame<f64, S, W>,
    (b, contact): (&[f64], Contact),
    estimators: &Estimators,
    scratch: &mut FrictionScratch,
    solution: &mut Solution,
) {
    let mu = solution.optimum(estimators, &inputs(engine, frame, b, contact), scratch);
    engine.field(mu, frame, |p, taxel, force| solution.field[p][taxel] = force);
}

/// The inputs of an estimator from the stress `b` (pascals, length m).
fn inputs<'a, S: Stored<W>, const W: usize>(
    engine: &Engine<f64, S, W>,
    frame: &'a mut RealFrame<f64, S, W>,
    b: &'a [f64],
    contact: Contact,
) -> Inputs<'a> {
    frame.stress.copy_from_slice(b);
    engine.until_friction(frame);
    Inputs { b, contact, sums: &frame.sums, u: frame.u.each_ref().map(Vec::as_slice) }
}

/// Memory of a batch with these matrices: that of before, if it is.
fn made<const W: usize>(
    before: Option<Box<BatchFrame<W>>>,
    list: &ProductList,
    blocks: &Arc<Blocks<W>>,
) -> Box<BatchFrame<W>> {
    before.filter(|batch| batch.is_of(blocks)).unwrap_or_else(|| Box::new(BatchFrame::new(list, blocks)))
}
