//! Separation of several contacts on one sensor, each with a friction and forces of its own.
//!
//! A frame is first solved as that of one contact. Its forces cause the frame, `b = sum over p of C3p f_p` (with a filter
//! nearly), but belong to several contacts. A contact is felt no farther away than the layer is deep, so regions separate them:
//! `b_k = sum over p of C3p f_p,k`, with what a filter leaves of the frame there, is nearly the frame of that contact alone. It
//! is solved as any frame of one contact, with the same estimator, correction and standard error. Now each contact has a friction
//! of its own, and the forces of all contacts are separated once more. The `b_k` add up to the frame, so its forces are the sums.
//!
//! [`Finder`] finds the contacts in what presses: connected components of touched taxels ([`Labels`]), and for each taxel the
//! nearest component. The hardware counts components by the same rule, on integers. With the default bits and no filter the
//! counts differ only where a share, of a taxel in the largest `|w|` or of a component in all, is within 0.0001 of [`SHARE`].

mod labels;
mod regions;

pub use labels::Labels;

use crate::sensor::Sensor;
use crate::status::Status;
use regions::{distances, spread};

/// Most records of contacts that a design can ask for.
pub const MOST: usize = 8;
/// A taxel touches if what presses on it is above this share of the frame's largest. A component is a contact if it has this
/// share of all that presses: about 8 %, in two shifts and an addition.
pub const SHARE: f64 = 5.0 / 64.0;

/// Forces of one contact, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForces {
    /// Taxels that it touches.
    pub taxels: usize,
    /// Bits of the frame's status that are about this contact: those of [`ContactForces::BITS`].
    pub status: Status,
    /// Where its normal force acts, in metres from the first taxel.
    pub centre_m: [f64; 2],
    /// Its force `[F_x, F_y, F_z]` in newtons.
    pub force: [f64; 3],
    /// Its torque `[T_x, T_y, T_z]` in N m about the middle of the grid at the surface, as a frame's.
    pub torque: [f64; 3],
    /// `sqrt(F_x^2 + F_y^2) / |F_z|`, 0 where `F_z` is 0.
    pub mu: f64,
    /// Standard error of `(F_x, F_y)` in newtons; 0 where the estimator has none.
    pub standard_error: f64,
}

impl ContactForces {
    /// Status bits that a contact can have. A frame has those of its contacts, and others.
    pub const BITS: [Status; 4] = [Status::DIRECTION_UNKNOWN, Status::AT_BOUND, Status::LOW_CONFIDENCE, Status::SLIP];

    /// The bits of a frame's status that can be a contact's.
    pub fn bits_of(status: Status) -> Status {
        let all = Self::BITS.iter().fold(0, |all, bit| all | bit.0);
        Status(status.0 & all)
    }

    /// Where a force and its torque about the middle of the grid at the surface say that it acts, in metres from the
    /// first taxel; the middle if nothing presses or pulls.
    pub fn centre_of(sensor: &Sensor, force: [f64; 3], torque: [f64; 3]) -> [f64; 2] {
        let middle = sensor.extent_m().map(|last| 0.5 * last);
        let [_, _, normal] = force;
        if normal == 0.0 {
            return middle;
        }
        let [about_x, about_y, _] = torque;
        [middle[0] - about_y / normal, middle[1] + about_x / normal]
    }

    /// Puts the contact that presses most first, and so on; of equal ones the first stays first.
    pub fn largest_first(contacts: &mut [Self]) {
        contacts.sort_by(|a, b| b.force[2].abs().total_cmp(&a.force[2].abs()));
    }
}

/// Finds the contacts in a sensor's frames.
#[derive(Clone, Debug)]
pub struct Finder {
    contacts: usize,
    columns: usize,
    /// Of neighbouring taxels.
    distances: [u64; 3],
}

/// The contacts of a frame, to be used again for the next one.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    /// Contact of each taxel, the nearest: 0 is the one that presses most. Without any contact `None`.
    pub regions: Vec<Option<usize>>,
    /// Taxels that each contact touches; as many as there are contacts with a region, at most those that were asked for.
    pub taxels: Vec<usize>,
    /// Number of contacts, with those that were too many to have a region.
    pub contacts: usize,
    touched: Vec<bool>,
    labels: Labels,
    /// Of each component the sum of what presses, its number and its taxels.
    components: Vec<(f64, usize, usize)>,
    /// Of each component its contact.
    numbers: Vec<Option<usize>>,
    nearest: Vec<(u64, usize)>,
}

impl Finder {
    /// For at most so many contacts.
    pub fn new(sensor: &Sensor, contacts: usize) -> Self {
        Self { contacts, columns: sensor.columns, distances: distances(sensor) }
    }

    /// Records of contacts in a solution: none where there is but one region, which is the frame.
    pub fn records(&self) -> usize {
        if self.contacts > 1 { self.contacts } else { 0 }
    }

    /// Finds the contacts in what presses, one value for each taxel.
    ///
    /// Of more contacts than asked for those that press least have no region: their taxels go to the nearest of the
    /// others. If every component has less than [`SHARE`] of all, the largest is the one contact that there is.
    pub fn find(&self, weight: &[f64], found: &mut Regions) {
        self.count(weight, found);
        let Regions { regions, taxels, contacts, labels, components, numbers, nearest, .. } = found;
        let kept = &components[..self.contacts.min(*contacts)];
        taxels.clear();
        taxels.extend(kept.iter().map(|&(_, _, taxels)| taxels));
        numbers.clear();
        numbers.resize(labels.count, None);
        for (contact, &(_, component, _)) in kept.iter().enumerate() {
            numbers[component] = Some(contact);
        }
        regions.clear();
        regions.extend(labels.components.iter().map(|component| component.and_then(|component| numbers[component])));
        spread(regions, self.columns, self.distances, nearest);
    }

    /// Counts the contacts in what presses, one value for each taxel. Of what is found only the number is new.
    pub fn count(&self, weight: &[f64], found: &mut Regions) {
        let Regions { contacts, touched, labels, components, .. } = found;
        let largest = weight.iter().copied().fold(0.0, f64::max);
        touched.clear();
        touched.extend(weight.iter().map(|&weight| weight > SHARE * largest));
        labels.find(touched, self.columns);
        components.clear();
        components.extend((0..labels.count).map(|component| (0.0, component, 0)));
        for (&component, weight) in labels.components.iter().zip(weight) {
            if let Some(component) = component {
                components[component].0 += weight;
                components[component].2 += 1;
            }
        }
        // Of equal ones the first in the raster stays first.
        components.sort_by(|a, b| b.0.total_cmp(&a.0));
        let least = SHARE * weight.iter().sum::<f64>();
        *contacts = components.iter().filter(|(sum, ..)| *sum >= least).count().max(components.len().min(1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(contacts: usize, weights: [[f64; 6]; 3]) -> Regions {
        let sensor = Sensor { columns: 6, rows: 3, pitch_mm: [2.0, 2.0], depth_mm: 2.0 };
        let mut found = Regions::default();
        Finder::new(&sensor, contacts).find(weights.as_flattened(), &mut found);
        found
    }

    fn regions(found: &Regions) -> String {
        found.regions.iter().map(|contact| contact.map_or('.', |contact| char::from(b'0' + contact as u8))).collect()
    }

    #[test]
    fn the_largest_contact_is_the_first() {
        let found = find(4, [[1.0, 1.0, 0.0, 0.0, 2.0, 2.0], [0.0; 6], [0.0; 6]]);
        assert_eq!(
            (found.contacts, found.taxels.as_slice(), regions(&found).as_str()),
            (2, &[2, 2][..], "111000111000111000")
        );
    }

    #[test]
    fn equal_contacts_come_in_raster_order() {
        let found = find(4, [[1.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0; 6], [0.0; 6]]);
        assert_eq!((found.contacts, regions(&found).as_str()), (2, "000111000111000111"));
    }

    #[test]
    fn faint_taxels_do_not_connect_and_small_components_are_no_contacts() {
        // Between the two 7 % of the largest; in the corner a component of 4 % of all.
        let found =
            find(4, [[5.0, 5.0, 0.35, 0.0, 0.0, 0.0], [5.0, 5.0, 0.35, 5.0, 5.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 1.2]]);
        assert_eq!((found.contacts, found.taxels.as_slice()), (2, &[4, 2][..]));
        assert!(regions(&found).ends_with('1'), "what is no contact belongs to the nearest: {}", regions(&found));
    }

    #[test]
    fn too_many_are_counted_and_go_to_their_neighbours() {
        let row = [[3.0, 0.0, 2.0, 0.0, 4.0, 0.0], [0.0; 6], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]];
        let found = find(2, row);
        assert_eq!(
            (found.contacts, found.taxels.as_slice(), regions(&found).as_str()),
            (4, &[1, 1][..], "110000110000110000")
        );
        assert_eq!(find(8, row).taxels, [1, 1, 1, 1]);
    }

    #[test]
    fn nothing_is_no_contact_and_specks_are_one() {
        let found = find(4, [[0.0; 6]; 3]);
        assert_eq!((found.contacts, regions(&found).as_str()), (0, ".................."));
        // Nine components, three times as many as could all be large enough.
        let specks = [[1.0, 0.0, 1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0, 1.0, 0.0]];
        assert_eq!(find(8, specks).contacts, 9);
        let found = find(8, specks);
        assert_eq!((found.taxels.len(), found.regions.iter().flatten().max()), (8, Some(&7)));
    }

    #[test]
    fn components_that_are_all_too_small_leave_the_largest() {
        let sensor = Sensor { columns: 10, rows: 6, pitch_mm: [2.0, 2.0], depth_mm: 2.0 };
        let mut weights = vec![0.0; 60];
        for (index, weight) in weights.iter_mut().enumerate() {
            *weight = f64::from(u8::from((index % 10 + index / 10) % 2 == 0));
        }
        weights[22] = 1.5;
        let mut found = Regions::default();
        Finder::new(&sensor, 4).find(&weights, &mut found);
        assert_eq!((found.contacts, found.taxels.as_slice()), (1, &[1][..]));
        assert!(found.regions.iter().all(|&contact| contact == Some(0)));
    }

    #[test]
    fn the_centre_is_where_the_torque_says() {
        let sensor = Sensor { columns: 6, rows: 3, pitch_mm: [2.0, 4.0], depth_mm: 2.0 };
        let (at, force) = ([3e-3, 7e-3], [1.0, -0.5, -4.0]);
        let found = ContactForces::centre_of(&sensor, force, sensor.torque_of(at, force));
        assert!(found.iter().zip(at).all(|(found, at)| (found - at).abs() < 1e-15), "{found:?}");
        let middle = ContactForces::centre_of(&sensor, [0.0; 3], [0.0; 3]);
        assert!(middle.iter().zip([5e-3, 4e-3]).all(|(found, at)| (found - at).abs() < 1e-15), "{middle:?}");
    }
}
