//! Frames with known forces, of either training set, and what they say of the gain.

use rand::Rng;

use super::general::{self, UnitContact};
use super::observer::{Observer, Sample};
use super::{CalibrateError, Settings, random_contacts};
use crate::design::Tension;
use crate::estimators::joint::TrainingSet;
use crate::numbers::middle;
use crate::scene::{Contact, Medium, Shape, stream, unit_responses};

/// Poisson's ratio of the layers, from and to: rubber, give or take.
const POISSON: [f64; 2] = [0.45, 0.49];
/// The same for a sensor that reads no tension. There a layer of another ratio looks like another friction, and what was
/// trained on all of them errs by 3 % at either end; so the layers are near what the documentation asks for, 0.49.
const POISSON_CLIPPED: [f64; 2] = [0.48, 0.495];
/// Layers of different Poisson's ratio.
const LAYERS: usize = 5;

/// One sample in this many has a second contact, pushed the same way: what the correction makes of one contact must not
/// do harm where there are two.
const PAIRED: usize = 5;

/// One round Hertz contact in this many has another pressure: a network that knows two profiles
/// alone errs on a third.
const RESHAPED: usize = 2;
/// That pressure's share of the way from Hertz's to an even one; at 2 most of the force is at the edge.
const PROFILES: [f64; 2] = [0.0, 2.0];
/// The same where it may be nothing in the middle: three times the mean at the edge, where a punch's has no end.
const HOLLOW: f64 = 3.0;

/// Makes the frames of a training set and estimates them; frames without an answer are left out.
pub(super) fn make(
    observer: &mut Observer<'_>,
    settings: &Settings,
    tick: &mut dyn FnMut(),
) -> Result<Vec<Sample>, CalibrateError> {
    match observer.training_set() {
        TrainingSet::Sliding => sliding(observer, settings, tick),
        TrainingSet::General => general(observer, settings, tick),
    }
}

fn sliding(
    observer: &mut Observer<'_>,
    settings: &Settings,
    tick: &mut dyn FnMut(),
) -> Result<Vec<Sample>, CalibrateError> {
    let sensor = observer.sensor();
    let [least, most] = match observer.tension() {
        Tension::Read => POISSON,
        Tension::Clipped => POISSON_CLIPPED,
    };
    // The contacts use stream 0 of the same seed.
    let mut random = stream(settings.seed, 1);
    let mut responses = Vec::with_capacity(settings.contacts);
    for (index, contact) in random_contacts(sensor, settings.seed, settings.contacts).iter().enumerate() {
        let share = (index / 8 % LAYERS) as f64 / (LAYERS - 1) as f64;
        let medium = Medium::BondedLayer { poisson: least + share * (most - least) };
        let mut response = unit_responses(sensor, medium, contact)?;
        if let Some(even) = even_pressure(contact)
            && random.random_range(0..RESHAPED) == 0
        {
            let even = unit_responses(sensor, medium, &even)?;
            let most = if settings.hollow { HOLLOW } else { PROFILES[1] };
            let share = random.random_range(PROFILES[0]..most);
            for (stress, even) in response.iter_mut().flatten().zip(even.iter().flatten()) {
                *stress += share * (even - *stress);
            }
        }
        responses.push(response);
        tick();
    }
    let mut samples = Vec::with_capacity(settings.samples);
    for index in 0..settings.samples {
        tick();
        let Some(one) = responses.get(index % responses.len().max(1)) else { break };
        let other = &responses[random.random_range(0..responses.len())];
        let share = if random.random_range(0..PAIRED) == 0 { random.random_range(0.2..0.8) } else { 0.0 };
        let friction = random.random::<f64>();
        let (sin, cos) = (std::f64::consts::TAU * random.random::<f64>()).sin_cos();
        let [x, y] = [friction * cos, friction * sin];
        let load = |kind: usize, taxel: usize| (1.0 - share) * one[kind][taxel] + share * other[kind][taxel];
        let frame: Vec<f64> =
            (0..one[0].len()).map(|taxel| load(0, taxel) + x * load(1, taxel) + y * load(2, taxel)).collect();
        let noise = observer.noise(&mut random);
        samples.extend(observer.sample(frame, [x, y, -1.0], noise, &mut random)?);
    }
    Ok(samples)
}

fn general(
    observer: &mut Observer<'_>,
    settings: &Settings,
    tick: &mut dyn FnMut(),
) -> Result<Vec<Sample>, CalibrateError> {
    let mut random = stream(settings.seed, 0);
    let contacts: Vec<UnitContact> = (0..settings.contacts)
        .map(|_| {
            tick();
            UnitContact::random(observer.sensor(), &mut random)
        })
        .collect();
    let mut random = stream(settings.seed, 1);
    let mut samples = Vec::with_capacity(settings.samples);
    for index in 0..settings.samples {
        tick();
        samples.extend(general::sample(&contacts, index, observer, &mut random)?);
    }
    Ok(samples)
}

/// A round contact with Hertz's pressure, with an even one in its place; nothing for any other.
fn even_pressure(contact: &Contact) -> Option<Contact> {
    match contact.shape {
        Shape::Hertz { semi_axes_m: [radius_m, other] } if radius_m.to_bits() == other.to_bits() => {
            Some(Contact { shape: Shape::Disc { radius_m }, ..contact.clone() })
        }
        _ => None,
    }
}

/// The gain, and the friction components that make the tangential resultant of each sample right with it.
///
/// The gain is the median of true over estimated normal force: contacts at the border of the grid, which lose force
/// beyond it, do not drag it along.
pub(super) fn gain_and_targets(samples: &[Sample]) -> (f64, Vec<[f64; 2]>) {
    let mut targets: Vec<[f64; 2]> = samples.iter().map(|sample| sample.mu).collect();
    let mut gain = 1.0;
    // F_z depends on the friction a little, and the friction wanted on the gain.
    for _ in 0..4 {
        gain = middle(samples.iter().zip(&targets).map(|(sample, [x, y])| {
            let [g0, g1, g2] = sample.sums[2];
            sample.force[2] / (g0 + x * g1 + y * g2)
        }));
        targets = samples.iter().map(|sample| target(sample, gain)).collect();
    }
    (gain, targets)
}

/// Solves the two equations of the tangential resultant for the friction components.
pub(super) fn target(sample: &Sample, gain: f64) -> [f64; 2] {
    let [[x0, a, b], [y0, c, d], ..] = sample.sums;
    let [x, y] = [sample.force[0] / gain - x0, sample.force[1] / gain - y0];
    let determinant = a * d - b * c;
    let found = [(d * x - b * y) / determinant, (a * y - c * x) / determinant];
    // Without weights nothing answers to friction; such a frame teaches nothing.
    if found.iter().all(|mu| mu.abs() < 2.0) { found } else { sample.mu }
}
