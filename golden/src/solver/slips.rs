//! What slips: the friction at the design's limit, and what was there in the frame before.

use super::{Solver, Status};
use crate::bodies::Body;

/// What slipped in the last frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slips {
    frame: bool,
    /// Of each body its centre, and whether it slipped.
    bodies: Vec<([f64; 2], bool)>,
}

impl Slips {
    /// What slips in a frame, for the next one.
    pub fn of(status: Status, records: &[Body]) -> Self {
        let touching = records.iter().filter(|body| **body != Body::default());
        let bodies = touching.map(|body| (body.centre_m, body.status.contains(Status::SLIP))).collect();
        Self { frame: status.contains(Status::SLIP), bodies }
    }

    /// Whether the body slipped that was next to a place, if it is known where bodies were.
    fn near(&self, place: [f64; 2]) -> bool {
        let distance = |&([x, y], _): &([f64; 2], bool)| (x - place[0]).hypot(y - place[1]);
        let nearest = self.bodies.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(self.frame, |&(_, slipped)| slipped)
    }
}

impl From<bool> for Slips {
    /// Whatever there was slipped, or nothing did.
    fn from(frame: bool) -> Self {
        Self { frame, bodies: Vec::new() }
    }
}

impl Solver {
    /// Sets the bit of a frame that slips, and of the bodies in it that do. Without contact nothing does; a frame that
    /// tells nothing changes nothing.
    ///
    /// A body is the one whose centre was nearest in the frame before.
    pub(super) fn note_slip(&self, slips: &mut Slips, status: &mut Status, mu: f64, records: &mut [Body]) {
        let Some(slip) = self.slip else { return };
        status.remove(Status::SLIP);
        if status.contains(Status::NOT_FINITE) {
            return;
        }
        if status.contains(Status::NO_CONTACT) {
            *slips = Slips::default();
            return;
        }
        let mut slipping = records.is_empty() && slip.slips(mu, slips.frame);
        for body in records.iter_mut().filter(|body| **body != Body::default()) {
            body.status.remove(Status::SLIP);
            if slip.slips(body.mu, slips.near(body.centre_m)) {
                body.status.insert(Status::SLIP);
                slipping = true;
            }
        }
        if slipping {
            status.insert(Status::SLIP);
        }
        *slips = Slips::of(*status, records);
    }
}
