//! Training of the standard error: the network's third output.
//!
//! The hidden units of the correction stay as they were found; some more join them that enter this output alone. The
//! logarithm of the error is a sum over the part of all of them that is the same for every mirror image. It is found on
//! general frames that the correction has not seen, as the most likely width of a normal distribution of the
//! error in the plane.

use nalgebra::{DMatrix, DVector};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::general::{self, Body};
use super::looks::Basis;
use super::observer::{Observer, Sample};
use super::samples::stream;
use super::train::{Layer, quantised, scaled_alike};
use super::{CalibrateError, Settings, Stage, twins};
use crate::estimators::joint::{
    Correction, ErrorOutput, Joint, MAX_HIDDEN, NetworkScratch, WEIGHT_FRACTION, WEIGHT_LIMIT,
};
use crate::estimators::standard_error::{ERROR_FRACTION, limited, ratio};
use crate::parity::{CLASSES, butterfly};
use crate::scene::normal;

/// One hidden unit for the error alone for so many of the correction.
const SHARE: usize = 4;
/// Most hidden units of a correction whose error output finds room beside them.
pub const MOST_FOUND: usize = MAX_HIDDEN * SHARE / (SHARE + 1);
/// Samples of a step.
const BATCH: usize = 256;
/// Length of the first steps of the hidden units, and of the sum over all of them; they fall to 0 along a cosine.
const RATES: [f32; 2] = [3e-3, 1e-2];
/// A frame counts as at most so many times as far off, squared, as it should be.
const FARTHEST: f64 = 16.0;
/// A unit that varies by less is no input.
const LEAST_SPREAD: f32 = 1e-2;
/// No frame's error is taken for less: a logarithm has no 0.
const LEAST_ERROR: f64 = 1e-4;
/// Share of each mirror image in the mean.
const QUARTER: f32 = 0.25;

/// Makes frames that nothing was fitted to, each of a body of its own.
pub(super) fn samples(
    observer: &mut Observer<'_>,
    settings: &Settings,
    tick: &mut dyn FnMut(Stage),
) -> Result<Vec<Sample>, CalibrateError> {
    let (mut of_bodies, mut random) = (stream(settings.seed, 3), stream(settings.seed, 4));
    let frames = settings.error_samples();
    let bodies: Vec<Body> = (0..frames)
        .map(|_| {
            tick(Stage::Contact);
            Body::random(observer.sensor(), &mut of_bodies)
        })
        .collect();
    let mut samples = Vec::with_capacity(frames);
    for index in 0..frames {
        tick(Stage::Sample);
        samples.extend(general::sample(&bodies, index, true, observer, &mut random)?);
    }
    Ok(samples)
}

/// Trains the error output of a correction, which has more hidden units then, on samples that it was not trained on.
pub(super) fn train(
    estimator: &Joint,
    correction: Correction,
    samples: &[Sample],
    (square, settings): (bool, &Settings),
    tick: &mut dyn FnMut(Stage),
) -> Correction {
    let found = correction.hidden.len();
    let units = (found / SHARE).max(1);
    let mut scratch = NetworkScratch::default();
    let mut known = DMatrix::<f32>::zeros(found, samples.len());
    let mut errors = Vec::with_capacity(samples.len());
    for (sample, mut column) in samples.iter().zip(known.column_iter_mut()) {
        let mu = estimator.corrected(sample.mu, &sample.look, &mut scratch);
        column.iter_mut().zip(scratch.even()).for_each(|(into, unit)| *into = *unit as f32);
        errors.push(sample.error(mu, estimator.gain).max(LEAST_ERROR));
    }
    let mean = known.column_mean();
    let spread = known.column_variance().map(|variance| variance.sqrt().max(LEAST_SPREAD));
    for mut column in known.column_iter_mut() {
        column -= &mean;
        column.component_div_assign(&spread);
    }
    let basis = Basis::new(samples, correction.half_window, square);
    let looks = basis.looks(samples);
    let mut random = stream(settings.seed, 5);
    let mut learner = Learner::new(&basis, [units, found], &errors, &mut random);
    let mut batch = [0, 1, 2, 3].map(|class| DMatrix::zeros(basis.size(class), BATCH));
    let mut of_known = DMatrix::zeros(found, BATCH);
    let mut wanted = vec![0.0; BATCH];
    let steps = settings.error_steps();
    for step in 1..=steps {
        for (column, wanted) in wanted.iter_mut().enumerate() {
            let index = random.random_range(0..samples.len());
            for (batch, looks) in batch.iter_mut().zip(&looks) {
                batch.set_column(column, &looks.column(index));
            }
            of_known.set_column(column, &known.column(index));
            *wanted = errors[index];
        }
        let rate = 0.5 * (1.0 + (std::f32::consts::PI * step as f32 / steps as f32).cos());
        learner.descend(&batch, &of_known, &wanted, rate, step);
        tick(Stage::Step);
    }
    learner.finish(&basis, correction, &mean, &spread)
}

/// The error output during training.
struct Learner {
    /// Weights of the units of the error output alone (rows) on the whitened inputs of each class.
    hidden: [Layer; CLASSES],
    /// Weights of these, of the units of the correction, and what is added.
    output: Layer,
    /// The units of each mirror image (rows) of each sample of a step.
    images: [DMatrix<f32>; CLASSES],
    /// Where the sensor is square, units have twins.
    diagonal: Option<twins::Diagonal>,
}

impl Learner {
    fn new(basis: &Basis, [units, known]: [usize; 2], errors: &[f64], random: &mut ChaCha8Rng) -> Self {
        let inputs: usize = (0..CLASSES).map(|class| basis.size(class)).sum();
        let spread = (2.0 / inputs as f64).sqrt();
        let mut hidden = [0, 1, 2, 3]
            .map(|class| DMatrix::from_fn(units, basis.size(class), |_, _| (spread * normal(random)) as f32));
        if let Some(diagonal) = &basis.diagonal {
            diagonal.add(&mut hidden);
            for weights in &mut hidden {
                *weights *= std::f32::consts::FRAC_1_SQRT_2;
            }
        }
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        let mut output = DMatrix::zeros(units + known + 1, 1);
        output[units + known] = sorted.get(sorted.len() / 2).map_or(0.0, |error| error.log2() as f32);
        Self {
            hidden: hidden.map(Layer::new),
            output: Layer::new(output),
            images: [0, 1, 2, 3].map(|_| DMatrix::zeros(units, BATCH)),
            diagonal: basis.diagonal.clone(),
        }
    }

    /// One step towards the most likely errors; `rate` is a share of the first one.
    fn descend(
        &mut self,
        batch: &[DMatrix<f32>; CLASSES],
        known: &DMatrix<f32>,
        errors: &[f64],
        rate: f32,
        step: usize,
    ) {
        let (units, found) = (self.images[0].nrows(), known.nrows());
        for ((sums, layer), batch) in self.images.iter_mut().zip(&self.hidden).zip(batch) {
            layer.weights.mul_to(batch, sums);
        }
        let mut even = DMatrix::<f32>::zeros(units, BATCH);
        let [a, b, c, d] = self.images.each_mut().map(DMatrix::as_mut_slice);
        for (((a, b), (c, d)), even) in a.iter_mut().zip(b).zip(c.iter_mut().zip(d)).zip(even.iter_mut()) {
            let images = butterfly([*a, *b, *c, *d]).map(|sum| sum.max(0.0));
            [*a, *b, *c, *d] = images;
            *even = QUARTER * images.iter().sum::<f32>();
        }
        let weights = self.output.weights.column(0);
        let (own, others) = (weights.rows(0, units), weights.rows(units, found));
        let base = weights[units + found];
        let slopes = DVector::from_fn(BATCH, |sample, _| {
            let log = base + own.dot(&even.column(sample)) + others.dot(&known.column(sample));
            // Of 2 ln s + (e / s)^2 along ln s, by half.
            let far = errors[sample] / ratio(limited(f64::from(log)));
            ((1.0 - (far * far).min(FARTHEST)) / BATCH as f64) as f32
        });
        let mut of_output = DMatrix::zeros(units + found + 1, 1);
        of_output.view_mut((0, 0), (units, 1)).copy_from(&(&even * &slopes));
        of_output.view_mut((units, 0), (found, 1)).copy_from(&(known * &slopes));
        of_output[units + found] = slopes.sum();
        // Back through the hinges, as in the training of the correction.
        let own = &self.output.weights.as_slice()[..units];
        for (sample, slope) in slopes.iter().enumerate() {
            let column = sample * units..(sample + 1) * units;
            let [a, b, c, d] = self.images.each_mut().map(|image| &mut image.as_mut_slice()[column.clone()]);
            let images = a.iter_mut().zip(b).zip(c.iter_mut().zip(d));
            for (((a, b), (c, d)), weight) in images.zip(own.iter()) {
                let slope = QUARTER * weight * slope;
                let back = [*a, *b, *c, *d].map(|unit| if unit > 0.0 { slope } else { 0.0 });
                [*a, *b, *c, *d] = butterfly(back);
            }
        }
        let mut of_hidden = [0, 1, 2, 3].map(|class| &self.images[class] * batch[class].transpose());
        if let Some(diagonal) = &self.diagonal {
            diagonal.add(&mut of_hidden);
            // A unit and its twin weigh the same here.
            let before = of_output.clone();
            for unit in 0..units {
                of_output[unit] += before[twins::twin(unit, units)];
            }
        }
        for (slopes, layer) in of_hidden.iter().zip(&mut self.hidden) {
            layer.descend(slopes, RATES[0] * rate, step);
        }
        self.output.descend(&of_output, RATES[1] * rate, step);
    }

    /// The correction with the units of the error output behind its own, in whole steps.
    fn finish(
        self,
        basis: &Basis,
        mut correction: Correction,
        mean: &DVector<f32>,
        spread: &DVector<f32>,
    ) -> Correction {
        let (units, found) = (self.images[0].nrows(), correction.hidden.len());
        let weights = self.output.weights.map(f64::from);
        let mut hidden = basis.weights(self.hidden.each_ref().map(|layer| &layer.weights));
        let mut own_weights = weights.rows(0, units).into_owned();
        scaled_alike(&mut hidden, &mut own_weights);
        let of_known = weights.rows(units, found).component_div(&spread.map(f64::from));
        let base = weights[units + found] - of_known.dot(&mean.map(f64::from));
        let limit = f64::from(WEIGHT_LIMIT);
        let whole =
            |value: f64, fraction: u32| (value * f64::from(1 << fraction)).round().clamp(-limit, limit - 1.0) as i32;
        let output = |weights: &[f64]| weights.iter().map(|&weight| whole(weight, WEIGHT_FRACTION)).collect::<Vec<_>>();
        let mut own = Correction {
            half_window: correction.half_window,
            hidden: quantised(&hidden),
            output: [vec![0; units], vec![0; units]],
            error: Some(ErrorOutput { base: whole(base, ERROR_FRACTION), output: output(own_weights.as_slice()) }),
        };
        let mut of_known = output(of_known.as_slice());
        if self.diagonal.is_some() {
            twins::tie(&mut own);
            for unit in 0..found {
                let other = twins::twin(unit, found);
                let mean = i32::midpoint(of_known[unit], of_known[other]);
                (of_known[unit], of_known[other]) = (mean, mean);
            }
        }
        correction.hidden.append(&mut own.hidden);
        for (output, mut zeros) in correction.output.iter_mut().zip(own.output) {
            output.append(&mut zeros);
        }
        correction.error = own.error.map(|error| ErrorOutput { output: [of_known, error.output].concat(), ..error });
        correction
    }
}
