//! The designs whose Verilog is read.

use crate::calibration;
use crate::support::{by_plan, shipped, with_lanes};
use golden::creep::Creep;
use golden::design::{
    Calibration, CalibrationIn, Curve, Design, Estimator, Outputs, Overrun, PlanKind, Samples, Scaling, Slip, Tension,
};

/// One of each kind: square and not, filtered and not, fewest and most lanes, narrowest words, every plan.
pub fn designs() -> Vec<Design> {
    let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
    let mut narrow = by_plan(shipped("odd"), paper, Outputs::Field);
    let mut tiny = by_plan(shipped("small"), reduced, Outputs::Field);
    (tiny.sensor.columns, tiny.sensor.rows) = (2, 2);
    "narrow".clone_into(&mut narrow.name);
    narrow.hardware.coefficient_bits = 8;
    narrow.hardware.data_bits = 16;
    let [long, long_beats, long_vectors] = long();
    let mut broken = by_plan(shipped("odd"), reduced, Outputs::Field);
    "broken".clone_into(&mut broken.name);
    let taxels = broken.sensor.taxels();
    let gain = (0..taxels).map(|taxel| (1.0 + taxel as f64) / 4.0).collect();
    let calibration = Some(Calibration { gain, offset: vec![-7.5; taxels] });
    broken.input.pa_per_count = Some(-3.0);
    broken.input.calibration = calibration;
    broken.input.dead = vec![0, 1, 7];
    broken.input.tension = Tension::Clipped;
    let mut curved = by_plan(shipped("small"), reduced, Outputs::Field);
    "curved".clone_into(&mut curved.name);
    curved.input.curve = Some(Curve { points: vec![[0.0, 0.0], [50.0, -100.0], [4095.0, -1e5]], law: None });
    // With more than 64 lanes: two taxels a cycle, a row of points weighed in one, a collector that looks ahead.
    let mut uncorrected = by_plan(with_lanes(shipped("odd"), 68), reduced, Outputs::Resultants);
    "uncorrected".clone_into(&mut uncorrected.name);
    uncorrected.algorithm.estimator = Estimator::Joint;
    uncorrected.algorithm.slip = Some(Slip { limit: 0.6, hysteresis: 0.1 });
    // Wide streams: samples taken at once, of a beat that is not filled, and one by one.
    let mut wide = by_plan(broken.clone(), reduced, Outputs::Field);
    "wide".clone_into(&mut wide.name);
    wide.input.dead.clear();
    wide.hardware.stream_bits = 128;
    let mut integers = wide.clone();
    "integers".clone_into(&mut integers.name);
    integers.hardware.samples = Samples::Int16;
    let mut unpacked = by_plan(shipped("odd"), paper, Outputs::Field);
    "unpacked".clone_into(&mut unpacked.name);
    unpacked.hardware.stream_bits = 64;
    (unpacked.input.smoothing, unpacked.input.crosstalk) = (3, 0.02);
    unpacked.input.creep = Some(Creep { strength: 0.4, seconds: 9.0, frames_per_second: 100.0 });
    let mut wide_control = by_plan(shipped("small-control"), reduced, Outputs::Resultants);
    "wide_control".clone_into(&mut wide_control.name);
    wide_control.hardware.stream_bits = 64;
    let mut in_ram = integers.clone();
    "in_ram".clone_into(&mut in_ram.name);
    in_ram.hardware.control = true;
    in_ram.hardware.calibration = CalibrationIn::Ram;
    // Without a place for dead taxels, with one, with many.
    let mut mapped = in_ram.clone();
    "mapped".clone_into(&mut mapped.name);
    mapped.input.room = 8;
    mapped.input.dead = vec![0, 1, 7];
    let mut mapped_once = calibration::design(Outputs::Resultants);
    "mapped_once".clone_into(&mut mapped_once.name);
    mapped_once.input.room = 1;
    let [curve_in_ram, curve_of_floats] = with_curves_in_ram(&mapped, &curved);
    // Frames dropped, with and without registers, samples one by one and at once.
    let mut dropping = Design { name: "dropping".to_owned(), ..in_ram.clone() };
    let mut scanned = by_plan(shipped("small"), paper, Outputs::Field);
    "scanned".clone_into(&mut scanned.name);
    for design in [&mut dropping, &mut scanned] {
        design.hardware.overrun = Overrun::Drop;
    }
    let [scaled, scaled_fold, scaled_banks] = scaled(&curve_in_ram);
    vec![
        calibration::design(Outputs::Field),
        in_ram,
        mapped,
        mapped_once,
        curve_in_ram,
        curve_of_floats,
        dropping,
        scanned,
        unpacked,
        scaled,
        scaled_fold,
        scaled_banks,
        wide,
        integers,
        wide_control,
        by_plan(shipped("small"), paper, Outputs::Field),
        by_plan(shipped("odd"), paper, Outputs::Field),
        shipped("sensor1-f1-l40"),
        with_lanes(by_plan(shipped("small"), paper, Outputs::Field), 1),
        by_plan(shipped("small"), reduced, Outputs::Field),
        by_plan(shipped("small"), reduced, Outputs::Resultants),
        by_plan(with_lanes(shipped("odd"), 12), reduced, Outputs::Field),
        shipped("small-control"),
        by_plan(shipped("small-control"), paper, Outputs::Field),
        shipped("sensor1-reduced-64"),
        shipped("sensor1-resultants"),
        tiny,
        shipped("sensor1-fast"),
        shipped("small-joint"),
        shipped("sensor2-wide"),
        uncorrected,
        long,
        long_beats,
        long_vectors,
        broken,
        curved,
        with_lanes(shipped("sensor1-f1-l40"), 64),
        narrow,
    ]
}

/// Words of two multipliers a lane: all their bits, scaled by each frame's largest stress; in beats of several samples,
/// contacts counted; vectors that are long beside short coefficients.
fn long() -> [Design; 3] {
    let mut long = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    (long.hardware.coefficient_bits, long.hardware.data_bits) = (27, 35);
    let [mut beats, mut vectors] = [long.clone(), long.clone()];
    "long".clone_into(&mut long.name);
    long.hardware.scaling = Scaling::PerFrame;
    "long_beats".clone_into(&mut beats.name);
    beats.hardware.stream_bits = 128;
    beats.algorithm.count_contacts = true;
    "long_vectors".clone_into(&mut vectors.name);
    (vectors.hardware.coefficient_bits, vectors.hardware.data_bits) = (9, 30);
    vectors.algorithm.estimator = Estimator::Joint;
    [long, beats, vectors]
}

/// A curve in the banks, behind a map of dead taxels and not, of integers and of floats, with the widest room.
fn with_curves_in_ram(mapped: &Design, curved: &Design) -> [Design; 2] {
    let mut curve_in_ram = mapped.clone();
    "curve_in_ram".clone_into(&mut curve_in_ram.name);
    curve_in_ram.input.pa_per_count = None;
    curve_in_ram.input.curve.clone_from(&curved.input.curve);
    let mut curve_of_floats = calibration::curve::design_with_curve();
    let points = (0..40).map(f64::from).map(|point| [100.0 * point, -20.0 * point * point]).collect();
    curve_of_floats.input.curve = Some(Curve { points, law: None });
    [curve_in_ram, curve_of_floats]
}

/// Frames scaled by their own largest stress, folded and not, with and without a calibration and drops in front of it.
fn scaled(banks: &Design) -> [Design; 3] {
    let mut scaled = by_plan(shipped("odd"), PlanKind::Paper, Outputs::Field);
    "scaled".clone_into(&mut scaled.name);
    scaled.hardware.stream_bits = 128;
    let mut scaled_fold = with_lanes(shipped("sensor1-fast"), 20);
    (scaled_fold.hardware.stream_bits, scaled_fold.hardware.data_bits) = (64, 25);
    let mut scaled_banks = banks.clone();
    "scaled_banks".clone_into(&mut scaled_banks.name);
    scaled_banks.hardware.overrun = Overrun::Drop;
    scaled_banks.input.smoothing = 4;
    for design in [&mut scaled, &mut scaled_fold, &mut scaled_banks] {
        design.hardware.scaling = Scaling::PerFrame;
    }
    [scaled, scaled_fold, scaled_banks]
}
