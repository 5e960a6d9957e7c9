//! `sptfra_regions` by itself, against the integer model and the solver's finder.

mod cases;
mod player;

use std::fs;

use golden::bodies::{Finder, Found as Solved};
use hdl_gen::model::contacts::regions::Found;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::tools;

use crate::support::effort::some_of;
use crate::support::{in_parallel, workspace};
use cases::{Case, fill};
use player::{assert_same, instance, lines, play};

/// Cases that take several times as long as the others.
const LONGEST: usize = 5;

/// Every grid's frames: the module says what the model says, in as many cycles as are stated, and so does the solver. Whole
/// numbers of so few bits have exact sums and shares in f64, so that there is no limit at which the two could differ.
#[test]
fn bodies_are_told_apart_as_the_model_does() {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut cases = vec![
        // Rows shorter than a sweep's; all patterns of 4 by 3 taxels.
        Case::new([2, 2], [2.0, 2.0], 2),
        Case::new([2, 7], [2.0, 3.0], 4),
        Case::new([2, 64], [1.0, 1.0], 8),
        Case::new([3, 5], [2.0, 0.5], 3),
        Case::new([4, 3], [2.0, 2.0], 4),
        Case::new([4, 3], [2.0, 2.0], 6),
        Case::new([64, 2], [0.01, 1000.0], 5),
        Case::new([3, 64], [1000.0, 0.37], 6),
        Case::new([64, 64], [2.0, 2.0], 8),
        Case::new([33, 17], [2.0, 4.0], 7),
        Case::new([17, 9], [4.0, 1.5], 5),
        Case::new([5, 6], [2.0, 2.0], 3),
        Case::new([8, 8], [2.0, 2.0], 2),
        Case::new([16, 16], [1.0, 1.2], 4),
    ];
    cases.extend(some_of(2..=8).into_iter().map(|contacts| Case::new([10, 10], [2.0, 2.0], contacts)));
    for latency in [1, 7] {
        cases.push(Case { latency, ..Case::new([9, 7], [2.0, 2.0], 4) });
    }
    for case in &mut cases {
        if case.sensor.taxels() == 12 {
            let mut faint = ChaCha8Rng::seed_from_u64(1);
            (0..1 << 12).for_each(|pattern: u32| {
                case.touch(|x, y| pattern >> (4 * y + x) & 1 == 1, &mut || 100, &mut faint);
            });
        }
        fill(case, 20_000, &mut random);
    }
    // What is played at once goes on until the longest is over: like lengths together.
    cases.sort_by_key(Case::cycles);
    let (short, long) = cases.split_at(cases.len() - LONGEST);
    let play = |cases: &&[Case]| play(cases, None).expect("no check of the module fails");
    let texts = in_parallel(&[long, short], play);
    let texts = texts.iter().rev().flatten();
    let mut solved = Solved::default();
    let mut seen_of_all = [0_u32; 14];
    for (case, text) in cases.iter().zip(texts) {
        let (name, finder) = (case.name(), Finder::new(&case.sensor, case.contacts));
        let expected: Vec<Found> = case.frames.iter().map(|frame| case.expected(frame)).collect();
        assert_same(case, text, &expected);
        let mut seen = [0_u32; 14];
        for (frame, expected) in case.frames.iter().zip(&expected) {
            finder.find(&frame.iter().map(|&weight| weight as f64).collect::<Vec<_>>(), &mut solved);
            let taxels: Vec<u32> = solved.taxels.iter().map(|&taxels| taxels as u32).collect();
            assert_eq!((solved.bodies, &taxels), (expected.bodies as usize, &expected.taxels), "{name}: {frame:?}");
            if expected.kept() > 1 {
                let regions: Vec<u8> = solved.regions.iter().map(|region| region.expect("a body") as u8).collect();
                assert_eq!(regions, expected.regions, "{name}: {frame:?}");
            }
            seen[expected.bodies as usize] += 1;
        }
        // Fewer than have a place, as many, and more.
        let [few, all, more] = [2..case.contacts, case.contacts..case.contacts + 1, case.contacts + 1..14];
        for counts in [few, all, more] {
            let some = counts.is_empty() || seen[counts].iter().any(|&seen| seen > 0);
            assert!(some || !(30..300).contains(&case.sensor.taxels()), "{name}: {seen:?}");
        }
        seen_of_all.iter_mut().zip(&seen).for_each(|(all, seen)| *all += seen);
    }
    assert!(seen_of_all[..=12].iter().all(|&seen| seen > 10) && seen_of_all[13] == 0, "{seen_of_all:?}");
}

/// Copies of the module that are wrong somewhere find something else, or are late.
#[test]
fn faults_are_noticed() {
    let faults = some_of([
        ("walk", "(column >= BORDER[", "(column > BORDER["),
        ("blobs", "joins_2 ? totals[joined_2] :", "1'b0 ? totals[joined_2] :"),
        ("blobs", "(weight > limit)", "(weight >= limit)"),
        ("blobs", "6'd63", "6'd64"),
        ("blobs", "(begins_3 ? {SUM_BITS{1'b0}} : sum)", "(begins_3 ? {SUM_BITS{1'b0}} : sum | 1)"),
        ("blobs", "if (taxel_1) begin", "if (touches_1) begin"),
        ("blobs", "taxel_3 <= 1'b0;", "taxel_3 <= taxel_2;"),
        ("bodies", "            noted <= {NAMES{1'b0}};", ""),
        ("bodies", "touches_1 && !touches_2", "touches_1 && !touches_2 && !noted[0]"),
        ("bodies", "known ? numbers[label_1]", "known ? number_2"),
        ("bodies", "~(run ? (FIRST << label_1)", "~(1'b0 ? (FIRST << label_1)"),
        ("bodies", "record[0];", "record[0] || touches_1;"),
        ("largest", "(sum > own_sum)", "(sum >= own_sum)"),
        ("largest", "moves ? counts[", "1'b0 ? counts["),
        ("largest", "is_body ?", "1'b1 ?"),
        ("passes", "THERE: left <= 5'd3;", "THERE: left <= 5'd2;"),
        ("passes", "AFTER_BACK = CONTACTS + 1", "AFTER_BACK = CONTACTS"),
        ("spread", "(other < first)", "(other[WORD_BITS-1:3] < first[WORD_BITS-1:3])"),
        ("spread", "!border && !before_border && !first_row", "!border && !before_border"),
        ("spread", "ends_row ? !last_row", "ends_row ? 1'b0"),
        ("spread", "distance + X[", "distance + Y["),
        ("spread", "distance_ahead + Y[", "distance_ahead + X["),
        ("spread", "|| borders[5];", "|| 1'b0;"),
        ("spread", "            diagonal <= diagonal_next;", "            diagonal <= straight;"),
        ("spread", "slots <= 5'd0;", "slots <= {slots[4:1], 1'b0};"),
        ("list", "end_of_body + 1'b1;", "end_of_body;"),
        ("list", "passed + first_size", "passed"),
    ]);
    let copies: Vec<_> = std::iter::once(None).chain(faults.iter().map(Some)).collect();
    let found = in_parallel(&copies, |fault| {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let mut case = Case::new([9, 7], [2.0, 3.0], 4);
        fill(&mut case, 2_500, &mut random);
        let expected: Vec<Found> = case.frames.iter().map(|frame| case.expected(frame)).collect();
        let texts = play(std::slice::from_ref(&case), *fault);
        if fault.is_none() {
            assert_same(&case, &texts.as_ref().unwrap()[0], &expected);
        }
        texts.is_ok_and(|texts| lines(&case, &expected) == texts[0])
    });
    let wrong: Vec<_> = copies.iter().zip(found).filter(|(fault, right)| fault.is_none() != *right).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// What no design has: the smallest and the largest grid, the narrowest and the widest words, with the checks of simulations
/// and without.
#[test]
fn any_width_is_clean() {
    let cases = [
        Case::new([2, 2], [0.01, 0.01], 2),
        Case::new([64, 64], [1000.0, 1000.0], 8),
        Case { latency: 1, ..Case::new([3, 5], [0.01, 1000.0], 3) },
        Case { latency: 16, ..Case::new([33, 4], [2.0, 1.5], 7) },
    ];
    let said = in_parallel(&cases, |case| {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(
            folder.path().join("bench.v"),
            format!("module bench(input wire clock);\n{}endmodule\n", instance(case)),
        )
        .expect("writable");
        let library = workspace("hdl-gen/rtl");
        let lint = |simulation: &[&str]| {
            let mut verilator = tools::verilator().expect("installed");
            verilator.args(["--quiet-stats", "--lint-only", "-Wall", "--top-module", "bench"]).args(simulation);
            let mut icarus = tools::icarus().expect("installed");
            icarus.args(["-Wall", "-g2005", "-t", "null", "-s", "bench"]).args(simulation);
            [verilator, icarus].map(|mut tool| {
                let output =
                    tool.arg("-y").arg(&library).arg("bench.v").current_dir(folder.path()).output().expect("starts");
                format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
            })
        };
        [lint(&[]), lint(&["-DSIMULATION"])].as_flattened().concat()
    });
    assert!(said.iter().all(String::is_empty), "{}", said.concat());
}
