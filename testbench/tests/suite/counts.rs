//! Sensors that count: gain, offset and sign of each taxel in front of the fixed point, in either plan.

use std::fs;
use std::path::Path;

use golden::design::{Design, Samples, Scaling};
use golden::frames::read_recording;
use hdl_gen::model::SATURATED;
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::{model_answers, timeout};
use testbench::compare::Comparison;
use testbench::stream::{Mode, Pacing, Traffic, exchange};
use testbench::stream_words::decode;

use crate::support::frames::encode;
use crate::support::{built, in_parallel, planned, shipped, simulate_exactly, workspace};

const SIDES: [usize; 2] = [5, 4];

/// How gains and offsets differ from taxel to taxel.
#[derive(Clone, Copy, PartialEq)]
enum Gains {
    /// Not at all.
    One,
    /// As those of a real sensor.
    Spread,
    /// One is next to nothing, and the others of every size.
    Tiny,
}

/// A design in counts.
fn design(folder: &Path, name: &str, plan: &str, pa_per_count: f64, gains: Gains) -> Design {
    let [columns, rows] = SIDES;
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let line = |taxel: usize| match gains {
        Gains::One => String::new(),
        Gains::Spread => format!("{:?},{:?}\n", random.random_range(0.3..2.5), random.random_range(-40.0..40.0)),
        Gains::Tiny if taxel == 7 => "1e-6,0\n".to_owned(),
        Gains::Tiny => format!("{:?},{:?}\n", 10_f64.powf(random.random_range(-4.0..0.3)), 3 * taxel),
    };
    let lines: String = (0..columns * rows).map(line).collect();
    let calibration = if lines.is_empty() { "" } else { "calibration = \"gains.csv\"\n" };
    fs::write(folder.join("gains.csv"), lines).expect("writable");
    let text = format!(
        "format = 3\nname = \"{name}\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n\
         pa_per_count = {pa_per_count:?}\n{calibration}[algorithm]\nestimator = \"line\"\ncount_contacts = false\nplan = \"{plan}\"\n\
         [hardware]\nlanes = 8\nfull_scale_pa = 50000.0\nscaling = \"fixed\"\n"
    );
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).expect("writable");
    Design::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Counts within the full scale and far beyond it, fractions, bad values, short and long frames.
fn packets(plan: &Plan) -> Vec<Vec<u32>> {
    let taxels = plan.taxels();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let full_scale = 50_000.0 / plan.design.input.pa_per_count.expect("counts").abs();
    let mut frame = |share: f64| -> Vec<f64> {
        (0..taxels).map(|_| share * full_scale * random.random_range(-1.0..1.0_f64)).collect()
    };
    let mut frames: Vec<Vec<u32>> = [0.3, 0.9, 1.1, 4.0, 1e6, 1e-5].map(&mut frame).iter().map(|f| encode(f)).collect();
    frames.push(vec![0; taxels]);
    let mut bad = encode(&frame(0.5));
    bad[taxels / 3] = f32::NAN.to_bits();
    frames.push(bad);
    frames.push(encode(&frame(0.5))[1..].to_vec());
    frames.push([encode(&frame(0.5)), vec![1.0_f32.to_bits(); 3]].concat());
    frames.push(encode(&frame(0.4)));
    frames
}

#[test]
fn counts_become_stress_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let kinds = [
        ("counts_paper", "paper", 12.5, Gains::Spread),
        ("counts_one_gain", "reduced", -3.7, Gains::One),
        ("counts_tiny_gain", "reduced", -10.0, Gains::Tiny),
    ];
    let designs = kinds.map(|(name, plan, pascals, gains)| design(folder.path(), name, plan, pascals, gains));
    let failures: Vec<String> = in_parallel(&designs, |design| {
        let plan = planned(design);
        let packets = packets(&plan);
        let saturated = model_answers(&plan, &packets).iter().filter(|words| words[0] & SATURATED != 0).count();
        assert!(saturated >= 2 && saturated < packets.len() - 4, "{}: {saturated} saturated", design.name);
        simulate_exactly(&plan, &built(&plan), &packets, 4).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A design whose counts follow a curve.
fn curved(folder: &Path, name: &str, plan: &str, curve: &str, dead: &str) -> Design {
    let [columns, rows] = SIDES;
    let gains = |taxel: usize| format!("{:?},{:?}\n", 0.3 + 0.1 * taxel as f64, 40.0 * taxel as f64 - 300.0);
    fs::write(folder.join("curved.csv"), (0..columns * rows).map(gains).collect::<String>()).expect("writable");
    fs::write(folder.join("points.csv"), "-90,700\n0,0\n40,-90\n500,-9000\n1700,-28000\n4095,-51000\n")
        .expect("writable");
    let text = format!(
        "format = 3\nname = \"{name}\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n\
         curve = {curve}\ncalibration = \"curved.csv\"\n{dead}[algorithm]\nestimator = \"line\"\ncount_contacts = false\nplan = \"{plan}\"\n\
         [hardware]\nlanes = 8\nfull_scale_pa = 50000.0\nscaling = \"fixed\"\n"
    );
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).expect("writable");
    Design::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn counts_follow_a_curve_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let designs = [
        curved(folder.path(), "curve_points", "paper", "\"points.csv\"", ""),
        curved(folder.path(), "curve_power", "reduced", "{ power = 1.25, scale = -1.5 }", "dead = [7, 8]\n"),
    ];
    let failures: Vec<String> = in_parallel(&designs, |design| {
        let plan = planned(design);
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let mut frame = |from: f64, to: f64| -> Vec<u32> {
            encode(&(0..plan.taxels()).map(|_| random.random_range(from..to)).collect::<Vec<f64>>())
        };
        let ends = [(0.0, 4000.0), (-50.0, 60.0), (0.0, 1500.0), (3500.0, 6000.0), (-1e6, 1e7), (0.0, 1.0)];
        let mut packets: Vec<Vec<u32>> = ends.iter().map(|&(from, to)| frame(from, to)).collect();
        packets.push(vec![4095.0_f32.to_bits(); plan.taxels()]);
        packets.push(frame(0.0, 900.0)[1..].to_vec());
        let mut bad = frame(0.0, 900.0);
        bad[2] = f32::INFINITY.to_bits();
        packets.push(bad);
        packets.push(frame(0.0, 2500.0));
        let saturated = model_answers(&plan, &packets).iter().filter(|words| words[0] & SATURATED != 0).count();
        assert!(saturated > 0 && saturated < packets.len() - 2, "{}: {saturated} saturated", design.name);
        simulate_exactly(&plan, &built(&plan), &packets, 4).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Integers of 16 bits reach as far below 0 as a power law's end, which is capped there: -32768 reads nothing by it, as any
/// count below 0, and is beyond what is known, as the end itself would be.
#[test]
fn the_most_negative_count_on_a_capped_power_law() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut designs = Vec::new();
    for (name, range, bits) in [("capped_fixed", Scaling::Fixed, 32), ("capped_frame", Scaling::PerFrame, 64)] {
        let mut design = curved(folder.path(), name, "reduced", "{ power = 1.25, scale = -0.0066 }", "");
        design.input.calibration = None;
        design.hardware.samples = Samples::Int16;
        design.hardware.scaling = range;
        design.hardware.stream_bits = bits;
        // As a file with these keys has it.
        let design = Design::from_toml(&design.to_toml(), "capped.toml").expect("a design");
        let curve = design.input.curve.as_ref().expect("a curve");
        assert_eq!(curve.largest_count().to_bits(), 32_768_f64.to_bits());
        designs.push(design);
    }
    let failures: Vec<String> = in_parallel(&designs, |design| {
        let plan = planned(design);
        let frame = |other: f64, place: usize, count: f64| -> Vec<u32> {
            let mut counts = vec![other; plan.taxels()];
            counts[place] = count;
            plan.streams().packet(&counts)
        };
        let ends = [-32_768.0, -32_767.0, 32_767.0, -1.0, 0.0];
        let packets: Vec<Vec<u32>> = ends
            .iter()
            .flat_map(|&count| [frame(900.0, 6, count), frame(300.0, 19, count), frame(count, 3, 20e3)])
            .collect();
        let answers = model_answers(&plan, &packets);
        for (place, answer) in answers.iter().enumerate() {
            assert_eq!(answer[0] & SATURATED != 0, place < 3, "{}: frame {place}", design.name);
        }
        simulate_exactly(&plan, &built(&plan), &packets, 4).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_frame_of_the_mat_is_the_models() {
    let plan = planned(&shipped("bed-mat"));
    let frames = read_recording(&workspace("data/bed_mat_64x27.csv"), &plan.design, 2).expect("the recording").frames;
    let packets: Vec<Vec<u32>> = frames.iter().map(|frame| encode(frame)).collect();
    assert_eq!(packets.len(), 24);
    let (expected, built) = (model_answers(&plan, &packets), built(&plan));
    assert!(
        expected.iter().filter(|words| decode(words).is_some_and(|answer| answer.resultant[2] < 0.0)).count() >= 20
    );
    let [free, .., both] = Mode::all(3);
    for (mode, count) in [(free, packets.len()), (both, 3)] {
        let traffic = Traffic::new(&packets[..count], timeout(&plan)).with_mode(&mode).with_pacing(Pacing::BackToBack);
        let outcome = exchange(&mut built.load(1).expect("loads"), &traffic, |_| ()).expect(mode.name);
        let words = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
        let comparison = Comparison::new(&expected[..count], words, plan.design.sensor.columns);
        assert!(comparison.is_exact(), "{}: {:?}", mode.name, comparison.first.first());
    }
    assert!(plan.resources.dsp <= 2520 && plan.resources.bram36 <= 912.0, "fits the ZCU102");
}
