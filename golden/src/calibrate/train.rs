//! Training of the correction: gradient descent with momentum, on the mean over each sample's mirror images.

use nalgebra::DMatrix;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::diagonal::Diagonal;
use super::observer::Sample;
use super::whitening::Basis;
use super::{Settings, diagonal};
use crate::design::Sensor;
use crate::estimators::joint::{self, Correction, LARGEST, TrainingSet, WEIGHT_FRACTION, WEIGHT_LIMIT};
use crate::parity::{COMPONENTS, butterfly};
use crate::scene::{normal, stream};

/// Samples of a step.
const BATCH: usize = 256;
/// Length of the first steps; it falls to 0 along a cosine.
const RATE: f32 = 3e-3;
/// Share of every weight that is forgotten for each unit of a step's length: it keeps the network from learning single
/// contacts by heart.
const DECAY: f32 = 0.1;
/// The largest weight of a hidden unit. Up to here a parity component's share of a weight, a quarter of four's sum,
/// is exact in the hardware's 18 bits.
const LARGEST_WEIGHT: f64 = 7.9;
/// The largest sum of a hidden unit's weights. The hardware rounds all units alike, as the largest sum demands, so all
/// are brought to about the same one; a factor on a unit goes out of its weights in the output, which changes nothing.
/// A little less than a power of two: with what rounding the weights adds a full one would cost all units a bit.
const LARGEST_SUM: f64 = 63.75;
/// Errors above this count by their size, those below by their square. Frames of much noise and contacts that look alike
/// must not decide the rest.
const SOFT: f32 = 0.02;
/// The shares of all steps between which spare units are left out, evenly.
const LEFT_OUT: [f64; 2] = [0.1, 0.5];
/// Share of a step in the mean of what a unit adds.
const COUNTED: f64 = 0.005;
/// Share of each mirror image in the mean.
const QUARTER: f32 = 0.25;

/// Trains the network to add what the scaled estimates lack of their targets.
pub(super) fn train(
    (sensor, training_set): (&Sensor, TrainingSet),
    samples: &[Sample],
    targets: &[[f64; 2]],
    friction_correction: [f64; 2],
    half_window: [usize; 2],
    settings: &Settings,
    tick: &mut dyn FnMut(),
) -> Correction {
    let missing: Vec<[f32; 2]> = samples
        .iter()
        .zip(targets)
        .map(|(sample, target)| {
            let scaled = joint::scaled(sample.mu, friction_correction);
            let missing = [0, 1].map(|axis| target[axis] - scaled[axis]);
            match training_set {
                TrainingSet::Sliding => missing,
                // More is never added.
                TrainingSet::General => missing.map(|part| part.clamp(-LARGEST, LARGEST)),
            }
            .map(|part| part as f32)
        })
        .collect();
    let basis = Basis::new(samples, half_window, diagonal::has_diagonal(sensor));
    let features = basis.features(samples);
    // Streams 0 and 1 of the seed made the samples.
    let mut random = stream(settings.seed, 2);
    let mut learner = Learner::new(&basis, settings.hidden + settings.spare, &mut random);
    let mut batch = [0, 1, 2, 3].map(|component| DMatrix::zeros(basis.size(component), BATCH));
    let mut wanted = DMatrix::zeros(BATCH, 2);
    for step in 1..=settings.steps {
        for column in 0..BATCH {
            let index = random.random_range(0..samples.len());
            for (batch, features) in batch.iter_mut().zip(&features) {
                batch.set_column(column, &features.column(index));
            }
            wanted[(column, 0)] = missing[index][0];
            wanted[(column, 1)] = missing[index][1];
        }
        let rate = 0.5 * RATE * (1.0 + (std::f32::consts::PI * step as f32 / settings.steps as f32).cos());
        learner.descend(&batch, &wanted, (rate, step));
        learner.leave_out(settings.hidden + spare_left(settings, step));
        tick();
    }
    learner.correction(&basis, half_window)
}

/// Spare units that are still there after a step.
fn spare_left(settings: &Settings, step: usize) -> usize {
    let [from, to] = LEFT_OUT;
    let share = (step as f64 / settings.steps as f64 - from) / (to - from);
    settings.spare - (share.clamp(0.0, 1.0) * settings.spare as f64) as usize
}

/// The network while it learns.
struct Learner {
    /// Weights of the hidden units (rows) on the whitened inputs of each component.
    hidden: [Layer; COMPONENTS],
    /// Weights of the hidden units (rows) in both components.
    output: Layer,
    /// The hidden units (rows) of each mirror image of each sample of a step.
    images: [DMatrix<f32>; COMPONENTS],
    /// Their part odd in x and odd in y.
    odd: [DMatrix<f32>; 2],
    /// Where the sensor is square, units have partners.
    diagonal: Option<Diagonal>,
    /// What each unit adds: a running mean of its square.
    added: Vec<f64>,
}

impl Learner {
    fn new(basis: &Basis, units: usize, random: &mut ChaCha8Rng) -> Self {
        let inputs: usize = (0..COMPONENTS).map(|component| basis.size(component)).sum();
        let spread = (2.0 / inputs as f64).sqrt();
        let mut hidden = [0, 1, 2, 3]
            .map(|component| DMatrix::from_fn(units, basis.size(component), |_, _| (spread * normal(random)) as f32));
        let spread = 0.03 / (units as f64).sqrt();
        let mut output = DMatrix::from_fn(units, 2, |_, _| (spread * normal(random)) as f32);
        let diagonal = basis.diagonal.clone();
        if let Some(diagonal) = &diagonal {
            // A sum of two is longer than either.
            let shorter = std::f32::consts::FRAC_1_SQRT_2;
            diagonal.add(&mut hidden);
            diagonal::add_output(&mut output);
            hidden.iter_mut().chain([&mut output]).for_each(|weights| *weights *= shorter);
        }
        let zeros = || DMatrix::zeros(units, BATCH);
        let images = [0, 1, 2, 3].map(|_| zeros());
        Self {
            hidden: hidden.map(Layer::new),
            output: Layer::new(output),
            images,
            odd: [zeros(), zeros()],
            diagonal,
            added: vec![0.0; units],
        }
    }

    /// The correction of each sample (rows) in a batch of whitened features by component.
    fn correct(&mut self, batch: &[DMatrix<f32>; COMPONENTS]) -> DMatrix<f32> {
        for ((sums, layer), batch) in self.images.iter_mut().zip(&self.hidden).zip(batch) {
            layer.weights.mul_to(batch, sums);
        }
        let [a, b, c, d] = self.images.each_mut().map(DMatrix::as_mut_slice);
        let [odd_x, odd_y] = self.odd.each_mut().map(DMatrix::as_mut_slice);
        let images = a.iter_mut().zip(b).zip(c.iter_mut().zip(d));
        for (((a, b), (c, d)), (odd_x, odd_y)) in images.zip(odd_x.iter_mut().zip(odd_y)) {
            let units = butterfly([*a, *b, *c, *d]).map(|sum| sum.max(0.0));
            [*a, *b, *c, *d] = units;
            [_, *odd_x, *odd_y, _] = butterfly(units);
        }
        let mut found = DMatrix::zeros(BATCH, 2);
        for (axis, odd) in self.odd.iter().enumerate() {
            found.column_mut(axis).gemv_tr(QUARTER, odd, &self.output.weights.column(axis), 0.0);
        }
        found
    }

    /// One step, of a length and a number, towards the corrections `wanted`, a row for each sample of the batch.
    fn descend(&mut self, batch: &[DMatrix<f32>; COMPONENTS], wanted: &DMatrix<f32>, (rate, step): (f32, usize)) {
        let mut errors = (self.correct(batch) - wanted) * (QUARTER / BATCH as f32);
        let soft = SOFT * (QUARTER / BATCH as f32);
        for mut error in errors.row_iter_mut() {
            error /= (1.0 + error.norm_squared() / (soft * soft)).sqrt();
        }
        let mut slope = DMatrix::zeros(self.output.weights.nrows(), 2);
        for (axis, odd) in self.odd.iter().enumerate() {
            slope.column_mut(axis).gemv(1.0, odd, &errors.column(axis), 0.0);
        }
        // Back through the rectifiers: the units give way to the slopes of the components' sums.
        let units = self.output.weights.nrows();
        let [along_x, along_y] = [0, 1].map(|axis| self.output.weights.column(axis));
        for sample in 0..BATCH {
            let [error_x, error_y] = [errors[(sample, 0)], errors[(sample, 1)]];
            let column = sample * units..(sample + 1) * units;
            let [a, b, c, d] = self.images.each_mut().map(|image| &mut image.as_mut_slice()[column.clone()]);
            let images = a.iter_mut().zip(b).zip(c.iter_mut().zip(d));
            for (((a, b), (c, d)), (along_x, along_y)) in images.zip(along_x.iter().zip(along_y.iter())) {
                let mut slopes = butterfly([0.0, along_x * error_x, along_y * error_y, 0.0]);
                for (slope, unit) in slopes.iter_mut().zip([*a, *b, *c, *d]) {
                    *slope = if unit > 0.0 { *slope } else { 0.0 };
                }
                [*a, *b, *c, *d] = butterfly(slopes);
            }
        }
        let mut slopes = [0, 1, 2, 3].map(|component| &self.images[component] * batch[component].transpose());
        if let Some(diagonal) = &self.diagonal {
            diagonal.add(&mut slopes);
            diagonal::add_output(&mut slope);
        }
        for (slopes, layer) in slopes.iter().zip(&mut self.hidden) {
            layer.descend(slopes, rate, step);
        }
        self.output.descend(&slope, rate, step);
    }

    /// Leaves out those units that add least until so many are left; partners go together.
    fn leave_out(&mut self, left: usize) {
        let units = self.added.len();
        if units <= left {
            return;
        }
        for (unit, added) in self.added.iter_mut().enumerate() {
            let square =
                |axis: usize| self.odd[axis].row(unit).norm_squared() * self.output.weights[(unit, axis)].powi(2);
            *added += COUNTED * (f64::from(square(0) + square(1)) - *added);
        }
        let together = if self.diagonal.is_some() { 2 } else { 1 };
        while self.added.len() >= left + together {
            let pairs = self.added.chunks_exact(together).map(|pair| pair.iter().sum::<f64>());
            let Some((least, _)) = pairs.enumerate().min_by(|(_, one), (_, other)| one.total_cmp(other)) else {
                return;
            };
            let first = together * least;
            self.added.drain(first..first + together);
            let layers = self.hidden.iter_mut().chain([&mut self.output]);
            let of_layers = layers.flat_map(|layer| [&mut layer.weights, &mut layer.mean, &mut layer.square]);
            for matrix in of_layers.chain(&mut self.images).chain(&mut self.odd) {
                *matrix = std::mem::replace(matrix, DMatrix::zeros(0, 0)).remove_rows(first, together);
            }
        }
    }

    /// The weights of the inputs themselves, in whole steps.
    fn correction(&self, basis: &Basis, half_window: [usize; 2]) -> Correction {
        let mut hidden = basis.weights(self.hidden.each_ref().map(|layer| &layer.weights));
        let mut output = self.output.weights.map(f64::from);
        scaled_alike(&mut hidden, &mut output);
        let mut output = quantised(&output.transpose()).into_iter();
        let output = [0, 1].map(|_| output.next().unwrap_or_default());
        let mut correction = Correction { half_window, hidden: quantised(&hidden), output };
        if self.diagonal.is_some() {
            diagonal::tie(&mut correction);
        }
        correction
    }
}

/// Brings the hidden units (rows) to about the same sum of weights, at the cost of their weights in the output.
pub(super) fn scaled_alike(hidden: &mut DMatrix<f64>, output: &mut DMatrix<f64>) {
    for (mut unit, mut output) in hidden.row_iter_mut().zip(output.row_iter_mut()) {
        let sum: f64 = unit.iter().map(|weight| weight.abs()).sum();
        let most = (LARGEST_SUM / sum).min(LARGEST_WEIGHT / unit.amax());
        // A power of two; of a unit without weights none.
        let factor = if most.is_finite() { most.log2().floor().exp2() } else { 1.0 };
        unit *= factor;
        output /= factor;
    }
}

/// Weights with what the descent remembers of their gradients (Adam: Kingma and Ba, 2015).
pub(super) struct Layer {
    pub(super) weights: DMatrix<f32>,
    mean: DMatrix<f32>,
    square: DMatrix<f32>,
}

impl Layer {
    pub(super) fn new(weights: DMatrix<f32>) -> Self {
        let zero = DMatrix::zeros(weights.nrows(), weights.ncols());
        Self { weights, mean: zero.clone(), square: zero }
    }

    pub(super) fn descend(&mut self, gradient: &DMatrix<f32>, rate: f32, step: usize) {
        const KEPT: [f32; 2] = [0.9, 0.999];
        let [mean_share, square_share] = KEPT.map(|kept| 1.0 - kept.powi(step as i32));
        let state = self.weights.iter_mut().zip(self.mean.iter_mut()).zip(self.square.iter_mut());
        for (((weight, mean), square), slope) in state.zip(gradient.iter()) {
            *mean = KEPT[0] * *mean + (1.0 - KEPT[0]) * slope;
            *square = KEPT[1] * *square + (1.0 - KEPT[1]) * slope * slope;
            *weight -= rate * DECAY * *weight;
            *weight -= rate * (*mean / mean_share) / ((*square / square_share).sqrt() + 1e-9);
        }
    }
}

/// Weights row by row in steps of `2^-WEIGHT_FRACTION`.
pub(super) fn quantised(weights: &DMatrix<f64>) -> Vec<Vec<i32>> {
    let limit = f64::from(WEIGHT_LIMIT);
    let steps = f64::from(1 << WEIGHT_FRACTION);
    let whole = |weight: &f64| (weight * steps).round().clamp(-limit, limit - 1.0) as i32;
    weights.row_iter().map(|row| row.iter().map(whole).collect()).collect()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;
    use crate::calibrate::observer::Observer;
    use crate::calibrate::samples;
    use crate::design::Design;
    use crate::estimators::joint::{Network, NetworkScratch};

    const HALF_WINDOW: [usize; 2] = [2, 3];

    /// A batch of samples of a small sensor, and a learner that has learned nothing yet.
    fn beginner(units: usize) -> (Vec<Sample>, Basis, Learner) {
        let pad = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
            name = \"pad\"\n[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n\
                   [algorithm]\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\n";
        let design = Design::from_toml(pad, "pad.toml").unwrap();
        let settings = Settings { contacts: 40, samples: BATCH, ..Settings::default() };
        let mut observer = Observer::new(&design, 0, HALF_WINDOW).unwrap();
        let samples = samples::make(&mut observer, &settings, &mut || ()).unwrap();
        let basis = Basis::new(&samples, HALF_WINDOW, false);
        let learner = Learner::new(&basis, units, &mut ChaCha8Rng::seed_from_u64(1));
        (samples, basis, learner)
    }

    fn batch(samples: &[Sample], basis: &Basis) -> [DMatrix<f32>; COMPONENTS] {
        basis.features(samples).map(|features| features.resize_horizontally(BATCH, 0.0))
    }

    /// What is trained by parity component, whitened, is what the solver makes of the weights.
    #[test]
    fn the_learner_is_the_network() {
        let (samples, basis, mut learner) = beginner(7);
        let found = learner.correct(&batch(&samples, &basis));
        let network = Network::new(&learner.correction(&basis, HALF_WINDOW));
        let mut largest = 0.0_f64;
        for (index, sample) in samples.iter().enumerate() {
            let wanted = network.correct(&sample.features, &mut NetworkScratch::default());
            for (axis, wanted) in wanted.into_iter().enumerate() {
                largest = largest.max(wanted.abs());
                // Rounding to steps of 2^-12 is all that is between them.
                assert!((f64::from(found[(index, axis)]) - wanted).abs() < 2e-3, "{index}: {wanted}");
            }
        }
        assert!(largest > 0.02, "{largest}");
    }

    /// A unit that adds nothing goes first, and what is left is the network without it.
    #[test]
    fn the_least_unit_is_left_out() {
        let (samples, basis, mut learner) = beginner(7);
        let batch = batch(&samples, &basis);
        learner.output.weights.row_mut(4).fill(0.0);
        let before = learner.correct(&batch);
        learner.leave_out(6);
        assert_eq!(learner.added.len(), 6);
        let found = learner.correct(&batch) - before;
        assert!(found.amax() < 1e-6, "{}", found.amax());
        let correction = learner.correction(&basis, HALF_WINDOW);
        assert_eq!([correction.hidden.len(), correction.output[0].len(), correction.output[1].len()], [6; 3]);
        // Spare units are there at the beginning, and none from half of the steps on.
        let settings = Settings { spare: 10, steps: 1000, ..Settings::default() };
        assert_eq!([1, 100, 301, 501, 1000].map(|step| spare_left(&settings, step)), [10, 10, 5, 0, 0]);
    }

    /// Rounding must not take a unit's sum to a full power of two, where the hardware drops a bit more of all units.
    #[test]
    fn sums_of_weights_stay_below_a_power_of_two() {
        // The second one, sixteen weights of all but four, rounds to a sum of 64.
        let mut hidden = DMatrix::from_row_slice(2, 16, &[[1.0; 16], [3.9999; 16]].concat());
        let mut output = DMatrix::from_element(2, 2, 1.0);
        scaled_alike(&mut hidden, &mut output);
        let sums: Vec<i32> = quantised(&hidden).iter().map(|unit| unit.iter().sum()).collect();
        assert_eq!(sums, [32 << WEIGHT_FRACTION; 2]);
        // What the unit gains its output loses.
        let gains = [output[(0, 0)], output[(1, 0)]].map(|gain| format!("{gain}"));
        assert_eq!(gains, ["0.5", "2"]);
    }

    /// The slopes are those of the softened squared error, by finite differences.
    #[test]
    fn a_step_goes_downhill() {
        const BY: f32 = 2e-3;
        let (samples, basis, mut learner) = beginner(5);
        let batch = batch(&samples, &basis);
        let wanted = DMatrix::from_fn(BATCH, 2, |sample, axis| 0.1 * ((sample + axis) % 5) as f32 - 0.2);
        // A step of length 0 leaves the weights and keeps a tenth of the slopes; layer 4 is the output.
        learner.descend(&batch, &wanted, (0.0, 1));
        for (layer, at) in [(0, (0, 0)), (0, (4, 3)), (1, (2, 1)), (2, (3, 2)), (3, (1, 0)), (4, (0, 0)), (4, (3, 1))] {
            let mut loss = |by: f32| {
                let weight = |learner: &mut Learner| match layer {
                    4 => learner.output.weights[at] += by,
                    component => learner.hidden[component].weights[at] += by,
                };
                weight(&mut learner);
                let errors = learner.correct(&batch) - &wanted;
                let soft = |error: f32| SOFT * SOFT * ((1.0 + error / (SOFT * SOFT)).sqrt() - 1.0);
                errors.row_iter().map(|error| f64::from(soft(error.norm_squared()))).sum::<f64>() / BATCH as f64
            };
            let difference = (loss(BY) - loss(-2.0 * BY)) / f64::from(2.0 * BY);
            loss(BY);
            let of = if layer == 4 { &learner.output } else { &learner.hidden[layer] };
            let slope = 10.0 * f64::from(of.mean[at]);
            assert!((slope - difference).abs() < 0.05 * slope.abs() + 5e-6, "{layer} {at:?}: {slope} {difference}");
        }
    }
}
