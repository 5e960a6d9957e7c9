//! How far each contact's forces, its place and its torque are from the true ones.

use serde::Serialize;

use crate::contacts::ContactForces;
use crate::solver::Solution;

/// How large errors are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quantiles {
    /// Half of the errors are at most this,
    pub median: f64,
    /// 95 % of them this,
    pub most: f64,
    /// and all of them this.
    pub worst: f64,
}

impl Quantiles {
    /// Of errors in any order; NaN, in JSON null, if there are none.
    pub fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let share = |share: f64| {
            let count = (errors.len() as f64 * share).ceil() as usize;
            errors.get(count.saturating_sub(1)).copied().unwrap_or(f64::NAN)
        };
        Self { median: share(0.5), most: share(0.95), worst: share(1.0) }
    }
}

/// Errors of contacts over many frames, those of forces in percent of each contact's own normal force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactErrors {
    /// Frames,
    pub frames: usize,
    /// and those of them that have the right number of contacts: the errors are of these.
    pub right: usize,
    /// Length of the error of `(F_x, F_y)`.
    pub tangential: Quantiles,
    /// Of `F_z`.
    pub normal: Quantiles,
    /// Distance of the centres, where the normal forces act, in mm.
    pub centre_mm: Quantiles,
    /// Of `T_z` over `|F_z|`, in mm: the arm at which as large a force would turn as much. NaN, in JSON null, where no torques
    /// of contacts are known, as of hardware; one of exact zeros counts as unknown.
    pub turn_mm: Quantiles,
    /// Share of the errors of `(F_x, F_y)` that are within two standard errors, in percent; NaN where none is told.
    pub within: f64,
}

impl ContactErrors {
    /// Compares the true contacts of frames with those that were found.
    pub fn new<'a>(frames: impl IntoIterator<Item = (&'a Vec<ContactForces>, &'a Solution)>) -> Self {
        let [mut count, mut right, mut within, mut told] = [0; 4];
        let [mut tangential, mut normal, mut centre, mut turn] = [const { Vec::new() }; 4];
        for (truth, solution) in frames {
            count += 1;
            if truth.len() != solution.contacts || truth.len() > solution.records.len() {
                continue;
            }
            right += 1;
            for (truth, found) in pairs(truth, &solution.records[..truth.len()]) {
                let [x, y, z] = [0, 1, 2].map(|axis| found.force[axis] - truth.force[axis]);
                let percent = 100.0 / truth.force[2].abs();
                within += usize::from(x.hypot(y) <= 2.0 * found.standard_error);
                told += usize::from(found.standard_error > 0.0);
                tangential.push(percent * x.hypot(y));
                normal.push(percent * z.abs());
                let [x, y] = [0, 1].map(|axis| found.centre_m[axis] - truth.centre_m[axis]);
                centre.push(1e3 * x.hypot(y));
                if [truth, found].iter().all(|contact| contact.torque.iter().any(|&torque| torque != 0.0)) {
                    turn.push(1e3 * (found.torque[2] - truth.torque[2]).abs() / truth.force[2].abs());
                }
            }
        }
        let within = if told > 0 { 100.0 * within as f64 / tangential.len() as f64 } else { f64::NAN };
        let [tangential, normal, centre_mm, turn_mm] = [tangential, normal, centre, turn].map(Quantiles::of);
        Self { frames: count, right, tangential, normal, centre_mm, turn_mm, within }
    }
}

/// Pairs of contacts that are the same one, as many of both: the two whose centres are nearest, then the next two.
pub fn pairs<'a>(
    truth: &'a [ContactForces],
    found: &'a [ContactForces],
) -> Vec<(&'a ContactForces, &'a ContactForces)> {
    let distance = |(a, b): &(&ContactForces, &ContactForces)| {
        (a.centre_m[0] - b.centre_m[0]).hypot(a.centre_m[1] - b.centre_m[1])
    };
    let mut all: Vec<(&ContactForces, &ContactForces)> =
        truth.iter().flat_map(|a| found.iter().map(move |b| (a, b))).collect();
    all.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut pairs: Vec<(&ContactForces, &ContactForces)> = Vec::new();
    for (a, b) in all {
        if pairs.iter().all(|(c, d)| !std::ptr::eq(*c, a) && !std::ptr::eq(*d, b)) {
            pairs.push((a, b));
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Status;

    fn contact(x: f64, force: [f64; 3]) -> ContactForces {
        ContactForces { centre_m: [x, 0.0], force, standard_error: 0.1, ..ContactForces::default() }
    }

    #[test]
    fn each_contact_is_compared_with_that_at_its_place() {
        // Found in another order; both errors are 1 N of 4 and 0.1 N of 2 along the surface.
        let truth = vec![contact(0.01, [0.0, 0.0, -4.0]), contact(0.03, [1.0, 0.0, -2.0])];
        let records =
            vec![contact(0.031, [1.1, 0.0, -2.5]), contact(0.009, [0.0, 1.0, -4.0]), ContactForces::default()];
        let solution = Solution { contacts: 2, records, ..Solution::zeros(Status::default(), 0) };
        let wrong = Solution { contacts: 3, ..solution.clone() };
        let found = ContactErrors::new([(&truth, &solution), (&truth, &wrong)]);
        assert_eq!((found.frames, found.right), (2, 1));
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}: {found:?}");
        close(found.tangential.median, 5.0);
        close(found.tangential.worst, 25.0);
        close(found.normal.median, 0.0);
        close(found.normal.most, 25.0);
        close(found.centre_mm.worst, 1.0);
        assert!(found.turn_mm.worst.is_nan());
        close(found.within, 50.0);
    }

    /// In mm: 4 N mm over 2 N.
    #[test]
    fn torques_are_compared_where_both_are_known() {
        let of = |torque| ContactForces { torque, ..contact(0.01, [0.0, 0.0, -2.0]) };
        let solution =
            |contact| Solution { contacts: 1, records: vec![contact], ..Solution::zeros(Status::default(), 0) };
        let truth = vec![of([0.02, 0.0, 0.01])];
        let [known, unknown] = [of([0.02, 0.0, 0.006]), of([0.0; 3])].map(solution);
        let found = ContactErrors::new([(&truth, &known), (&truth, &unknown)]);
        assert_eq!(found.right, 2);
        assert!((found.turn_mm.median - 2.0).abs() < 1e-9 && (found.turn_mm.worst - 2.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn without_errors_there_are_no_figures() {
        let none = ContactErrors::new([]);
        assert_eq!((none.frames, none.right), (0, 0));
        assert!([none.tangential.median, none.normal.worst, none.within].iter().all(|figure| figure.is_nan()));
    }
}
