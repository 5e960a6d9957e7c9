//! What a limit of the doubt marks: bad frames that it catches against good ones that it marks, too.

use golden::scene::Kind;
use golden::solver::Solver;

use super::design;

/// Of each frame the error of the tangential force and its standard error, both in percent of the normal force that is
/// true and that is found.
fn pairs(name: &str, kind: Kind, count: u64) -> Vec<[f64; 2]> {
    let design = design(name);
    let solver = Solver::new(&design).unwrap();
    let frames = kind.frames(&design.sensor, 0.5, 1000..1000 + count).unwrap();
    let pair = |frame: &golden::scene::SceneFrame| {
        let found = solver.solve(&frame.stress).unwrap();
        let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.force[axis]);
        [x.hypot(y) / frame.force[2].abs(), found.standard_error / found.resultant[2].abs()].map(|share| 100.0 * share)
    };
    frames.iter().map(pair).collect()
}

/// How the frames of a standard error split: which share of them errs by more than 10 %, and which by less than 5 %.
type Split = fn([f64; 2]) -> [f64; 2];

/// As they do,
fn found([error, _]: [f64; 2]) -> [f64; 2] {
    [f64::from(u8::from(error > 10.0)), f64::from(u8::from(error < 5.0))]
}

/// and as they would if each error were normally distributed in the plane with exactly the width that is told.
fn ideal([_, width]: [f64; 2]) -> [f64; 2] {
    // The width is the root of the mean square of the error's length.
    let beyond = |error: f64| (-(error / width).powi(2)).exp();
    [beyond(10.0), 1.0 - beyond(5.0)]
}

/// Shares of the bad and the good frames that a limit marks, and of all of them.
fn marked(pairs: &[[f64; 2]], limit: f64, split: Split) -> [f64; 3] {
    let (mut of, mut marked) = ([0.0; 3], [0.0; 3]);
    for &pair in pairs {
        let [bad, good] = split(pair);
        for ((of, marked), share) in of.iter_mut().zip(&mut marked).zip([bad, good, 1.0]) {
            *of += share;
            *marked += if pair[1] > limit { share } else { 0.0 };
        }
    }
    [0, 1, 2].map(|index| 100.0 * marked[index] / of[index])
}

#[test]
#[ignore = "prints the table of limits of the doubt in docs/explanation/accuracy.md; minutes"]
fn table() {
    const LIMITS: [f64; 8] = [3.0, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0];
    let both = ["sensor1-wide", "sensor2-wide"].map(|name| pairs(name, Kind::MixedInside, 2000));
    for limit in LIMITS {
        let cells = both.each_ref().map(|pairs| {
            let [[bad, good, all], [ideal_bad, ideal_good, _]] =
                [found as Split, ideal].map(|split| marked(pairs, limit, split));
            format!(" {bad:.0} | {good:.0} | {all:.0} | {ideal_bad:.0} / {ideal_good:.0} |")
        });
        println!("| {limit} |{}", cells.concat());
    }
}
