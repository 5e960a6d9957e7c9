//! Runs of the cores that take one operation at a time: ratio and CORDIC.

use hdl_gen::cores::cordic;
use hdl_gen::cores::ratio::{divide, latency};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bench::Run;

/// Plays operations one after the other, with starts and other operands in between that must not matter.
struct Player<R, const N: usize> {
    run: Run,
    rng: ChaCha8Rng,
    latency: u32,
    /// Whether the result stays at the port while the next operation is under way.
    keeps_result: bool,
    junk: fn(&mut ChaCha8Rng) -> [u64; N],
    /// Whether a start while one is under way begins the next, as opposed to being ignored.
    takes_any_start: bool,
    outputs: fn(Option<R>, Option<u64>) -> Vec<Option<u64>>,
    held: Option<R>,
    done: bool,
}

impl<R: Copy, const N: usize> Player<R, N> {
    fn cycle(&mut self, reset: bool, start: bool, operands: [u64; N]) {
        // Before the first edge in reset nothing is promised.
        let done = (!self.run.cycles.is_empty()).then_some(u64::from(self.done));
        let expected = (self.outputs)(self.held, done);
        let controls = [u64::from(reset), u64::from(start)];
        self.run.push(&[&controls[..], &operands[..]].concat(), &expected);
        self.done = false;
    }

    fn idle(&mut self, cycles: u32, reset: bool) {
        for _ in 0..cycles {
            let operands = (self.junk)(&mut self.rng);
            self.cycle(reset, false, operands);
        }
    }

    /// Cycles with an operation under way, with starts where they are ignored.
    fn busy(&mut self, cycles: u32) {
        for _ in 0..cycles {
            let operands = (self.junk)(&mut self.rng);
            let start = !self.takes_any_start && self.rng.random_ratio(1, 10);
            self.cycle(false, start, operands);
        }
    }

    fn operation(&mut self, operands: [u64; N], result: R) {
        let gap = [0, 0, 1, 5][self.rng.random_range(0..4)];
        self.idle(gap, false);
        if self.rng.random_ratio(1, 100) {
            // An operation given up leaves no done behind: by a reset, or by the next start where that counts.
            let other = (self.junk)(&mut self.rng);
            self.cycle(false, true, other);
            self.held = None;
            let before = self.rng.random_range(0..self.latency - 1);
            self.busy(before);
            if !self.takes_any_start || self.rng.random_bool(0.5) {
                self.idle(1, true);
                self.idle(3, false);
            }
        }
        self.cycle(false, true, operands);
        self.held = self.held.filter(|_| self.keeps_result);
        self.busy(self.latency - 1);
        (self.held, self.done) = (Some(result), true);
        self.run.results += 1;
    }
}

pub fn ratio() -> Run {
    const WIDTH: u32 = 40;
    const INTEGER_BITS: u32 = 6;
    const BITS: u32 = 22;
    let mut player = Player {
        run: Run::new(
            "sptfra_ratio",
            &[("reset", 1), ("start", 1), ("numerator_x", WIDTH), ("numerator_y", WIDTH), ("denominator", WIDTH)],
            &[("quotient_x", BITS), ("quotient_y", BITS), ("done", 1)],
        ),
        rng: ChaCha8Rng::seed_from_u64(4),
        latency: latency(BITS) as u32,
        keeps_result: false,
        takes_any_start: true,
        junk: |rng| std::array::from_fn(|_| rng.random::<u64>() >> (64 - WIDTH)),
        outputs: |result: Option<[u64; 2]>, done| {
            let of = |axis: usize| result.map(|quotients| quotients[axis] & ((1 << BITS) - 1));
            vec![of(0), of(1), done]
        },
        held: None,
        done: false,
    };
    player.idle(3, true);
    let quotients =
        |[x, y, denominator]: [u64; 3]| [x, y].map(|value| divide(value << (BITS - INTEGER_BITS), denominator));
    let largest = (1 << WIDTH) - 1;
    let corners = [0, 1, 2, 3, largest / 2, largest / 2 + 1, largest - 1, largest];
    let fits = |numerator: u64, denominator: u64| denominator == 0 || numerator >> INTEGER_BITS < denominator;
    for denominator in corners {
        for x in corners.into_iter().filter(|&value| fits(value, denominator)) {
            for y in corners.into_iter().filter(|&value| fits(value, denominator)) {
                player.operation([x, y, denominator], quotients([x, y, denominator]));
            }
        }
    }
    for _ in 0..10_000 {
        let any = |rng: &mut ChaCha8Rng| rng.random::<u64>() >> rng.random_range(64 - WIDTH..64);
        let denominator = any(&mut player.rng);
        let mut numerator = || {
            // Next to a multiple of the denominator one unit decides the last digit.
            let near = (denominator * player.rng.random_range(0..64)).saturating_sub(player.rng.random_range(0..2));
            let value = if player.rng.random_bool(0.2) { near } else { any(&mut player.rng) };
            value.min(largest).min((denominator << INTEGER_BITS).saturating_sub(1))
        };
        let operands = [numerator(), numerator(), denominator];
        player.operation(operands, quotients(operands));
    }
    player.idle(4, false);
    player.run
}

pub fn cordic() -> Run {
    let mut player = Player {
        run: Run::new(
            "sptfra_cordic",
            &[("reset", 1), ("start", 1), ("x", 32), ("y", 32)],
            &[("magnitude", 34), ("angle", 32), ("done", 1)],
        ),
        rng: ChaCha8Rng::seed_from_u64(5),
        latency: cordic::LATENCY,
        keeps_result: true,
        takes_any_start: false,
        junk: |rng| [rng.random(), rng.random()],
        outputs: |result: Option<cordic::Vector>, done| {
            vec![result.map(|vector| vector.magnitude), result.map(|vector| vector.angle as u64), done]
        },
        held: None,
        done: false,
    };
    player.idle(3, true);
    let one = 1 << 30;
    let corners = [0, 1, -1, 2, one / 2, -one / 2, one - 1, one, -one, i32::MAX, i32::MIN];
    for x in corners {
        for y in corners {
            player.operation([x as u64, y as u64], cordic::vector(x, y));
        }
    }
    for _ in 0..10_000 {
        let (widths, rng) = ([1, 1, 1, 4, 20], &mut player.rng);
        let mut component = || rng.random::<i32>() >> widths[rng.random_range(0..5)];
        let (x, y) = (component(), component());
        player.operation([x as u64, y as u64], cordic::vector(x, y));
    }
    player.idle(4, false);
    player.run
}
