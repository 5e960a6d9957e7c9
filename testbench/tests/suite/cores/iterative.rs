//! Runs of the cores that take one operation at a time: divider and CORDIC.

use hdl_gen::cores::{cordic, divider};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bench::Run;

/// Plays operations one after the other, with starts and other operands in between that must not matter.
struct Player<R> {
    run: Run,
    rng: ChaCha8Rng,
    latency: u32,
    /// Whether the result stays at the port while the next operation is under way.
    keeps_result: bool,
    junk: fn(&mut ChaCha8Rng) -> [u64; 2],
    outputs: fn(Option<R>, Option<u64>) -> Vec<Option<u64>>,
    held: Option<R>,
    done: bool,
}

impl<R: Copy> Player<R> {
    fn cycle(&mut self, reset: bool, start: bool, operands: [u64; 2]) {
        // Before the first edge in reset nothing is promised.
        let done = (!self.run.cycles.is_empty()).then_some(u64::from(self.done));
        let expected = (self.outputs)(self.held, done);
        self.run.push(&[u64::from(reset), u64::from(start), operands[0], operands[1]], &expected);
        self.done = false;
    }

    fn idle(&mut self, cycles: u32, reset: bool) {
        for _ in 0..cycles {
            let operands = (self.junk)(&mut self.rng);
            self.cycle(reset, false, operands);
        }
    }

    /// Cycles with an operation under way, in which starts are ignored.
    fn busy(&mut self, cycles: u32) {
        for _ in 0..cycles {
            let operands = (self.junk)(&mut self.rng);
            let start = self.rng.random_ratio(1, 10);
            self.cycle(false, start, operands);
        }
    }

    fn operation(&mut self, operands: [u64; 2], result: R) {
        let gap = [0, 0, 1, 5][self.rng.random_range(0..4)];
        self.idle(gap, false);
        if self.rng.random_ratio(1, 100) {
            // An operation given up leaves no done behind.
            let other = (self.junk)(&mut self.rng);
            self.cycle(false, true, other);
            self.held = None;
            let before = self.rng.random_range(0..self.latency - 1);
            self.busy(before);
            self.idle(1, true);
            self.idle(3, false);
        }
        self.cycle(false, true, operands);
        self.held = self.held.filter(|_| self.keeps_result);
        self.busy(self.latency - 1);
        (self.held, self.done) = (Some(result), true);
        self.run.results += 1;
    }
}

fn wide(rng: &mut ChaCha8Rng) -> u64 {
    let width = rng.random_range(0..64);
    rng.random::<u64>() >> width
}

pub fn divider() -> Run {
    let mut player = Player {
        run: Run::new(
            "sptfra_divider",
            &[("reset", 1), ("start", 1), ("numerator", 64), ("denominator", 48)],
            &[("quotient", 64), ("done", 1)],
        ),
        rng: ChaCha8Rng::seed_from_u64(4),
        latency: divider::LATENCY,
        keeps_result: false,
        junk: |rng| [rng.random(), rng.random()],
        outputs: |quotient, done| vec![quotient, done],
        held: None,
        done: false,
    };
    player.idle(3, true);
    let largest = (1 << 48) - 1;
    let corners =
        [0, 1, 2, 3, largest / 2, largest - 1, largest, largest + 1, u64::MAX / 2 + 1, u64::MAX - 1, u64::MAX];
    for numerator in corners {
        for denominator in corners.into_iter().filter(|&value| value <= largest) {
            player.operation([numerator, denominator], divider::divide(numerator, denominator));
        }
    }
    for _ in 0..10_000 {
        let denominator = wide(&mut player.rng) & largest;
        let near = player.rng.random_bool(0.2);
        let numerator = if near {
            // Next to a multiple of the denominator, where one unit decides the last digit.
            let factor = player.rng.random::<u16>();
            denominator.wrapping_mul(u64::from(factor)).wrapping_sub(player.rng.random_range(0..2))
        } else {
            wide(&mut player.rng)
        };
        player.operation([numerator, denominator], divider::divide(numerator, denominator));
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
