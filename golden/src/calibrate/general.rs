//! Contacts as they are: of any shape, tilted, held, turning, over the grid's edge, on a layer that is not quite what the
//! design says, read by taxels that are not quite alike.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::CalibrateError;
use super::contacts::radii;
use super::observer::{Observer, Sample};
use crate::design::Sensor;
use crate::scene::{COARSE, Contact, Field, Medium, Shape, Shear, Traction, normal};

/// Poisson's ratios of the layers: 0.49, up to 5 % less, and a little more. A table of stress is made for each.
const POISSON: [f64; 6] = [0.4655, 0.475, 0.48, 0.485, 0.49, 0.495];
/// Largest share by which the layer is deeper or less deep than the design says.
const DEPTH: f64 = 0.05;
/// Largest standard deviation of the taxels' gains.
const GAIN_SPREAD: f64 = 0.02;
/// Largest sides of a taxel, in pitches, and the share of contacts that are read by such ones.
const TAXEL: f64 = 0.8;
const AVERAGED: f64 = 0.5;
/// Largest length over width.
const RATIO: f64 = 2.2;
/// Edges of the pressure `(1 - rho^2)^n`, from and to.
const EDGES: [f64; 2] = [-0.45, 2.0];
/// Largest tilt of the pressure.
const TILT: f64 = 0.65;
/// Largest speed of turning over that of sliding.
const SPIN: f64 = 1.5;
/// Share of contacts that lie anywhere over the grid, so that part of them is beyond it; the others lie within it.
const ANYWHERE: f64 = 0.25;
/// One frame in this many has two contacts.
const PAIRED: usize = 12;

/// A contact that presses with 1 N.
pub(super) struct UnitContact {
    /// Stress without friction.
    normal: Vec<f64>,
    /// What a friction of 1 adds, in the direction of this contact.
    tangential: Vec<f64>,
    /// Force along x and y of a friction of 1.
    push: [f64; 2],
}

impl UnitContact {
    /// A contact at random.
    pub(super) fn random(sensor: &Sensor, random: &mut ChaCha8Rng) -> Self {
        let poisson = POISSON[random.random_range(0..POISSON.len())];
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let [smallest, largest] = radii(sensor);
        let radius = between(smallest, largest);
        let ratio = if between(0.0, 1.0) < 0.4 { 1.0 } else { RATIO.powf(between(-0.5, 0.5)) };
        let half = [radius * ratio, radius / ratio];
        let half = if ratio.to_bits() == 1.0_f64.to_bits() { half } else { half.map(|half| half.max(0.7 * smallest)) };
        let [kind, push, anywhere, averaged] = [(); 4].map(|()| between(0.0, 1.0));
        let mut shape = match kind {
            ..0.2 => Shape::Rectangle { sides_m: half.map(|half| 1.8 * half) },
            0.2..0.5 => Shape::Disc { radius_m: radius },
            _ => Shape::Hertz { semi_axes_m: half },
        };
        let mut traction = Traction { turn_deg: between(0.0, 180.0), ..Traction::default() };
        let [tilt, angle] = [TILT * between(0.0, 1.0).sqrt(), between(0.0, std::f64::consts::TAU)];
        let tilted = between(0.0, 1.0) < 0.7;
        // What sticks is known in closed form under Hertz's pressure only.
        let held = push < 0.25;
        if held {
            shape = Shape::Hertz { semi_axes_m: half };
        } else {
            let edge = between(EDGES[0], EDGES[1]);
            traction.edge = (between(0.0, 1.0) < 0.6).then_some(edge);
            // The sum of both is at most 1, whatever the direction.
            traction.tilt = if tilted { [tilt * angle.cos(), tilt * angle.sin()] } else { [0.0; 2] };
        }
        traction.shear = match push {
            ..0.25 => Shear::Held { share: between(0.1, 1.0) },
            0.25..0.4 => Shear::Even,
            0.4..0.55 => Shear::Sliding { spin: between(-SPIN, SPIN) },
            _ => Shear::Sliding { spin: 0.0 },
        };
        let sides = sensor.extent_m();
        let centre_m = [0, 1].map(|axis| {
            let side = sides[axis];
            let margin = if anywhere < ANYWHERE { 0.0 } else { radius.min(0.4 * side) };
            between(margin, side - margin)
        });
        let direction_deg = between(-180.0, 180.0);
        let contact = Contact { shape, centre_m, normal_force_n: 1.0, friction: 1.0, traction, direction_deg };
        let deeper = between(1.0 - DEPTH, 1.0 + DEPTH);
        let sides = TAXEL * between(0.0, 1.0);
        let taxel_m = (averaged < AVERAGED).then(|| sensor.pitch_mm.map(|pitch| sides * 1e-3 * pitch));
        let built = Sensor { depth_mm: deeper * sensor.depth_mm, ..sensor.clone() };
        let ([normal, tangential], push) =
            Field::new(&built, Medium::BondedLayer { poisson }, taxel_m, COARSE).parts(&contact);
        Self { normal, tangential, push }
    }
}

/// What a contact, or two, give at random; nothing if that has no answer.
pub(super) fn sample(
    contacts: &[UnitContact],
    index: usize,
    observer: &mut Observer<'_>,
    random: &mut ChaCha8Rng,
) -> Result<Option<Sample>, CalibrateError> {
    let one = &contacts[index % contacts.len()];
    let other = &contacts[random.random_range(0..contacts.len())];
    let share = if random.random_range(0..PAIRED) == 0 { random.random_range(0.2..0.8) } else { 0.0 };
    let friction = random.random::<f64>();
    let parts = [(one, 1.0 - share, friction), (other, share, friction * random.random_range(0.5..1.0))];
    let (mut frame, mut force) = (vec![0.0; one.normal.len()], [0.0, 0.0, -1.0]);
    for (contact, share, friction) in parts {
        let stresses = contact.normal.iter().zip(&contact.tangential);
        for (sum, (normal, tangential)) in frame.iter_mut().zip(stresses) {
            *sum += share * (normal + friction * tangential);
        }
        force.iter_mut().zip(contact.push).for_each(|(sum, push)| *sum += share * friction * push);
    }
    let spread = GAIN_SPREAD * random.random::<f64>();
    for stress in &mut frame {
        *stress *= 1.0 + spread * normal(random);
    }
    let noise = observer.noise(random);
    observer.sample(frame, force, noise, random)
}
