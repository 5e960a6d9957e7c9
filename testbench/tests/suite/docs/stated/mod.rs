//! The figures that README and docs state of designs, against what `hdl-gen inspect` says of them.

use std::fs;

use golden::design::{CalibrationIn, Design, InputRange, Kernel, MAX_LANES, Outputs, Samples};
use hdl_gen::inspection::figures;
use hdl_gen::plan::Plan;

use self::read::{Claim, figure, is, of_sentence, of_tables, pages};
use crate::support::{in_parallel, shipped, workspace};

mod read;

type Change = fn(&mut Design);

/// Rows of tables whose design is none of the shipped ones, or is not named: page, how the row begins, the shipped design
/// that it is made of, and how.
const VARIED: [(&str, &str, &str, Change); 21] = [
    ("accuracy.md", "sensor 1, point, no filter", "sensor1-reduced", as_it_is),
    ("accuracy.md", "sensor 1, cell, no filter", "sensor1-reduced", |design| design.algorithm.kernel = Kernel::Cell),
    ("accuracy.md", "sensor 1, point, F3", "sensor1-f3", as_it_is),
    ("accuracy.md", "sensor 2, point, no filter", "sensor2-reduced", as_it_is),
    ("accuracy.md", "sensor 2, cell, no filter", "sensor2-reduced", |design| design.algorithm.kernel = Kernel::Cell),
    ("accuracy.md", "sensor 2, point, F3", "sensor2-f3", as_it_is),
    ("architecture.md", "joint, 15 × 15 points, 64 lanes", "sensor1-fast-64", as_it_is),
    ("contacts.md", "`sensor1-fast-64` with streams of 32 bits", "sensor1-fast-64", narrow),
    ("contacts.md", "the same for four", "sensor1-fast-64", |design| {
        narrow(design);
        design.algorithm.contacts = 4;
    }),
    ("estimators.md", "sensor 1 or 2, line", "sensor1-reduced", as_it_is),
    ("estimators.md", "sensor 1, joint, no correction", "sensor1-joint", |design| {
        design.algorithm.joint.correction = None;
    }),
    ("estimators.md", "sensor 1, joint |", "sensor1-joint", as_it_is),
    ("estimators.md", "sensor 2, joint |", "sensor2-joint", as_it_is),
    ("estimators.md", "joint, 64 lanes, 64 multipliers", "sensor1-fast-64", narrow),
    ("estimators.md", "the same with 128 lanes |", "sensor1-fast-100", most_lanes),
    ("estimators.md", "the same with 64 lanes, resultants only", "sensor1-fast-100", few_resultants),
    ("estimators.md", "the same with 128 lanes, resultants only", "sensor1-fast-100", |design| {
        resultants(design);
        most_lanes(design);
    }),
    ("estimators.md", "sensor 1, line, 128 lanes", "sensor1-reduced-64", |design| {
        most_lanes(design);
        design.hardware.stream_bits = 128;
    }),
    ("estimators.md", "joint, 15 × 15 points, no correction, 16 × 16 taxels, 100", "sensor1-fast-64", |design| {
        larger(design);
        hundred_lanes(design);
    }),
    ("estimators.md", "the same 16 × 16 with 128 lanes", "sensor1-fast-64", |design| {
        larger(design);
        most_lanes(design);
    }),
    ("estimators.md", "sensor 1, joint, 15 × 15 points, resultants only", "sensor1-fast", resultants),
];

fn narrow(design: &mut Design) {
    design.hardware.stream_bits = 32;
}

fn hundred_lanes(design: &mut Design) {
    design.hardware.lanes = 100;
}

fn most_lanes(design: &mut Design) {
    design.hardware.lanes = MAX_LANES;
}

fn larger(design: &mut Design) {
    (design.sensor.columns, design.sensor.rows) = (16, 16);
    design.algorithm.joint.correction = None;
}

fn few_resultants(design: &mut Design) {
    resultants(design);
    design.hardware.lanes = 64;
}

fn own_range(design: &mut Design) {
    design.hardware.range = InputRange::Frame;
}

fn integers(design: &mut Design) {
    design.hardware.samples = Samples::Int16;
    design.input.pa_per_count = Some(1.0);
}

fn integers_in_ram(design: &mut Design) {
    integers(design);
    design.hardware.control = true;
    design.hardware.calibration = CalibrationIn::Ram;
}

/// What `hdl-gen new` writes beside the estimator.
fn as_new(design: &mut Design) {
    own_range(design);
    design.algorithm.count_bodies = true;
}

fn resultants(design: &mut Design) {
    design.algorithm.outputs = Outputs::Resultants;
}

/// Rows that state figures of others.
const OF_OTHERS: [&str; 3] = ["published: ", "the line as it was", "the joint estimator as it was"];
/// What tables of other things than designs have in their first column.
const NO_DESIGNS: [&str; 4] = ["block", "core", "stage", "taxels"];

/// Sentences, with a figure's name in braces where it is stated: page, shipped design, what is changed in it, the words.
const SENTENCES: [(&str, &str, Change, &str); 28] = [
    ("README.md", "sensor1-fast-100", as_it_is, "taxels takes {us} to"),
    ("README.md", "sensor1-joint", as_it_is, "to {us} µs, on"),
    ("README.md", "sensor1-resultants", as_it_is, "µs, on {dsp} to"),
    ("README.md", "sensor1-fast-100", as_it_is, "to {dsp} DSP: [how fast"),
    ("README.md", "sensor1-joint", as_it_is, "taxels in hardware: {rate}; with"),
    ("README.md", "sensor1-fast", as_it_is, "with `grid = 15` {rate}, and"),
    ("README.md", "sensor1-fast-64", as_it_is, "and {rate} on 64 lanes with streams of 128 bits"),
    ("README.md", "sensor1-joint", as_it_is, "joint estimator, whole field: {dsp} DSP, {bram} RAMB36; as"),
    ("README.md", "sensor1-fast", as_it_is, "as `sensor1-fast` {dsp} DSP, {bram} RAMB36 and"),
    ("README.md", "bed-mat", as_it_is, "{rate} frames a second on {dsp} DSP and {bram} RAMB36 (predicted)"),
    ("README.md", "sensor1-bodies", two_bodies, "in place of 4 it is {latency} cycles, {dsp} DSP and {bram} BRAM"),
    ("choosing.md", "sensor1-resultants", as_it_is, "not needed: {latency} cycles with 16 lanes"),
    ("choosing.md", "sensor1-fast-64", own_range, "taxels: {latency} cycles in place of"),
    ("choosing.md", "sensor1-fast-64", as_it_is, "in place of {latency} for `sensor1-fast-64`"),
    ("choosing.md", "sensor1-fast", as_it_is, "`sensor1-fast` so takes some {mW} mW"),
    ("accuracy.md", "sensor1-joint", as_it_is, "it takes {latency} cycles a frame in place of"),
    ("accuracy.md", "sensor1-reduced", as_it_is, "cycles a frame in place of {latency}, an"),
    ("accuracy.md", "sensor1-joint", as_it_is, "an interval of {interval}, {dsp} DSP and {bram} BRAM"),
    ("accuracy.md", "sensor1-fast", as_it_is, "it takes {latency} cycles at an interval of {interval}, and errs"),
    ("architecture.md", "sensor1-reduced", as_it_is, "| **latency** | **{latency}** |"),
    ("estimators.md", "sensor1-fast-64", as_it_is, "| **latency** | {latency} |"),
    ("estimators.md", "sensor1-fast-100", few_resultants, "| **interval** | 470 | {interval} (376) |"),
    ("estimators.md", "sensor1-fast-100", as_it_is, "{interval} (457) | | lanes"),
    (
        "estimators.md",
        "sensor1-clipped",
        as_it_is,
        "`sensor1-clipped` takes {latency} cycles at an interval of {interval}, {dsp} DSP and {bram} RAMB36",
    ),
    ("estimators.md", "sensor2-clipped", as_it_is, "`sensor2-clipped` {latency} and {interval}."),
    ("streams.md", "sensor1-fast-64", integers_in_ram, "latency: {latency} cycles in place"),
    ("streams.md", "sensor1-fast-64", integers, "cycles in place of {latency}."),
    ("estimators.md", "sensor1-fast", as_new, "units {latency} cycles, at the same"),
];

fn as_it_is(_: &mut Design) {}

fn two_bodies(design: &mut Design) {
    design.algorithm.contacts = 2;
}

/// Figures of the front pages that are of no one plan: a difference, of the published design, assumed; of several bodies,
/// which `told_apart` compares with simulation.
const NOT_OURS: [&str; 5] = [
    "takes 297 cycles",
    "7,335,000 cycles",
    "At 1,000 frames a second",
    "two bodies takes 15,875 cycles",
    "5,878 frames a second",
];
/// What makes a number a figure of a design.
const UNITS: [&str; 6] = ["DSP", "RAMB36", "BRAM", "cycles", "frames a second", "µs"];

/// Each figure of the claims that is not the plan's.
fn wrong(claims: &[Claim]) -> Vec<String> {
    let mut designs: Vec<&Design> = Vec::new();
    for claim in claims.iter().filter(|claim| !claim.figures.is_empty()) {
        if !designs.contains(&&claim.design) {
            designs.push(&claim.design);
        }
    }
    let predicted = in_parallel(&designs, |design| {
        let plan = Plan::new(design).unwrap_or_else(|error| panic!("{}: {error}", design.name));
        figures(&plan)["predicted"].take()
    });
    let mut wrong = Vec::new();
    for Claim { place, design, figures } in claims {
        for (name, stated) in figures {
            let at = designs.iter().position(|known| *known == design).expect("planned");
            let found = figure(&predicted[at], name);
            if !is(*stated, found) {
                wrong.push(format!("{place}\n    states {name} {}, the plan says {found}", stated.0));
            }
        }
    }
    wrong
}

/// The lines of a page that no claim is of, as one.
fn prose(text: &str, claims: &[Claim]) -> String {
    let of_claim = |line: &&str| claims.iter().any(|claim| line.starts_with('|') && claim.place.ends_with(line));
    let lines = text.lines().filter(|line| !of_claim(line));
    lines.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

/// Numbers with the unit of a figure that a page has and no claim is of.
fn unclaimed(prose: &str) -> Vec<String> {
    let units = UNITS.iter().flat_map(|unit| prose.match_indices(&format!(" {unit}")).collect::<Vec<_>>());
    let counted = units.filter(|(at, _)| prose[..*at].ends_with(|letter: char| letter.is_ascii_digit()));
    let around = counted.map(|(at, unit)| {
        let begin = prose[..at].char_indices().rev().nth(40).map_or(0, |(begin, _)| begin);
        format!("{}{unit}", &prose[begin..at])
    });
    around.filter(|around| !NOT_OURS.iter().any(|known| around.ends_with(known))).collect()
}

#[test]
fn figures_of_designs_are_those_of_their_plans() {
    let pages = pages();
    let mut claims: Vec<Claim> = pages.iter().flat_map(|(page, text)| of_tables(page, text)).collect();
    let in_tables = claims.iter().map(|claim| claim.figures.len()).sum::<usize>();
    assert!(in_tables > 150, "only {in_tables} figures were found in tables");
    let mut prose: Vec<(&str, String)> =
        pages.iter().map(|(page, text)| (page.as_str(), prose(text, &claims))).collect();
    for (page, stem, change, words) in SENTENCES {
        let mut design = shipped(stem);
        change(&mut design);
        let (_, text) = prose.iter_mut().find(|(name, _)| *name == page).expect("a page");
        claims.push(of_sentence(page, text, design, words));
    }
    let mut wrong = wrong(&claims);
    // The front pages state nothing beside.
    for (page, text) in prose.iter().filter(|(page, _)| ["README.md", "choosing.md"].contains(page)) {
        let named =
            |around| format!("{page}: …{around}: is compared with nothing; state it in a table, or in SENTENCES");
        wrong.extend(unclaimed(text).into_iter().map(named));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The published design's times and multipliers, over ours: what the README says in words.
#[test]
fn the_readme_compares_with_the_published_design_as_the_plans_do() {
    let readme = fs::read_to_string(workspace("README.md")).expect("readable");
    let readme = readme.split_whitespace().collect::<Vec<_>>().join(" ");
    let of = |stem: &str, name: &str| {
        let plan = Plan::new(&shipped(stem)).expect("a plan");
        figure(&figures(&plan)["predicted"], name)
    };
    for (words, ratio, from, to) in [
        ("fifteen hundred times as fast as", 28_760.0 / of("sensor1-reduced", "us"), 1450.0, 1600.0),
        ("three thousand times as fast as", 58_680.0 / of("sensor1-reduced", "us"), 3000.0, 3300.0),
        ("six hundred times as fast as", 28_760.0 / of("sensor1-joint", "us"), 600.0, 700.0),
        ("on a sixteenth of their multipliers", 568.0 / of("sensor1-reduced", "dsp"), 15.5, 16.5),
    ] {
        assert!(readme.contains(words), "the README says no more {words:?}");
        assert!((from..=to).contains(&ratio), "the README says {words:?}, the plans {ratio:.1}");
    }
}

/// A figure that is off by one, and a row without a design, are found.
#[test]
fn a_figure_that_no_plan_tells_is_found() {
    let table = "| design | latency | DSP |\n|---|---|---|\n| `sensor1-resultants` | 1,636 cycles | 35 |\n";
    let found = wrong(&of_tables("README.md", table));
    assert!(matches!(&found[..], [one] if one.contains("states latency 1636, the plan says 1635")), "{found:?}");
    let unnamed = table.replace("`sensor1-resultants`", "ours");
    assert!(std::panic::catch_unwind(|| of_tables("README.md", &unnamed)).is_err());
    assert_eq!(unclaimed("a frame takes 2,324 cycles on 9 DSP").len(), 2);
}
