//! The formulas of the records in f64, and how near the hardware's model is to them.

use hdl_gen::model::contacts::records::{Counted, Records};
use hdl_gen::plan::contacts::records::{Constants, FRAME};
use hdl_gen::plan::words;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::design;

/// Bits of a status that a body can have, and three more bits: doubtful, saturated, more bodies than records.
const BODY_BITS: u32 = 0x0446;
const DOUBTFUL: u32 = 1 << 6;
const SATURATED: u32 = 1 << 3;
const MORE_BODIES: u32 = 1 << 7;

/// A header of floats and a status.
pub fn header(status: u32, values: [f64; 11]) -> [u32; 16] {
    let mut words = [0; 16];
    words[0] = status;
    words[2..13].iter_mut().zip(values).for_each(|(word, value)| *word = (value as f32).to_bits());
    words
}

/// The headers of a frame's answers.
#[derive(Clone, Debug)]
pub struct Headers {
    pub frame: [u32; 16],
    pub last: Vec<[u32; 16]>,
    pub before: Vec<[u32; 16]>,
}

impl Headers {
    /// Such as a core gives: bodies within a grid of that size in metres, a few newtons, most of which press.
    pub fn likely(kept: usize, [width, height]: [f64; 2], random: &mut ChaCha8Rng) -> Self {
        let answer = |random: &mut ChaCha8Rng| {
            let normal = -random.random_range(0.05..5.0_f64) * if random.random_bool(0.1) { -1.0 } else { 1.0 };
            let mu = random.random_range(0.0..1.0_f64);
            let phi = random.random_range(-3.1..3.1_f64);
            let (force_x, force_y) = (mu * normal.abs() * phi.cos(), mu * normal.abs() * phi.sin());
            let (x, y) = (random.random_range(-0.5..0.5) * width, random.random_range(-0.5..0.5) * height);
            let torque = [y * normal, -x * normal, x * force_y - y * force_x];
            let [about_x, about_y, about_z] = torque;
            let error = if random.random_bool(0.2) { 0.0 } else { random.random_range(0.0..0.2) * normal.abs() };
            let (mu_x, mu_y) = (mu * phi.cos(), mu * phi.sin());
            let values = [force_x, force_y, normal, about_x, about_y, about_z, mu, phi, mu_x, mu_y, error];
            let mut header = header(random.random(), values);
            (header[1], header[13]) = (random.random(), random.random());
            header
        };
        let last: Vec<_> = (0..kept).map(|_| answer(random)).collect();
        let before = last.iter().map(|last| {
            let mut before = answer(random);
            for word in [2, 3] {
                let force = f32::from_bits(last[word]) + random.random_range(-0.1..0.1_f32);
                before[word] = force.to_bits();
            }
            before
        });
        let before = before.collect();
        Self { frame: answer(random), last, before }
    }

    /// The same friction at other places: each body presses where the one of these headers does, and as much.
    pub fn move_to(&mut self, places: &[[u32; 16]]) {
        self.last.iter_mut().zip(places).for_each(|(header, place)| header[4..=6].copy_from_slice(&place[4..=6]));
    }

    /// The same bodies with this friction.
    pub fn rub(&mut self, mu: f32) {
        self.last.iter_mut().for_each(|header| header[words::MU] = mu.to_bits());
    }

    /// What the hardware makes of them.
    pub fn answer(&self, model: &mut Records, counted: Counted) -> Vec<u32> {
        model.take(FRAME, false, &self.frame);
        self.last.iter().enumerate().for_each(|(body, header)| model.take(body as u8, false, header));
        self.before.iter().enumerate().for_each(|(body, header)| model.take(body as u8, true, header));
        model.finish(counted)
    }
}

/// A number, and how large what it is made of is: its error is over that.
#[derive(Clone, Copy, Debug)]
pub struct Value {
    pub exact: f64,
    pub size: f64,
}

impl Value {
    fn new(exact: f64, size: f64) -> Self {
        Self { exact, size: size.max(exact.abs()) }
    }
}

/// A body's record: its number among the headers, its status, and its seven floats.
#[derive(Clone, Debug)]
pub struct Record {
    pub body: usize,
    pub status: u32,
    /// Whether it is nearly doubtful, or nearly not.
    pub unsure: bool,
    pub values: [Value; 7],
}

/// The frame's floats from word 2 on, and the records.
#[derive(Clone, Debug)]
pub struct Exact {
    pub status: u32,
    pub frame: [Value; 11],
    pub records: Vec<Record>,
}

fn value(bits: u32) -> f64 {
    f64::from(f32::from_bits(bits))
}

/// Of several bodies, as the solver makes them; `middle` and `reach` in metres.
pub fn exact(headers: &Headers, middle: [f64; 2], reach: f64, limit: f64, more: bool) -> Exact {
    let bodies: Vec<[f64; 16]> = headers.last.iter().map(|header| header.map(value)).collect();
    let over = |a: f64, b: f64| if b == 0.0 { 0.0 } else { a / b };
    let centres: Vec<[f64; 2]> =
        bodies.iter().map(|body| [middle[0] - over(body[6], body[4]), middle[1] + over(body[5], body[4])]).collect();
    // How far the parts of a centre reach.
    let farthest: Vec<[f64; 2]> = bodies
        .iter()
        .map(|body| [middle[0] + over(body[6], body[4]).abs(), middle[1] + over(body[5], body[4]).abs()])
        .collect();
    let mut records: Vec<Record> = (0..bodies.len())
        .map(|k| {
            let [own, header] = [bodies[k], bodies[k]];
            let before = headers.before[k].map(value);
            let changed = (own[2] - before[2]).hypot(own[3] - before[3]);
            let others = (0..bodies.len()).filter(|&other| other != k);
            let felt = others.map(|other| {
                let [x, y] = [0, 1].map(|axis| centres[other][axis] - centres[k][axis]);
                let near = (x * x + y * y) / (reach * reach);
                // A centre's error moves it.
                let moved = farthest[other].iter().chain(&farthest[k]).sum::<f64>() / reach;
                let felt = bodies[other][4].abs() / (1.0 + near * near);
                [felt, felt * (1.0 + moved)]
            });
            let [felt, felt_size] = felt.fold([0.0; 2], |all, felt| [all[0] + felt[0], all[1] + felt[1]]);
            let sigma = header[12];
            let all = sigma.hypot(1.25 * changed).hypot(felt);
            let error = if sigma > 0.0 { all } else { 0.0 };
            let doubtful = error > limit * own[4].abs();
            let plain = |exact: f64| Value::new(exact, 0.0);
            let [x, y] = [0, 1].map(|axis| Value::new(centres[k][axis], farthest[k][axis]));
            let error = Value::new(error, sigma + 1.25 * changed + felt_size);
            Record {
                body: k,
                status: headers.last[k][0] & BODY_BITS | if doubtful { DOUBTFUL } else { 0 },
                unsure: (all - limit * own[4].abs()).abs() < 1e-4 * error.size,
                values: [x, y, plain(own[2]), plain(own[3]), plain(own[4]), plain(own[8]), error],
            }
        })
        .collect();
    let sums: [Value; 6] = std::array::from_fn(|word| {
        let parts = || bodies.iter().map(move |body| body[2 + word]);
        Value::new(parts().sum(), parts().map(f64::abs).sum())
    });
    let [x, y, z, ..] = sums.map(|sum| sum.exact);
    let length = x.hypot(y);
    let normal = |part: f64, size: f64| {
        Value::new(over(part, z.abs()), over(size, z.abs()) * (1.0 + over(sums[2].size, z.abs())))
    };
    let tangential = sums[0].size + sums[1].size;
    let errors = records.iter().fold([0.0_f64; 2], |all, record| {
        let [Value { exact, size }] = [record.values[6]];
        [all[0].hypot(exact), all[1].hypot(size)]
    });
    let rest = [
        normal(length, tangential),
        Value::new(y.atan2(x), 4.0 + over(tangential, length)),
        normal(x, sums[0].size),
        normal(y, sums[1].size),
        Value::new(errors[0], errors[1]),
    ];
    let status = headers.last.iter().fold(headers.frame[0] & !BODY_BITS, |all, header| all | header[0] & SATURATED);
    let status = records.iter().fold(status, |all, record| all | record.status) | if more { MORE_BODIES } else { 0 };
    records.sort_by(|a, b| b.values[4].exact.abs().total_cmp(&a.values[4].exact.abs()));
    let frame = std::array::from_fn(|word| if word < 6 { sums[word] } else { rest[word - 6] });
    Exact { status, frame, records }
}

/// The worst errors of the frame's floats and of a record's, over their sizes, so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    pub frame: [f64; 11],
    pub record: [f64; 7],
}

impl Exact {
    /// Asserts that what is not a float is the same, and notes how far the floats are from these.
    pub fn compare(&self, found: &[u32], taxels: &[u16], worst: &mut Worst) {
        let unsure = self.records.iter().any(|record| record.unsure);
        assert!(unsure || found[0] == self.status, "{:x}, not {:x}", found[0], self.status);
        let note = |worst: &mut f64, found: u32, Value { exact, size }: Value| {
            *worst = worst.max(if size == 0.0 { value(found).abs() } else { (value(found) - exact).abs() / size });
        };
        for (word, &value) in self.frame.iter().enumerate() {
            note(&mut worst.frame[word], found[2 + word], value);
        }
        for (record, found) in self.records.iter().zip(found[words::SUMMARY_WORDS..].chunks(8)) {
            assert_eq!(found[0] as u16, taxels[record.body], "{self:?}");
            assert!(record.unsure || found[0] >> 16 == record.status, "{self:?}");
            for (word, &value) in record.values.iter().enumerate() {
                note(&mut worst.record[word], found[1 + word], value);
            }
        }
    }
}

/// Likely headers: each float within a few steps of 24 bits of the largest part that it is made of.
#[test]
fn the_model_is_as_near_as_float32_is() {
    let mut random = ChaCha8Rng::seed_from_u64(31);
    let mut worst = Worst::default();
    for contacts in [2, 4, 8] {
        let design = design("sensor1-wide", contacts);
        let constants = Constants::of(&design);
        let mut model = Records::new(contacts, &constants);
        let last = design.sensor.position_m(design.sensor.taxels() - 1);
        let reach = 2e-3 * design.sensor.pitch_mm[0].max(design.sensor.pitch_mm[1]);
        for _ in 0..20_000 {
            let kept = random.random_range(2..=contacts);
            let headers = Headers::likely(kept, last, &mut random);
            let taxels: Vec<u16> = (0..contacts).map(|_| random.random()).collect();
            let bodies = random.random();
            let found = headers.answer(&mut model, Counted { kept, bodies, taxels: &taxels, saturated: false });
            assert_eq!([found[1], found[13]], [headers.frame[1], headers.frame[13] & !0xFF | u32::from(bodies)]);
            let more = usize::from(bodies) > contacts;
            let exact = exact(&headers, last.map(|last| 0.5 * last), reach, design.algorithm.joint.doubt, more);
            exact.compare(&found, &taxels, &mut worst);
        }
    }
    let steps = |errors: &[f64]| errors.iter().map(|error| error * 2.0_f64.powi(24)).collect::<Vec<_>>();
    println!("worst errors in steps of 2^-24: frame {:.2?}, records {:.2?}", steps(&worst.frame), steps(&worst.record));
    let all: Vec<f64> = worst.frame.into_iter().chain(worst.record).collect();
    assert!(all.iter().all(|&error| error < 12.0 * 2.0_f64.powi(-24)), "{worst:?}");
}
