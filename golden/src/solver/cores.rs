//! Many frames on all cores.

use rayon::prelude::*;

use super::reading::{FrameInput, Past};
use super::{Slips, Solution, Solver, SolverError, Status};
use crate::contacts::ContactForces;

/// Frames that one core takes at a time.
pub const PIECE: usize = crate::products::batch::FRAMES;

impl Solver {
    /// Solves frames that follow each other in `values`, m each, on all cores by [`Solver::solve_batch`]; a single one as
    /// [`Solver::solve`] does.
    ///
    /// Every [`PIECE`] frames have a place of their own among `places`, in order; `put` gets it with the frame's index in
    /// the piece and its solution, on whatever thread. The cores know nothing of each other's frames: let
    /// [`Solver::follow_slips`] decide which slip. `past` is what the frames before have left, and then these.
    ///
    /// # Errors
    ///
    /// Values that are no whole frames.
    pub fn solve_on_all_cores<P: Send>(
        &self,
        values: &[f64],
        past: &mut Past,
        places: impl IntoIterator<Item = P>,
        put: impl Fn(&mut P, usize, &Solution) + Sync,
    ) -> Result<(), SolverError> {
        let taxels = self.taxels();
        let rest = values.len() % taxels;
        if rest > 0 {
            return Err(SolverError::length(rest, taxels));
        }
        if values.len() == taxels {
            // Of a stream: what a batch needs would take longer than the frame.
            let mut solution = Solution::zeros(Status::default(), 0);
            let mut workspace = self.workspace();
            std::mem::swap(&mut workspace.past, past);
            self.solve_into(&mut workspace, values, &mut solution)?;
            *past = workspace.past;
            places.into_iter().take(1).for_each(|mut place| put(&mut place, 0, &solution));
            return Ok(());
        }
        let decoded = self.reader.follows().then(|| self.decoded(past, values.chunks(taxels))).transpose()?;
        let frames = match &decoded {
            Some(decoded) => decoded.frames(),
            None => values.chunks(taxels).map(FrameInput::Values).collect(),
        };
        let pieces: Vec<_> = frames.chunks(PIECE).zip(places).collect();
        pieces.into_par_iter().try_for_each_init(
            || (self.workspace(), Vec::new()),
            |(workspace, solutions), (frames, mut place)| {
                self.solve_frames(workspace, frames, solutions)?;
                solutions.iter().enumerate().for_each(|(index, solution)| put(&mut place, index, solution));
                Ok(())
            },
        )
    }

    /// Decides for frames that follow each other, each given by its status, friction coefficient and records of contacts,
    /// which slip. `slips` says what slipped in the one before, and then in the last one.
    pub fn follow_slips<'a>(
        &self,
        slips: &mut Slips,
        frames: impl IntoIterator<Item = (&'a mut Status, f64, &'a mut [ContactForces])>,
    ) {
        for (status, mu, records) in frames {
            self.note_slip(slips, status, mu, records);
        }
    }
}
