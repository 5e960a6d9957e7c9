//! What slips: the friction at the design's limit, and what was there in the frame before.

use super::{Solver, Status};
use crate::contacts::ContactForces;

/// What slipped in the last frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slips {
    frame: bool,
    /// Of each contact its centre, and whether it slipped.
    contacts: Vec<([f64; 2], bool)>,
}

impl Slips {
    /// What slips in a frame, for the next one.
    pub fn of(status: Status, records: &[ContactForces]) -> Self {
        let touching = records.iter().filter(|contact| **contact != ContactForces::default());
        let contacts = touching.map(|contact| (contact.centre_m, contact.status.contains(Status::SLIP))).collect();
        Self { frame: status.contains(Status::SLIP), contacts }
    }

    /// Whether the contact slipped that was next to a place, if it is known where contacts were.
    fn near(&self, place: [f64; 2]) -> bool {
        let distance = |&([x, y], _): &([f64; 2], bool)| (x - place[0]).hypot(y - place[1]);
        let nearest = self.contacts.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(self.frame, |&(_, slipped)| slipped)
    }
}

impl From<bool> for Slips {
    /// Whatever there was slipped, or nothing did.
    fn from(frame: bool) -> Self {
        Self { frame, contacts: Vec::new() }
    }
}

impl Solver {
    /// Sets the bit of a frame that slips, and of the contacts in it that do. Without contact nothing does; a frame that
    /// tells nothing changes nothing.
    ///
    /// A contact is the one whose centre was nearest in the frame before.
    pub(super) fn note_slip(&self, slips: &mut Slips, status: &mut Status, mu: f64, records: &mut [ContactForces]) {
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
        for contact in records.iter_mut().filter(|contact| **contact != ContactForces::default()) {
            contact.status.remove(Status::SLIP);
            if slip.slips(contact.mu, slips.near(contact.centre_m)) {
                contact.status.insert(Status::SLIP);
                slipping = true;
            }
        }
        if slipping {
            status.insert(Status::SLIP);
        }
        *slips = Slips::of(*status, records);
    }
}
