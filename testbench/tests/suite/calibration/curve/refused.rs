//! Curves that a bank does not take.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::registers::address;

use super::super::{CONTRADICTION, OUT_OF_RANGE, errors, load, perform, read_back, version};
use super::{random_bank_and_curve, subject};
use crate::support::banks::takes;

/// What no word tells alone the commit finds: the core takes a bank where the model does, and no other.
#[test]
fn what_does_not_go_together_is_refused() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut core = subject.core(3);
    let (mut taken, mut refused) = (0, 0);
    for _ in 0..300 {
        let mut bank = random_bank_and_curve(subject, &mut random);
        let map = bank.curve.as_mut().expect("a curve");
        let count = map.curve.segments.len();
        let place = random.random_range(0..count);
        let segment = &mut map.curve.segments[place];
        let by = 10_f64.powf(random.random_range(-1.0..7.0)) * if random.random_bool(0.5) { 1.0 } else { -1.0 };
        match random.random_range(0..7) {
            0 => segment.first += by as i64,
            1 => segment.value += by as i64,
            2 => segment.slope += random.random_range(-2..=2),
            3 => segment.slope = -segment.slope,
            4 => segment.shift = (segment.shift + 1).min(40),
            5 => map.end += by as i64,
            _ => map.curve.last += by as i64,
        }
        let segment = &map.curve.segments[place];
        let within = segment.first.abs() < 1 << 25
            && segment.value.abs() < (1 << 26) - (1 << 12)
            && segment.slope.abs() < 1 << 17
            && map.curve.last.abs() < 1 << 25
            && map.end.abs() < (1 << 26) - (1 << 12);
        if !within {
            continue;
        }
        let before = version(&mut core);
        perform(&mut core, &load(&bank, bank.crc()));
        if takes(subject.calibration(), &bank) {
            assert_eq!((errors(&mut core), version(&mut core)), (0, (before + 1) & 0xFF), "{bank:?}");
            taken += 1;
        } else {
            assert_eq!((errors(&mut core), version(&mut core)), (CONTRADICTION, before), "{bank:?}");
            refused += 1;
        }
    }
    assert!(taken > 40 && refused > 100, "{taken} taken, {refused} refused");
}

/// Largest magnitudes of a curve's words.
const NUMBER: i64 = (1 << 25) - 1;
const VALUE: i64 = (1 << 26) - 1 - (1 << 12);
const SLOPE: i64 = (1 << 17) - 1;

#[test]
fn what_is_out_of_bounds_is_refused() {
    let subject = subject();
    let power_up = subject.calibration().power_up.words();
    let mut core = subject.core(5);
    let mut attempt = |index: usize, word: i64, fits: bool| {
        let word = word as u32;
        core.write(address::CALIBRATION_INDEX, index as u32).expect("a reply");
        core.write(address::CALIBRATION_DATA, word).expect("a reply");
        assert_eq!(errors(&mut core), if fits { 0 } else { OUT_OF_RANGE }, "word {index}: {word:#010x}");
        core.write(address::CALIBRATION_INDEX, index as u32).expect("a reply");
        let expected = if fits { word } else { power_up.get(index).copied().unwrap_or(0) };
        assert_eq!(core.read(address::CALIBRATION_DATA).expect("a reply"), expected, "word {index}: {word:#010x}");
        if fits {
            core.write(address::CALIBRATION_DATA, power_up[index]).expect("a reply");
        }
    };
    let (first, count) = (26, 26 + 64);
    for segment in [0, 3, 15] {
        for (word, most) in [(0, NUMBER), (1, VALUE), (2, SLOPE)] {
            for (value, fits) in [(most, true), (-most, true), (most + 1, false), (-most - 1, false), (0, true)] {
                attempt(first + 4 * segment + word, value, fits);
            }
            attempt(first + 4 * segment + word, i64::from(i32::MIN), false);
        }
        for (value, fits) in [(0, false), (1, true), (40, true), (41, false), (64, false), (-1, false)] {
            attempt(first + 4 * segment + 3, value, fits);
        }
    }
    for (value, fits) in [(0, false), (1, true), (16, true), (17, false), (128, false), (-1, false)] {
        attempt(count, value, fits);
    }
    for (word, most) in [(1, NUMBER), (2, VALUE)] {
        for (value, fits) in [(most, true), (-most, true), (most + 1, false), (-most - 1, false)] {
            attempt(count + word, value, fits);
        }
    }
    attempt(count + 3, 1, false);
    assert_eq!((read_back(&mut core, true), read_back(&mut core, false)), (power_up.clone(), power_up));
}
