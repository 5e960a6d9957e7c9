//! `sptfra_contact_counter` by itself, against the integer model and the solver's own count.

use std::fmt::Write as _;
use std::fs;

use golden::contacts::{Finder, Regions};
use golden::parity::Orbits;
use golden::sensor::Sensor;
use hdl_gen::model::contacts::count;
use hdl_gen::timing::latency;
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::faults::some_faults;
use crate::support::in_parallel;
use crate::support::player::{verilator, write_broken};

/// Bits of `|w|`.
const BITS: u32 = 12;
const MOST: i64 = (1 << BITS) - 1;

/// A grid, how its weights come, and what they are.
struct Case {
    name: &'static str,
    channels: usize,
    sensor: Sensor,
    frames: Vec<Vec<i64>>,
}

impl Case {
    fn new(name: &'static str, channels: usize, [columns, rows]: [usize; 2]) -> Self {
        let sensor = Sensor { columns, rows, pitch_mm: [2.0, 2.0], depth_mm: 2.0 };
        Self { name, channels, sensor, frames: Vec::new() }
    }

    /// What comes in a cycle: the taxels of each element.
    fn elements(&self) -> Vec<Vec<usize>> {
        let Sensor { columns, rows, .. } = self.sensor;
        match self.channels {
            4 => Orbits::new(columns, rows).all().into_iter().map(Vec::from).collect(),
            _ => (0..columns * rows).map(|taxel| vec![taxel]).collect(),
        }
    }

    fn row_width(&self) -> u32 {
        let elements = self.elements().len();
        if elements > 8 { (elements - 1).ilog2() + 1 } else { 3 }
    }

    /// Adds a frame whose touching taxels are the ones of `touched`, all alike, or of any size.
    fn touch(&mut self, touched: impl Fn(usize, usize) -> bool, random: Option<&mut ChaCha8Rng>) {
        let columns = self.sensor.columns;
        let mut plain = ChaCha8Rng::seed_from_u64(0);
        let any = random.is_some();
        let random = random.unwrap_or(&mut plain);
        // 5/64 of the largest do not touch yet.
        let least = if any { 320 } else { MOST };
        let weight = |taxel: usize| {
            if touched(taxel % columns, taxel / columns) {
                random.random_range(least..=MOST)
            } else {
                random.random_range(0..320)
            }
        };
        let mut frame: Vec<i64> = (0..self.sensor.taxels()).map(weight).collect();
        if any && let Some(first) = frame.iter_mut().find(|weight| **weight >= 320) {
            *first = MOST;
        }
        self.frames.push(frame);
    }
}

/// Drawings on any grid, then components at random: equal weights, and any.
fn fill(case: &mut Case, taxels: usize, random: &mut ChaCha8Rng) {
    let Sensor { columns, rows, .. } = case.sensor;
    let shapes: [fn(usize, usize) -> bool; 9] = [
        |_, _| false,
        |_, _| true,
        // A board, combs with the teeth up, down and sideways, steps, columns, rings.
        |x, y| (x + y) % 2 == 0,
        |x, y| x % 2 == 0 || y % 5 == 4,
        |x, y| x % 2 == 0 || y == 0,
        |x, y| y % 2 == 0 || x == 2,
        |x, y| (x + 2 * y) % 4 < 2 || (x / 2 + y) % 3 == 0,
        |x, _| x % 3 == 0,
        |x, y| x.max(y) % 4 < 2 && x % 7 != 3,
    ];
    for shape in shapes {
        case.touch(shape, None);
        case.touch(shape, Some(random));
    }
    for _ in 0..taxels / (columns * rows) {
        let density: f64 = random.random_range(0.05..0.9);
        let pattern: Vec<bool> = (0..columns * rows).map(|_| random.random_bool(density)).collect();
        let equal = random.random_bool(0.2);
        case.touch(|x, y| pattern[y * columns + x], if equal { None } else { Some(random) });
    }
    case.frames.push(vec![0; columns * rows]);
}

/// Each case in a player of its own: all frames, now with room between them, now two in a hurry.
#[test]
fn components_are_counted_as_the_model_counts_them() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut cases = [
        // All patterns of 4 by 3 taxels.
        Case::new("folded_4x3", 4, [4, 3]),
        Case::new("taxels_4x3", 1, [4, 3]),
        Case::new("folded_10x10", 4, [10, 10]),
        Case::new("folded_9x7", 4, [9, 7]),
        Case::new("taxels_13x6", 1, [13, 6]),
        Case::new("folded_2x2", 4, [2, 2]),
        Case::new("folded_64x3", 4, [64, 3]),
        Case::new("taxels_3x64", 1, [3, 64]),
        Case::new("folded_33x17", 4, [33, 17]),
    ];
    for case in &mut cases {
        if case.name.ends_with("_4x3") {
            (0..1 << 12).for_each(|pattern: u32| case.touch(|x, y| pattern >> (4 * y + x) & 1 == 1, None));
        }
        fill(case, 12_000, &mut random);
    }
    let found = play(&cases, None, &mut random).expect("no check of the module fails");
    for (case, found) in cases.iter().zip(found) {
        let Sensor { columns, .. } = case.sensor;
        let finder = Finder::new(&case.sensor, 1);
        let mut solver = Regions::default();
        assert_eq!(found.len(), case.frames.len(), "{}: counts", case.name);
        let mut most = 0;
        for (number, (frame, found)) in case.frames.iter().zip(found).enumerate() {
            let expected = count(frame, columns);
            assert_eq!(found, expected, "{}, frame {number}: {frame:?}", case.name);
            finder.count(&frame.iter().map(|&weight| weight as f64).collect::<Vec<_>>(), &mut solver);
            assert_eq!(expected as usize, solver.contacts.max(1), "{}, frame {number}: {frame:?}", case.name);
            most = most.max(found);
        }
        assert!(most > 2 || case.sensor.taxels() == 4, "{}: {most} at most", case.name);
    }
}

/// Copies of the module that are wrong somewhere count wrong.
#[test]
fn faults_are_noticed() {
    let faults = [
        // One taxel of a component that is joined gets its new label.
        ("sptfra_components", "meets && (old == above)", "meets && (old == above) && (index == COLUMNS)"),
        ("sptfra_components", "(above != own)", "1'b1"),
        ("sptfra_components", "joins_5 ? sums[joined_5] : NOTHING", "NOTHING"),
        ("sptfra_components", "(joined_6 >= least)", "1'b0"),
        ("sptfra_components", "was_contact && !begins_7", "was_contact"),
        ("sptfra_components", "!borders[3] && (weight_3 > limit)", "(weight_3 > limit)"),
        ("sptfra_contact_counter", "are_own_1[index] ?", "1'b1 ?"),
        ("sptfra_contact_counter", "left + {3'd0, done}", "left"),
    ];
    let faults = some_faults(faults, |&(module, from, _)| (module, from));
    let copies: Vec<_> = std::iter::once(None).chain(faults.iter().map(Some)).collect();
    let found = in_parallel(&copies, |fault| {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let mut case = Case::new("folded_9x7", 4, [9, 7]);
        fill(&mut case, 8_000, &mut random);
        let expected: Vec<u32> = case.frames.iter().map(|frame| count(frame, 9)).collect();
        let found = play(&[case], *fault, &mut random);
        found.is_ok_and(|found| found[0] == expected)
    });
    let wrong: Vec<_> = copies.iter().zip(found).filter(|(fault, right)| fault.is_none() != *right).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Plays all cases at once; the counts of each, or what a check of the module says. A fault is a module, a
/// text in it and what takes its place.
fn play(cases: &[Case], fault: Option<&(&str, &str, &str)>, random: &mut ChaCha8Rng) -> Result<Vec<Vec<u32>>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: String| folder.path().join(name);
    let mut bench = "module bench(input clock);\n".to_owned();
    let mut longest = 0;
    for case in cases {
        let lines = stimulus(case, random);
        let (cycles, width) = (lines.len(), case.channels as u32 * BITS);
        longest = longest.max(cycles);
        fs::write(place(format!("{}.in", case.name)), lines.concat()).expect("writable");
        let (row, Sensor { columns, rows, .. }) = (case.row_width(), &case.sensor);
        let (name, channels, expected) = (case.name, case.channels, latency::count_contacts(&case.sensor));
        let high = width + row + 2;
        let _ = write!(
            bench,
            "    generate if (1) begin : {name}
        reg [{high}:0] stimulus [0:{cycles}-1];
        reg [{high}:0] in;
        wire [7:0] contacts;
        integer cycle, file;
        initial begin
            cycle = 0;
            in = 0;
            in[{high}] = 1;
            $readmemh(\"{name}.in\", stimulus, 0, {cycles} - 1);
            file = $fopen(\"{name}.out\", \"w\");
        end
        sptfra_contact_counter #(.CHANNELS({channels}), .COLUMNS({columns}), .ROWS({rows}), .DATA_BITS({BITS}), .EXPECTED_LATENCY({expected}))
            subject (.clock(clock), .reset(in[{high}]), .contacts_take(in[{take}]), .weights_valid(in[{valid}]),
            .weights_row(in[{width} +: {row}]), .weights(in[{width}-1:0]), .contacts(contacts));
        always @(posedge clock) if (cycle <= {cycles}) begin
            if (in[{take}]) $fwrite(file, \"%0d\\n\", contacts);
            if (cycle == {cycles}) $fclose(file);
            in <= (cycle < {cycles}) ? stimulus[cycle] : 0;
            cycle <= cycle + 1;
        end
    end endgenerate\n",
            take = high - 1,
            valid = high - 2,
        );
    }
    fs::write(place("bench.v".to_owned()), bench + "endmodule\n").expect("writable");
    if let Some((module, from, to)) = fault {
        write_broken(folder.path(), module, from, to);
    }
    verilator(folder.path(), longest + 1)?;
    let counts = |case: &Case| {
        let text = fs::read_to_string(place(format!("{}.out", case.name))).expect("written");
        text.lines().map(|line| line.parse().map_err(|_| format!("{}: {line} contacts", case.name))).collect()
    };
    cases.iter().map(counts).collect()
}

/// A line for each cycle: reset, take, valid, row, weights.
fn stimulus(case: &Case, random: &mut ChaCha8Rng) -> Vec<String> {
    let (elements, row) = (case.elements(), case.row_width());
    let width = case.channels as u32 * BITS;
    let took = latency::count_contacts(&case.sensor) as usize;
    let mut lines: Vec<u128> = vec![1 << (width + row + 2); 3];
    let (mut done, mut taken) = (0, 0);
    let mut takes = Vec::new();
    for (number, frame) in case.frames.iter().enumerate() {
        // A frame may come while the one before is counted; the one after that must wait.
        if number % 2 == 0 || random.random_bool(0.5) {
            let free = done + random.random_range(0..3);
            lines.resize(lines.len().max(free), 0);
        }
        let mut order: Vec<usize> = (0..elements.len()).collect();
        order.shuffle(random);
        for element in order {
            if random.random_bool(0.05) {
                lines.push(0);
            }
            let weights = elements[element].iter().rev().fold(0, |all, &taxel| (all << BITS) | frame[taxel] as u128);
            lines.push(((1 << row | element as u128) << width) | weights);
        }
        done = done.max(lines.len() - 1) + took;
        if number % 2 == 0 && done < lines.len() + elements.len() {
            done = done.max(lines.len());
        }
        taken = (taken + 1).max(done + random.random_range(1..took));
        takes.push(taken);
    }
    lines.resize(lines.len().max(taken + 1), 0);
    for take in takes {
        lines[take] |= 1 << (width + row + 1);
    }
    lines.into_iter().map(|line| format!("{line:x}\n")).collect()
}
