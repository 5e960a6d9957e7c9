//! Zeros passed over: whole rows dealt in rounds, over the columns that are not zero, are the product with the matrix.

use golden::parity::{CLASSES, Quads};
use hdl_gen::plan::matrix::QuantisedMatrix;
use hdl_gen::plan::product::{Product, mirror};
use hdl_gen::plan::schedule::Schedule;
use proptest::prelude::*;

use crate::reduced::{exactly, folded, product, stored, swapped, symmetric, unfolded};

/// What the lanes make of a vector by the list of its quads that are not zero. Sixteen times the product.
fn in_rounds(quads: &Quads, product: &Product, matrix: QuantisedMatrix, lanes: usize, x: &[i64]) -> Vec<i64> {
    let n = quads.count();
    let schedule = Schedule::new(std::slice::from_ref(product), &[matrix], lanes, false);
    let rounds = schedule.windows[0].rounds.expect("rounds");
    let zero = |&quad: &usize| quads.members(quad).into_iter().all(|taxel| x[taxel] == 0);
    let listed: Vec<usize> = (0..n).filter(|quad| !zero(quad)).collect();
    let mut rows = vec![None; n];
    for (index, visit) in schedule.visits.iter().enumerate() {
        let (round, lane) = (index / lanes, index % lanes);
        assert_eq!(visit.lane as usize, lane, "lanes are visited in turn");
        assert!(round < rounds.count);
        let words = &schedule.lanes[lane].rounds[rounds.word + round * n..][..n];
        let mut sums = [0; CLASSES];
        for &quad in &listed {
            let column = product.mirrored.map_or(quad, |side| mirror(quad, side));
            for (way, sum) in sums.iter_mut().enumerate() {
                let class = if product.mirrored.is_some() { swapped(way) } else { way };
                *sum += i64::from(words[column][way]) * folded(quads, class, quad, x);
            }
        }
        assert!(rows[visit.row as usize].replace(sums).is_none(), "one result a row");
    }
    unfolded(quads, |quad| product.ways().map(|way| rows[quad].expect("a result for every row")[way]))
}

/// Values of which most are zero.
fn sparse() -> impl Strategy<Value = Vec<i64>> {
    let value = prop_oneof![4 => Just(0), 1 => -1_000_000..1_000_000_i64];
    proptest::collection::vec(value, 49)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rounds_over_what_is_not_zero_are_the_product(
        columns in 1_usize..8, rows in 1_usize..8, parity in 0_usize..4, lanes in 1_usize..=16,
        numbers in proptest::collection::vec(-2_000..2_000_i32, 256), x in sparse(),
    ) {
        let quads = Quads::new(columns, rows);
        let dense = symmetric(&quads, parity, &numbers);
        let x = &x[..quads.taxels()];
        let product = Product { skips: true, ..product(parity, None) };
        let found = in_rounds(&quads, &product, stored(&quads, parity, &dense), lanes, x);
        prop_assert_eq!(found, exactly(&dense, x));
    }

    #[test]
    fn mirrored_rounds_are_those_of_the_mirrored_matrix(
        side in 1_usize..8, lanes in 1_usize..=16,
        numbers in proptest::collection::vec(-2_000..2_000_i32, 256), x in sparse(),
    ) {
        let quads = Quads::new(side, side);
        let dense = symmetric(&quads, 1, &numbers);
        let x = &x[..quads.taxels()];
        let other = |taxel: usize| mirror(taxel, side);
        let mirrored = nalgebra::DMatrix::from_fn(side * side, side * side, |row, column| {
            dense[(other(row), other(column))]
        });
        let product = Product { skips: true, ..product(1, Some(quads.columns())) };
        let found = in_rounds(&quads, &product, stored(&quads, 1, &dense), lanes, x);
        prop_assert_eq!(found, exactly(&mirrored, x));
    }
}
