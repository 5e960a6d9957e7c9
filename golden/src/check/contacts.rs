//! Frames of more contacts than they are solved for.

use nalgebra::DVector;

use super::count;
use crate::contacts::{Finder, Regions};
use crate::design::Design;
use crate::matrices::{Matrices, MatrixName};
use crate::solver::reading::{FrameInput, Reader, Reading};

/// What is to be said of a design that counts contacts and is solved as if there were one: in how many frames there are
/// more. `frames` are the loaded ones: noise has many contacts.
pub(super) fn check(design: &Design, frames: &[&Vec<f64>], matrices: &Matrices) -> Option<String> {
    if design.algorithm.contacts > 1 || !design.algorithm.count_contacts {
        return None;
    }
    let (reader, finder) = (Reader::new(design), Finder::new(&design.sensor, 1));
    let inverse = matrices.folded(MatrixName::C33inv);
    let (mut b, mut found) = (DVector::zeros(reader.taxels()), Regions::default());
    let several = |frame: &&&Vec<f64>| {
        let Ok(Reading::Contact { .. }) = reader.read(FrameInput::Values(frame), &mut b) else { return false };
        let weight: Vec<f64> = (&*inverse * &b).iter().map(|force| (-force).max(0.0)).collect();
        finder.count(&weight, &mut found);
        found.contacts > 1
    };
    let several = frames.iter().filter(several).count();
    (several > 0).then(|| {
        format!(
            "several contacts press in {several} of {}, which algorithm.contacts = 1 solves as one: their forces may be off by a \
             tenth to a quarter; with contacts = 4 they are separated",
            count(frames.len())
        )
    })
}
