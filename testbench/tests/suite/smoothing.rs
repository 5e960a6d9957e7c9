//! Averages over frames, and creep: RTL and model alike in all stream modes, among bad frames, steps and resets.

use crate::support::faults::{broken, some_faults};
use crate::support::resets::{self, judged};
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly, with_joint};
use golden::creep::Creep;
use golden::dead_taxels::DeadTaxels;
use golden::design::{Design, MeasuredNoise, Outputs, Overrun, PlanKind, Samples, Scaling};
use golden::estimators::StandardError;
use golden::scene::normal;
use golden::sensor::Sensor;
use golden::solver::{Solution, Solver};
use hdl_gen::model::{BAD_LENGTH, Model, NOT_FINITE};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::accuracy::SolverError;
use testbench::co_simulation::{model_answers, timeout};
use testbench::registers::{Access, Controlled, address};
use testbench::stream::{Mode, Pacing, Reset, Traffic, exchange};
use testbench::stream_words::decode;
use testbench::verilate::Built;

const NOISE: f64 = 0.01;
/// Within the frames of a contact it rises to most of what it adds.
const CREEP: Creep = Creep { strength: 0.4, seconds: 0.03, frames_per_second: 100.0 };

/// Most of it is noise.
const ERROR: StandardError = StandardError { model: 0.002, noise: 30.0, border: 0.05 };

/// Both plans and estimators, both scalings, noise as a share and as measured. Smoothing, creep or both, dead taxels and
/// crosstalk, integers, beats of several samples at once and one by one.
fn designs() -> Vec<Design> {
    let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
    let small = |name: &str, kind: PlanKind, outputs: Outputs, scaling: Scaling, smoothing: u32| {
        let mut design = by_plan(shipped("small"), kind, outputs);
        design.name = format!("smooth_{name}");
        design.hardware.scaling = scaling;
        (design.input.smoothing, design.input.noise) = (smoothing, NOISE);
        design.algorithm.standard_error = Some(ERROR);
        design
    };
    let plain = small("plain", reduced, Outputs::Field, Scaling::PerFrame, 2);
    let of_paper = small("paper", paper, Outputs::Field, Scaling::PerFrame, 1);
    let mut corrected = small("corrected", reduced, Outputs::Resultants, Scaling::Fixed, 8);
    corrected.hardware.stream_bits = 128;
    corrected.input.crosstalk = 0.05;
    corrected.input.dead = vec![5];
    corrected.input.creep = Some(CREEP);
    let mut counts = with_joint(small("counts", reduced, Outputs::Field, Scaling::PerFrame, 3));
    "smooth_counts".clone_into(&mut counts.name);
    counts.algorithm.standard_error = Some(ERROR);
    (counts.sensor.columns, counts.sensor.rows) = (3, 5);
    counts.input.pa_per_count = Some(-12.5);
    counts.input.measured_noise = Some(MeasuredNoise { deviation: NOISE * 4000.0, largest: 4000.0 });
    counts.hardware.samples = Samples::Int16;
    counts.hardware.stream_bits = 64;
    let mut fixed = small("fixed", paper, Outputs::Field, Scaling::Fixed, 4);
    fixed.input.measured_noise = Some(MeasuredNoise { deviation: NOISE * 3e4, largest: 3e4 });
    // Three samples in the last beat of four.
    let mut wide = small("wide", reduced, Outputs::Field, Scaling::Fixed, 2);
    (wide.sensor.columns, wide.sensor.rows) = (3, 5);
    wide.hardware.stream_bits = 128;
    let mut creeps = small("creeps", reduced, Outputs::Field, Scaling::PerFrame, 0);
    creeps.input.creep = Some(CREEP);
    vec![plain, of_paper, corrected, counts, fixed, wide, creeps]
}

/// The plan of one of them.
fn designed(name: &str) -> Plan {
    planned(&designs().into_iter().find(|design| design.name == name).expect("one of them"))
}

/// Contacts that are held, with noise, and released; each frame as often as it takes to see both what is averaged and restarts.
fn pascals(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
    let mut frames = Vec::new();
    for _ in 0..5 {
        let contact = frames::contact(plan, random);
        let stress: Vec<f64> = contact.iter().map(|&bits| f64::from(f32::from_bits(bits))).collect();
        let peak = stress.iter().fold(0.0_f64, |peak, stress| peak.max(stress.abs()));
        let mut noisy = |stress: &f64| stress + NOISE * peak * normal(random);
        frames.extend((0..6).map(|_| stress.iter().map(&mut noisy).collect::<Vec<f64>>()));
    }
    frames.insert(12, vec![0.0; plan.taxels()]);
    frames
}

fn packet(plan: &Plan, stress: &[f64]) -> Vec<u32> {
    let (input, samples) = (&plan.design.input, plan.design.hardware.samples);
    let value = |(taxel, &stress): (usize, &f64)| match samples {
        Samples::Float32 => input.from_pa(taxel, stress),
        _ => samples.clip(input.from_pa(taxel, stress).round()),
    };
    frames::filled(plan, stress.iter().enumerate().map(value))
}

fn contacts(plan: &Plan, seed: u64) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    pascals(plan, &mut random).iter().map(|stress| packet(plan, stress)).collect()
}

/// The same, then frames that a limit decides on.
fn packets(plan: &Plan, seed: u64) -> Vec<Vec<u32>> {
    let full_scale = plan.design.hardware.full_scale_pa;
    let last_taxel = plan.taxels() - 1;
    // The last taxel is the largest: it allows the first one a step, then makes a larger one itself.
    let with = |first: f64, last: f64| {
        let mut stress = vec![-0.01 * full_scale; plan.taxels()];
        (stress[0], stress[last_taxel]) = (-first * full_scale, -last * full_scale);
        stress
    };
    let steps = [with(0.01, 0.2), with(0.016, 0.2), with(0.016, 0.18)];
    // What was held for long has crept: the last reading less this is beyond the full scale, on either side.
    let beyond = [full_scale, -full_scale].into_iter().flat_map(|stress| {
        let held = vec![0.5 * stress; plan.taxels()];
        let mut last = held.clone();
        last[1] = -stress;
        std::iter::repeat_n(held, 10).chain([last])
    });
    // So light that measured noise is many times the load.
    let light = vec![-1e-4 * full_scale; plan.taxels()];
    let mut sent = contacts(plan, seed);
    sent.extend(steps.into_iter().chain(beyond).chain([light]).map(|stress| packet(plan, &stress)));
    sent
}

#[test]
fn every_word_and_every_cycle_is_right() {
    let wrong = in_parallel(&designs(), |design| {
        let plan = planned(design);
        let packets = packets(&plan, 3);
        simulate_exactly(&plan, &built(&plan), &packets, 3)
            .map(drop)
            .map_err(|fault| format!("{}: {fault}", design.name))
    });
    assert_eq!(wrong.into_iter().filter_map(Result::err).collect::<Vec<_>>(), Vec::<String>::new());
}

/// Short, long and not finite frames among the others.
fn with_bad_frames(plan: &Plan) -> Vec<Vec<u32>> {
    let width = plan.streams().words();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let mut sent = Vec::new();
    for packet in packets(plan, 5) {
        let mut bad = packet.clone();
        match random.random_range(0..4) {
            0 => bad.truncate((plan.streams().beats_in() - 1) * width),
            1 => bad.extend(std::iter::repeat_n(bad[0], 2 * width)),
            2 if plan.streams().sample == Samples::Float32 => bad[0] = f32::NAN.to_bits(),
            _ => bad.clear(),
        }
        sent.extend([packet, bad].into_iter().filter(|packet| !packet.is_empty()));
    }
    sent
}

/// A traffic of good and bad frames with resets among them.
fn with_resets(plan: &Plan, built: &Built, mode: &Mode) -> Result<(), String> {
    let sent = with_bad_frames(plan);
    let interval = plan.timeline.interval_cycles;
    let resets = [5, 11, 23].map(|frames| Reset { cycle: frames * interval + 7 * frames, length: 1 });
    let traffic = Traffic::new(&sent, 8 * timeout(plan)).with_mode(mode).with_resets(&resets);
    let mut core = built.load(5).expect("loads");
    let outcome = exchange(&mut core, &traffic, |_| ()).map_err(|error| error.to_string())?;
    judged(plan, &sent, &outcome)
}

#[test]
fn bad_frames_and_resets_are_right() {
    in_parallel(&designs(), |design| {
        let plan = planned(design);
        let sent = with_bad_frames(&plan);
        let expected = model_answers(&plan, &sent);
        let is_bad = |words: &&Vec<u32>| words[0] & (BAD_LENGTH | NOT_FINITE) != 0;
        assert!(expected.iter().filter(is_bad).count() > 8, "{}", design.name);
        // Without the bad ones the other answers are the same, but for their numbers.
        let unnumbered = |words: &Vec<u32>| [&[words[0] & 0xffff][..], &words[1..]].concat();
        let good = expected.iter().filter(|words| !is_bad(words)).map(unnumbered);
        let alone = model_answers(&plan, &packets(&plan, 5));
        assert!(good.eq(alone.iter().map(unnumbered)), "{}", design.name);
        let built = built(&plan);
        for mode in Mode::all(5) {
            with_resets(&plan, &built, &mode).unwrap_or_else(|error| panic!("{}: {error}", mode.name));
        }
    });
}

#[test]
fn dropped_frames_leave_the_average_as_it_was() {
    let mut design = designs().swap_remove(0);
    design.hardware.overrun = Overrun::Drop;
    "smooth_drops".clone_into(&mut design.name);
    let plan = planned(&design);
    let sent = with_bad_frames(&plan);
    let pacing = Pacing::Spaced { cycles: plan.timeline.interval_cycles / 2, inside: usize::MAX };
    let traffic = Traffic::new(&sent, timeout(&plan)).with_pacing(pacing).with_drops();
    let outcome = exchange(&mut built(&plan).load(3).expect("loads"), &traffic, |_| ()).expect("runs");
    assert!(outcome.dropped.len() > 5, "{}", outcome.dropped.len());
    judged(&plan, &sent, &outcome).unwrap();
}

/// From which frame on a rate acts that is written in a cycle; none if some answer is that of neither rate.
fn changed(plan: &Plan, built: &Built, sent: &[Vec<u32>], (cycle, rate): (u64, u32)) -> Option<usize> {
    let answers = |change: usize, rate: u32| {
        let mut model = Model::new(plan);
        let mut answer = |(index, packet): (usize, &Vec<u32>)| {
            if index == change {
                model.smooth(rate);
            }
            model.process(packet)
        };
        sent.iter().enumerate().map(&mut answer).collect::<Vec<_>>()
    };
    let mut core = Controlled::new(built.load(5).expect("loads"), 5).expect("has a port");
    core.plan(cycle, Access::Write { address: address::SMOOTHING, data: rate, strobes: 1 });
    let outcome = exchange(&mut core, &Traffic::new(sent, timeout(plan)), |_| ()).expect("runs");
    assert_eq!(core.read(address::SMOOTHING).expect("a reply"), rate);
    let found: Vec<Vec<u32>> = outcome.exchanges.into_iter().map(|exchange| exchange.words).collect();
    (0..sent.len()).find(|&change| answers(change, rate) == found)
}

/// Written at any moment, a rate acts from some frame on: the ones before have the old one.
#[test]
fn a_rate_that_is_written_acts_on_whole_frames() {
    let mut design = designs().swap_remove(0);
    design.hardware.control = true;
    "smooth_control".clone_into(&mut design.name);
    let plan = planned(&design);
    let built = built(&plan);
    let sent = packets(&plan, 3);
    let interval = plan.timeline.interval_cycles;
    let write = |(index, rate): (u64, u32)| (2 * interval + (2 * interval + 13) * index, rate);
    let writes = (0..).zip([0, 1, 3, 5, 8, 15, 0]).map(write);
    let changes: Vec<usize> = writes.map(|write| changed(&plan, &built, &sent, write).expect("one of both")).collect();
    assert!(changes.is_sorted() && changes[0] > 0 && changes[6] > changes[0] + 6, "{changes:?}");
    // In each cycle of an interval, so that stresses of a frame are on their way in some.
    let torn = |built: &Built| {
        (interval..2 * interval).step_by(3).find(|&cycle| changed(&plan, built, &sent[..6], (cycle, 7)).is_none())
    };
    assert_eq!(torn(&built), None);
    let at_once = broken(
        &plan,
        "sptfra_smoothing",
        "if (opens) begin\n            rate_held",
        "if (1'b1) begin\n            rate_held",
    );
    assert!(torn(&at_once).is_some(), "a rate that acts within a frame");
}

/// Steps of a dead taxel are those of a sum: they restart nothing, however large.
#[test]
fn steps_of_replaced_taxels_restart_nothing() {
    let mut design = designs().swap_remove(0);
    (design.input.dead, design.input.smoothing) = (vec![5], 8);
    "smooth_dead".clone_into(&mut design.name);
    let plan = planned(&design);
    let dead = DeadTaxels::new(&design.sensor, design.algorithm.kernel, &[5]);
    let weights = &dead.weights()[0];
    assert!(weights.iter().map(|weight| weight.abs()).sum::<f64>() > 1.1, "{weights:?}");
    // All others step by less than the limit of 6 deviations, so that their sum steps by more.
    let stepped = |step: f64| weights.iter().map(|weight| step.copysign(*weight) - 1000.0).collect::<Vec<_>>();
    let steps = [0.0, 5.95, 0.0, -5.95, 0.0, 5.95].map(|deviations| 1000.0 * NOISE * deviations);
    let sent: Vec<_> = steps.map(|step| packet(&plan, &stepped(step))).into();
    simulate_exactly(&plan, &built(&plan), &sent, 3).unwrap();
    let counted = broken(&plan, "sptfra_smoothing", "(!takes[2] || flags[FLAGS])", "!takes[2]");
    assert!(simulate_exactly(&plan, &counted, &sent, 3).is_err(), "a step of a dead taxel restarts the average");
}

#[test]
fn the_model_averages_as_the_solver_does() {
    for design in designs() {
        let mut alone = design.clone();
        (alone.input.smoothing, alone.input.creep) = (0, None);
        let sent = contacts(&planned(&design), 7);
        let error = |model: &Design, solver: &Design| {
            let plan = planned(model);
            let answers = model_answers(&plan, &sent).into_iter().filter_map(|words| decode(&words));
            let received = sent.iter().map(|packet| plan.streams().received(packet));
            let input = &solver.input;
            let solver = Solver::new(&solver.solved_as_one()).expect("a solution");
            let solutions = solver.solve_in_order(received).expect("whole frames");
            let force = |solution: &Solution| solution.resultant[2].abs();
            let largest = solutions.iter().map(force).fold(0.0, f64::max);
            // Where a contact and what fades of the one before cancel, a force has no scale.
            let (answers, solutions): (Vec<Solution>, Vec<Solution>) =
                answers.zip(solutions).filter(|(_, solution)| force(solution) > 0.02 * largest).unzip();
            assert!(2 * answers.len() > sent.len(), "{}: {} frames have a scale", plan.design.name, answers.len());
            for (n, (answer, solution)) in answers.iter().zip(&solutions).enumerate() {
                let apart = (answer.standard_error / solution.standard_error - 1.0).abs();
                let differ = model.input != *input;
                assert!(differ || apart < 0.02, "{}, frame {n}: {apart}", plan.design.name);
            }
            SolverError::new(&answers, &solutions).resultant_max
        };
        let [smoothed, without, mixed] = [error(&design, &design), error(&alone, &alone), error(&alone, &design)];
        println!("{}: {smoothed}, {without}, {mixed}", design.name);
        assert!(smoothed < 2.0 * without, "{}: {smoothed} {without}", design.name);
        assert!(mixed > 10.0 * smoothed, "{}: {mixed} {smoothed}", design.name);
    }
}

/// With a scale for each frame all is 4 cycles later. With one scale the lanes also wait for the frame's last beat before
/// they get its first element. Element after element comes at most a cycle later then.
#[test]
fn a_shipped_design_is_hardly_later_and_as_often() {
    let sensor1 =
        ["fast", "resultants", "reduced", "small", "fast-64", "fast-100"].map(|name| format!("sensor1-{name}"));
    let names = [&sensor1[..], &["paper", "bed-mat", "small-control"].map(str::to_owned)].concat();
    let late = in_parallel(&names, |name| {
        let mut design = shipped(name);
        let mut later = |scaling: Scaling| {
            design.hardware.scaling = scaling;
            let [(latency, interval), (smoothed, often)] = [0, 4].map(|smoothing| {
                design.input.smoothing = smoothing;
                let timeline = planned(&design).timeline;
                (timeline.latency_cycles, timeline.interval_cycles)
            });
            println!("{name}, {scaling:?}: {latency} {interval}, {smoothed} {often}");
            (smoothed - latency, often == interval)
        };
        let [per_frame, fixed] = [Scaling::PerFrame, Scaling::Fixed].map(&mut later);
        let Sensor { columns, rows, .. } = design.sensor;
        let elements = match design.algorithm.plan {
            PlanKind::Paper => columns * rows,
            PlanKind::Reduced => columns.div_ceil(2) * rows.div_ceil(2),
        };
        (per_frame != (4, true) || fixed.0 > elements as u64 + 3 || !fixed.1)
            .then(|| format!("{name}: {per_frame:?} {fixed:?}"))
    });
    assert_eq!(late.into_iter().flatten().collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn faults_are_noticed() {
    let faults = [
        ("bank <= !bank;", "bank <= bank;"),
        ("if (!is_bad && !out_bad_length) begin", "if (!out_bad_length) begin"),
        ("if (!is_bad && !out_bad_length) begin", "if (!is_bad) begin"),
        ("bank_averaged <= !restarts;", "bank_averaged <= 1'b1;"),
        ("            holds <= 1'b0;\n", ""),
        ("wire restarts = !holds || ", "wire restarts = !holds && "),
        ("localparam SETTLES = 4 + LEVELS;", "localparam SETTLES = 4;"),
        ("takes[1+LEVELS] && (magnitude > most)", "takes[1] && (magnitude > most)"),
        ("rate_held <= rate;", "rate_held <= 4'd1;"),
        ("taken_rate <= restarts ? 4'd0 : rate_held;", "taken_rate <= rate_held;"),
        ("if (settles[1] && is_good) begin", "if (settles[1]) begin"),
        ("$signed({stress_1[26], stress_1, 9'h100}) - old_1", "$signed({stress_1[26], stress_1, 9'h000}) - old_1"),
    ];
    let of_creep = [
        ("if (good_ends) begin", "if (in_ends) begin"),
        ("in_ends && !bad && !in_bad_length", "in_ends && !bad"),
        ("in_ends && !bad && !in_bad_length", "in_ends && !in_bad_length"),
        ("holds_1 ? kept_1 : HALF", "kept_1"),
        ("            holds <= 1'b0;\n", ""),
        ("!bank, place};", "bank, place};"),
        ("{{27{1'b0}}, 1'b1, {(FRACTION-1){1'b0}}}", "{CREEP_BITS{1'b0}}"),
        ("(stress_1 < -MOST)", "1'b0"),
        ("(stress_1 > MOST)", "1'b0"),
        ("- FRACTION - 1)", "- FRACTION)"),
    ];
    // A beat with four samples, which may be no numbers.
    let [averages, creeps] = ["smooth_wide", "smooth_creeps"].map(designed);
    let [free, ..] = Mode::all(5);
    let of_error = [
        ("step < 6'd13", "step < 6'd12"),
        ("radicand <= {1'b0, variance};", "radicand <= {1'b0, 25'd16777216};"),
        ("product <= 30'd0;", "product <= product;"),
    ];
    let faults = faults.map(|fault| (&averages, "sptfra_smoothing", fault)).into_iter();
    let faults = faults.chain(of_error.map(|fault| (&averages, "sptfra_standard_error", fault)));
    let faults = faults.chain(of_creep.map(|fault| (&creeps, "sptfra_creep", fault)));
    let faults = some_faults(faults, |&(_, module, (from, _))| (module, from));
    let missed = in_parallel(&faults, |&(plan, module, (from, to))| {
        with_resets(plan, &broken(plan, module, from, to), &free).is_ok().then_some(from)
    });
    assert_eq!(missed.into_iter().flatten().collect::<Vec<_>>(), Vec::<&str>::new());
}

#[test]
fn resets_in_each_cycle_are_right() {
    let [corrected, wide, creeps] = ["smooth_corrected", "smooth_wide", "smooth_creeps"].map(designed);
    let wrong = in_parallel(&[&corrected, &wide, &creeps], |plan| resets::in_each_cycle(plan, &built(plan)).err());
    assert_eq!(wrong.into_iter().flatten().collect::<Vec<_>>(), Vec::<String>::new());
    // Ends of a frame that a reset leaves.
    let faults = [
        (&corrected, "sptfra_crosstalk", "            lasts <= 3'd0;\n"),
        (&wide, "sptfra_smoothing", "            ends <= {SETTLES{1'b0}};\n"),
        (&creeps, "sptfra_creep", "            ends <= 2'd0;\n"),
    ];
    let faults = some_faults(faults, |&(_, module, from)| (module, from));
    let missed = in_parallel(&faults, |&(plan, module, from)| {
        resets::in_each_cycle(plan, &broken(plan, module, from, "")).is_ok().then_some(module)
    });
    assert_eq!(missed.into_iter().flatten().collect::<Vec<_>>(), Vec::<&str>::new());
}
