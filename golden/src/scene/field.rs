//! The stress of contacts of any traction, summed over points of the surface.

use std::sync::Arc;

use super::green::{PointLoad, gauss_legendre};
use super::traction::{FINE, Load, Points, loads};
use super::{Contact, Medium, Scene};
use crate::sensor::Sensor;

/// What stays the same from contact to contact: the medium, and where the taxels are.
pub(crate) struct Field {
    load: Arc<PointLoad>,
    depth_m: f64,
    /// Places in metres and their weight in the taxel's mean, as many for each taxel.
    places: Vec<([f64; 2], f64)>,
    per_taxel: usize,
    points: Points,
    sensor: Sensor,
}

impl Field {
    /// The field of a scene's sensor.
    pub(super) fn of(scene: &Scene) -> Self {
        Self::new(&scene.sensor, scene.medium, scene.sensor_errors.taxel_m, FINE)
    }

    /// The field of a sensor whose taxels average over rectangles of the sides `taxel_m`.
    pub(crate) fn new(sensor: &Sensor, medium: Medium, taxel_m: Option<[f64; 2]>, points: Points) -> Self {
        let within = match taxel_m {
            None => vec![([0.0, 0.0], 1.0)],
            Some([a, b]) => {
                let (nodes, weights) = gauss_legendre(points.across);
                let axis = || nodes.iter().zip(&weights);
                axis()
                    .flat_map(|(y, wy)| axis().map(move |(x, wx)| ([0.5 * a * x, 0.5 * b * y], 0.25 * wx * wy)))
                    .collect()
            }
        };
        let places = (0..sensor.taxels()).flat_map(|taxel| {
            let [x, y] = sensor.position_m(taxel);
            within.iter().map(move |&([dx, dy], weight)| ([x + dx, y + dy], weight))
        });
        let places = places.collect();
        let depth_m = sensor.depth_m();
        Self { load: PointLoad::of(medium), depth_m, places, per_taxel: within.len(), points, sensor: sensor.clone() }
    }

    /// Adds the stress of loads at a taxel to `sums`. `of` maps a load's normal and tangential stress to the parts.
    fn sum<const N: usize>(
        &self,
        taxel: usize,
        centre_m: [f64; 2],
        loads: &[Load],
        mut sums: [f64; N],
        of: impl Fn(f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let scale = 1.0 / self.depth_m;
        for ([x, y], weight) in &self.places[taxel * self.per_taxel..][..self.per_taxel] {
            let (x, y) = (x - centre_m[0], y - centre_m[1]);
            let mut values = [0.0; N];
            for load in loads {
                let [dx, dy] = [(x - load.place[0]) * scale, (y - load.place[1]) * scale];
                let [normal, shear] = self.load.at(dx * dx + dy * dy);
                let parts = of(load.force[0] * normal, (load.force[1] * dx + load.force[2] * dy) * shear);
                values.iter_mut().zip(parts).for_each(|(value, part)| *value += part);
            }
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value * scale * scale);
        }
        sums
    }

    /// Adds the stress of a contact, pushed in the direction `angle_deg`, to that of the taxels; returns the force that
    /// it exerts, `[F_x, F_y, F_z]`, and its torque about the middle of the grid.
    pub(crate) fn add(&self, contact: &Contact, angle_deg: f64, stress: &mut [f64]) -> [[f64; 3]; 2] {
        let Contact { shape, centre_m, normal_force_n, friction, traction, .. } = contact;
        let angle = angle_deg.to_radians();
        let loads = loads(*shape, traction, *normal_force_n, *friction, angle, self.points);
        for (taxel, sum) in stress.iter_mut().enumerate() {
            [*sum] = self.sum(taxel, *centre_m, &loads, [*sum], |normal, shear| [normal + shear]);
        }
        let mut exerted = [[0.0; 3]; 2];
        for load in &loads {
            let [pressing, along_x, along_y] = load.force;
            let force = [along_x, along_y, -pressing];
            let place = [0, 1].map(|axis| centre_m[axis] + load.place[axis]);
            for (sums, parts) in exerted.iter_mut().zip([force, self.sensor.torque_of(place, force)]) {
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
            }
        }
        exerted
    }

    /// The stress of a contact in its own direction in two parts, which add up: pressed alone, and what a friction of 1
    /// adds; and the force `[F_x, F_y]` of a friction of 1. All three grow with the friction as it does.
    pub(crate) fn parts(&self, contact: &Contact) -> ([Vec<f64>; 2], [f64; 2]) {
        let Contact { shape, centre_m, normal_force_n, traction, direction_deg, .. } = contact;
        let loads = loads(*shape, traction, *normal_force_n, 1.0, direction_deg.to_radians(), self.points);
        let of_taxel = |taxel| self.sum(taxel, *centre_m, &loads, [0.0; 2], |normal, shear| [normal, shear]).into();
        let (normal, tangential) = (0..self.sensor.taxels()).map(of_taxel).unzip();
        let push = loads.iter().fold([0.0; 2], |[x, y], load| [x + load.force[1], y + load.force[2]]);
        ([normal, tangential], push)
    }
}

#[cfg(test)]
mod tests {
    use super::super::traction::COARSE;
    use super::super::{Shape, Shear, Traction, spectral};
    use super::*;

    const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };

    fn sensor() -> Sensor {
        Sensor { columns: 10, rows: 10, pitch_mm: [4.0, 2.0], depth_mm: 3.0 }
    }

    fn contact(shape: Shape, traction: Traction) -> Contact {
        Contact { shape, centre_m: [17e-3, 8.3e-3], normal_force_n: 1.0, friction: 0.5, direction_deg: 0.0, traction }
    }

    fn stress(field: &Field, contact: &Contact, angle: f64) -> Vec<f64> {
        let mut stress = vec![0.0; 100];
        field.add(contact, angle, &mut stress);
        stress
    }

    fn difference(one: &[f64], other: &[f64]) -> f64 {
        let peak = one.iter().fold(0.0_f64, |peak, s| peak.max(s.abs()));
        one.iter().zip(other).fold(0.0_f64, |far, (a, b)| far.max((a - b).abs())) / peak
    }

    #[test]
    fn points_and_waves_agree() {
        // The same contacts by another way: the Fourier integral of the load's known spectrum.
        for medium in [LAYER, Medium::BondedLayer { poisson: 0.45 }, Medium::HalfSpace] {
            let field = Field::new(&sensor(), medium, None, FINE);
            for shape in [
                Shape::Hertz { semi_axes_m: [7e-3, 5e-3] },
                Shape::Disc { radius_m: 6e-3 },
                Shape::Punch { radius_m: 6e-3 },
                Shape::Rectangle { sides_m: [8e-3, 5e-3] },
            ] {
                let contact = contact(shape, Traction::default());
                let axis =
                    |count: usize, pitch: f64, centre: f64| (0..count).map(|i| i as f64 * pitch - centre).collect();
                let offsets = [axis(10, 4e-3, 17e-3), axis(10, 2e-3, 8.3e-3)];
                let fine = spectral::Resolution::fine(medium);
                let [p, x, y] = spectral::responses(medium, shape, 3e-3, &offsets, fine).expect("waves");
                let (fx, fy) = (0.5 * 1.0_f64.cos(), 0.5 * 1.0_f64.sin());
                let waves: Vec<f64> = (0..100).map(|i| p[i] + fx * x[i] + fy * y[i]).collect();
                let error = difference(&waves, &stress(&field, &contact, 1.0_f64.to_degrees()));
                assert!(error < 2e-5, "{medium:?} {shape:?}: {error:e}");
            }
        }
    }

    #[test]
    fn finer_rules_change_nothing() {
        let finer = Points { radial: 40, around: 96, ..FINE };
        let [field, fine] = [FINE, finer].map(|points| Field::new(&sensor(), LAYER, None, points));
        for traction in [
            Traction { tilt: [0.6, 0.3], turn_deg: 30.0, ..Traction::default() },
            Traction { shear: Shear::Held { share: 0.5 }, ..Traction::default() },
            Traction { shear: Shear::Sliding { spin: 1.5 }, edge: Some(2.0), ..Traction::default() },
            Traction { shear: Shear::Even, edge: Some(-0.4), ..Traction::default() },
        ] {
            let contact = contact(Shape::Hertz { semi_axes_m: [7e-3, 4e-3] }, traction);
            let error = difference(&stress(&fine, &contact, 40.0), &stress(&field, &contact, 40.0));
            assert!(error < 5e-5, "{traction:?}: {error:e}");
        }
    }

    #[test]
    fn the_coarse_parts_of_a_contact_add_up_to_its_stress() {
        let taxel = Some([3.2e-3, 1.6e-3]);
        let [coarse, fine] = [COARSE, FINE].map(|points| Field::new(&sensor(), LAYER, taxel, points));
        for traction in [
            Traction { tilt: [0.5, 0.3], turn_deg: 30.0, ..Traction::default() },
            Traction { shear: Shear::Held { share: 0.5 }, ..Traction::default() },
            Traction { shear: Shear::Sliding { spin: 1.0 }, edge: Some(-0.4), ..Traction::default() },
            Traction { shear: Shear::Even, edge: Some(2.0), ..Traction::default() },
        ] {
            let direction_deg = 40.0;
            let contact = Contact { direction_deg, ..contact(Shape::Hertz { semi_axes_m: [7e-3, 4.5e-3] }, traction) };
            let ([normal, tangential], [x, y]) = coarse.parts(&contact);
            let parts: Vec<f64> = normal.iter().zip(&tangential).map(|(n, t)| n + 0.5 * t).collect();
            let mut whole = vec![0.0; 100];
            let [force, _] = fine.add(&contact, direction_deg, &mut whole);
            let error = difference(&whole, &parts);
            assert!(error < 4e-3, "{traction:?}: {error:e}");
            assert!((0.5 * x - force[0]).abs() < 1e-3 && (0.5 * y - force[1]).abs() < 1e-3, "{traction:?}");
        }
    }

    #[test]
    fn a_contact_that_only_turns_about_its_middle_leaves_no_trace() {
        // Torsion of a round contact: k . q is 0 for every wave, whatever the layer.
        let field = Field::new(&sensor(), LAYER, None, FINE);
        let spin = |spin| Traction { shear: Shear::Sliding { spin }, ..Traction::default() };
        let round = Shape::Hertz { semi_axes_m: [7e-3, 7e-3] };
        let still = Contact { friction: 0.0, ..contact(round, Traction::default()) };
        let error = difference(&stress(&field, &still, 0.0), &stress(&field, &contact(round, spin(1e9)), 0.0));
        assert!(error < 1e-5, "{error:e}");
        let long = Shape::Hertz { semi_axes_m: [7e-3, 3e-3] };
        let still = Contact { shape: long, ..still };
        let error = difference(&stress(&field, &still, 0.0), &stress(&field, &contact(long, spin(1e9)), 0.0));
        assert!(error > 1e-3, "of another shape it does: {error:e}");
    }

    #[test]
    fn a_turned_contact_is_the_contact_turned() {
        let square = Sensor { columns: 9, rows: 9, pitch_mm: [3.0, 3.0], depth_mm: 3.0 };
        let field = Field::new(&square, LAYER, None, FINE);
        let at = |turn_deg, angle| {
            let traction = Traction { turn_deg, tilt: [0.4, -0.2], ..Traction::default() };
            let shape = Shape::Rectangle { sides_m: [9e-3, 4e-3] };
            let contact = Contact { centre_m: [12e-3, 12e-3], ..contact(shape, traction) };
            let mut stress = vec![0.0; 81];
            field.add(&contact, angle, &mut stress);
            stress
        };
        let (one, other) = (at(0.0, 20.0), at(90.0, 110.0));
        // Turned by 90 degrees, (x, y) goes to (-y, x).
        let turned: Vec<f64> = (0..81).map(|i| one[(8 - i % 9) * 9 + i / 9]).collect();
        assert!(difference(&turned, &other) < 1e-9, "{}", difference(&turned, &other));
    }

    #[test]
    fn the_taxels_of_a_layer_carry_force_and_moment() {
        // Taxels without gaps that cover all of the stress: their mean times their area is its integral, so the force
        // is that of the contact, and the moment that of the tangential force at the height of the layer.
        let wide = Sensor { columns: 30, rows: 30, pitch_mm: [3.0, 3.0], depth_mm: 3.0 };
        let field = Field::new(&wide, LAYER, Some([3e-3, 3e-3]), FINE);
        let centre_m = [43.5e-3, 43.5e-3];
        for (traction, eccentric) in [
            (Traction::default(), 0.0),
            (Traction { tilt: [0.6, 0.0], ..Traction::default() }, 0.6 * 6e-3 / 5.0),
            (Traction { shear: Shear::Held { share: 0.5 }, ..Traction::default() }, 0.0),
            (Traction { shear: Shear::Even, ..Traction::default() }, 0.0),
        ] {
            let contact = Contact { centre_m, ..contact(Shape::Hertz { semi_axes_m: [6e-3; 2] }, traction) };
            let mut stress = vec![0.0; 900];
            let [[fx, fy, fz], torque] = field.add(&contact, 0.0, &mut stress);
            let area = 9e-6;
            let force: f64 = stress.iter().sum::<f64>() * area;
            assert!((force - fz).abs() < 1e-4 && fy.abs() < 1e-12, "{traction:?}: {force} {fz}");
            let moment: f64 = (0..900).map(|i| stress[i] * area * (wide.position_m(i)[0] - centre_m[0])).sum();
            let expected = fz * eccentric - fx * 3e-3;
            assert!((moment - expected).abs() < 3e-3 * 3e-3, "{traction:?}: {moment} {expected}");
            // About the middle of the grid, over which the contact stands.
            assert!((torque[1] + fz * eccentric).abs() < 1e-6, "{traction:?}: {torque:?}");
            assert!(torque[0].abs() < 1e-9 && torque[2].abs() < 1e-9, "{traction:?}: {torque:?}");
        }
    }

    #[test]
    fn a_large_taxel_reads_less_of_a_peak() {
        let shape = Shape::Hertz { semi_axes_m: [3e-3; 2] };
        let contact = Contact { centre_m: [16e-3, 8e-3], ..contact(shape, Traction::default()) };
        let [small, large] = [None, Some([3.6e-3, 1.8e-3])].map(|taxel| Field::new(&sensor(), LAYER, taxel, FINE));
        let taxel = 4 * 10 + 4;
        let [point, mean] = [small, large].map(|field| stress(&field, &contact, 0.0)[taxel]);
        assert!(mean > point && mean < 0.5 * point, "{point} {mean}");
    }
}
