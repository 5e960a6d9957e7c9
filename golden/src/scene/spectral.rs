//! Stress under a contact of known load spectrum, by the transfer function of the medium.
//!
//! The inverse Fourier integral is summed by the midpoint rule on a grid of wave vectors. Since the spectrum of the
//! load is known exactly, the rule errs only by the images of the contact at multiples of `2 pi / step`, which are
//! put so far away that they do not matter, and by the waves left out, of which the depth leaves `exp(-k h)`.

use std::f64::consts::PI;

use super::shape::Shape;
use super::transfer::Medium;

/// How finely the integral is summed.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Largest wave number times the depth.
    pub largest_kh: f64,
    /// Distance from any taxel to the nearest image of the contact, in depths.
    pub image_distance: f64,
}

impl Resolution {
    /// Relative errors below 1e-10 of the peak for a layer, and below 1e-6 for a half-space, whose images fade slowly, so that
    /// more waves would be in vain.
    pub const fn fine(medium: Medium) -> Self {
        match medium {
            Medium::HalfSpace => Self { largest_kh: 20.0, image_distance: 50.0 },
            Medium::BondedLayer { .. } => Self { largest_kh: 30.0, image_distance: 32.0 },
        }
    }

    /// Relative errors below 1e-4 of the peak for a layer, in a twentieth of the time.
    pub const COARSE: Self = Self { largest_kh: 12.0, image_distance: 12.0 };
}

/// Largest number of wave numbers along one axis, a second or two of work.
const MAX_WAVES: f64 = 4096.0;

/// Responses at the points of a grid to 1 N pressing, 1 N along x, 1 N along y, in pascals per newton: one vector
/// each, in taxel order.
pub type UnitResponses = [Vec<f64>; 3];

/// Sums the response of `medium` at depth `depth_m` below a contact of the given shape.
///
/// `offsets_m` are the coordinates of the grid's columns and rows minus the centre of the contact. Returns the number
/// of wave numbers needed if that is beyond reason: the depth is then tiny compared with the distances.
pub fn responses(
    medium: Medium,
    shape: Shape,
    depth_m: f64,
    offsets_m: &[Vec<f64>; 2],
    resolution: Resolution,
) -> Result<UnitResponses, f64> {
    let half_extent = shape.half_extent_m();
    let largest = resolution.largest_kh / depth_m;
    let mut axes = Vec::with_capacity(2);
    for (offsets, half) in offsets_m.iter().zip(half_extent) {
        let reach = offsets.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
        let step = 2.0 * PI / (reach + half + resolution.image_distance * depth_m);
        let waves = (largest / step).ceil();
        if waves > MAX_WAVES {
            return Err(waves);
        }
        axes.push(Axis::new(step, waves as usize, offsets));
    }
    let [along_x, along_y] = [&axes[0], &axes[1]];
    // Four quadrants of wave vectors, and (2 pi)^2 from the inverse transform.
    let weight = along_x.step * along_y.step / (PI * PI);
    let columns = offsets_m[0].len();
    let mut sums: UnitResponses = std::array::from_fn(|_| vec![0.0; columns * offsets_m[1].len()]);
    for (&ky, (cos_y, sin_y)) in along_y.waves.iter().zip(&along_y.tables) {
        let mut row = vec![[0.0; 3]; columns];
        for (&kx, (cos_x, sin_x)) in along_x.waves.iter().zip(&along_x.tables) {
            // Wave numbers are far from what a square overflows or vanishes at.
            let k = (kx * kx + ky * ky).sqrt();
            if k > largest {
                break;
            }
            let [h_p, h_q] = medium.transfer(k * depth_m);
            let load = weight * shape.spectrum([kx * half_extent[0], ky * half_extent[1]]);
            let normal = load * h_p;
            let (shear_x, shear_y) = (load * h_q * kx / k, load * h_q * ky / k);
            for (sums, (cos, sin)) in row.iter_mut().zip(cos_x.iter().zip(sin_x)) {
                sums[0] += normal * cos;
                sums[1] += shear_x * sin;
                sums[2] += shear_y * cos;
            }
        }
        // Of exp(i k . r) the normal load keeps cos cos; i times it, times the odd factor kx / k, keeps -sin cos.
        for (line, (cos, sin)) in cos_y.iter().zip(sin_y).enumerate() {
            let taxels = line * columns..(line + 1) * columns;
            for (load, (sums, factor)) in sums.iter_mut().zip([cos, cos, sin]).enumerate() {
                for (sum, values) in sums[taxels.clone()].iter_mut().zip(&row) {
                    *sum -= values[load] * factor;
                }
            }
        }
    }
    Ok(sums)
}

/// Wave numbers along one axis, with cosine and sine at each grid coordinate.
struct Axis {
    step: f64,
    waves: Vec<f64>,
    tables: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Axis {
    fn new(step: f64, count: usize, offsets: &[f64]) -> Self {
        // Midpoints: images alternate in sign and all but cancel, and k = 0, where k / |k| has no value, is avoided.
        let waves: Vec<f64> = (0..count).map(|index| (index as f64 + 0.5) * step).collect();
        let tables = waves
            .iter()
            .map(|k| {
                let (sines, cosines): (Vec<f64>, Vec<f64>) = offsets.iter().map(|x| (k * x).sin_cos()).unzip();
                (cosines, sines)
            })
            .collect();
        Self { step, waves, tables }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEPTH: f64 = 3e-3;
    const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };

    fn fine(medium: Medium, shape: Shape, offsets: &[Vec<f64>; 2]) -> UnitResponses {
        responses(medium, shape, DEPTH, offsets, Resolution::fine(medium)).unwrap()
    }

    fn offsets() -> [Vec<f64>; 2] {
        let axis = |centre: f64| (0..8).map(|i| f64::from(i) * 4e-3 - centre).collect();
        [axis(13e-3), axis(9e-3)]
    }

    /// Largest difference over all points and kinds of load, relative to the peak under the normal load.
    fn difference(one: &UnitResponses, other: &UnitResponses) -> f64 {
        let peak = one[0].iter().fold(0.0_f64, |peak, s| peak.max(s.abs()));
        let pairs = one.iter().flatten().zip(other.iter().flatten());
        pairs.fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / peak
    }

    const SHAPES: [Shape; 6] = [
        Shape::Hertz { semi_axes_m: [7e-3, 7e-3] },
        Shape::Hertz { semi_axes_m: [2e-3, 5e-3] },
        Shape::Rectangle { sides_m: [14e-3, 5e-3] },
        Shape::Rectangle { sides_m: [2e-3, 3e-3] },
        Shape::Disc { radius_m: 10e-3 },
        Shape::Punch { radius_m: 6e-3 },
    ];

    #[test]
    fn with_the_half_space_it_agrees_with_the_closed_forms() {
        let offsets = offsets();
        let mut compared = 0;
        for shape in SHAPES {
            let places = offsets[1].iter().flat_map(|&y| offsets[0].iter().map(move |&x| [x, y]));
            let stresses: Option<Vec<_>> = places.map(|place| shape.half_space(place, DEPTH)).collect();
            let Some(stresses) = stresses else { continue };
            let expected = [0, 1, 2].map(|load| stresses.iter().map(|stress| stress[load]).collect());
            let found = fine(Medium::HalfSpace, shape, &offsets);
            let error = difference(&expected, &found);
            assert!(error < 1e-6, "{shape:?}: {error:e}");
            compared += 1;
        }
        assert_eq!(compared, 5, "all but the disc");
    }

    #[test]
    fn under_the_middle_of_a_disc_the_half_space_has_the_textbook_stress() {
        // Johnson, Contact Mechanics, section 3.4: sigma_zz = -p (1 - z^3 / (a^2 + z^2)^(3/2)).
        let a: f64 = 10e-3;
        let disc = Shape::Disc { radius_m: a };
        let [normal, x, y] = fine(Medium::HalfSpace, disc, &[vec![0.0], vec![0.0]]);
        let expected = -(1.0 - (DEPTH / a.hypot(DEPTH)).powi(3)) / (PI * a * a);
        assert!((normal[0] / expected - 1.0).abs() < 1e-6, "{normal:?} {expected}");
        assert!(x[0] == 0.0 && y[0] == 0.0);
    }

    #[test]
    fn a_finer_sum_changes_nothing() {
        let offsets = offsets();
        for (medium, limit) in
            [(LAYER, 1e-10), (Medium::BondedLayer { poisson: 0.3 }, 1e-10), (Medium::HalfSpace, 1e-6)]
        {
            let Resolution { largest_kh, image_distance } = Resolution::fine(medium);
            let finer = Resolution { largest_kh: 1.3 * largest_kh, image_distance: 2.0 * image_distance };
            for shape in SHAPES {
                let one = fine(medium, shape, &offsets);
                let other = responses(medium, shape, DEPTH, &offsets, finer).unwrap();
                let error = difference(&other, &one);
                assert!(error < limit, "{medium:?} {shape:?}: {error:e}");
            }
        }
    }

    /// Of a contact much smaller than the depth the spectrum does not fade: what the sum leaves out the depth alone makes small.
    #[test]
    fn a_tip_has_the_errors_promised_too() {
        let offsets = [vec![0.0, 2e-3], vec![0.0, -5e-3]];
        let tip = Shape::Disc { radius_m: 0.3e-3 };
        for (medium, limit) in [(LAYER, 1e-10), (Medium::HalfSpace, 1e-6)] {
            let finer = Resolution { largest_kh: 48.0, image_distance: 100.0 };
            let error =
                difference(&responses(medium, tip, DEPTH, &offsets, finer).unwrap(), &fine(medium, tip, &offsets));
            assert!(error < limit, "{medium:?}: {error:e}");
        }
    }

    #[test]
    fn the_sum_converges_to_the_layer() {
        // Errors on the layer as the sum grows finer, against one much finer than the usual: each step gains at least a
        // digit, and what is left at the usual resolution is below 1e-11.
        let offsets = offsets();
        let finest = Resolution { largest_kh: 48.0, image_distance: 80.0 };
        for shape in SHAPES {
            let at = |resolution| responses(LAYER, shape, DEPTH, &offsets, resolution).unwrap();
            let limit = at(finest);
            let errors = [(6.0, 4.0), (10.0, 8.0), (16.0, 16.0), (24.0, 32.0)]
                .map(|(largest_kh, image_distance)| difference(&limit, &at(Resolution { largest_kh, image_distance })));
            assert!(errors[0] > 1e-6, "{shape:?}: {errors:?}");
            for pair in errors.windows(2) {
                assert!(pair[1] < 0.1 * pair[0] || pair[1] < 1e-10, "{shape:?}: {errors:?}");
            }
            assert!(difference(&limit, &fine(LAYER, shape, &offsets)) < 1e-11, "{shape:?}");
        }
    }

    #[test]
    fn the_fast_sum_is_good_enough_to_calibrate_with() {
        let offsets = offsets();
        for shape in SHAPES {
            let coarse = responses(LAYER, shape, DEPTH, &offsets, Resolution::COARSE).unwrap();
            let error = difference(&fine(LAYER, shape, &offsets), &coarse);
            assert!(error < 1e-4, "{shape:?}: {error:e}");
        }
    }

    #[test]
    fn a_coarse_sum_shows() {
        let coarse = Resolution { largest_kh: 4.0, image_distance: 1.0 };
        let disc = Shape::Disc { radius_m: 10e-3 };
        let coarse = responses(LAYER, disc, DEPTH, &offsets(), coarse).unwrap();
        assert!(difference(&fine(LAYER, disc, &offsets()), &coarse) > 1e-4);
    }

    #[test]
    fn the_layer_carries_the_whole_force() {
        // Midpoint sum over a grid that covers the contact and what spreads from it.
        let axis: Vec<f64> = (-30..=30).map(|i| f64::from(i) * 1e-3).collect();
        let disc = Shape::Disc { radius_m: 10e-3 };
        let sums = fine(LAYER, disc, &[axis.clone(), axis]).map(|stress| stress.iter().sum::<f64>() * 1e-6);
        assert!((sums[0] + 1.0).abs() < 1e-3, "{sums:?}");
        assert!(sums[1].abs() < 1e-9 && sums[2].abs() < 1e-9, "{sums:?}");
    }

    #[test]
    fn tension_trails_the_push_on_the_layer_too() {
        let axis = vec![-10e-3, 0.0, 10e-3];
        let shape = Shape::Hertz { semi_axes_m: [7e-3, 7e-3] };
        let [normal, x, y] = fine(LAYER, shape, &[axis.clone(), axis]);
        assert!(normal[4] < 0.0);
        assert!(x[3] > 0.0 && x[5] < 0.0, "{x:?}");
        assert!(y[1] > 0.0 && y[7] < 0.0, "{y:?}");
    }

    #[test]
    fn too_small_a_depth_is_refused() {
        let disc = Shape::Disc { radius_m: 10e-3 };
        assert!(responses(LAYER, disc, 1e-5, &offsets(), Resolution::fine(LAYER)).is_err());
    }
}
