//! Grids and frames: drawn, at random, and such as are hard to tell apart.

use golden::sensor::Sensor;
use hdl_gen::blocks::regions::WEIGHT_BITS;
use hdl_gen::blocks::regions::{WEIGHT_LATENCY, counted, parted, steps};
use hdl_gen::model::contacts::regions::{Found, find};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

const MOST: i64 = (1 << WEIGHT_BITS) - 1;

/// A grid, how many bodies have a region, how late weights come, and the weights of each frame.
pub struct Case {
    pub sensor: Sensor,
    pub contacts: usize,
    /// Cycles from the address of a weight to the weight.
    pub latency: u64,
    pub frames: Vec<Vec<i64>>,
}

impl Case {
    pub fn new([columns, rows]: [usize; 2], pitch_mm: [f64; 2], contacts: usize) -> Self {
        let sensor = Sensor { columns, rows, pitch_mm, depth_mm: 2.0 };
        Self { sensor, contacts, latency: WEIGHT_LATENCY, frames: Vec::new() }
    }

    pub fn name(&self) -> String {
        let Sensor { columns, rows, pitch_mm: [x, y], .. } = self.sensor;
        format!("of_{columns}x{rows}_{}_{}_by_{}_behind_{}", x * 100.0, y * 100.0, self.contacts, self.latency)
    }

    pub fn taxel_width(&self) -> u32 {
        self.sensor.taxels().next_power_of_two().ilog2().max(3)
    }

    /// More than all its frames take.
    pub fn cycles(&self) -> usize {
        let frame = counted(&self.sensor, self.latency) + parted(&self.sensor, self.contacts);
        self.frames.len() * (2 * frame as usize + self.sensor.taxels() + 20)
    }

    pub fn expected(&self, frame: &[i64]) -> Found {
        find(frame, self.sensor.columns, steps(&self.sensor), self.contacts)
    }

    /// Adds a frame whose taxels of `touched` have `weight`, and the others what does not touch, so long as any does.
    pub fn touch(
        &mut self,
        touched: impl Fn(usize, usize) -> bool,
        weight: &mut dyn FnMut() -> i64,
        faint: &mut ChaCha8Rng,
    ) {
        let columns = self.sensor.columns;
        let mut frame: Vec<i64> = (0..self.sensor.taxels())
            .map(|taxel| if touched(taxel % columns, taxel / columns) { weight() } else { -1 })
            .collect();
        let most = 5 * frame.iter().max().copied().unwrap_or(0).max(0) / 64;
        frame.iter_mut().filter(|weight| **weight < 0).for_each(|weight| *weight = faint.random_range(0..=most));
        self.frames.push(frame);
    }
}

/// A path that winds inwards: its own neighbour nowhere but along itself.
fn spiral(columns: usize, rows: usize) -> Vec<bool> {
    let mut on = vec![false; columns * rows];
    let at = |x: i64, y: i64| {
        (x >= 0 && y >= 0 && x < columns as i64 && y < rows as i64).then(|| y as usize * columns + x as usize)
    };
    let [mut x, mut y, mut dx, mut dy] = [0_i64, 0, 1, 0];
    on[0] = true;
    let mut turns = 0;
    while turns < 2 {
        let is_free = |x: i64, y: i64, on: &[bool]| {
            at(x, y).is_some_and(|at| !on[at]) && at(x + dx, y + dy).is_none_or(|next| !on[next])
        };
        if is_free(x + dx, y + dy, &on) {
            (x, y, turns) = (x + dx, y + dy, 0);
            on[at(x, y).expect("inside")] = true;
        } else {
            (dx, dy, turns) = (-dy, dx, turns + 1);
        }
    }
    on
}

/// Drawings on any grid with equal weights and with any; then some hundred taxels at random, of few and of many weights.
pub fn fill(case: &mut Case, taxels: usize, random: &mut ChaCha8Rng) {
    let Sensor { columns, rows, .. } = case.sensor;
    let winds = spiral(columns, rows);
    let (right, bottom) = (columns - 1, rows - 1);
    let shapes: [&dyn Fn(usize, usize) -> bool; 18] = [
        &|_, _| false,
        &|_, _| true,
        // One taxel: the first, the last, one between.
        &|x, y| x == 0 && y == 0,
        &|x, y| x == right && y == bottom,
        &|x, y| x == columns / 2 && y == rows / 2,
        // Boards, combs with the teeth up, down and sideways, steps, columns, rings, spirals.
        &|x, y| (x + y) % 2 == 0,
        &|x, y| (x + y) % 2 == 1,
        &|x, y| x % 2 == 0 && y % 2 == 0,
        &|x, y| x % 2 == 0 || y % 5 == 4,
        &|x, y| x % 2 == 0 || y == 0,
        &|x, y| y % 2 == 0 || x == 2,
        &|x, y| (x + 2 * y) % 4 < 2 || (x / 2 + y) % 3 == 0,
        &|x, _| x % 3 == 0,
        &|x, y| x.max(y) % 4 < 2 && x % 7 != 3,
        &|x, y| winds[y * columns + x],
        &|x, y| winds[(bottom - y) * columns + right - x],
        // Corners; two rows as far from one another as can be.
        &|x, y| (x == 0 || x == right) && (y == 0 || y == bottom),
        &|_, y| y == 0 || y == bottom,
    ];
    let mut faint = ChaCha8Rng::seed_from_u64(random.random());
    for shape in shapes {
        case.touch(shape, &mut || MOST, &mut faint);
        case.touch(shape, &mut || 1, &mut faint);
        case.touch(shape, &mut || random.random_range(MOST / 12..=MOST), &mut faint);
    }
    for number in 0..taxels.div_ceil(columns * rows) {
        let density: f64 = if random.random_bool(0.5) { random.random_range(0.0..0.15) } else { random.random() };
        let touched: Vec<bool> = (0..columns * rows).map(|_| random.random_bool(density)).collect();
        let touched = |x: usize, y: usize| touched[y * columns + x];
        match number % 5 {
            // Ties, limits met exactly, what it may be.
            0 => case.touch(touched, &mut || MOST, &mut faint),
            1 => case.touch(touched, &mut || random.random_range(1..=3), &mut faint),
            2 => case.touch(touched, &mut || [5, 6, 59, 64][random.random_range(0..4)], &mut faint),
            3 => case.touch(touched, &mut || random.random_range(0..=MOST), &mut faint),
            // As many as can all be bodies, and one more.
            _ => {
                let mut points: Vec<usize> =
                    (0..columns * rows).filter(|at| at % columns % 2 == 0 && at / columns % 2 == 0).collect();
                points.shuffle(random);
                points.truncate(1 + number / 5 % 13);
                let least = MOST - MOST / (2 << (number / 5 % 4));
                let mut weight = |taxel: usize| {
                    if points.contains(&taxel) { random.random_range(least..=MOST) } else { 0 }
                };
                case.frames.push((0..columns * rows).map(&mut weight).collect());
            }
        }
    }
    case.frames.push(vec![0; columns * rows]);
    case.frames.push((0..columns * rows).map(|_| random.random_range(0..=MOST)).collect());
}
