//! What `inspect` says that each reduction saves, on grids on which one can count by hand.

use hdl_gen::plan::Plan;
use hdl_gen::plan::savings::savings;

use crate::support::plan;

/// A grid of 4 x 4 taxels: 16 taxels, 4 orbits.
fn square(algorithm: &str, hardware: &str) -> Plan {
    plan(&format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"square\"\n[sensor]\ncolumns = 4\nrows = 4\npitch_mm = [3.0, 3.0]\ndepth_mm = 2.0\n\
         [algorithm]\n{algorithm}\n[hardware]\nlanes = 4\n{hardware}"
    ))
}

fn steps(plan: &Plan) -> Vec<(&'static str, usize, usize)> {
    savings(plan).into_iter().map(|saving| (saving.step, saving.macs, saving.coefficients)).collect()
}

#[test]
fn every_reduction_of_a_square_is_counted() {
    // A matrix has 16 x 16 = 256 entries, folded 4 blocks of 4 x 4. The sums of the line are nine rows of 4 orbits in 4
    // channels on y+ and |w|, and the residual adds three parts of 4 orbits in 4 channels.
    let field = steps(&square("plan = \"reduced\"", ""));
    let names: Vec<&str> = field.iter().map(|step| step.0).collect();
    assert_eq!(names, ["the paper's plan", "fewer products", "parity fold", "diagonal mirror"]);
    assert_eq!(field[0], ("the paper's plan", 16 * 256, 14 * 256));
    assert_eq!(field[1], ("fewer products", 10 * 256, 10 * 256));
    let (products, residual) = (10 * 64, 3 * 16);
    let sums = field[2].2 - products;
    assert_eq!(field[2].1, products + sums + residual);
    // K2, C32 and A2 are K1, C31 and A1 mirrored.
    assert_eq!(field[3], ("diagonal mirror", field[2].1, field[2].2 - 3 * 64));
}

#[test]
fn resultants_need_four_products() {
    let found = steps(&square("plan = \"reduced\"\noutputs = \"resultants\"", ""));
    assert_eq!(found[2], ("resultants only", 4 * 256, 4 * 256));
}

#[test]
fn a_filter_is_said_not_to_be_exact() {
    let found = steps(&square("plan = \"reduced\"\nfilter = { kind = \"f1\", l = 8 }", ""));
    let [.., folded, filtered] = found[..] else { panic!("{found:?}") };
    assert_eq!((folded.0, filtered.0), ("parity fold", "filter (not exact)"));
    assert!(filtered.1 < folded.1 && filtered.2 < folded.2, "{found:?}");
}

#[test]
fn the_papers_plan_saves_nothing() {
    assert_eq!(steps(&square("plan = \"paper\"", "")), []);
}
