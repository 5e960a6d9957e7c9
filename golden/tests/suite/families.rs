//! Contacts of other kinds than those that the estimators were made for: what is left of their accuracy.

use std::f64::consts::PI;

use golden::design::{Design, Sensor};
use golden::scene::{Contact, Medium, Scene, SceneFrame, SensorErrors, Shape, Shear, Traction};
use golden::solver::Solver;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Kinds of frames; one differs from the first in one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Family {
    /// Round, Hertz's pressure or an even one, sliding, within the grid.
    Sliding,
    TiltedAlong,
    TiltedAcross,
    Held,
    Even,
    Turned,
    Soft,
    Hard,
    /// The body turns while it slides.
    Spinning,
    /// Centred on the grid's edge.
    Border,
    /// Taxels that average over 0.8 of their pitch.
    LargeTaxels,
    Deeper,
    Shallower,
    Stiffer,
    GainSpread,
    Noisy,
    /// Any of the above together.
    Wide,
}

const FAMILIES: [(Family, &str); 17] = [
    (Family::Sliding, "round, sliding, as ever"),
    (Family::TiltedAlong, "pressure tilted along the push, 0.6"),
    (Family::TiltedAcross, "pressure tilted across the push, 0.5"),
    (Family::Held, "held, half of the largest force (Mindlin)"),
    (Family::Even, "even shear under Hertz's pressure"),
    (Family::Turned, "ellipses and rectangles, 2 : 1, turned"),
    (Family::Soft, "soft edge, (1 - ρ²)²"),
    (Family::Hard, "hard edge, (1 - ρ²)^-0.4"),
    (Family::Spinning, "turns while it slides, at its edge as fast"),
    (Family::Border, "half beyond the grid's edge"),
    (Family::LargeTaxels, "taxels of 0.8 pitches"),
    (Family::Deeper, "layer 5 % deeper"),
    (Family::Shallower, "layer 5 % less deep"),
    (Family::Stiffer, "ν 5 % less, 0.4655"),
    (Family::GainSpread, "gains spread by 2 %"),
    (Family::Noisy, "noise 1 %"),
    (Family::Wide, "all of it, at random, µ 0.1 to 1"),
];

/// One frame of a family.
fn frame(sensor: &Sensor, family: Family, seed: u64) -> SceneFrame {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let last = sensor.position_m(sensor.taxels() - 1);
    let pitch = 1e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1]);
    let radius = between(1.25 * pitch, (2.5 * pitch).min(0.45 * last[0].min(last[1])));
    let margin = radius + sensor.depth_m() / 3.0;
    let mut centre_m = last.map(|far| between(margin.min(0.5 * far), (far - margin).max(0.5 * far)));
    let round = Shape::Hertz { semi_axes_m: [radius; 2] };
    let mut shape = if seed.is_multiple_of(2) { round } else { Shape::Disc { radius_m: radius } };
    let mut traction = Traction::default();
    let mut friction = 0.5;
    let mut poisson = 0.49;
    let mut errors = SensorErrors { seed, ..SensorErrors::default() };
    let taxel = |share: f64| sensor.pitch_mm.map(|pitch| share * pitch * 1e-3);
    let long = |ratio: f64| [radius * ratio.sqrt(), radius / ratio.sqrt()];
    match family {
        Family::Sliding => {}
        Family::TiltedAlong => traction.tilt = [0.6, 0.0],
        Family::TiltedAcross => traction.tilt = [0.0, 0.5],
        Family::Held => (shape, traction.shear) = (round, Shear::Held { share: 0.5 }),
        Family::Even => (shape, traction.shear) = (round, Shear::Even),
        Family::Turned => {
            traction.turn_deg = between(0.0, 180.0);
            shape = match seed % 2 {
                0 => Shape::Hertz { semi_axes_m: long(2.0) },
                _ => Shape::Rectangle { sides_m: long(2.0).map(|half| 1.8 * half) },
            };
        }
        Family::Soft => traction.edge = Some(2.0),
        Family::Hard => traction.edge = Some(-0.4),
        Family::Spinning => traction.shear = Shear::Sliding { spin: 1.0 },
        Family::Border => {
            let side = seed as usize % 2;
            centre_m[side] = if seed % 4 < 2 { 0.0 } else { last[side] };
        }
        Family::LargeTaxels => errors.taxel_m = Some(taxel(0.8)),
        Family::Deeper => errors.depth = 0.05,
        Family::Shallower => errors.depth = -0.05,
        Family::Stiffer => poisson = 0.95 * 0.49,
        Family::GainSpread => errors.gain_spread = 0.02,
        Family::Noisy => errors.noise = 0.01,
        Family::Wide => {
            friction = between(0.1, 1.0);
            poisson = [0.4655, 0.475, 0.485, 0.49, 0.495][seed as usize % 5];
            errors.depth = between(-0.05, 0.05);
            errors.gain_spread = between(0.0, 0.02);
            errors.noise = between(0.0, 0.003);
            errors.taxel_m = Some(taxel(between(0.0, 0.8)));
            traction.turn_deg = between(0.0, 180.0);
            centre_m = last.map(|far| between(0.0, far));
            let sides = long(between(1.0, 2.0));
            shape = match seed % 4 {
                0 | 1 => Shape::Hertz { semi_axes_m: sides },
                2 => Shape::Rectangle { sides_m: sides.map(|half| 1.8 * half) },
                _ => Shape::Disc { radius_m: radius },
            };
            if seed.is_multiple_of(4) {
                traction.shear = Shear::Held { share: between(0.2, 0.95) };
            } else {
                traction.edge = Some(between(-0.4, 2.0));
                traction.tilt = [between(-0.5, 0.5), between(-0.5, 0.5)];
                traction.shear = match seed % 3 {
                    0 => Shear::Even,
                    1 => Shear::Sliding { spin: 0.0 },
                    _ => Shear::Sliding { spin: between(-1.0, 1.0) },
                };
            }
        }
    }
    let direction_deg = between(-180.0, 180.0);
    let contact = Contact { shape, centre_m, normal_force_n: 3.0, friction, traction, direction_deg };
    let scene = Scene {
        sensor: sensor.clone(),
        medium: Medium::BondedLayer { poisson },
        contacts: vec![contact],
        sweep_deg: Vec::new(),
        sensor_errors: errors,
    };
    scene.frames().unwrap().remove(0)
}

/// Length of the error of the tangential force in percent of the normal force: of each frame, in rising order; and the
/// share of frames with another status than good.
fn errors(solver: &Solver, frames: &[SceneFrame]) -> (Vec<f64>, f64) {
    let mut flagged = 0;
    let mut errors: Vec<f64> = frames
        .iter()
        .map(|frame| {
            let found = solver.solve(&frame.stress).unwrap();
            flagged += usize::from(found.status.0 != 0);
            let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.force[axis]);
            100.0 * x.hypot(y) / frame.force[2].abs()
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    (errors, flagged as f64 / frames.len() as f64)
}

fn share(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() as f64 * share).ceil() as usize).clamp(1, sorted.len()) - 1]
}

fn design(name: &str) -> Design {
    Design::load(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../designs/{name}.toml"))).unwrap()
}

#[test]
fn frames_of_every_family_have_an_answer_not_far_from_the_truth() {
    let joint = design("sensor2-joint");
    let solver = Solver::new(&joint).unwrap();
    for (family, label) in FAMILIES {
        let frames: Vec<SceneFrame> = (0..8).map(|seed| frame(&joint.sensor, family, seed)).collect();
        let (errors, _) = errors(&solver, &frames);
        assert!(frames.iter().all(|frame| frame.friction <= 1.0 + 1e-9 && frame.direction.abs() <= PI));
        let limit = if family == Family::Sliding { 4.0 } else { 40.0 };
        assert!(share(&errors, 0.5) < limit, "{label}: {errors:?}");
    }
}

#[test]
#[ignore = "prints the table of families in docs/estimators.md; minutes"]
fn table() {
    const FRAMES: u64 = 200;
    for sensor in ["sensor1", "sensor2"] {
        let designs = ["none", "joint"].map(|kind| design(&format!("{sensor}-{kind}")));
        let [line, joint] = designs.each_ref().map(|design| Solver::new(design).unwrap());
        for (family, label) in FAMILIES {
            let frames: Vec<SceneFrame> =
                (0..FRAMES).map(|seed| frame(&designs[1].sensor, family, 1000 + seed)).collect();
            let row: String = [&line, &joint]
                .map(|solver| {
                    let (errors, flagged) = errors(solver, &frames);
                    let [median, most, worst] = [0.5, 0.95, 1.0].map(|part| share(&errors, part));
                    format!(" {median:.1} / {most:.1} / {worst:.1} | {:.0} |", 100.0 * flagged)
                })
                .concat();
            println!("| {} | {label} |{row}", &sensor[6..]);
        }
    }
}
