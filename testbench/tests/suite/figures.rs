//! The figures that the paper's two sensors must reach: cycles, busy lanes, error. Printed as tables, also when the
//! tests pass.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;

use crate::support::designs::{folders, paper};
use crate::support::effort::some_of;
use crate::support::frames::encode;
use crate::support::{built, in_parallel, planned, shipped, simulate_exactly, with_lanes, workspace};
use golden::design::{Design, Optimise};
use golden::scene::Scene;
use golden::solver::Solver;
use hdl_gen::plan::Plan;
use hdl_gen::plan::product::{Coefficients, Product};
use testbench::accuracy::SolverError;
use testbench::co_simulation::model_answers;
use testbench::frame_set::FrameSet;
use testbench::stream_words::decode;

/// Of the largest `|f_z|` of a frame; of resultants, of `|F_z|`.
const MOST_FIELD_ERROR: f64 = 2e-3;
const LEAST_BUSY: f64 = 0.9;
const LEAST_BUSY_REDUCED: f64 = 0.95;

/// Shows a table even of a test that passes: what goes to the stream itself is not captured.
fn show(table: &str) {
    std::io::stdout().write_all(table.as_bytes()).expect("standard output is open");
}

/// Share of its lane cycles in which each sparse product multiplies. The combination of the residual's parts, three
/// entries a row, is none of a matrix.
fn least_busy_product(plan: &Plan) -> f64 {
    let pes = plan.pes() as u64;
    let of_matrix = |product: &Product| product.coefficients == Coefficients::Rom;
    let windows = plan.products.iter().zip(&plan.schedule.windows).filter(|(product, _)| of_matrix(product));
    windows.map(|(_, window)| window.macs as f64 / (window.length * pes) as f64).fold(1.0, f64::min)
}

/// What a reduced design must keep to.
struct Limits {
    latency: u64,
    interval: u64,
    dsp: usize,
    bram36: f64,
}

/// Sensor 1 by the reduced plan, and a mat of 18 by 27, whose cycles nobody has stated: as predicted, and some simulated.
#[test]
fn the_reduced_plan_keeps_to_its_limits() {
    let mut mat = shipped("sensor1-reduced");
    "mat_18x27".clone_into(&mut mat.name);
    (mat.sensor.columns, mat.sensor.rows) = (18, 27);
    let latency = |mut design: Design| {
        design.name += "_for_latency";
        design.hardware.optimise = Optimise::Latency;
        design
    };
    let wide = |mut design: Design| {
        design.name += "_wide";
        design.hardware.stream_bits = 128;
        design
    };
    let limits = |latency, interval, dsp, bram36| Some(Limits { latency, interval, dsp, bram36 });
    let rows = [
        (shipped("sensor1-reduced"), limits(3_000, 2_000, 40, 40.0)),
        (latency(shipped("sensor1-reduced")), None),
        (shipped("sensor1-reduced-64"), limits(1_220, 480, 100, 45.0)),
        (wide(shipped("sensor1-reduced-64")), limits(900, 480, 110, 45.0)),
        (shipped("sensor1-resultants"), limits(1_900, 1_100, 40, 30.0)),
        (shipped("sensor2-reduced"), limits(3_000, 2_000, 40, 40.0)),
        (mat, None),
    ];
    let lines = in_parallel(&rows, |(design, limits)| {
        let name = &design.name;
        let plan = planned(design);
        let (latency, interval) = (plan.timeline.latency_cycles, plan.timeline.interval_cycles);
        let (dsp, bram36) = (plan.resources.dsp, plan.resources.bram36);
        if let Some(limits) = limits {
            assert!(latency <= limits.latency && interval <= limits.interval, "{name}: {latency}, {interval} cycles");
            assert!(dsp <= limits.dsp && bram36 <= limits.bram36, "{name}: {dsp} DSP, {bram36} BRAM");
        }
        let least = least_busy_product(&plan);
        assert!(least >= LEAST_BUSY_REDUCED, "{name}: lanes busy {least} in a product");
        let lanes = design.hardware.lanes;
        format!("{name:<30}{lanes:>5}{latency:>10}{interval:>10}{dsp:>6}{bram36:>8}{:>9.1} %\n", 100.0 * least)
    });
    in_parallel(&some_of(&rows), |(design, _)| takes_what_is_predicted(design, &planned(design)));
    show(&format!(
        "\n{:<30}{:>5}{:>10}{:>10}{:>6}{:>8}{:>11}\n{}\n",
        "predicted",
        "lanes",
        "latency",
        "interval",
        "DSP",
        "BRAM",
        "least busy",
        lines.concat()
    ));
}

/// Latency and interval as predicted, and every word.
fn takes_what_is_predicted(design: &Design, plan: &Plan) {
    if let Err(error) = simulate_exactly(plan, &built(plan), &some_packets(design), 1) {
        panic!("{}: {error}", design.name);
    }
}

/// A few directions of the standing scene: latency does not depend on data, and the errors are judged elsewhere.
fn some_packets(design: &Design) -> Vec<Vec<u32>> {
    let frames = FrameSet::standing(&design.sensor).expect("frames");
    frames.stress.iter().step_by(5).map(|stress| encode(stress)).collect()
}

#[test]
fn sensor_1_answers_in_time_and_its_lanes_are_busy() {
    let rows = [
        (shipped("sensor1-none"), Some(12_000)),
        (shipped("sensor1-f1-l40"), Some(10_500)),
        (with_lanes(shipped("sensor1-f1-l40"), 64), Some(3_800)),
        (shipped("sensor1-f2-p30"), None),
    ];
    let lines = in_parallel(&rows, |(design, most)| {
        let plan = planned(design);
        let (latency, lanes) = (plan.timeline.latency_cycles, design.hardware.lanes);
        assert!(most.is_none_or(|most| latency <= most), "{}: {latency} cycles", design.name);
        let (busy, least) = (plan.schedule.busy_fraction(), least_busy_product(&plan));
        assert!(busy >= LEAST_BUSY, "{}: lanes busy {busy}", design.name);
        assert!(lanes > 16 || least >= LEAST_BUSY, "{}: lanes busy {least} in a product", design.name);
        let most = most.map_or_else(String::new, |most| most.to_string());
        let interval = plan.timeline.interval_cycles;
        let (busy, least) = (100.0 * busy, 100.0 * least);
        format!("{:<24}{lanes:>5}{latency:>10}{most:>10}{interval:>10}{busy:>9.1} %{least:>9.1} %\n", design.name)
    });
    in_parallel(&some_of(&rows), |(design, _)| takes_what_is_predicted(design, &planned(design)));
    show(&format!(
        "\n{:<24}{:>5}{:>10}{:>10}{:>10}{:>11}{:>11}\n{}\n",
        "predicted",
        "lanes",
        "latency",
        "at most",
        "interval",
        "lanes busy",
        "least",
        lines.concat()
    ));
}

/// The designs of both sensors: files, and the paper's variants.
fn sensor_designs() -> Vec<String> {
    let entries = folders().into_iter().flat_map(|folder| fs::read_dir(folder).expect("a folder of designs"));
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
        .filter(|name| name.starts_with("sensor1-") || name.starts_with("sensor2-"))
        .chain(paper())
        .collect();
    names.sort();
    names
}

/// The standing frames of the design's sensor and those of the shipped scenes that have the same one.
fn all_frames(design: &Design) -> Vec<Vec<f64>> {
    let mut stress = FrameSet::standing(&design.sensor).expect("frames").stress;
    for file in ["scenes/sensor1-hertz.toml", "scenes/sensor2-disc.toml"] {
        let scene = Scene::load(&workspace(file)).expect("a good scene");
        if scene.sensor == design.sensor {
            stress.extend(scene.frames().expect("frames").into_iter().map(|frame| frame.stress));
        }
    }
    stress
}

/// The model stands in for the RTL: the other tests show that it gives the same words.
#[test]
fn the_field_of_every_frame_is_close_to_the_solver() {
    let names = sensor_designs();
    for filter in ["none", "f1-l40", "f3", "reduced", "fast"] {
        for sensor in ["sensor1", "sensor2"] {
            assert!(names.contains(&format!("{sensor}-{filter}")), "{sensor}-{filter}");
        }
    }
    let lines = in_parallel(&names, |name| {
        let design = shipped(name);
        let plan = planned(&design);
        let solver = Solver::new(&design).expect("a solver");
        let packets: Vec<Vec<u32>> = all_frames(&design).iter().map(|stress| encode(stress)).collect();
        let mut worst = SolverError::default();
        for (index, (packet, words)) in packets.iter().zip(model_answers(&plan, &packets)).enumerate() {
            let stress: Vec<f64> = packet.iter().map(|&word| f64::from(f32::from_bits(word))).collect();
            let solution = solver.solve(&stress).expect("a frame of the right length");
            let answer = decode(&words).expect("a whole frame");
            assert_eq!(answer.status, solution.status, "{name}, frame {index}: status");
            let error = SolverError::new(&[answer], &[solution]);
            let most = error.field_max.max(error.resultant_max);
            assert!(most <= MOST_FIELD_ERROR, "{name}, frame {index}: {error:?}");
            worst.field_max = worst.field_max.max(error.field_max);
            worst.resultant_max = worst.resultant_max.max(error.resultant_max);
        }
        let compared = if plan.field_words() > 0 { worst.field_max } else { worst.resultant_max };
        assert!(packets.len() >= 36 && compared > 0.0, "{name}: {} frames, {worst:?}", packets.len());
        (packets.len(), worst)
    });
    let mut table = format!("\n{:<24}{:>8}{:>14}{:>14}\n", "against f64", "frames", "field", "resultants");
    for (name, (frames, error)) in names.iter().zip(lines) {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{name:<24}{frames:>8}{:>14.2e}{:>14.2e}", error.field_max, error.resultant_max);
    }
    show(&format!("{table}\n"));
}
