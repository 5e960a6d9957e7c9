//! The schedule: who computes what, and when.

use golden::parity::COMPONENTS;
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::{Entry, QuantisedMatrix};
use hdl_gen::plan::product::{Block, Coefficients, Epilogue, Product, SUM_ROWS, Step, Vector, take_to_operand};
use hdl_gen::plan::schedule::{PeProgram, Schedule, SegmentKind, WriteBackSlot};
use hdl_gen::timing::latency::{ISSUE_TO_RESULT, collector_jump};
use proptest::prelude::*;

use crate::pes::{RowSums, Sums, execute};
use crate::support::{any_design, design_text, plan, small_plan};

mod speed;

/// The paper's products, whatever matrices they are given.
fn paper_products() -> Vec<Product> {
    small_plan("").products
}

/// Any number, the same for the same vector, element and channel.
fn operand(vector: Vector, element: usize) -> Sums {
    let seed = vector.name().bytes().fold(7, |seed: u64, byte| seed.wrapping_mul(131) + u64::from(byte));
    std::array::from_fn(|channel| {
        let index = (COMPONENTS * element + channel) as u64;
        (index.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(seed << 30) >> 40) as i64 - (1 << 23)
    })
}

fn run(schedule: &Schedule, products: &[Product], matrices: &[QuantisedMatrix], size: usize) -> RowSums {
    execute(schedule, products, matrices, size, &|product, part, element| operand(product.operands[part], element))
}

/// Checks the schedules of both kinds of collector; returns that of one which does not look ahead.
fn check(products: &[Product], matrices: &[QuantisedMatrix], pes: usize) -> Schedule {
    check_one(products, matrices, pes, true);
    check_one(products, matrices, pes, false)
}

/// Executes a schedule and compares with matrix times vector; then looks at what the execution cannot see.
fn check_one(products: &[Product], matrices: &[QuantisedMatrix], pes: usize, ahead: bool) -> Schedule {
    let schedule = Schedule::new(products, matrices, pes, ahead);
    let size = matrices[products[0].matrix].rows.len();
    let sums = run(&schedule, products, matrices, size);
    let preloads = products.iter().filter(|product| product.preload.is_some()).count();
    assert_eq!(sums.len(), products.len() * size + preloads * SUM_ROWS);
    for (index, product) in products.iter().enumerate() {
        let whole = |channel: usize| -> Vec<i64> {
            let parts = product.operands.iter().flat_map(|&part| (0..size).map(move |element| operand(part, element)));
            parts.map(|channels| channels[channel]).collect()
        };
        let operands: Vec<Vec<i64>> = (0..COMPONENTS).map(whole).collect();
        let expected = |matrix: &QuantisedMatrix, row: usize| -> Sums {
            std::array::from_fn(|channel| matrix.row_product(row, channel, &operands[channel]))
        };
        for row in 0..size {
            // A mirrored product leaves its stored row as the result on the other side of the diagonal.
            let result = product.mirrored.map_or(row, |side| row % side * side + row / side);
            let found = sums[&(index as u32, result as u32)];
            assert_eq!(found, expected(&matrices[product.matrix], row), "product {index}, row {row}, {pes} PEs");
        }
        for row in 0..product.preload.map_or(0, |_| SUM_ROWS) {
            let matrix = &matrices[product.preload.unwrap().matrix];
            let found = sums[&(index as u32, (size + row) as u32)];
            assert_eq!(found, expected(matrix, row), "preload of product {index}, row {row}, {pes} PEs");
        }
    }
    check_dealing(&schedule, products, matrices);
    check_order(&schedule, products);
    check_programs(&schedule, products);
    schedule
}

/// Every coefficient stands in one PE's ROM, once, PE after PE row by row, in equal shares; a program's
/// matrices begin at the same address in every PE.
fn check_dealing(schedule: &Schedule, products: &[Product], matrices: &[QuantisedMatrix]) {
    let mut stored = vec![false; matrices.len()];
    let mut begin = vec![0; schedule.pes.len()];
    for program in &schedule.programs {
        for (pe, begin) in schedule.pes.iter().zip(&mut begin) {
            assert!(pe.words[*begin..program.word].iter().all(|&word| word == Entry::default()));
            *begin = program.word;
        }
        for product in &products[program.first..program.end] {
            if std::mem::replace(&mut stored[product.matrix], true) {
                continue;
            }
            let preload = product.preload.map(|preload| {
                stored[preload.matrix] = true;
                &matrices[preload.matrix]
            });
            let main = &matrices[product.matrix];
            let rows: Vec<&Vec<Entry>> = preload.iter().flat_map(|preload| &preload.rows).chain(&main.rows).collect();
            let flat: Vec<Entry> = rows.iter().copied().flatten().copied().collect();
            let longest = rows.iter().map(|row| row.len()).max().unwrap();
            let share = flat.len().div_ceil((flat.len() / longest).clamp(1, schedule.pes.len()));
            let mut left = flat.len();
            let mut stored_words = Vec::new();
            for (pe, begin) in schedule.pes.iter().zip(&mut begin) {
                let mine = share.min(left);
                stored_words.extend_from_slice(&pe.words[*begin..*begin + mine]);
                *begin += mine;
                left -= mine;
            }
            // Of a row in the order in which the operands are there.
            let mut words = &mut stored_words[..];
            for row in rows {
                let (mine, others) = words.split_at_mut(row.len());
                mine.sort_by_key(|&(column, _)| column);
                assert_eq!(mine, &row[..], "{}", main.name);
                words = others;
            }
            assert!(words.is_empty());
        }
    }
    assert!(stored.into_iter().all(|stored| stored));
    assert!(schedule.pes.iter().zip(begin).all(|(pe, end)| pe.words.len() == end), "no word besides");
}

/// The slots of a program, in order.
fn slots_of(schedule: &Schedule, program: usize) -> &[WriteBackSlot] {
    let end = schedule.programs.get(program + 1).map_or(schedule.slots.len(), |next| next.slot);
    &schedule.slots[schedule.programs[program].slot..end]
}

fn check_order(schedule: &Schedule, products: &[Product]) {
    let slots = |of: Vector| {
        let found = schedule.slots.iter().filter(move |slot| products[slot.product as usize].result == of);
        found.map(|slot| (slot.row, slot.cycle))
    };
    for program in &schedule.programs {
        let mut next = 0;
        for (product, window) in products.iter().zip(&schedule.windows).take(program.end).skip(program.first) {
            assert!(window.start >= next && window.length > 0, "products follow each other");
            next = window.start + window.length;
            if let Epilogue::Add(partial) = product.epilogue {
                let there: std::collections::BTreeMap<u32, u64> = slots(partial).collect();
                for (row, cycle) in slots(product.result) {
                    assert!(there[&row] + ISSUE_TO_RESULT <= cycle, "the addend is there before the sum");
                }
            }
        }
        assert_eq!(program.length, next);
    }
    for (index, program) in schedule.programs.iter().enumerate() {
        assert_eq!(slots_of(schedule, index).last().map(|slot| slot.cycle), Some(program.last_slot));
    }
}

/// Programs cover the products, and whichever two follow each other at once, the collector is through with the one
/// before the other has a result.
fn check_programs(schedule: &Schedule, products: &[Product]) {
    let mut first = 0;
    for (index, program) in schedule.programs.iter().enumerate() {
        assert_eq!(program.first, first);
        assert!(products[first..program.end].iter().all(|product| product.program == index));
        first = program.end;
        let slots = slots_of(schedule, index);
        assert_eq!((program.first_slot, program.last_slot), (slots[0].cycle, slots.last().unwrap().cycle));
        // What is started later in time has later slots, product by product: the last one marks the end.
        assert!(slots.is_sorted_by_key(|slot| (slot.product, slot.cycle)));
        for next in &schedule.programs {
            let begins = program.length + next.gap;
            assert!(program.last_slot + collector_jump(schedule.ahead) <= begins + next.first_slot, "{index}");
            // The collector remembers one start: it has gone on to the next program before the one after that starts.
            assert!(program.last_slot < begins + next.length, "{index}");
        }
    }
    assert_eq!(first, products.len());
}

fn matrix(size: usize, rows: Vec<Vec<Entry>>) -> QuantisedMatrix {
    assert_eq!(rows.len(), size);
    QuantisedMatrix::from_rows("M", rows, 0)
}

/// Coefficients of all four channels.
fn any_channels() -> impl Strategy<Value = [i32; COMPONENTS]> {
    proptest::array::uniform4(-131_072_i32..131_072)
}

/// Rows of at least one entry: one entry only, a few, or all.
fn any_row(size: usize) -> impl Strategy<Value = Vec<Entry>> {
    let one = (0..size as u32, any_channels()).prop_map(|entry| vec![entry]);
    let some = proptest::collection::btree_map(0..size as u32, any_channels(), 1..=size)
        .prop_map(|entries| entries.into_iter().collect());
    let all = proptest::collection::vec(any_channels(), size).prop_map(|values| (0..).zip(values).collect());
    prop_oneof![one, some, all]
}

fn any_matrix(size: usize) -> impl Strategy<Value = QuantisedMatrix> {
    proptest::collection::vec(any_row(size), size).prop_map(move |rows| matrix(size, rows))
}

/// The fourteen stored matrices, and a PE count.
fn any_matrices() -> impl Strategy<Value = (Vec<QuantisedMatrix>, usize)> {
    (2_usize..24).prop_flat_map(|size| (proptest::collection::vec(any_matrix(size), 14), 1_usize..=64))
}

/// The products of a reduced plan with other matrices in place of its own, those of the sums and of the friction
/// excepted; by whether one matrix serves both directions. Of one orbit up to five by five.
fn any_folded_matrices() -> impl Strategy<Value = (Vec<Product>, Vec<QuantisedMatrix>, usize)> {
    (1_usize..=5, any::<bool>(), any::<bool>()).prop_flat_map(|(side, mirrored, field)| {
        let pitch = if mirrored { [4.0, 4.0] } else { [4.0, 2.0] };
        let outputs = if field { "field" } else { "resultants" };
        let more = format!("[algorithm]\nplan = \"reduced\"\noutputs = \"{outputs}\"\n[hardware]\nlanes = 4");
        let plan = plan(&design_text("pad", [2 * side, 2 * side], pitch, 1.5, &more));
        let size = side * side;
        assert_eq!(plan.products.iter().any(|product| product.mirrored.is_some()), mirrored);
        let fixed = |index: usize| {
            let is_preload =
                plan.products.iter().any(|product| product.preload.is_some_and(|preload| preload.matrix == index));
            let is_friction = |product: &Product| product.coefficients == Coefficients::Friction;
            is_preload || plan.products.iter().any(|product| product.matrix == index && is_friction(product))
        };
        let fixed: Vec<bool> = (0..plan.matrices.len()).map(fixed).collect();
        let drawn = proptest::collection::vec(any_matrix(size), plan.matrices.len());
        (drawn, 1_usize..=16).prop_map(move |(drawn, pes)| {
            let pairs = plan.matrices.iter().zip(drawn).zip(&fixed);
            let matrices = pairs.map(|((own, drawn), &fixed)| if fixed { own.clone() } else { drawn }).collect();
            (plan.products.clone(), matrices, pes)
        })
    })
}

/// No vector is written where a product still reads another.
fn check_stress_bank(plan: &Plan) {
    let reads: Vec<_> = plan
        .products
        .iter()
        .zip(&plan.schedule.windows)
        .filter(|(product, _)| product.operands.contains(&Vector::Stress))
        .collect();
    let (_, last) = reads.last().unwrap();
    for slot in &plan.schedule.slots {
        let result = plan.products[slot.product as usize].result;
        if plan.operands.place(result) == plan.operands.place(Vector::Stress) {
            assert!(slot.cycle >= last.start + last.length);
            assert_eq!(plan.schedule.programs.len(), 1, "no other frame's stress is there");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn programs_compute_the_products((matrices, pes) in any_matrices()) {
        check(&paper_products(), &matrices, pes);
    }

    #[test]
    fn programs_compute_the_products_of_the_reduced_plan((products, matrices, pes) in any_folded_matrices()) {
        check(&products, &matrices, pes);
    }

    #[test]
    fn designs_are_scheduled_soundly(text in any_design()) {
        let plan = plan(&text);
        prop_assert_eq!(plan.pes() * plan.channels(), plan.design.hardware.lanes);
        let schedule = check(&plan.products, &plan.matrices, plan.pes());
        prop_assert_eq!(schedule, plan.schedule.clone());
        check_stress_bank(&plan);
    }
}

#[test]
fn rows_of_one_entry_keep_two_places_enough() {
    // A result a cycle from every PE: the collector is the bottleneck, and PEs must wait for it.
    let diagonal = |size: usize| matrix(size, (0..size as u32).map(|row| vec![(row, [3, 5, 7, 9])]).collect());
    for (size, pes) in [(2, 1), (2, 64), (30, 8), (64, 64), (65, 64), (128, 3)] {
        let matrices = vec![diagonal(size); 14];
        let schedule = check(&paper_products(), &matrices, pes);
        let idle = |pe: &hdl_gen::plan::schedule::PeProgram| {
            pe.segments.iter().any(|segment| segment.kind == SegmentKind::Idle)
        };
        assert_eq!(schedule.pes.iter().any(idle), pes > 1, "{size} rows, {pes} PEs");
        assert!(schedule.slots.len() as u64 <= schedule.programs[0].last_slot + 1, "one slot a cycle");
    }
}

/// Each product reads first what the one before it wrote last.
#[test]
fn a_product_starts_as_soon_as_its_macs_find_their_operands() {
    let reversal =
        |size: usize| matrix(size, (1..=size).map(|row| vec![((size - row) as u32, [3, 5, 7, 9])]).collect());
    let product = |matrix, block, operand, epilogue, result| Product {
        step: Step {
            matrix,
            operands: vec![operand],
            coefficients: Coefficients::Rom,
            sums: false,
            parity: 0,
            mirrored: None,
            epilogue,
            result,
        },
        preload: None,
        block,
        program: 0,
        shift: 0,
    };
    let chain = |first: Epilogue, second: Epilogue| {
        vec![
            product(0, Block::We, Vector::Stress, first, Vector::Weight),
            product(1, Block::Co, Vector::Weight, second, Vector::G(3, 0)),
            product(2, Block::Op, Vector::G(3, 0), Epilogue::Keep, Vector::U(0)),
        ]
    };
    let kinds = [
        (Epilogue::Keep, Epilogue::Keep, [take_to_operand(Epilogue::Keep); 2]),
        (Epilogue::Part, Epilogue::Store, [take_to_operand(Epilogue::Part), take_to_operand(Epilogue::Store)]),
    ];
    for (first, second, delays) in kinds {
        for (size, pes) in (2..20).flat_map(|size| (1..10).map(move |pes| (size, pes))) {
            let schedule = check(&chain(first, second), &vec![reversal(size); 3], pes);
            for (index, window) in schedule.windows.iter().enumerate().skip(1) {
                let there = |column: u32| {
                    let of_operand = |slot: &&WriteBackSlot| (slot.product as usize, slot.row) == (index - 1, column);
                    schedule.slots.iter().find(of_operand).unwrap().cycle + delays[index - 1]
                };
                // A row has one entry, and a PE rows in a row: word k of a PE is issued k cycles after the first.
                let share = size.div_ceil(pes.min(size));
                let of_pe = |(number, pe): (usize, &PeProgram)| {
                    let mine = share.min(size.saturating_sub(number * share));
                    let words = &pe.words[index * mine..(index + 1) * mine];
                    (0..).zip(words).map(|(issue, &(column, _))| there(column).saturating_sub(issue)).max()
                };
                let soonest = schedule.pes.iter().enumerate().filter_map(of_pe).max().unwrap();
                let before = schedule.windows[index - 1];
                assert_eq!(window.start, soonest.max(before.start + before.length), "no sooner and no later");
            }
        }
    }
}
