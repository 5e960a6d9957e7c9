//! The closed forms and the cell kernel against quadrature of the point force.

use std::f64::consts::PI;

use golden::design::{Kernel, Sensor};
use golden::{half_space, kernel};

const DEPTH: f64 = 3e-3;
/// Field points relative to the centre of the load: under it, at its edge, beside it, far away, in all quadrants.
const PLACES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [1.1e-3, -0.4e-3],
    [-5e-3, 0.0],
    [0.0, 3e-3],
    [-4.2e-3, 2.9e-3],
    [6.5e-3, 6.5e-3],
    [-1e-2, -8e-3],
    [25e-3, -12e-3],
];

/// Abscissae in (-1, 1) and weights of Gauss and Legendre's rule, by Newton's method on the Legendre polynomial.
fn gauss(count: u32) -> Vec<(f64, f64)> {
    let n = f64::from(count);
    (0..count)
        .map(|index| {
            let mut x = (PI * (f64::from(index) + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut last, mut value) = (1.0, x);
                for k in 2..=count {
                    let k = f64::from(k);
                    (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
                }
                slope = n * (x * value - last) / (x * x - 1.0);
                x -= value / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Stress at `place` for loads `[weight, x, y]` that press, that push along x, along y.
fn summed(loads: &[[f64; 3]], place: [f64; 2]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for &[weight, x, y] in loads {
        // The kernel takes force minus taxel, and its f_z presses when negative.
        let [along_x, along_y, normal] = kernel::point([x - place[0], y - place[1]], DEPTH);
        for (sum, stress) in sums.iter_mut().zip([-normal, along_x, along_y]) {
            *sum += weight * stress;
        }
    }
    sums
}

/// A uniform load of 1 N on a rectangle, as point forces.
fn rectangle(half_sides: [f64; 2]) -> Vec<[f64; 3]> {
    let rule = gauss(48);
    let [a, b] = half_sides;
    rule.iter().flat_map(|(y, wy)| rule.iter().map(move |(x, wx)| [0.25 * wx * wy, a * x, b * y])).collect()
}

/// A load of 1 N on an ellipse, as point forces, in polar coordinates with `r = sin(t)`: `density(cos t)` is the
/// traction there, in which the root in the distance from the edge is smooth.
fn ellipse(semi_axes: [f64; 2], density: fn(f64) -> f64) -> Vec<[f64; 3]> {
    const TURN: u32 = 96;
    let [a, b] = semi_axes;
    let mut loads = Vec::new();
    for (t, weight) in gauss(64) {
        let (r, depth) = (0.25 * PI * (t + 1.0)).sin_cos();
        for step in 0..TURN {
            let (sin, cos) = (2.0 * PI * f64::from(step) / f64::from(TURN)).sin_cos();
            loads.push([weight * density(depth) * r * depth, a * r * cos, b * r * sin]);
        }
    }
    let total: f64 = loads.iter().map(|load| load[0]).sum();
    for load in &mut loads {
        load[0] /= total;
    }
    loads
}

/// Compares at all places, relative to the peak under the normal load.
#[track_caller]
fn assert_same(form: impl Fn([f64; 2]) -> [f64; 3], loads: &[[f64; 3]]) {
    let peak = summed(loads, [0.0, 0.0])[0].abs();
    for place in PLACES {
        let (found, expected) = (form(place), summed(loads, place));
        for (f, e) in found.into_iter().zip(expected) {
            assert!((f - e).abs() < 1e-13 * peak, "{place:?}: {found:?} for {expected:?}");
        }
    }
}

#[test]
fn rectangles() {
    for half_sides in [[2e-3, 1e-3], [4e-3, 4e-3], [0.5e-3, 5e-3]] {
        assert_same(|place| half_space::rectangle(half_sides, place, DEPTH), &rectangle(half_sides));
    }
}

#[test]
fn hertz_contacts() {
    for semi_axes in [[4e-3, 4e-3], [5e-3, 2e-3], [1e-3, 6e-3]] {
        assert_same(|place| half_space::hertz(semi_axes, place, DEPTH), &ellipse(semi_axes, |depth| depth));
    }
}

#[test]
fn punches() {
    for radius in [1e-3, 4e-3, 6e-3] {
        assert_same(|place| half_space::punch(radius, place, DEPTH), &ellipse([radius; 2], |depth| 1.0 / depth));
    }
}

#[test]
fn cells_are_point_forces_spread_out() {
    for pitch in [[4e-3, 2e-3], [4e-3, 4e-3]] {
        let loads = rectangle(pitch.map(|side| 0.5 * side));
        // The kernel's offset is that of the force from the taxel.
        let form = |place: [f64; 2]| {
            let [x, y, z] = kernel::cell(place.map(|v| -v), DEPTH, pitch);
            [-z, x, y]
        };
        assert_same(form, &loads);
    }
}

#[test]
fn the_matrices_hold_the_kernel_of_every_pair() {
    let sensor = Sensor { columns: 5, rows: 4, pitch_mm: [4.0, 2.5], depth_mm: 3.0 };
    let pitch = sensor.pitch_mm.map(|side| 1e-3 * side);
    for kind in [Kernel::Point, Kernel::Cell] {
        let entry = |offset| match kind {
            Kernel::Point => kernel::point(offset, DEPTH),
            Kernel::Cell => kernel::cell(offset, DEPTH, pitch),
        };
        let matrices = kernel::matrices(&sensor, kind);
        for taxel in 0..20 {
            for force in 0..20 {
                let (from, to) = (sensor.position_m(taxel), sensor.position_m(force));
                let expected = entry([to[0] - from[0], to[1] - from[1]]);
                for (matrix, expected) in matrices.iter().zip(expected) {
                    // Rounding of positions, relative to entries of about 1e5.
                    assert!((matrix[(taxel, force)] - expected).abs() < 1e-8, "{kind:?} {taxel} {force}");
                }
            }
        }
    }
}

#[test]
fn both_kernels_have_the_symmetries_of_the_grid_to_the_bit() {
    let sensor = Sensor { columns: 7, rows: 7, pitch_mm: [3.7, 3.7], depth_mm: 3.0 };
    for kind in [Kernel::Point, Kernel::Cell] {
        let [c31, c32, c33] = kernel::matrices(&sensor, kind);
        let mirror = |taxel: usize| taxel / 7 * 7 + 6 - taxel % 7;
        let transpose = |taxel: usize| taxel % 7 * 7 + taxel / 7;
        for taxel in 0..49 {
            for force in 0..49 {
                let mirrored = (mirror(taxel), mirror(force));
                let swapped = (transpose(taxel), transpose(force));
                let at = (taxel, force);
                // Sums, so that zeros of either sign are the same.
                assert!(c31[at] + c31[mirrored] == 0.0 && c31[at] - c32[swapped] == 0.0, "{kind:?} {at:?}");
                assert!(c33[at] - c33[mirrored] == 0.0 && c33[at] - c33[swapped] == 0.0, "{kind:?} {at:?}");
            }
        }
    }
}

#[test]
fn cells_bear_a_pressure_without_gain() {
    // The same force on every cell is a uniform pressure; in the middle of a wide grid that is the stress. Point
    // forces on so coarse a grid cause 1.25 times as much straight below them.
    let sensor = Sensor { columns: 31, rows: 31, pitch_mm: [4.0, 4.0], depth_mm: 3.0 };
    let middle = 15 * 31 + 15;
    for (kind, low, high) in [(Kernel::Cell, 0.999, 1.0), (Kernel::Point, 1.24, 1.26)] {
        let [_, _, c33] = kernel::matrices(&sensor, kind);
        let gain = 16e-6 * c33.row(middle).sum();
        assert!((low..high).contains(&gain), "{kind:?}: {gain}");
    }
}
