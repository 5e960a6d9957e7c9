//! Several bodies in hardware: whole designs against the model, the model against the solver, what one body costs.

use std::collections::BTreeMap;

use golden::design::{CalibrationIn, Design, Filter, InputRange, Outputs, Overrun, PlanKind, Samples, Slip, Tension};
use golden::matrices::{Matrices, MatrixName};
use golden::solver::{Solution, Solver, Status};
use hdl_gen::plan::timing::Timeline;
use hdl_gen::plan::{Plan, PlanError, contacts, words};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::figures::grouped;
use testbench::stream::{Exchange, Pacing, Traffic, exchange};
use testbench::stream_words::{Answer, decode_bodies};
use testbench::stress::{self, stress};
use testbench::trial::{model_answers, timeout};
use testbench::verilate::Built;

use crate::bodies::kinds::{Kind, frame};
use crate::support::effort::{half_of, share_of};
use crate::support::{
    built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly, with_joint, with_lanes, with_points,
    workspace,
};

fn telling_apart(mut design: Design, contacts: usize) -> Design {
    design.name += "_several";
    design.algorithm.contacts = contacts;
    design
}

fn streaming(mut design: Design, bits: u32) -> Design {
    design.hardware.stream_bits = bits;
    design
}

fn dropping(mut design: Design) -> Design {
    design.name += "_drops";
    design.hardware.overrun = Overrun::Drop;
    design
}

fn filtered(mut design: Design) -> Design {
    design.name += "_filtered";
    design.algorithm.filter = Filter::F2 { p: 0.02 };
    design
}

fn of_frames(mut design: Design) -> Design {
    design.name += "_scaled";
    design.hardware.range = InputRange::Frame;
    design
}

fn slipping(mut design: Design) -> Design {
    design.name += "_slipping";
    design.algorithm.slip = Some(Slip { limit: 0.4, hysteresis: 0.2 });
    design
}

fn clipped(mut design: Design) -> Design {
    design.name += "_clipped";
    design.input.tension = Tension::Clipped;
    design
}

fn without_field(mut design: Design) -> Design {
    design.name += "_sums";
    design.algorithm.outputs = Outputs::Resultants;
    design
}

/// Both plans, both estimators, odd sides, a filter, a range for each frame, a sensor that reads no tension, resultants
/// alone, slip, wide streams, a source that is never held; few records and many, few lanes and many. `make test` plays every
/// second.
fn designs() -> Vec<Design> {
    vec![
        telling_apart(shipped("odd"), 2),
        telling_apart(of_frames(by_plan(shipped("odd"), PlanKind::Reduced, Outputs::Field)), 3),
        telling_apart(dropping(filtered(shipped("odd"))), 5),
        telling_apart(clipped(with_joint(shipped("small"))), 4),
        telling_apart(slipping(shipped("sensor1-fast-64")), 8),
        telling_apart(streaming(without_field(shipped("odd")), 64), 2),
        telling_apart(without_field(of_frames(slipping(with_joint(shipped("small"))))), 3),
    ]
}

/// Frames that press where a drawing has a mark, frames of bodies of every kind, and between them frames without an answer.
pub fn packets(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let sensor = &plan.design.sensor;
    let full = plan.design.hardware.full_scale_pa;
    let marks: [fn(usize, usize) -> bool; 7] = [
        |x, y| x < 2 && y < 2,
        |x, y| x % 5 < 2 && y < 2,
        |x, y| x % 4 < 2 && y % 3 < 1,
        |x, y| x == 0 || y == 2 || x == 3,
        |x, y| (x + y) % 2 == 0,
        |x, _| x % 3 == 0,
        |_, _| true,
    ];
    let mut packets: Vec<Vec<u32>> = Vec::new();
    for (index, mark) in marks.into_iter().enumerate() {
        let stress = |taxel: usize| {
            let (x, y) = (taxel % sensor.columns, taxel / sensor.columns);
            if mark(x, y) { -0.3 * full * (1.0 + 0.4 * (taxel % 3) as f64) } else { 0.002 * full * (taxel % 7) as f64 }
        };
        let whole = plan.streams().packet(&(0..sensor.taxels()).map(stress).collect::<Vec<_>>());
        packets.push(whole.clone());
        match index % 4 {
            0 => packets.push(vec![0; whole.len()]),
            1 => packets.push(whole[..whole.len() / 2].to_vec()),
            2 => packets.push([&[f32::NAN.to_bits()], &whole[1..]].concat()),
            _ => packets.push([whole.clone(), whole].concat()),
        }
    }
    // Three bodies have room on the larger ones.
    if sensor.taxels() >= 100 {
        let kinds = [Kind::One, Kind::Anyhow, Kind::One, Kind::One, Kind::Three, Kind::Opposed, Kind::Row];
        packets.extend(
            kinds.iter().zip(40..).map(|(&kind, seed)| plan.streams().packet(&frame(sensor, kind, seed).stress)),
        );
    }
    // What only pulls is a contact, too.
    packets.push(plan.streams().packet(&vec![0.1 * full; sensor.taxels()]));
    packets.push(frames::contact(plan, random));
    packets.push(frames::noise(plan, 0.5, random));
    packets
}

#[test]
fn the_hardware_tells_apart_as_the_model_does() {
    let failures: Vec<String> = in_parallel(&half_of(designs()), |design| {
        let plan = planned(design);
        let packets = packets(&plan, &mut ChaCha8Rng::seed_from_u64(11));
        let mut seen = BTreeMap::new();
        for answer in model_answers(&plan, &packets) {
            *seen.entry(answer[words::CENSUS] & 0xFF).or_insert(0) += 1;
        }
        let most = if plan.taxels() < 100 { 2 } else { 3 };
        assert!((0..=most).all(|bodies| seen.contains_key(&bodies)), "{}: {seen:?}", design.name);
        simulate_exactly(&plan, &built(&plan), &packets, 3).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A layer so deep that what is found of the bodies is many times what is found of all as one, and frames of nothing that
/// such a sensor could feel.
fn saturating() -> (Design, Vec<Vec<u32>>) {
    let mut design = with_lanes(of_frames(shipped("small-bodies")), 4);
    (design.sensor.columns, design.sensor.rows, design.sensor.depth_mm) = (5, 5, 5.5);
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let mut frame = |presses: bool| {
        let mut stress =
            || if presses { -3e4 * f32::from(random.random_bool(0.4)) } else { random.random_range(-9e4..9e4_f32) };
        (0..25).map(|_| stress().to_bits()).collect()
    };
    let packets = (0..16).map(|index| frame(index % 4 == 0)).collect();
    (design, packets)
}

/// Forces of bodies that have no room in the steps of those of the whole frame are clipped, and the frame says so, though
/// nothing in the core was.
#[test]
fn forces_that_do_not_fit_are_said_to_be_saturated() {
    let (several, packets) = saturating();
    let several = planned(&several);
    let answers = model_answers(&several, &packets);
    let saturated = |answer: &&Vec<u32>| answer[words::STATUS] & Status::SATURATED.0 != 0;
    let count = answers.iter().filter(saturated).count();
    assert!((1..packets.len()).contains(&count), "{count} of {}", packets.len());
    simulate_exactly(&several, &built(&several), &packets, 7).expect("bit for bit");
}

/// A frame of one body is answered as by a design for one, word for word, and record 1 says the same.
#[test]
fn one_body_has_the_forces_of_a_design_for_one() {
    let several = telling_apart(shipped("sensor1-fast"), 4);
    let mut one = several.clone();
    (one.algorithm.contacts, one.algorithm.count_bodies) = (1, true);
    let [several, one] = [several, one].map(|design| planned(&design));
    let packets: Vec<Vec<u32>> =
        (0..20).map(|seed| one.streams().packet(&frame(&one.design.sensor, Kind::One, 70 + seed).stress)).collect();
    let records = 8 * 4;
    for (found, expected) in model_answers(&several, &packets).iter().zip(model_answers(&one, &packets)) {
        assert_eq!(found[..16], expected[..16]);
        assert_eq!(found[16 + records..], expected[16..]);
        assert_eq!(found[19..24], [found[2], found[3], found[4], found[8], found[12]]);
        assert!(found[24..16 + records].iter().all(|&word| word == 0));
    }
}

/// Which bodies slip, and for how long, as the solver says it: bodies that come, stay, are pushed less and leave.
#[test]
fn bodies_slip_as_in_the_solver() {
    let design = telling_apart(slipping(shipped("sensor1-fast")), 4);
    let (plan, solver) = (planned(&design), Solver::new(&design).expect("matrices"));
    let scene = |kind, seed| frame(&design.sensor, kind, seed).stress;
    let mut scenes = Vec::new();
    for seed in 0..12 {
        let [slides, held] = [scene(Kind::Anyhow, 900 + seed), scene(Kind::Held, 900 + seed)];
        scenes.extend([scene(Kind::One, 900 + seed), held.clone(), slides.clone(), held, slides]);
        // Without contact what slips ends; what tells nothing, a NaN, changes nothing.
        let mut between = vec![0.0; design.sensor.taxels()];
        between[0] = if seed % 2 == 0 { 0.0 } else { f64::NAN };
        scenes.extend([between, scene(Kind::Held, 950 + seed), scene(Kind::Three, 900 + seed)]);
    }
    let packets: Vec<Vec<u32>> = scenes.iter().map(|stress| plan.streams().packet(stress)).collect();
    let (mut workspace, mut expected) = (solver.workspace(), Solution::zeros(Status::default(), 0));
    // Bodies that slip, that do not, and that do below the limit for they did before.
    let mut seen = [0; 3];
    for (words, stress) in model_answers(&plan, &packets).iter().zip(&scenes) {
        let found = decode_bodies(words, 4).expect("a whole frame");
        solver.solve_into(&mut workspace, stress, &mut expected).expect("a whole frame");
        let slips = |status: Status| status.contains(Status::SLIP);
        assert_eq!(slips(Status(found.status)), slips(expected.status), "{found:?}\n{expected:?}");
        for (found, expected) in found.records.iter().zip(&expected.records).filter(|(_, expected)| expected.taxels > 0)
        {
            assert_eq!(slips(found.status), slips(expected.status), "{found:?}\n{expected:?}");
            seen[if slips(found.status) { usize::from(found.mu < 0.4) * 2 } else { 1 }] += 1;
        }
    }
    assert!(seen.iter().all(|&seen| seen >= 5), "{seen:?}");
}

/// Resultants alone are the words before the field, whatever the frames.
#[test]
fn resultants_are_the_words_before_the_field() {
    let field = telling_apart(with_joint(shipped("small")), 3);
    let [alone, field] = [without_field(field.clone()), field].map(|design| planned(&design));
    let packets = packets(&field, &mut ChaCha8Rng::seed_from_u64(5));
    let before = 16 + 8 * 3;
    assert_eq!([alone.words_out(), field.words_out()], [before, before + 3 * field.taxels()]);
    assert_eq!(alone.timeline.latency_cycles, field.timeline.latency_cycles - 3 * field.taxels() as u64);
    let whole = model_answers(&field, &packets);
    assert!(whole.iter().any(|answer| answer[words::CENSUS] & 0xFF > 1));
    for (found, whole) in model_answers(&alone, &packets).iter().zip(whole) {
        assert_eq!(found[..], whole[..before]);
    }
}

/// The largest differences of two answers along the surface and along z, of all bodies and of each, over the normal force.
fn difference(found: &Answer, expected: &Solution) -> [f64; 2] {
    let of = |found: [f64; 3], expected: [f64; 3]| {
        let apart: f64 =
            found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
        apart / expected[2].abs()
    };
    let records = found.records.iter().zip(&expected.records).filter(|(_, expected)| expected.taxels > 0);
    let of_bodies = records.map(|(found, expected)| of(found.force, expected.force)).fold(0.0, f64::max);
    [of(found.resultant, expected.resultant), of_bodies]
}

#[test]
fn the_solver_tells_apart_as_the_hardware_does() {
    for name in ["sensor1-fast", "sensor2-none", "sensor1-wide", "sensor1-clipped-wide"] {
        let design = telling_apart(shipped(name), 4);
        let (plan, solver) = (planned(&design), Solver::new(&design).expect("matrices"));
        for kind in [Kind::One, Kind::Same, Kind::Opposed, Kind::Anyhow, Kind::Three, Kind::Row] {
            let mut scenes: Vec<Vec<f64>> = (0..6).map(|seed| frame(&design.sensor, kind, 900 + seed).stress).collect();
            // A frame in which nothing pulls says so, or what it is of.
            let pulled_by = if design.input.tension == Tension::Clipped { 0 } else { 5 };
            scenes[pulled_by..].iter_mut().flatten().for_each(|stress| *stress = stress.min(0.0));
            let packets: Vec<Vec<u32>> = scenes.iter().map(|stress| plan.streams().packet(stress)).collect();
            for (words, stress) in model_answers(&plan, &packets).iter().zip(&scenes) {
                let found = decode_bodies(words, 4).expect("a whole frame");
                let expected = solver.solve(stress).expect("a whole frame");
                assert_eq!(found.bodies, expected.bodies, "{name}, {kind:?}");
                let [all, each] = difference(&found, &expected);
                assert!(all < 2e-3 && each < 2e-3, "{name}, {kind:?}: {all:.1e}, {each:.1e}");
                // At the limit of doubt, or of the search, one of the two may say it.
                let limits = Status::DOUBTFUL.0 | Status::AT_BOUND.0;
                assert_eq!(found.status | limits, expected.status.0 | limits, "{name}, {kind:?}");
                for (found, expected) in found.records.iter().zip(&expected.records) {
                    assert_eq!(found.taxels, expected.taxels, "{name}, {kind:?}");
                    assert_eq!(found.status.0 | limits, expected.status.0 | limits, "{name}, {kind:?}");
                    let apart = |a: f64, b: f64| (a - b).abs();
                    assert!(
                        (0..2).all(|axis| apart(found.centre_m[axis], expected.centre_m[axis]) < 2e-5),
                        "{found:?}"
                    );
                    assert!(apart(found.mu, expected.mu) < 4e-3, "{found:?}, {expected:?}");
                    let errors = [found.standard_error, expected.standard_error];
                    assert!(apart(errors[0], errors[1]) <= 0.02 * errors[1], "{found:?}, {expected:?}");
                }
            }
        }
    }
}

#[test]
fn streams_with_pauses_faults_and_resets_are_told_apart() {
    let odd = by_plan(shipped("odd"), PlanKind::Reduced, Outputs::Field);
    let wide = streaming(without_field(slipping(odd.clone())), 128);
    // A standard error for each body.
    let points = with_points(shipped("small"));
    for design in [odd, wide, points] {
        let design = telling_apart(design, 3);
        let report = stress(
            &design,
            &stress::Options { frames: share_of(900) as u64, seed: 3 },
            &golden::progress::Progress::hidden(),
        );
        let report = report.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.sent, report.answered.plus(report.lost_to_resets));
    }
}

#[test]
fn what_does_not_go_with_several_bodies_is_refused() {
    type Change = fn(&mut Design);
    let changes: [(&str, Change); 3] = [
        ("no [sensor] dead", |design| design.input.dead = vec![3]),
        ("samples = \"float32\"", |design| design.hardware.samples = Samples::Int16),
        ("calibration = \"rom\"", |design| design.hardware.calibration = CalibrationIn::Ram),
    ];
    for (needs, change) in changes {
        let mut design = telling_apart(shipped("sensor1-fast"), 4);
        change(&mut design);
        let error = Plan::new(&design).expect_err("no hardware");
        assert!(matches!(error, PlanError::Contacts { contacts: 4, .. }), "{error}");
        assert!(error.to_string().contains(needs), "{error}");
    }
    for (name, lacks) in [("small-scanner", true), ("bed-mat", true), ("sensor1-bodies", false)] {
        assert_eq!(contacts::needs(&shipped(name)).is_some(), lacks, "{name}");
    }
}

/// Frames of so many bodies: blocks of 2 x 2 taxels that press alike.
pub fn blocks(plan: &Plan, bodies: usize, frames: usize) -> Vec<Vec<u32>> {
    let sensor = &plan.design.sensor;
    let corners = [[1, 1], [7, 7], [1, 7], [7, 1]];
    let press = |taxel: usize| {
        let [x, y] = [taxel % sensor.columns, taxel / sensor.columns];
        let touches = |[left, top]: &[usize; 2]| (*left..left + 2).contains(&x) && (*top..top + 2).contains(&y);
        if corners[..bodies].iter().any(touches) { -0.2 } else { 0.0 }
    };
    let c33inv = Matrices::of(&plan.design).expect("matrices").dense(MatrixName::C33inv);
    let c33 = c33inv.try_inverse().expect("an inverse");
    let row = |row: usize| (0..sensor.taxels()).map(|taxel| c33[(row, taxel)] * press(taxel)).sum();
    let stress: Vec<f64> = (0..sensor.taxels()).map(row).collect();
    vec![plan.streams().packet(&stress); frames]
}

/// Latency of a frame alone, and the distance of frames back to back while others wait behind them.
fn cycles_of(plan: &Plan, core: &Built, bodies: usize) -> [u64; 2] {
    let packets = blocks(plan, bodies, 10);
    assert!(model_answers(plan, &packets).iter().all(|answer| answer[words::CENSUS] & 0xFF == bodies as u32));
    let run = |pacing| {
        let traffic = Traffic::new(&packets, timeout(plan)).with_pacing(pacing);
        exchange(&mut core.load(1).expect("loaded"), &traffic, |_| ()).expect("all frames come out").exchanges
    };
    let alone: Vec<u64> = run(Pacing::OneAtATime).iter().map(Exchange::latency).collect();
    assert!(alone.iter().all(|cycles| *cycles == alone[0]), "{alone:?}");
    let ends: Vec<u64> = run(Pacing::BackToBack).iter().map(|exchange| exchange.last_out).collect();
    let distances: Vec<u64> = ends.windows(2).map(|ends| ends[1] - ends[0]).collect();
    assert!(distances[3..7].iter().all(|cycles| *cycles == distances[3]), "{distances:?}");
    [alone[0], distances[3]]
}

/// What several bodies cost does not depend on what they do; docs/contacts.md has these figures, and README some of them.
#[test]
#[ignore = "half a minute: part of `make test-long`"]
fn several_bodies_take_as_long_as_stated() {
    let read = |page: &str| std::fs::read_to_string(workspace(page)).expect("is there");
    let (contacts, readme) = (read("docs/contacts.md"), read("README.md"));
    for name in ["sensor1-bodies", "sensor1-fast-64"] {
        let plan = planned(&streaming(telling_apart(shipped(name), 4), 32));
        let core = built(&plan);
        // Of one they are predicted, and the mean of distances that may differ.
        let Timeline { latency_cycles, interval_cycles, .. } = plan.timeline;
        let several = [2, 3, 4].map(|bodies| cycles_of(&plan, &core, bodies));
        let found = [[latency_cycles, interval_cycles], several[0], several[1], several[2]];
        let cells = found.map(|cycles| cycles.map(grouped).join(" / ")).join(" | ");
        let row = format!("| {} | {cells} |", plan.design.hardware.lanes);
        assert!(contacts.contains(&row), "{row}");
        if name == "sensor1-bodies" {
            let [_, two, three, four] = found.map(|[latency, interval]| {
                let rate = (plan.design.hardware.clock_mhz * 1e6 / interval as f64).round() as u64;
                [latency, rate].map(grouped)
            });
            let latencies = format!("two bodies takes {}\ncycles, of three {}, of four {},", two[0], three[0], four[0]);
            let rates = format!("at {}, {} and {} frames a second", two[1], three[1], four[1]);
            assert!(readme.contains(&latencies) && readme.contains(&rates), "{latencies} {rates}");
        }
    }
    let of_two = planned(&telling_apart(shipped("sensor1-bodies"), 2));
    let (cycles, resources) = (grouped(of_two.timeline.latency_cycles), of_two.resources);
    let two = format!("in place of 4 it is {cycles} cycles, {} DSP and {} BRAM", resources.dsp, resources.bram36);
    assert!(readme.contains(&two), "{two}");
}
