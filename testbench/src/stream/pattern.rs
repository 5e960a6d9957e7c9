//! When a stream's end is willing: always, or by a seeded pattern of pauses.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How willing one end of a stream is. The same value gives the same cycles on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pattern {
    /// Every cycle.
    #[default]
    Free,
    /// Each cycle with a probability of its own draw.
    Random {
        /// Seed of the generator.
        seed: u64,
        /// Probability of being willing in a cycle, above 0.
        willing: f64,
    },
    /// Runs of willing and of pausing cycles, their lengths drawn evenly from 1 to the maximum.
    Bursts {
        /// Seed of the generator.
        seed: u64,
        /// Longest run of willing cycles.
        longest_run: u32,
        /// Longest pause.
        longest_pause: u32,
    },
}

impl Pattern {
    /// The generator at its start.
    pub fn start(self) -> Gate {
        let seed = match self {
            Self::Free => 0,
            Self::Random { seed, .. } | Self::Bursts { seed, .. } => seed,
        };
        Gate { pattern: self, random: ChaCha8Rng::seed_from_u64(seed), open: false, left: 0 }
    }
}

/// A running pattern.
#[derive(Clone, Debug)]
pub struct Gate {
    pattern: Pattern,
    random: ChaCha8Rng,
    open: bool,
    left: u32,
}

impl Gate {
    /// Whether the end is willing in the next cycle.
    pub fn next_cycle(&mut self) -> bool {
        match self.pattern {
            Pattern::Free => true,
            // A probability of zero would be a stream that never moves.
            Pattern::Random { willing, .. } => self.random.random_bool(willing.clamp(0.01, 1.0)),
            Pattern::Bursts { longest_run, longest_pause, .. } => {
                if self.left == 0 {
                    self.open = !self.open;
                    let longest = if self.open { longest_run } else { longest_pause };
                    self.left = self.random.random_range(1..=longest.max(1));
                }
                self.left -= 1;
                self.open
            }
        }
    }
}

/// The four ways a stream core must work: each end free-running or pausing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// For reports.
    pub name: &'static str,
    /// Of the input's source.
    pub source: Pattern,
    /// Of the output's sink.
    pub sink: Pattern,
}

impl Mode {
    /// How many there are.
    pub const COUNT: usize = 4;

    /// True if neither end ever pauses.
    pub fn is_free(&self) -> bool {
        (self.source, self.sink) == (Pattern::Free, Pattern::Free)
    }

    /// Free, idle source, stalled sink, both.
    pub fn all(seed: u64) -> [Self; Self::COUNT] {
        let idle = Pattern::Bursts { seed: seed ^ 0x1D1E, longest_run: 9, longest_pause: 5 };
        let stall = Pattern::Random { seed: seed ^ 0x57A1, willing: 0.6 };
        [
            Self { name: "free-running", source: Pattern::Free, sink: Pattern::Free },
            Self { name: "idle source", source: idle, sink: Pattern::Free },
            Self { name: "stalled sink", source: Pattern::Free, sink: stall },
            Self { name: "idle and stalled", source: idle, sink: stall },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycles(pattern: Pattern) -> Vec<bool> {
        let mut gate = pattern.start();
        (0..2000).map(|_| gate.next_cycle()).collect()
    }

    #[test]
    fn free_is_always_willing() {
        assert!(cycles(Pattern::Free).into_iter().all(|willing| willing));
    }

    #[test]
    fn random_is_willing_about_as_often_as_asked() {
        let willing = cycles(Pattern::Random { seed: 7, willing: 0.3 }).into_iter().filter(|&w| w).count();
        assert!((500..700).contains(&willing), "{willing} of 2000");
    }

    #[test]
    fn bursts_stay_within_their_lengths_and_reach_them() {
        let pattern = Pattern::Bursts { seed: 1, longest_run: 4, longest_pause: 7 };
        let cycles = cycles(pattern);
        let longest = |value| cycles.split(|&willing| willing != value).map(<[bool]>::len).max();
        assert_eq!((longest(true), longest(false)), (Some(4), Some(7)));
    }

    #[test]
    fn the_seed_decides() {
        let pattern = |seed| cycles(Pattern::Random { seed, willing: 0.5 });
        assert_eq!(pattern(3), pattern(3));
        assert_ne!(pattern(3), pattern(4));
    }
}
