//! What a limit of the standard error marks: errors above 10 % that it catches, against errors below 5 %.

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

/// Shares in percent that a limit marks: of errors above 10 %, of errors below 5 %, and of all.
fn marked(pairs: &[[f64; 2]], limit: f64) -> [f64; 3] {
    let is_in: [fn(f64) -> bool; 3] = [|error| error > 10.0, |error| error < 5.0, |_| true];
    is_in.map(|is_in| {
        let own: Vec<_> = pairs.iter().filter(|[error, _]| is_in(*error)).collect();
        100.0 * own.iter().filter(|[_, told]| *told > limit).count() as f64 / own.len() as f64
    })
}

#[test]
#[ignore = "prints the rows of results/confidence-limits.csv; minutes"]
fn table() {
    const LIMITS: [f64; 8] = [3.0, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0];
    let both = ["sensor1-wide", "sensor2-wide"].map(|name| pairs(name, Kind::MixedInside, 2000));
    for limit in LIMITS {
        for (number, pairs) in both.iter().enumerate() {
            let [caught, good, all] = marked(pairs, limit);
            println!("{},{limit},{caught:.0},{good:.0},{all:.0}", number + 1);
        }
    }
}
