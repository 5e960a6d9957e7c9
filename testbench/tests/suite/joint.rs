//! The grid search in hardware: every word and cycle by the model, the model by the solver, the RTL by the truth.

use std::fmt::Write as _;
use std::io::Write as _;

use crate::contacts::{Pressed, Truth, Worst, centred, frames, inside, judged};
use crate::support::effort::some_of;
use crate::support::frames::encode;
use crate::support::{built, in_parallel, planned, shipped, simulate_exactly, with_lanes};
use golden::design::{Design, Optimise, Outputs};
use golden::kernel::Kernel;
use golden::metrics::Outcome;
use golden::scene::{Medium, Shape};
use golden::solver::{Solution, Solver};
use hdl_gen::model::{AT_BOUND, DIRECTION_UNKNOWN, LOW_CONFIDENCE, NO_CONTACT, SATURATED};
use hdl_gen::new_design::NewDesign;
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::accuracy::SolverError;
use testbench::co_simulation::{model_answers, timeout};
use testbench::stream::{Traffic, exchange};
use testbench::stream_words::decode;

const LAYER: Medium = Medium::BondedLayer { poisson: 0.49 };
const SOFTER: Medium = Medium::BondedLayer { poisson: 0.45 };
const HERTZ: Shape = Shape::Hertz { semi_axes_m: [7e-3; 2] };
const DISC: Shape = Shape::Disc { radius_m: 10e-3 };
/// Of contacts; those of the solver's tests.
const SEED: u64 = 0x5eed_0ff0;
const FRICTIONS: [f64; 3] = [0.2, 0.5, 0.8];
/// Of the largest `|f_z|` of a frame. Most of it is the field's own rounding, which the line search has too; the
/// rest is a friction component off by a few of its steps, 2^-16.
const MOST_FIELD_ERROR: f64 = 5e-4;
/// A joint design may have so many times the multipliers of one with the line.
const MOST_TIMES_DSP: usize = 2;

fn designs() -> Vec<Design> {
    ["sensor1-fast", "sensor2-fast"].map(shipped).to_vec()
}

fn uncorrected(mut design: Design) -> Design {
    design.name += "_uncorrected";
    design.algorithm.joint.correction = None;
    design
}

/// What `sptfra new` makes of a layer of 0.4 pitches: the kernel "cell", no correction.
fn thin() -> Design {
    let new = NewDesign { name: "thin".to_owned(), pitch_mm: [4.0; 2], depth_mm: 1.6, ..NewDesign::paper(1) };
    let design = Design::from_toml(&new.text(&mut |_| ()).expect("can be fitted"), "thin").expect("a design");
    assert_eq!(design.algorithm.kernel, Kernel::Cell);
    design
}

fn as_received(packet: &[u32]) -> Vec<f64> {
    packet.iter().map(|&word| f64::from(f32::from_bits(word))).collect()
}

/// Shows a table even of a test that passes.
fn show(table: &str) {
    std::io::stdout().write_all(table.as_bytes()).expect("standard output is open");
}

#[test]
fn cycles_and_multipliers_keep_to_their_limits() {
    let resultants = |mut design: Design| {
        design.name += "_resultants";
        design.algorithm.outputs = Outputs::Resultants;
        design
    };
    let narrow = |mut design: Design| {
        design.name += "_narrow";
        design.hardware.stream_bits = 32;
        design
    };
    let small_area = |mut design: Design| {
        design.name += "_area";
        design.hardware.optimise = Optimise::Area;
        design
    };
    // Latency and interval, the longer answer included, DSP and RAMB36, at most.
    let rows = [
        (shipped("sensor1-fast"), "sensor1-reduced", [2_643, 1_640], [50, 36]),
        (shipped("sensor2-fast"), "sensor2-reduced", [2_619, 1_640], [50, 30]),
        // A row of points at a time.
        (small_area(shipped("sensor1-fast")), "sensor1-reduced", [3_843, 1_640], [50, 36]),
        (shipped("sensor2-wide"), "sensor2-reduced", [2_835, 1_640], [51, 34]),
        // Sixteen hidden units at a time.
        (narrow(shipped("sensor1-fast-64")), "sensor1-reduced-64", [1_356, 470], [146, 44]),
        (shipped("sensor1-fast-64"), "sensor1-reduced-64", [1_057, 470], [149, 44]),
        // Two taxels a cycle, a row of points weighed in one, and a collector that looks ahead.
        (shipped("sensor1-fast-100"), "sensor1-reduced-64", [876, 340], [193, 67]),
        (with_lanes(shipped("sensor1-fast-100"), 128), "sensor1-reduced-64", [889, 352], [221, 84]),
        (uncorrected(shipped("sensor1-fast")), "sensor1-reduced", [2_115, 1_640], [26, 28]),
        (thin(), "sensor2-reduced", [2_146, 1_640], [26, 22]),
        (resultants(shipped("sensor1-fast")), "sensor1-resultants", [1_954, 704], [49, 22]),
        (resultants(with_lanes(shipped("sensor1-fast-100"), 64)), "sensor1-resultants", [885, 217], [145, 24]),
    ];
    let lines = in_parallel(&rows, |(design, line, most_cycles, most)| {
        let (plan, line) = (planned(design), planned(&with_lanes(shipped(line), design.hardware.lanes)));
        let (latency, interval) = (plan.timeline.latency_cycles, plan.timeline.interval_cycles);
        let [most_latency, most_interval] = *most_cycles;
        assert!(latency <= most_latency && interval <= most_interval, "{}: {latency}, {interval} cycles", design.name);
        let more = latency as i64 - line.timeline.latency_cycles as i64;
        assert!(plan.resources.dsp <= MOST_TIMES_DSP * line.resources.dsp, "{}", design.name);
        let (dsp, bram36) = (plan.resources.dsp, plan.resources.bram36);
        let [most_dsp, most_bram36] = *most;
        let few = dsp <= most_dsp && bram36 <= most_bram36 as f64;
        assert!(few, "{}: {dsp} DSP, {bram36} RAMB36", design.name);
        format!("{:<30}{latency:>10}{more:>10}{interval:>10}{dsp:>6}{bram36:>8}\n", design.name)
    });
    // Latency and interval as predicted, and every word in every mode.
    in_parallel(&some_of(&rows), |(design, ..)| {
        let (plan, mut random) = (planned(design), ChaCha8Rng::seed_from_u64(5));
        let mut packets = crate::support::frames::extremes(&plan, &mut random);
        packets.extend((0..12).map(|_| crate::support::frames::contact(&plan, &mut random)));
        packets.push(crate::support::frames::noise(&plan, 1.0, &mut random));
        if let Err(error) = simulate_exactly(&plan, &built(&plan), &packets, 1) {
            panic!("{}: {error}", design.name);
        }
    });
    let heads = ["predicted", "latency", "more", "interval", "DSP", "BRAM"];
    let [name, latency, more, interval, dsp, bram36] = heads;
    show(&format!("\n{name:<30}{latency:>10}{more:>10}{interval:>10}{dsp:>6}{bram36:>8}\n{}\n", lines.concat()));
}

/// Contacts in the middle, right between four taxels, and anywhere; with all their directions, frictions, noise.
fn seeded(design: &Design) -> Vec<Truth> {
    let sensor = &design.sensor;
    let sets = [centred(sensor, LAYER, HERTZ), centred(sensor, LAYER, DISC), inside(sensor, LAYER, SEED, 60)];
    let of = |set: &Vec<Pressed>| -> Vec<Truth> {
        let each = FRICTIONS.into_iter().flat_map(|friction| [(friction, 0.0), (friction, 0.002)]);
        each.flat_map(|(friction, noise)| frames(set, friction, noise)).collect()
    };
    sets.iter().flat_map(of).collect()
}

#[test]
fn the_model_is_close_to_the_solver() {
    let more = ["sensor1-fast-64", "sensor1-wide", "sensor2-wide"].map(shipped);
    let corrected: Vec<Design> = designs().into_iter().chain(more).collect();
    let all = some_of(corrected.iter().cloned().chain(corrected.iter().cloned().map(uncorrected)).chain([thin()]));
    let lines = in_parallel(&all, |design| {
        let (plan, solver) = (planned(design), Solver::new(design).expect("a solver"));
        let packets: Vec<Vec<u32>> = seeded(design).iter().map(|truth| encode(&truth.frame)).collect();
        let (mut field, mut friction) = (0.0_f64, 0.0_f64);
        for (index, (packet, words)) in packets.iter().zip(model_answers(&plan, &packets)).enumerate() {
            let solution = solver.solve(&as_received(packet)).expect("a frame of the right length");
            let answer = decode(&words).expect("a whole frame");
            // Right at the limit of confidence a digit decides.
            let limit = design.algorithm.max_standard_error * solution.resultant[2].abs();
            let undecided = (solution.standard_error - limit).abs() < 0.02 * limit;
            let either = if undecided { LOW_CONFIDENCE } else { 0 };
            assert_eq!(answer.status.0 | either, solution.status.0 | either, "{}, frame {index}: status", design.name);
            let apart = (answer.standard_error - solution.standard_error).abs();
            assert!(apart <= 0.02 * solution.standard_error, "{}, frame {index}: {apart} N", design.name);
            let off = [answer.mu_x - solution.mu_x, answer.mu_y - solution.mu_y];
            friction = off.iter().fold(friction, |most, off| most.max(off.abs()));
            let error = SolverError::new(&[answer], &[solution]);
            assert!(error.field_max <= MOST_FIELD_ERROR, "{}, frame {index}: {error:?}", design.name);
            field = field.max(error.field_max);
        }
        format!("{:<28}{:>8}{field:>12.2e}{friction:>12.2e}\n", design.name, packets.len())
    });
    let [name, count, field, friction] = ["against f64", "frames", "field", "friction"];
    show(&format!("\n{name:<28}{count:>8}{field:>12}{friction:>12}\n{}\n", lines.concat()));
}

/// What the RTL answers to frames sent back to back, each word compared with the model's.
fn simulated(plan: &Plan, frames: &[Truth]) -> Vec<Solution> {
    let packets: Vec<Vec<u32>> = frames.iter().map(|truth| encode(&truth.frame)).collect();
    let mut core = built(plan).load(1).expect("loaded");
    let outcome = exchange(&mut core, &Traffic::new(&packets, timeout(plan)), |_| ()).expect("answered");
    let words: Vec<Vec<u32>> = outcome.exchanges.into_iter().map(|exchange| exchange.words).collect();
    assert_eq!(words, model_answers(plan, &packets), "{}", plan.design.name);
    words.iter().map(|words| decode(words).expect("a whole frame")).collect()
}

fn outcome(answer: &Solution) -> (u32, Outcome) {
    (answer.status.0, Outcome::from(answer))
}

/// The goals of the estimator, in RTL, cycle by cycle: the limits are those of the solver's tests.
#[test]
fn the_rtl_reaches_what_the_solver_reaches() {
    // Sensor, set, largest tangential error in percent at each friction, with noise, and the largest e_Fz.
    let cases: Vec<_> = designs()
        .into_iter()
        .flat_map(|design| {
            let sensor = design.sensor.clone();
            let middle = |medium, shape| centred(&sensor, medium, shape);
            [
                ("Hertz", middle(LAYER, HERTZ), [6.0, 3.0, 6.0], 8.0, 2.1),
                ("disc", middle(LAYER, DISC), [6.0, 3.0, 6.0], 8.0, 2.1),
                ("Hertz, nu 0.45", middle(SOFTER, HERTZ), [9.0, 4.5, 9.0], 12.0, 3.0),
                ("disc, nu 0.45", middle(SOFTER, DISC), [9.0, 4.5, 9.0], 12.0, 3.0),
                ("200 inside", inside(&sensor, LAYER, SEED, 200), [7.0, 5.0, 7.0], 8.0, 3.1),
            ]
            .map(|(name, set, clean, noisy, normal)| (design.clone(), name, set, clean, noisy, normal))
        })
        .collect();
    let lines = in_parallel(&some_of(&cases), |(design, name, set, clean, noisy, normal)| {
        let plan = planned(design);
        let runs: Vec<(f64, f64, f64)> = [(0.0, *clean), (0.002, [*noisy; 3])]
            .into_iter()
            .flat_map(|(noise, limits)| FRICTIONS.into_iter().zip(limits).map(move |(mu, limit)| (noise, mu, limit)))
            .collect();
        let sets: Vec<Vec<Truth>> = runs.iter().map(|&(noise, friction, _)| frames(set, friction, noise)).collect();
        let lengths: Vec<usize> = sets.iter().map(Vec::len).collect();
        let all: Vec<Truth> = sets.into_iter().flatten().collect();
        let answers = simulated(&plan, &all);
        let mut line = format!("{:<16}{name:<16}", design.name);
        let mut first = 0;
        for ((noise, friction, limit), length) in runs.into_iter().zip(lengths) {
            let part = first..first + length;
            first += length;
            let Worst { error: [x, y, z], flagged, .. } = judged(&all[part.clone()], answers[part].iter().map(outcome));
            // The goals for the normal force are those without noise, in the middle at a friction of 0.5.
            let normal = match *name {
                "200 inside" if noise == 0.0 => 3.0,
                "Hertz" | "disc" if noise == 0.0 && (0.4..0.6).contains(&friction) => 2.0,
                _ => *normal,
            };
            let case = format!("{} {name}, friction {friction}, noise {noise}", design.name);
            assert!(x <= limit && y <= limit && z <= normal, "{case}: {x:.2} {y:.2} over {limit}, {z:.2}");
            assert_eq!(flagged, 0, "{case}");
            // Writing to a String cannot fail.
            let _ = write!(line, "{:>7.1}", x.max(y));
        }
        line + "\n"
    });
    show(&format!(
        "\nlargest tangential error in %, simulated; without and with 0.2 % noise at 0.2, 0.5, 0.8\n{}\n",
        lines.concat()
    ));
}

/// Frames at the ends of what there is to find; RTL and model agree on them in the tests above.
#[test]
fn frames_without_a_plain_answer_say_so() {
    let design = shipped("sensor1-fast");
    let plan = planned(&design);
    let taxels = plan.taxels();
    let full_scale = design.hardware.full_scale_pa;
    let step = plan.formats.stress.step();
    let answer = |frame: Vec<f64>| decode(&model_answers(&plan, &[encode(&frame)])[0]).expect("a whole frame");
    let with = |taxel: usize, value: f64, rest: f64| {
        let mut frame = vec![rest; taxels];
        frame[taxel] = value;
        answer(frame)
    };
    assert_eq!(answer(vec![0.0; taxels]).status.0, NO_CONTACT);
    assert_eq!(with(44, -step, 0.0).status.0, NO_CONTACT, "one step of one taxel is below the floor");
    // Nothing presses, so nothing limits the friction.
    let pulled = answer(vec![500.0; taxels]);
    assert_eq!((pulled.status.0, pulled.mu_x, pulled.mu_y), (DIRECTION_UNKNOWN | LOW_CONFIDENCE, 0.0, 0.0));
    let clipped = with(44, -2.0 * full_scale, 0.0);
    assert_eq!(clipped.status.0 & SATURATED, SATURATED);
    // One taxel alone is a contact in its middle: no push.
    let alone = with(44, -0.1 * full_scale, 0.0);
    assert_eq!(alone.status.0 & (NO_CONTACT | DIRECTION_UNKNOWN | SATURATED), 0);
    // Tension on one side only, far more than friction explains.
    let dragged = answer((0..taxels).map(|taxel| if taxel % 10 < 5 { 3e4 } else { -3e4 }).collect());
    assert_eq!(dragged.status.0 & AT_BOUND, AT_BOUND, "{dragged:?}");
    // The least stress that is a contact: the grid's values are then a few steps each.
    let mut faint = design.clone();
    faint.algorithm.noise_floor_pa = 1e-3;
    let faint = planned(&faint);
    let mut frame = vec![0.0; taxels];
    frame[44] = -(faint.thresholds.contact as f64) * step;
    let answer = decode(&model_answers(&faint, &[encode(&frame)])[0]).expect("a whole frame");
    assert!(answer.status.0 & (NO_CONTACT | SATURATED) == 0 && answer.mu_x.abs().max(answer.mu_y.abs()) <= 1.5);
}
