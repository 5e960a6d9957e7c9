//! Solving frame after frame without asking for memory each time.

use nalgebra::DVector;

use super::reading::Reading;
use super::{Products, Solution, Solver, SolverError, Status, batch, paper, reduced};
use crate::estimators::Seen;
use crate::parity::Quads;

/// Memory for solving frames with one solver; see [`Solver::workspace`].
#[derive(Clone, Debug)]
pub struct Workspace {
    quads: Quads,
    b: DVector<f64>,
    products: Scratch,
    /// For several frames at once, made when first used.
    batch: Option<Box<batch::Scratch>>,
}

#[derive(Clone, Debug)]
enum Scratch {
    Paper(Box<paper::Scratch>),
    Reduced(Box<reduced::Scratch>),
}

impl Solver {
    /// Memory for [`Solver::solve_into`] and [`Solver::solve_batch`]; each thread needs its own.
    pub fn workspace(&self) -> Workspace {
        let taxels = self.taxels();
        let products = match &self.products {
            Products::Paper(paper) => Scratch::Paper(Box::new(paper.scratch(taxels))),
            Products::Reduced(reduced) => Scratch::Reduced(Box::new(reduced.scratch(taxels))),
        };
        Workspace { quads: *self.matrices.quads(), b: DVector::zeros(taxels), products, batch: None }
    }

    /// As [`Solver::solve`], into a solution that is there already: after the first frame no memory is asked for.
    ///
    /// The workspace is that of this solver; that of another is replaced.
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
        let b = &mut workspace.b;
        match self.reader.read(frame, b)? {
            Reading::Nothing(status) => solution.reset(status, self.field_length()),
            Reading::Contact { contact, status } => {
                solution.reset(status, self.field_length());
                match (&self.products, &mut workspace.products) {
                    (Products::Paper(paper), Scratch::Paper(scratch)) => {
                        paper.solve(&self.friction, b.as_slice(), contact, scratch, solution);
                    }
                    (Products::Reduced(reduced), Scratch::Reduced(scratch)) => {
                        reduced.solve(&self.friction, b.as_slice(), contact, scratch, solution);
                    }
                    // `fit` has seen to it that there is no other case.
                    _ => {}
                }
                self.scale(solution);
            }
        }
        Ok(())
    }

    /// What an estimator sees of a frame; `None` for a frame without an answer.
    pub(crate) fn see<'a>(&self, workspace: &'a mut Workspace, frame: &[f64]) -> Result<Option<Seen<'a>>, SolverError> {
        self.fit(workspace);
        let Workspace { b, products, .. } = workspace;
        let Reading::Contact { contact, .. } = self.reader.read(frame, b)? else { return Ok(None) };
        let b = b.as_slice();
        Ok(match (&self.products, products) {
            (Products::Paper(paper), Scratch::Paper(scratch)) => {
                paper.coefficients(b, scratch);
                Some(Seen { b, contact, sums: &scratch.sums, u: scratch.u.each_ref().map(Vec::as_slice) })
            }
            (Products::Reduced(reduced), Scratch::Reduced(scratch)) => {
                reduced.coefficients(b, scratch);
                Some(Seen { b, contact, sums: &scratch.sums, u: scratch.frame.stresses() })
            }
            // As above.
            _ => None,
        })
    }

    /// Solves many frames. With the reduced plan and no strong filter they share the products, which is faster the
    /// larger the sensor; the results then differ from those of [`Solver::solve`] by rounding.
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
        solutions.resize_with(frames.len(), || Solution::zeros(Status::default(), 0));
        let reduced = match &self.products {
            Products::Reduced(reduced) if reduced.batch_pays() => reduced,
            _ => {
                let mut pairs = frames.iter().zip(solutions);
                return pairs.try_for_each(|(frame, solution)| self.solve_into(workspace, frame.as_ref(), solution));
            }
        };
        let taxels = self.taxels();
        let Workspace { b, batch, .. } = workspace;
        let scratch = batch.get_or_insert_with(|| Box::new(batch::Scratch::new(reduced.quads(), taxels)));
        for (frames, solutions) in frames.chunks(batch::FRAMES).zip(solutions.chunks_mut(batch::FRAMES)) {
            reduced.solve_batch(&self.reader, &self.friction, frames, solutions, b, scratch)?;
            for solution in solutions {
                self.scale(solution);
            }
        }
        Ok(())
    }

    /// Multiplies the forces by the estimator's gain, if it has one.
    fn scale(&self, solution: &mut Solution) {
        if let Some(gain) = self.friction.gain() {
            solution.scale(gain);
        }
    }

    /// Replaces a workspace made for another sensor or plan.
    fn fit(&self, workspace: &mut Workspace) {
        let same_plan = matches!(
            (&self.products, &workspace.products),
            (Products::Paper(_), Scratch::Paper(_)) | (Products::Reduced(_), Scratch::Reduced(_))
        );
        let quads = self.matrices.quads();
        if !same_plan || workspace.quads != *quads {
            *workspace = self.workspace();
        }
    }
}
