//! Training of the correction: gradient descent with momentum, on samples and their mirror images.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::samples::Sample;
use super::{Settings, Stage};
use crate::design::{Correction, WEIGHT_BITS, WEIGHT_FRACTION};
use crate::scene::normal;
use crate::solver::correction::MIRRORS;
use crate::solver::joint;

/// Samples of a step.
const BATCH: usize = 256;
/// Length of the first steps; it falls to 0 along a cosine.
const RATE: f64 = 3e-3;
/// Share of every weight that is forgotten for each unit of a step's length: it keeps the network from learning single
/// contacts by heart.
const DECAY: f64 = 0.03;

/// Trains the network to add what the scaled estimates lack of their targets.
pub(super) fn train(
    samples: &[Sample],
    targets: &[[f64; 2]],
    tangential: [f64; 2],
    half_window: [usize; 2],
    settings: &Settings,
    tick: &mut dyn FnMut(Stage),
) -> Correction {
    let inputs = Correction::inputs(half_window);
    let units = settings.hidden;
    let missing: Vec<[f64; 2]> = samples
        .iter()
        .zip(targets)
        .map(|(sample, target)| {
            let scaled = joint::scaled(sample.mu, tangential);
            [target[0] - scaled[0], target[1] - scaled[1]]
        })
        .collect();
    let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
    // Streams 0 and 1 of the seed made the samples.
    random.set_stream(2);
    let spread = 3.0 * (2.0 / inputs as f64).sqrt();
    let mut hidden = Layer::new(DMatrix::from_fn(units, inputs, |_, _| spread * normal(&mut random)));
    let spread = 0.03 / (units as f64).sqrt();
    let mut output = Layer::new(DMatrix::from_fn(2, units, |_, _| spread * normal(&mut random)));

    let mut looks = DMatrix::zeros(inputs, BATCH);
    let mut errors = DMatrix::zeros(2, BATCH);
    for step in 1..=settings.steps {
        let mut wanted = DMatrix::zeros(2, BATCH);
        for column in 0..BATCH {
            let index = random.random_range(0..samples.len());
            let [sign_x, sign_y] = MIRRORS[random.random_range(0..MIRRORS.len())];
            samples[index].look.mirrored([sign_x, sign_y], looks.column_mut(column).as_mut_slice());
            wanted[(0, column)] = sign_x * missing[index][0];
            wanted[(1, column)] = sign_y * missing[index][1];
        }
        let units = (&hidden.weights * &looks).map(|sum| sum.max(0.0));
        (&output.weights * &units).sub_to(&wanted, &mut errors);
        let mut back = output.weights.tr_mul(&errors);
        back.zip_apply(&units, |slope, unit| {
            if unit <= 0.0 {
                *slope = 0.0;
            }
        });
        let rate = 0.5 * RATE * (1.0 + (std::f64::consts::PI * step as f64 / settings.steps as f64).cos());
        let share = 1.0 / BATCH as f64;
        output.descend(&((&errors * units.transpose()) * share), rate, step);
        hidden.descend(&((back * looks.transpose()) * share), rate, step);
        tick(Stage::Step);
    }
    Correction {
        half_window,
        hidden: hidden.quantised(),
        output: {
            let mut rows = output.quantised().into_iter();
            [0, 1].map(|_| rows.next().unwrap_or_default())
        },
    }
}

/// Weights with what the descent remembers of their gradients (Adam: Kingma and Ba, 2015).
struct Layer {
    weights: DMatrix<f64>,
    mean: DMatrix<f64>,
    square: DMatrix<f64>,
}

impl Layer {
    fn new(weights: DMatrix<f64>) -> Self {
        let zero = DMatrix::zeros(weights.nrows(), weights.ncols());
        Self { weights, mean: zero.clone(), square: zero }
    }

    fn descend(&mut self, gradient: &DMatrix<f64>, rate: f64, step: usize) {
        const KEPT: [f64; 2] = [0.9, 0.999];
        let [mean_share, square_share] = KEPT.map(|kept| 1.0 - kept.powi(step as i32));
        let state = self.weights.iter_mut().zip(self.mean.iter_mut()).zip(self.square.iter_mut());
        for (((weight, mean), square), slope) in state.zip(gradient.iter()) {
            *mean = KEPT[0] * *mean + (1.0 - KEPT[0]) * slope;
            *square = KEPT[1] * *square + (1.0 - KEPT[1]) * slope * slope;
            *weight -= rate * DECAY * *weight;
            *weight -= rate * (*mean / mean_share) / ((*square / square_share).sqrt() + 1e-9);
        }
    }

    /// The weights row by row in steps of `2^-WEIGHT_FRACTION`.
    fn quantised(&self) -> Vec<Vec<i32>> {
        let limit = f64::from(1 << (WEIGHT_BITS - 1));
        let steps = f64::from(1 << WEIGHT_FRACTION);
        let row = |row: usize| {
            self.weights
                .row(row)
                .iter()
                .map(|weight| (weight * steps).round().clamp(-limit, limit - 1.0) as i32)
                .collect()
        };
        (0..self.weights.nrows()).map(row).collect()
    }
}
