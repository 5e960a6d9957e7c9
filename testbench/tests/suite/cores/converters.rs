//! Runs of the number converters, which are pipelines. The one to float32 advances only when enabled.

use std::collections::VecDeque;

use hdl_gen::cores::{fixed_to_float, float_to_fixed};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bench::Run;

/// How often the pipeline is enabled, changing every thousand cycles.
fn enabled(rng: &mut ChaCha8Rng, cycle: usize) -> bool {
    rng.random_bool([1.0, 0.7, 0.2][cycle / 1_000 % 3])
}

pub fn float_to_fixed() -> Run {
    let mut run = Run::new(
        "sptfra_float_to_fixed",
        &[("float_bits", 32), ("shift", 10), ("limit", 27)],
        &[("fixed", 27), ("saturated", 1), ("not_finite", 1)],
    );
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let floats = [
        0.0,
        -0.0,
        0.5,
        -0.5,
        1.5,
        2.5,
        -2.5,
        1.0,
        67_108_863.0,
        67_108_862.5,
        67_108_864.0,
        1e30,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
        -f32::NAN,
        0.499_999_97,
        0.25,
        8_388_607.5,
    ];
    let mut corners: Vec<(u32, i32)> = Vec::new();
    for bits in floats.map(f32::to_bits).into_iter().chain([1, 0x7f_ffff, 0x8000_0001, 0x7f80_0001]) {
        corners.extend([-512, -30, -27, -1, 0, 1, 3, 4, 24, 126, 149, 511].map(|shift| (bits, shift)));
    }
    let mut limit = (1 << 26) - 1;
    let stages = float_to_fixed::LATENCY as usize;
    let mut pipeline: VecDeque<(u32, i32)> = VecDeque::new();
    let mut shown: Option<float_to_fixed::Converted> = None;
    // The limit stays while conversions are under way: after a change, those are not judged.
    let mut settled = 0;
    for _ in 0..45_000 {
        let (bits, shift) = if rng.random_bool(0.8) {
            // An exponent for which the result is around its useful range.
            let shift = rng.random_range(-120..=120);
            let exponent = (127 - shift + rng.random_range(-4..30)).clamp(0, 255) as u32;
            (rng.random::<u32>() & 0x807f_ffff | exponent << 23, shift)
        } else if rng.random_bool(0.5) {
            (rng.random(), rng.random_range(-512..512))
        } else {
            corners[rng.random_range(0..corners.len())]
        };
        let before = limit;
        match rng.random_range(0..200) {
            0 | 1 => limit = rng.random_range(0..1 << 26) >> rng.random_range(0..26),
            2 | 3 => limit = (1 << 26) - 1,
            _ => {}
        }
        if limit != before {
            settled = 0;
        }
        run.push(
            &[u64::from(bits), shift as u64, u64::from(limit)],
            &[
                shown.map(|shown| shown.fixed as u64),
                shown.map(|shown| u64::from(shown.saturated)),
                shown.map(|shown| u64::from(shown.not_finite)),
            ],
        );
        pipeline.push_back((bits, shift));
        if pipeline.len() == stages
            && let Some((bits, shift)) = pipeline.pop_front()
        {
            settled += 1;
            shown = (settled > stages).then(|| float_to_fixed::convert(bits, shift, limit));
            run.results += usize::from(shown.is_some());
        }
    }
    run
}

pub fn fixed_to_float() -> Run {
    let mut run =
        Run::new("sptfra_fixed_to_float", &[("enable", 1), ("fixed", 64), ("exponent", 10)], &[("float_bits", 32)]);
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let numbers = [
        0,
        1,
        -1,
        2,
        i64::MAX,
        i64::MIN,
        i64::MIN + 1,
        (1 << 24) - 1,
        1 << 24,
        (1 << 24) + 1,
        (1 << 24) + 3,
        (1 << 25) - 1,
        -((1 << 25) - 1),
        (1 << 40) - 1,
        (1 << 40) + (1 << 16),
        (1 << 40) + (1 << 16) + 1,
    ];
    let mut corners: Vec<(i64, i32)> = Vec::new();
    for number in numbers {
        corners.extend([-512, -190, -151, -150, -127, -126, 0, 64, 65, 103, 104, 127, 128, 511].map(|e| (number, e)));
    }
    let stages = fixed_to_float::LATENCY as usize;
    let mut pipeline: VecDeque<(i64, i32)> = VecDeque::new();
    let mut shown: Option<u32> = None;
    for cycle in 0..45_000 {
        let enable = enabled(&mut rng, cycle);
        let (fixed, exponent) = if rng.random_bool(0.1) {
            corners[rng.random_range(0..corners.len())]
        } else {
            let mut fixed = rng.random::<i64>() >> rng.random_range(0..64);
            if rng.random_bool(0.3) {
                // Trailing zeros, for ties in the rounding.
                fixed &= -1 << rng.random_range(0..40);
            }
            let range = [512, 160, 60][rng.random_range(0..3)];
            (fixed, rng.random_range(-range..range))
        };
        run.push(&[u64::from(enable), fixed as u64, exponent as u64], &[shown.map(u64::from)]);
        if enable {
            pipeline.push_back((fixed, exponent));
            if pipeline.len() == stages
                && let Some((fixed, exponent)) = pipeline.pop_front()
            {
                shown = Some(fixed_to_float::convert(fixed, exponent));
                run.results += 1;
            }
        }
    }
    run
}
