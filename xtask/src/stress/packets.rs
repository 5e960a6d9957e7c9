//! Packets of every kind that a source can send, good and bad.

use golden::design::Samples;
use hdl_gen::model::{BAD_LENGTH, Model, NO_CONTACT, NOT_FINITE};
use hdl_gen::plan::Plan;
use hdl_gen::plan::words::FORCE;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Attempts at a balanced frame, one in four of which succeeds, and steps of each.
const BALANCE_TRIALS: usize = 16;
const BALANCE_STEPS: usize = 24;
/// Frames of a rest at most, and from one's begin to the next one's on average.
const REST_FRAMES: usize = 24;
const REST_EVERY: usize = 60;

/// What is wrong with a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing.
    Good,
    /// TLAST too early.
    Short,
    /// TLAST too late.
    Long,
    /// A NaN or an infinity among the taxels.
    NotFinite,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Good, Self::Short, Self::Long, Self::NotFinite];

    /// The status bit that says so, known without asking the model.
    pub fn status(self) -> u32 {
        match self {
            Self::Good => 0,
            Self::Short | Self::Long => BAD_LENGTH,
            Self::NotFinite => NOT_FINITE,
        }
    }
}

/// A number for each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Nothing wrong.
    pub good: u64,
    /// TLAST too early.
    pub short: u64,
    /// TLAST too late.
    pub long: u64,
    /// NaN or infinity.
    pub not_finite: u64,
}

impl Counts {
    /// One more of a kind.
    pub fn add(&mut self, kind: Kind) {
        *match kind {
            Kind::Good => &mut self.good,
            Kind::Short => &mut self.short,
            Kind::Long => &mut self.long,
            Kind::NotFinite => &mut self.not_finite,
        } += 1;
    }

    /// Of all kinds together.
    pub fn total(&self) -> u64 {
        self.good + self.short + self.long + self.not_finite
    }

    /// Kind by kind.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            good: self.good + other.good,
            short: self.short + other.short,
            long: self.long + other.long,
            not_finite: self.not_finite + other.not_finite,
        }
    }
}

/// Packets of a plan at random.
pub struct Packets<'a> {
    plan: &'a Plan,
    /// See [`balanced`].
    balanced: Vec<Vec<u32>>,
}

impl<'a> Packets<'a> {
    /// Looks for the packets that chance alone never makes.
    pub fn new(plan: &'a Plan, random: &mut ChaCha8Rng) -> Self {
        Self { plan, balanced: balanced(plan, random) }
    }

    /// The next packet: in six of ten cases a good one.
    pub fn next(&self, random: &mut ChaCha8Rng) -> (Kind, Vec<u32>) {
        let rare = !self.balanced.is_empty() && random.random_range(0..50) == 0;
        if rare {
            return (Kind::Good, self.balanced[random.random_range(0..self.balanced.len())].clone());
        }
        packet(self.plan, random)
    }
}

/// Puts the sensor to rest here and there, under a load that does not move: what a tare wants. About a fifth of the
/// packets become such frames.
pub fn with_rests(plan: &Plan, packets: &mut [(Kind, Vec<u32>)], random: &mut ChaCha8Rng) {
    let most = plan.design.hardware.full_scale_pa / 50.0;
    let noise = plan.design.algorithm.noise_floor_pa;
    let mut first = random.random_range(0..2 * REST_EVERY);
    while first < packets.len() {
        let level: Vec<f64> = (0..plan.taxels()).map(|_| random.random_range(-most..most)).collect();
        for packet in packets.iter_mut().skip(first).take(random.random_range(1..=REST_FRAMES)) {
            let pascals: Vec<f64> = level.iter().map(|level| level + noise * random.random_range(-1.0..1.0)).collect();
            *packet = (Kind::Good, in_words(plan, &pascals));
        }
        first += random.random_range(1..2 * REST_EVERY);
    }
}

/// A packet that chance makes.
pub fn packet(plan: &Plan, random: &mut ChaCha8Rng) -> (Kind, Vec<u32>) {
    let mut words = good(plan, random);
    let (taxels, streams) = (words.len(), plan.streams());
    match random.random_range(0..10) {
        // Of a frame of one beat none is too short.
        0 if streams.beats_in() > 1 => {
            words.truncate(random.random_range(1..=(streams.beats_in() - 1) * streams.words()));
            (Kind::Short, words)
        }
        0 | 1 => {
            let length = random.random_range(streams.whole_beats(words.len()) + 1..=3 * words.len());
            while words.len() < length {
                words.push(random.random());
            }
            (Kind::Long, words)
        }
        2 | 3 if streams.sample == Samples::Float32 => {
            words[random.random_range(0..taxels)] = not_finite(random);
            (Kind::NotFinite, words)
        }
        _ => (Kind::Good, words),
    }
}

fn not_finite(random: &mut ChaCha8Rng) -> u32 {
    let fraction = if random.random_bool(0.3) { 0 } else { random.random_range(0..1 << 23) };
    u32::from(random.random_bool(0.5)) << 31 | 0xFF << 23 | fraction
}

/// Faint frames whose resultant is exactly zero along z and not across, if there are some to be found: a taxel against
/// all others, none of which alone is more than noise, so that the direction is unknown and the forces are plain sums.
/// The one is bisected, by the model, for the sums' change of sign.
pub fn balanced(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let noise = plan.design.algorithm.noise_floor_pa;
    let taxels = plan.taxels();
    let mut model = Model::new(plan);
    let mut found = Vec::new();
    for _ in 0..BALANCE_TRIALS {
        let sign = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        let one = random.random_range(0..taxels);
        let mut pascals: Vec<f64> = (0..taxels).map(|_| -sign * noise * random.random_range(0.0..0.95)).collect();
        // None of the whole answer but its status and F_x, F_y, F_z matters.
        let mut answer = |pascal: f64| {
            pascals[one] = sign * pascal;
            let packet = in_words(plan, &pascals);
            let words = model.process(&packet);
            (packet, words[0] & NO_CONTACT != 0, [0, 1, 2].map(|axis| f32::from_bits(words[FORCE + axis])))
        };
        let (mut low, mut high) = (0.0, 3.0 * taxels as f64 * noise);
        let (_, _, [_, _, beyond]) = answer(high);
        for _ in 0..BALANCE_STEPS {
            let middle = f64::midpoint(low, high);
            let (packet, nothing, [x, y, z]) = answer(middle);
            if !nothing && z == 0.0 && (x != 0.0 || y != 0.0) {
                found.push(packet);
                break;
            }
            *(if nothing || z * beyond <= 0.0 { &mut low } else { &mut high }) = middle;
        }
    }
    found
}

/// A frame without a fault: a contact, noise, silence, single taxels, the ends of the range, any finite float at all, and what
/// pulls everywhere, so that nothing limits the friction.
fn good(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<u32> {
    let sensor = &plan.design.sensor;
    let full_scale = plan.design.hardware.full_scale_pa;
    let taxels = sensor.taxels();
    let peak = full_scale * 10_f64.powf(random.random_range(-4.0..0.1));
    let pascals: Vec<f64> = match random.random_range(0..11) {
        0 => vec![0.0; taxels],
        1 => (0..taxels).map(|_| random.random_range(-peak..=peak)).collect(),
        2 => (0..taxels).map(|_| if random.random_bool(0.5) { full_scale } else { -full_scale }).collect(),
        3 => {
            let mut stress = vec![0.0; taxels];
            stress[random.random_range(0..taxels)] = -peak;
            stress
        }
        4 => {
            let finite = |word: u32| if word >> 23 & 0xFF == 0xFF { word & !(1 << 30) } else { word };
            // Integers are what they are.
            return (0..plan.streams().words_in()).map(|_| finite(random.random())).collect();
        }
        5 => (0..taxels).map(|_| peak * random.random_range(0.95..1.0)).collect(),
        _ => {
            let centre = [sensor.columns, sensor.rows].map(|side| random.random_range(0.0..side as f64));
            let push = [0, 1].map(|_| random.random_range(-1.0..1.0));
            let radius = random.random_range(0.5..0.6 * sensor.columns.max(sensor.rows) as f64);
            (0..taxels)
                .map(|taxel| {
                    let x = ((taxel % sensor.columns) as f64 - centre[0]) / radius;
                    let y = ((taxel / sensor.columns) as f64 - centre[1]) / radius;
                    -peak * (1.0 + push[0] * x + push[1] * y) * (-(x * x + y * y)).exp()
                })
                .collect()
        }
    };
    in_words(plan, &pascals)
}

fn in_words(plan: &Plan, pascals: &[f64]) -> Vec<u32> {
    let value = |(taxel, &pascal): (usize, &f64)| plan.design.input.from_pa(taxel, pascal);
    plan.streams().packet(&pascals.iter().enumerate().map(value).collect::<Vec<_>>())
}
