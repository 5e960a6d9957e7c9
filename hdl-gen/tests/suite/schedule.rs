//! The schedule: who computes what, and when.

use hdl_gen::plan::optimum::OptimumPlan;
use hdl_gen::plan::product::{Block, Epilogue, Product, Vector};
use hdl_gen::plan::quantise::QuantisedMatrix;
use hdl_gen::plan::schedule::{ISSUE_TO_RESULT, Schedule, SegmentKind, VISIT_TO_DRAINED, VISIT_TO_OPERAND};
use hdl_gen::plan::timing::Timeline;
use proptest::prelude::*;

use crate::lanes::{RowSums, execute};
use crate::support::{any_design, plan, small_plan};

/// The paper's products, whatever matrices they are given.
fn paper_products() -> Vec<Product> {
    small_plan("").products
}

/// Numbers that depend on where they stand.
fn vector(size: usize, seed: u64) -> Vec<i64> {
    let number = |index: u64| (index.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(seed) >> 40) as i64 - (1 << 23);
    (0..size as u64).map(number).collect()
}

/// Any vector, the same for the same name.
fn operands(size: usize) -> impl Fn(Vector) -> Vec<i64> {
    move |vector_name| vector(size, vector_name.name().bytes().fold(7, |seed, byte| seed * 131 + u64::from(byte)))
}

fn run(schedule: &Schedule, products: &[Product], size: usize) -> RowSums {
    let mut names: Vec<Vector> = products.iter().map(|product| product.operand).collect();
    names.sort_unstable();
    names.dedup();
    let make = operands(size);
    let vectors: Vec<Vec<i64>> = names.iter().map(|&name| make(name)).collect();
    execute(schedule, products, |name| &vectors[names.binary_search(&name).expect("every operand has a vector")])
}

/// Executes a schedule and compares with matrix times vector; then looks at what the execution cannot see.
fn check(products: &[Product], matrices: &[QuantisedMatrix], lanes: usize) -> Schedule {
    let schedule = Schedule::new(products, matrices, lanes);
    let size = matrices[0].rows.len();
    let sums = run(&schedule, products, size);
    assert_eq!(sums.len(), products.len() * size);
    let make = operands(size);
    for (index, product) in products.iter().enumerate() {
        let matrix = &matrices[product.matrix];
        let operand = make(product.operand);
        for row in 0..size {
            let expected = matrix.row_product(row, &operand);
            assert_eq!(sums[&(index as u32, row as u32)], expected, "product {index}, row {row}, {lanes} lanes");
        }
    }
    check_dealing(&schedule, matrices);
    check_order(&schedule, products);
    schedule
}

/// Every coefficient stands in one lane's ROM, once, lane after lane in row order, in equal shares.
fn check_dealing(schedule: &Schedule, matrices: &[QuantisedMatrix]) {
    let mut begin = vec![0; schedule.lanes.len()];
    for matrix in matrices {
        let flat: Vec<(u32, i32)> = matrix.rows.concat();
        let longest = matrix.rows.iter().map(Vec::len).max().unwrap();
        let share = flat.len().div_ceil((flat.len() / longest).clamp(1, schedule.lanes.len()));
        let mut rest = &flat[..];
        for (lane, begin) in schedule.lanes.iter().zip(&mut begin) {
            let (mine, others) = rest.split_at(share.min(rest.len()));
            assert_eq!(&lane.words[*begin..*begin + mine.len()], mine, "{}", matrix.name);
            *begin += mine.len();
            rest = others;
        }
        assert!(rest.is_empty());
    }
    assert!(schedule.lanes.iter().zip(begin).all(|(lane, end)| lane.words.len() == end), "no word besides");
}

fn check_order(schedule: &Schedule, products: &[Product]) {
    let visits = |of: Vector| {
        let found = schedule.visits.iter().filter(move |visit| products[visit.product as usize].result == of);
        found.map(|visit| (visit.row, visit.cycle))
    };
    let mut next = 0;
    for (product, window) in products.iter().zip(&schedule.windows) {
        assert!(window.start >= next && window.length > 0, "products follow each other");
        next = window.start + window.length;
        if let Epilogue::Add(partial) = product.epilogue {
            let there: std::collections::BTreeMap<u32, u64> = visits(partial).collect();
            for (row, cycle) in visits(product.result) {
                assert!(there[&row] + ISSUE_TO_RESULT <= cycle, "the addend is there before the sum");
            }
        }
    }
    assert_eq!(schedule.drained, schedule.visits.last().unwrap().cycle + VISIT_TO_DRAINED);
}

fn matrix(size: usize, rows: Vec<Vec<(u32, i32)>>) -> QuantisedMatrix {
    assert_eq!(rows.len(), size);
    let sum = |row: &Vec<(u32, i32)>| row.iter().map(|&(_, value)| i64::from(value.abs())).sum();
    QuantisedMatrix { name: "M".to_owned(), row_sum: rows.iter().map(sum).max().unwrap_or(0), rows, lsb: 0 }
}

/// Rows of at least one entry: one entry only, a few, or all.
fn any_row(size: usize) -> impl Strategy<Value = Vec<(u32, i32)>> {
    let value = -131_072_i32..131_072;
    let one = (0..size as u32, value.clone()).prop_map(|entry| vec![entry]);
    let some = proptest::collection::btree_map(0..size as u32, value.clone(), 1..=size)
        .prop_map(|entries| entries.into_iter().collect());
    let all = proptest::collection::vec(value, size).prop_map(|values| (0..).zip(values).collect());
    prop_oneof![one, some, all]
}

/// The fourteen stored matrices, and a lane count.
fn any_matrices() -> impl Strategy<Value = (Vec<QuantisedMatrix>, usize)> {
    (2_usize..24).prop_flat_map(|size| {
        let one = proptest::collection::vec(any_row(size), size).prop_map(move |rows| matrix(size, rows));
        (proptest::collection::vec(one, 14), 1_usize..=64)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn programs_compute_the_products((matrices, lanes) in any_matrices()) {
        check(&paper_products(), &matrices, lanes);
    }

    #[test]
    fn designs_are_scheduled_soundly(text in any_design()) {
        let plan = plan(&text);
        check(&plan.products, &plan.matrices, plan.design.hardware.lanes);
        // The vector that takes the stress's place is written when nobody reads the stress any more.
        let reads: Vec<_> = plan.products.iter().zip(&plan.schedule.windows)
            .filter(|(product, _)| product.operand == Vector::Stress).collect();
        let (_, last) = reads.last().unwrap();
        for visit in &plan.schedule.visits {
            let result = plan.products[visit.product as usize].result;
            if plan.operands.place(result) == plan.operands.place(Vector::Stress) {
                prop_assert!(visit.cycle >= last.start + last.length);
            }
        }
    }
}

#[test]
fn rows_of_one_entry_keep_two_places_enough() {
    // A result a cycle from every lane: the collector is the bottleneck, and lanes must wait for it.
    let diagonal = |size: usize| matrix(size, (0..size as u32).map(|row| vec![(row, 3)]).collect());
    for (size, lanes) in [(2, 1), (2, 64), (30, 8), (64, 64), (65, 64), (128, 3)] {
        let matrices = vec![diagonal(size); 14];
        let schedule = check(&paper_products(), &matrices, lanes);
        let idle = |lane: &hdl_gen::plan::schedule::LaneProgram| {
            lane.segments.iter().any(|segment| segment.kind == SegmentKind::Idle)
        };
        assert_eq!(schedule.lanes.iter().any(idle), lanes > 1, "{size} rows, {lanes} lanes");
        assert!(schedule.visits.len() as u64 <= schedule.drained);
    }
}

#[test]
fn a_product_waits_for_the_last_row_of_its_operand() {
    // Each product reads first what the one before it wrote last.
    let reversal = |size: usize| matrix(size, (1..=size).map(|row| vec![((size - row) as u32, 3)]).collect());
    let chain: Vec<Product> = [
        (Block::We, Vector::Stress, Vector::Weight),
        (Block::Co, Vector::Weight, Vector::G(3, 0)),
        (Block::Op, Vector::G(3, 0), Vector::U(0)),
    ]
    .into_iter()
    .enumerate()
    .map(|(matrix, (block, operand, result))| Product {
        matrix,
        operand,
        block,
        epilogue: Epilogue::Keep,
        result,
        shift: 0,
    })
    .collect();
    for size in 2..20 {
        for lanes in 1..10 {
            let schedule = check(&chain, &vec![reversal(size); 3], lanes);
            for (index, window) in schedule.windows.iter().enumerate().skip(1) {
                let of_operand = schedule.visits.iter().filter(|visit| visit.product as usize == index - 1);
                let last = of_operand.map(|visit| visit.cycle).max().unwrap();
                assert_eq!(window.start, last + VISIT_TO_OPERAND, "no sooner and no later");
            }
        }
    }
}

#[test]
fn dense_matrices_keep_all_lanes_busy() {
    for lanes in [1, 2, 7, 16, 64] {
        let plan = plan(&format!(
            "name = \"d\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
             [hardware]\nlanes = {lanes}"
        ));
        for (product, window) in plan.products.iter().zip(&plan.schedule.windows) {
            let entries = plan.matrices[product.matrix].nnz() as u64;
            assert_eq!(window.length, entries.div_ceil(lanes), "{lanes} lanes");
        }
        assert!(plan.schedule.busy_fraction() >= 0.9, "{lanes} lanes: {}", plan.schedule.busy_fraction());
    }
}

#[test]
fn more_lanes_are_never_slower_on_the_papers_sensor() {
    let mut before = u64::MAX;
    for lanes in [1, 2, 4, 8, 16, 32, 64] {
        let plan = plan(&format!(
            "name = \"d\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
             [algorithm]\nfilter = {{ kind = \"f1\", l = 40 }}\n[hardware]\nlanes = {lanes}"
        ));
        let timeline = &plan.timeline;
        assert!(timeline.latency_cycles < before && timeline.interval_cycles <= timeline.latency_cycles);
        before = timeline.latency_cycles;
        let again = Timeline::new(plan.taxels(), &plan.products, &plan.schedule, &plan.optimum);
        assert_eq!(&again, timeline);
        let OptimumPlan { cells, elements, .. } = plan.optimum;
        assert!(cells * elements >= plan.taxels() && (cells - 1) * elements < plan.taxels());
    }
}
