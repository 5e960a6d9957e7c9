//! Many frames on all cores.

use rayon::prelude::*;

use super::{Slips, Solution, Solver, SolverError, Status};
use crate::bodies::Body;

/// Frames that one core takes at a time.
pub const PIECE: usize = crate::products::batch::FRAMES;

impl Solver {
    /// Solves frames that follow each other in `values`, m each, on all cores by [`Solver::solve_batch`]; a single one as
    /// [`Solver::solve`] does.
    ///
    /// Every [`PIECE`] frames have a place of their own among `places`, in order; `put` gets it with the frame's index in
    /// the piece and its solution, on whatever thread. The cores know nothing of each other's frames: let
    /// [`Solver::follow_slips`] decide which slip.
    ///
    /// # Errors
    ///
    /// [`SolverError::FrameLength`] for values that are no whole frames.
    pub fn solve_on_all_cores<P: Send>(
        &self,
        values: &[f64],
        places: impl IntoIterator<Item = P>,
        put: impl Fn(&mut P, usize, &Solution) + Sync,
    ) -> Result<(), SolverError> {
        let taxels = self.taxels();
        let rest = values.len() % taxels;
        if rest > 0 {
            return Err(SolverError::FrameLength { found: rest, expected: taxels });
        }
        if values.len() == taxels {
            // Of a stream: what a batch needs would take longer than the frame.
            let mut solution = Solution::zeros(Status::default(), 0);
            self.solve_into(&mut self.workspace(), values, &mut solution)?;
            places.into_iter().take(1).for_each(|mut place| put(&mut place, 0, &solution));
            return Ok(());
        }
        let pieces: Vec<_> = values.chunks(PIECE * taxels).zip(places).collect();
        pieces.into_par_iter().try_for_each_init(
            || (self.workspace(), Vec::new()),
            |(workspace, solutions), (values, mut place)| {
                let frames: Vec<&[f64]> = values.chunks(taxels).collect();
                self.solve_batch(workspace, &frames, solutions)?;
                solutions.iter().enumerate().for_each(|(index, solution)| put(&mut place, index, solution));
                Ok(())
            },
        )
    }

    /// Decides for frames that follow each other, each given by its status, friction coefficient and records of bodies,
    /// which slip. `slips` says what slipped in the one before, and then in the last one.
    pub fn follow_slips<'a>(
        &self,
        slips: &mut Slips,
        frames: impl IntoIterator<Item = (&'a mut Status, f64, &'a mut [Body])>,
    ) {
        for (status, mu, records) in frames {
            self.note_slip(slips, status, mu, records);
        }
    }
}
