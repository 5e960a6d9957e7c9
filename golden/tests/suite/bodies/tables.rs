//! The tables of several bodies in `docs/explanation/accuracy.md`, errors in percent of the normal force.

use golden::bodies::Body;
use golden::metrics::Quantiles;
use golden::scene::{self, Scene, SceneFrame};
use golden::solver::{Solver, Status};

use super::kinds::{Kind, frame, frame_and_scene};
use super::{design, judge};

pub fn row(Quantiles { median, most, worst }: Quantiles) -> String {
    // Of no body there is no error.
    if median.is_nan() { " – |".to_owned() } else { format!(" {median:.1} / {most:.1} / {worst:.1} |") }
}

/// Kinds of the first table, and of those of single designs.
pub const KINDS: [(Kind, &str); 19] = [
    (Kind::Same, "two, pushed the same way"),
    (Kind::Opposed, "two, opposed"),
    (Kind::Anyhow, "two, anyhow"),
    (Kind::Small, "4 N, and 1 N on half the radius"),
    (Kind::Held, "one slides, one is held"),
    (Kind::Three, "three, anyhow"),
    (Kind::Row, "three in a row"),
    (Kind::Apart(8000), "two, 8 mm apart"),
    (Kind::Apart(6000), "two, 6 mm apart"),
    (Kind::Apart(4000), "two, 4 mm apart"),
    (Kind::Apart(3000), "two, 3 mm apart"),
    (Kind::Apart(2000), "two, 2 mm apart"),
    (Kind::Apart(0), "two that touch"),
    (Kind::Heavier(6), "one 6 times as heavy"),
    (Kind::Heavier(8), "one 8 times as heavy"),
    (Kind::Heavier(10), "one 10 times as heavy"),
    (Kind::Heavier(12), "one 12 times as heavy"),
    (Kind::One, "one alone"),
    (Kind::Wide, "one to three of the wide family"),
];

#[test]
#[ignore = "prints the table of bodies in docs/explanation/accuracy.md; minutes"]
fn told_apart() {
    for sensor in ["sensor1", "sensor2"] {
        for (kind, label) in KINDS {
            let geometry = design(&format!("{sensor}-fast"), 1).sensor;
            let frames: Vec<SceneFrame> = (0..100).map(|seed| frame(&geometry, kind, 3000 + seed)).collect();
            let (mut cells, mut right, mut within) = (String::new(), 0, 0.0);
            for calibration in ["fast", "wide"] {
                let solvers =
                    [1, 4].map(|contacts| Solver::new(&design(&format!("{sensor}-{calibration}"), contacts)).unwrap());
                let [one, several] = solvers.each_ref().map(|solver| judge(solver, &frames));
                cells += &[one.total, several.total, several.bodies.tangential].map(row).concat();
                if calibration == "fast" {
                    cells += &row(several.bodies.normal);
                }
                (right, within) = (several.bodies.right, several.bodies.within);
            }
            let within = if within.is_nan() { "–".to_owned() } else { format!("{within:.0}") };
            println!("| {} | {label} |{cells} {within} | {right} |", &sensor[6..]);
        }
    }
}

/// The same of a shipped fast design with `contacts = 4`, and how many of the bodies, in percent, are doubtful.
#[test]
#[ignore = "prints the table of sensor1-wide in docs/explanation/accuracy.md; minutes"]
fn of_the_shipped_one() {
    let solver = Solver::new(&design("sensor1-wide", 4)).unwrap();
    for (kind, label) in KINDS {
        let frames: Vec<SceneFrame> =
            (0..100).map(|seed| frame(solver.matrices().sensor(), kind, 3000 + seed)).collect();
        let found = judge(&solver, &frames);
        let cells = [found.total, found.bodies.tangential, found.bodies.normal].map(row).concat();
        let records = frames.iter().flat_map(|frame| solver.solve(&frame.stress).unwrap().records);
        let bodies: Vec<Body> = records.filter(|body| body.taxels > 0).collect();
        let doubtful = bodies.iter().filter(|body| body.status.contains(Status::DOUBTFUL)).count();
        let doubtful = 100.0 * doubtful as f64 / bodies.len() as f64;
        println!("| {label} |{cells} {:.0} | {doubtful:.0} | {} |", found.bodies.within, found.bodies.right);
    }
}

/// Where the errors of each body come from: in percent of its normal force, with the correction and without, of the frames as
/// they are; and of those that each body would cause alone, as if they were parted without an error.
#[test]
#[ignore = "prints the table of what parting costs in docs/explanation/accuracy.md; minutes"]
fn of_parting() {
    for sensor in ["sensor1", "sensor2"] {
        let joint = design(&format!("{sensor}-fast"), 4);
        let mut plain = joint.clone();
        plain.algorithm.joint.correction = None;
        let solvers = [joint, plain].map(|design| Solver::new(&design).unwrap());
        let geometry = solvers[0].matrices().sensor();
        for (kind, label) in
            KINDS.iter().filter(|(kind, _)| !matches!(kind, Kind::Apart(_) | Kind::Heavier(_) | Kind::Wide))
        {
            let made: Vec<(SceneFrame, Scene)> =
                (0..100).map(|seed| frame_and_scene(geometry, *kind, 3000 + seed)).collect();
            let frames: Vec<SceneFrame> = made.iter().map(|(frame, _)| frame.clone()).collect();
            let alone: Vec<SceneFrame> = made
                .iter()
                .flat_map(|(_, scene)| scene.contacts.iter().map(move |contact| (scene, contact.clone())))
                .map(|(scene, contact)| Scene { contacts: vec![contact], ..scene.clone() }.frames().unwrap().remove(0))
                .collect();
            let far: Vec<SceneFrame> = frames.iter().filter(|frame| nearest(&frame.bodies) > 16e-3).cloned().collect();
            let cells: String = solvers
                .each_ref()
                .map(|solver| {
                    let each = [&frames, &far, &alone].map(|frames| row(judge(solver, frames).bodies.tangential));
                    each.concat()
                })
                .concat();
            println!("| {} | {label} |{cells} {} |", &sensor[6..], far.len());
        }
    }
}

/// Least distance of the centres of two bodies in metres; without two of them it is endless.
fn nearest(bodies: &[Body]) -> f64 {
    let pairs = bodies.iter().enumerate().flat_map(|(index, a)| bodies[..index].iter().map(move |b| (a, b)));
    let distance = |(a, b): (&Body, &Body)| (a.centre_m[0] - b.centre_m[0]).hypot(a.centre_m[1] - b.centre_m[1]);
    pairs.map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "prints the table of single bodies in docs/explanation/accuracy.md; minutes"]
fn of_one_body() {
    for sensor in ["sensor1", "sensor2"] {
        let names = ["fast", "wide"].map(|calibration| format!("{sensor}-{calibration}"));
        let pairs = names.map(|name| [1, 4].map(|contacts| Solver::new(&design(&name, contacts)).unwrap()));
        for kind in scene::Kind::ALL {
            let label = kind.title();
            let frames = kind.frames(pairs[0][0].matrices().sensor(), 0.5, 1000..1060).unwrap();
            let (mut cells, mut right) = (String::new(), 0);
            for solvers in &pairs {
                let [one, several] = solvers.each_ref().map(|solver| judge(solver, &frames));
                cells += &[one.total, several.total].map(row).concat();
                right = several.bodies.right;
            }
            println!("| {} | {label} |{cells} {right} of 60 |", &sensor[6..]);
        }
    }
}
