//! The true force field of a frame: what each taxel's cell of the surface carries.

use super::Scene;
use super::traction::{Points, loads};

/// Fine enough that no cell of a contact misses more than some thousandths of its largest force.
const DENSE: Points = Points { radial: 240, around: 600, across: 1 };

impl Scene {
    /// The forces in newtons on the surface over each taxel, `[f_x, f_y, f_z]` in taxel order, of frame `index` of
    /// [`Scene::frames`]: the traction summed over the taxel's cell, a pitch along each axis. What lies beyond the cells
    /// belongs to no taxel. `None` if there is no such frame.
    pub fn surface(&self, index: usize) -> Option<[Vec<f64>; 3]> {
        let turned_deg = match self.sweep_deg.as_slice() {
            [] if index == 0 => 0.0,
            sweep => *sweep.get(index)?,
        };
        let mut field = [0, 1, 2].map(|_| vec![0.0; self.sensor.taxels()]);
        for contact in &self.contacts {
            let angle = (contact.direction_deg + turned_deg).to_radians();
            let loads = loads(contact.shape, &contact.traction, contact.normal_force_n, contact.friction, angle, DENSE);
            for load in loads {
                let place = [0, 1].map(|axis| contact.centre_m[axis] + load.place[axis]);
                let Some(taxel) = self.sensor.taxel_at(place) else { continue };
                let [pressing, along_x, along_y] = load.force;
                for (values, part) in field.iter_mut().zip([along_x, along_y, -pressing]) {
                    values[taxel] += part;
                }
            }
        }
        Some(field)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Contact, Medium, SensorErrors, Shape, Traction};
    use super::*;
    use crate::sensor::Sensor;

    fn scene(shape: Shape, centre_m: [f64; 2], sweep_deg: &[f64]) -> Scene {
        let (traction, medium) = (Traction::default(), Medium::HalfSpace);
        let contact = Contact { shape, centre_m, normal_force_n: 8.0, friction: 0.5, traction, direction_deg: 90.0 };
        let sensor = Sensor { columns: 10, rows: 10, pitch_mm: [4.0, 2.0], depth_mm: 3.0 };
        let sensor_errors = SensorErrors::default();
        Scene { sensor, medium, contacts: vec![contact], sweep_deg: sweep_deg.to_vec(), sensor_errors }
    }

    #[test]
    fn an_even_load_is_on_the_cells_that_it_covers() {
        // Over 2 × 2 cells exactly: taxels (4, 4), (5, 4), (4, 5) and (5, 5).
        let scene = scene(Shape::Rectangle { sides_m: [8e-3, 4e-3] }, [18e-3, 9e-3], &[]);
        let [x, y, z] = scene.surface(0).expect("a frame");
        for taxel in 0..100 {
            let loaded = [44, 45, 54, 55].contains(&taxel);
            let exact = if loaded { [0.0, 1.0, -2.0] } else { [0.0; 3] };
            for (found, exact) in [x[taxel], y[taxel], z[taxel]].into_iter().zip(exact) {
                assert!((found - exact).abs() < 1e-12, "{taxel}: {found} {exact}");
            }
        }
        assert_eq!(scene.surface(1), None, "one frame");
    }

    #[test]
    fn cells_carry_the_contact_and_no_more() {
        let hertz = Shape::Hertz { semi_axes_m: [7e-3; 2] };
        let frames = scene(hertz, [18e-3, 9e-3], &[0.0, 30.0]);
        let frame = &frames.frames().expect("frames")[1];
        let field = frames.surface(1).expect("a frame");
        for (values, exact) in field.iter().zip(frame.force) {
            assert!((values.iter().sum::<f64>() - exact).abs() < 1e-9, "{exact}");
        }
        // Half of what stands on the edge of the first column's cells is over no taxel.
        let [_, _, z] = scene(hertz, [-2e-3, 9e-3], &[]).surface(0).expect("a frame");
        assert!((z.iter().sum::<f64>() + 4.0).abs() < 0.05, "{z:?}");
    }
}
