//! The least error of any unbiased estimator (Cramér-Rao) under noise.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::spectral::UnitResponses;
use super::{Contact, Kind, Medium, Scene, SceneError, Shape, unit_responses};
use crate::numbers::mean;
use crate::sensor::Sensor;

/// Steps of place and radius for the slopes, in depths: the stress changes over a depth.
const STEP: f64 = 1.0 / 30.0;
/// Directions of a quarter circle, over which errors are averaged.
const DIRECTIONS: u32 = 16;

/// Cramér-Rao bound of the tangential force's error at a noise of 1 % of the frame's largest reading.
///
/// Median and 95 % quantile of the error's length, in percent of the normal force; both are proportional to the noise. The
/// contacts are those of [`Kind::Sliding`]. Their place, radius, normal and tangential force are unknown. The sensor reads
/// tension; one that does not knows less. Infinite if the taxels do not determine these six numbers.
///
/// # Errors
///
/// [`SceneError::TooFine`], as [`Kind::frames`].
pub fn bound(
    sensor: &Sensor,
    friction: f64,
    seeds: impl IntoParallelIterator<Item = u64>,
) -> Result<[f64; 2], SceneError> {
    let of_seed = |seed| {
        let Scene { medium, contacts, .. } = Kind::Sliding.scene(sensor, friction, seed);
        variances(sensor, medium, &contacts[0])
    };
    let variances: Option<Vec<[f64; 2]>> =
        seeds.into_par_iter().map(of_seed).collect::<Result<Vec<_>, _>>()?.into_iter().collect();
    Ok(variances.map_or([f64::INFINITY; 2], |variances| [0.5, 0.95].map(|share| quantile(&variances, share))))
}

/// Variances of the tangential force's error along its principal axes at a noise of 1 %, the larger first. In squared percent
/// of the normal force; none where the readings do not determine the contact.
fn variances(sensor: &Sensor, medium: Medium, contact: &Contact) -> Result<Option<[f64; 2]>, SceneError> {
    let [x, y] = contact.centre_m;
    let [radius, _] = contact.shape.half_extent_m();
    let moved = |[dx, dy, growth]: [f64; 3]| {
        let shape = match contact.shape {
            Shape::Disc { .. } => Shape::Disc { radius_m: radius + growth },
            _ => Shape::Hertz { semi_axes_m: [radius + growth; 2] },
        };
        unit_responses(sensor, medium, &Contact { shape, centre_m: [x + dx, y + dy], ..contact.clone() })
    };
    // Of a normal force of 1.
    let (sin, cos) = contact.direction_deg.to_radians().sin_cos();
    let stress = |[normal, along_x, along_y]: &UnitResponses| {
        let of_taxel = |taxel| normal[taxel] + contact.friction * (cos * along_x[taxel] + sin * along_y[taxel]);
        DVector::from_iterator(sensor.taxels(), (0..sensor.taxels()).map(of_taxel))
    };
    let still = moved([0.0; 3])?;
    let mut slopes: Vec<DVector<f64>> = still.iter().map(|of| DVector::from_column_slice(of)).collect();
    let step = STEP * sensor.depth_m();
    for axis in 0..3 {
        let by = |step| moved([0, 1, 2].map(|other| if other == axis { step } else { 0.0 }));
        slopes.push((stress(&by(step)?) - stress(&by(-step)?)) / (2.0 * step));
    }
    // Metres and newtons differ by orders of magnitude: columns of length 1 keep the digits.
    let lengths: Vec<f64> = slopes.iter_mut().map(DVector::normalize_mut).collect();
    let slopes = DMatrix::from_columns(&slopes);
    let Some(information) = slopes.tr_mul(&slopes).cholesky() else { return Ok(None) };
    let inverse = information.inverse();
    let deviation = stress(&still).amax();
    let of = |one: usize, other: usize| deviation.powi(2) * inverse[(one, other)] / (lengths[one] * lengths[other]);
    let (mean, far) = (f64::midpoint(of(1, 1), of(2, 2)), (0.5 * (of(1, 1) - of(2, 2))).hypot(of(1, 2)));
    Ok(Some([mean + far, (mean - far).max(0.0)]))
}

/// The length that a share of the errors is below, each contact's errors normal with these variances.
///
/// An error is a standard normal pair, of Rayleigh's length and even direction, stretched along the principal axes.
fn quantile(variances: &[[f64; 2]], share: f64) -> f64 {
    let squares = variances.iter().flat_map(|[large, small]| {
        let angles = (0..DIRECTIONS).map(|index| FRAC_PI_2 * (f64::from(index) + 0.5) / f64::from(DIRECTIONS));
        angles.map(move |angle| large * angle.cos().powi(2) + small * angle.sin().powi(2))
    });
    let squares: Vec<f64> = squares.collect();
    let below = |length: f64| {
        let share = |square: &f64| -(-0.5 * length.powi(2) / square).exp_m1();
        mean(squares.iter().map(share))
    };
    let largest = squares.iter().copied().fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, (-2.0 * largest * (1.0 - share).ln()).sqrt());
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        if below(middle) < share { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Quantiles;
    use crate::scene::{SceneFrame, normal};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn sensor(pitch_mm: [f64; 2]) -> Sensor {
        Sensor { columns: 10, rows: 10, pitch_mm, depth_mm: 3.0 }
    }

    fn is_near(found: f64, expected: f64, share: f64) -> bool {
        (found / expected - 1.0).abs() < share
    }

    /// Figures of another program: forces and places fitted in numpy, the errors drawn.
    #[test]
    fn the_papers_sensors_have_the_known_bounds() {
        for (pitch_mm, median, most) in [([4.0, 2.0], 3.66, 8.14), ([4.0, 4.0], 4.50, 10.28)] {
            let found = bound(&sensor(pitch_mm), 0.5, 90_000..90_200).expect("contacts");
            assert!(is_near(found[0], median, 0.01) && is_near(found[1], most, 0.02), "{pitch_mm:?}: {found:?}");
        }
    }

    /// Least squares on noisy frames of scenes, with other parameters, has errors at the bound.
    #[test]
    fn a_fit_reaches_the_bound() {
        const SEEDS: std::ops::Range<u64> = 7..13;
        let (sensor, percent) = (sensor([4.0, 2.0]), 0.1);
        let mut errors = Vec::new();
        for seed in SEEDS {
            // By millimetres, the radius' logarithm, and the force in newtons.
            let stress = |[x, y, size, pressing, along_x, along_y]: [f64; 6]| {
                let mut scene = Kind::Sliding.scene(&sensor, 0.5, seed);
                let contact = &mut scene.contacts[0];
                let [radius, _] = contact.shape.half_extent_m().map(|radius| radius * size.exp());
                contact.shape = match contact.shape {
                    Shape::Disc { .. } => Shape::Disc { radius_m: radius },
                    _ => Shape::Hertz { semi_axes_m: [radius; 2] },
                };
                contact.centre_m = [contact.centre_m[0] + 1e-3 * x, contact.centre_m[1] + 1e-3 * y];
                contact.friction = along_x.hypot(along_y) / pressing;
                (contact.normal_force_n, contact.direction_deg) = (pressing, along_y.atan2(along_x).to_degrees());
                DVector::from_vec(scene.frames().expect("a frame").remove(0).stress)
            };
            let SceneFrame { force, .. } = Kind::Sliding.frame(&sensor, 0.5, seed).expect("a frame");
            let truth = [0.0, 0.0, 0.0, -force[2], force[0], force[1]];
            let exact = stress(truth);
            let slopes = [0, 1, 2, 3, 4, 5].map(|index| {
                let mut moved = truth;
                moved[index] += 1e-4;
                (stress(moved) - &exact) / 1e-4
            });
            let fit = DMatrix::from_columns(&slopes).pseudo_inverse(1e-9).expect("full rank");
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            for _ in 0..2000 {
                let error = &fit * exact.map(|_| 0.01 * percent * exact.amax() * normal(&mut random));
                errors.push(100.0 * error[4].hypot(error[5]) / force[2].abs());
            }
        }
        let [median, most] = bound(&sensor, 0.5, SEEDS).expect("contacts").map(|error| percent * error);
        let found = Quantiles::of(errors);
        assert!(is_near(found.median, median, 0.03) && is_near(found.most, most, 0.03), "{found:?} {median} {most}");
    }

    #[test]
    fn of_equal_variances_the_lengths_are_rayleighs_and_of_one_alone_half_a_normal() {
        assert!(is_near(quantile(&[[4.0; 2]], 0.5), 2.0 * (2.0 * 2.0_f64.ln()).sqrt(), 1e-9));
        assert!(is_near(quantile(&[[4.0, 0.0]], 0.95), 2.0 * 1.959_964, 1e-3));
    }

    #[test]
    fn too_few_taxels_determine_nothing() {
        let few = Sensor { columns: 2, rows: 2, ..sensor([4.0, 4.0]) };
        assert!(bound(&few, 0.5, 0..4).expect("contacts").into_iter().all(f64::is_infinite));
    }
}
