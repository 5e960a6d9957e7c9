//! Why a kind of contact errs by more than round sliding ones: which way, and of which contacts.

use golden::design::{Design, Sensor};
use golden::scene::{Contact, Kind, Scene, SceneFrame, Shape, Shear};
use golden::solver::Solver;

use super::{design, share};

/// Error of a frame's tangential force in percent of the normal force: along its push, more than 0 for too much, and
/// across.
pub fn error_of(solver: &Solver, frame: &SceneFrame) -> [f64; 2] {
    let found = solver.solve(&frame.stress).unwrap();
    let [x, y] = [0, 1].map(|axis| 100.0 * (found.resultant[axis] - frame.force[axis]) / frame.force[2].abs());
    let (sin, cos) = frame.direction.sin_cos();
    [x * cos + y * sin, y * cos - x * sin]
}

/// Half extents of a contact along x and y in metres.
fn extents(contact: &Contact) -> [f64; 2] {
    let [a, b] = contact.shape.half_extent_m();
    let (sin, cos) = contact.traction.turn_deg.to_radians().sin_cos();
    match contact.shape {
        Shape::Rectangle { .. } => [(a * cos).abs() + (b * sin).abs(), (a * sin).abs() + (b * cos).abs()],
        _ => [(a * cos).hypot(b * sin), (a * sin).hypot(b * cos)],
    }
}

/// How far a contact reaches beyond the outermost taxels, in depths; negative where it does not.
fn beyond(sensor: &Sensor, contact: &Contact) -> f64 {
    let last = sensor.position_m(sensor.taxels() - 1);
    let reach = extents(contact);
    let over =
        |axis: usize| (reach[axis] - contact.centre_m[axis]).max(contact.centre_m[axis] + reach[axis] - last[axis]);
    over(0).max(over(1)) / sensor.depth_m()
}

/// A frame, where it comes from, and its errors along and across.
type Row = (Scene, SceneFrame, [f64; 2]);

fn rows(design: &Design, kind: Kind, count: u64) -> Vec<Row> {
    let solver = Solver::new(design).unwrap();
    let frames = kind.frames(&design.sensor, 0.5, 1000..1000 + count).unwrap();
    let row = |(index, frame): (usize, SceneFrame)| {
        let error = error_of(&solver, &frame);
        (kind.scene(&design.sensor, 0.5, 1000 + index as u64), frame, error)
    };
    frames.into_iter().enumerate().map(row).collect()
}

/// Frames, lengths of the errors (half, 95 % and all of them at most, share above 10 %), mean and spread of those along the
/// push, mean and root mean square of those across, to the left of it.
fn line(rows: &[&Row]) -> String {
    if rows.is_empty() {
        return "0 |".to_owned();
    }
    let mut lengths: Vec<f64> = rows.iter().map(|(_, _, [along, across])| along.hypot(*across)).collect();
    lengths.sort_by(f64::total_cmp);
    let [median, most, worst] = [0.5, 0.95, 1.0].map(|part| share(&lengths, part));
    let count = rows.len() as f64;
    let mean = rows.iter().map(|(_, _, [along, _])| along).sum::<f64>() / count;
    let aside = rows.iter().map(|(_, _, [_, across])| across).sum::<f64>() / count;
    let root = |of: &dyn Fn(&Row) -> f64| (rows.iter().map(|row| of(row).powi(2)).sum::<f64>() / count).sqrt();
    let [spread, across] = [root(&|(_, _, [along, _])| along - mean), root(&|(_, _, [_, across])| *across)];
    let bad = 100.0 * lengths.iter().filter(|&&length| length > 10.0).count() as f64 / count;
    format!(
        "{count} | {median:.1} / {most:.1} / {worst:.1} | {bad:.0} | {mean:+.1} | {spread:.1} | {aside:+.1} | {across:.1} |"
    )
}

type Part = (&'static str, fn(&Sensor, &Row) -> bool);

/// The first contact of a scene.
fn of((scene, ..): &Row) -> &Contact {
    &scene.contacts[0]
}

fn long_turn(row: &Row) -> f64 {
    // From x to the long axis, 0 to 90 degrees.
    let turn = of(row).traction.turn_deg;
    turn.min(180.0 - turn)
}

fn push_to_long(row: &Row) -> f64 {
    let turn = (of(row).direction_deg - of(row).traction.turn_deg).rem_euclid(180.0);
    turn.min(180.0 - turn)
}

fn ratio(row: &Row) -> f64 {
    let [a, b] = of(row).shape.half_extent_m();
    a / b
}

const PARTS: [Part; 30] = [
    ("all", |_, _| true),
    ("within the outermost taxels", |sensor, row| beyond(sensor, of(row)) <= 0.0),
    ("beyond them, by up to half a depth", |sensor, row| (1e-9..0.5).contains(&beyond(sensor, of(row)))),
    ("beyond them, by more", |sensor, row| beyond(sensor, of(row)) >= 0.5),
    ("ellipse or disc", |_, row| !matches!(of(row).shape, Shape::Rectangle { .. })),
    ("rectangle", |_, row| matches!(of(row).shape, Shape::Rectangle { .. })),
    ("long axis within 30° of x", |_, row| ratio(row) > 1.3 && long_turn(row) < 30.0),
    ("long axis within 30° of y", |_, row| ratio(row) > 1.3 && long_turn(row) > 60.0),
    ("long axis between", |_, row| ratio(row) > 1.3 && (30.0..=60.0).contains(&long_turn(row))),
    ("pushed along the long axis", |_, row| ratio(row) > 1.3 && push_to_long(row) < 30.0),
    ("pushed across", |_, row| ratio(row) > 1.3 && push_to_long(row) > 60.0),
    ("longer than 1.5 : 1", |_, row| ratio(row) > 1.5),
    ("rounder than 1.3 : 1", |_, row| ratio(row) <= 1.3),
    ("small: half the width below 1.25 pitches", |sensor, row| narrow(sensor, row)),
    ("wide", |sensor, row| !narrow(sensor, row)),
    ("radius below 1.6 pitches", |sensor, row| radius(sensor, row) < 1.6),
    ("radius above 2 pitches", |sensor, row| radius(sensor, row) > 2.0),
    ("all but even shear", |_, row| of(row).traction.shear != Shear::Even),
    ("all but even shear, µ below 0.6", |_, row| of(row).traction.shear != Shear::Even && row.1.friction < 0.6),
    ("even shear", |_, row| of(row).traction.shear == Shear::Even),
    ("held", |_, row| matches!(of(row).traction.shear, Shear::Held { .. })),
    ("sliding straight", |_, row| of(row).traction.shear == Shear::Sliding { spin: 0.0 }),
    ("turning", |_, row| matches!(of(row).traction.shear, Shear::Sliding { spin } if spin.abs() > 0.0)),
    ("turns to the left", |_, row| matches!(of(row).traction.shear, Shear::Sliding { spin } if spin > 0.3)),
    ("hard edge, n < 0", |_, row| of(row).traction.edge.is_some_and(|edge| edge < 0.0)),
    ("soft edge, n > 1", |_, row| of(row).traction.edge.is_some_and(|edge| edge > 1.0)),
    ("friction above 0.6", |_, (_, frame, _)| frame.friction > 0.6),
    ("friction below 0.4", |_, (_, frame, _)| frame.friction < 0.4),
    ("noise above 0.2 %", |_, (scene, ..)| scene.sensor_errors.noise > 0.002),
    ("noise below 0.1 %", |_, (scene, ..)| scene.sensor_errors.noise < 0.001),
];

/// The larger half axis in pitches.
fn radius(sensor: &Sensor, row: &Row) -> f64 {
    let [a, b] = of(row).shape.half_extent_m();
    1e3 * a.max(b) / sensor.pitch_mm[0].max(sensor.pitch_mm[1])
}

fn narrow(sensor: &Sensor, row: &Row) -> bool {
    let [a, b] = of(row).shape.half_extent_m();
    a.min(b) < 1.25e-3 * sensor.pitch_mm[0].max(sensor.pitch_mm[1])
}

/// The rows as a correction would leave them that was told how each contact is sheared, and takes that kind's share of the
/// push off, or adds it.
fn known_kinds(rows: &[Row]) -> Vec<Row> {
    let kinds: [fn(&Shear) -> bool; 3] = [
        |shear| *shear == Shear::Even,
        |shear| matches!(shear, Shear::Held { .. }),
        |shear| matches!(shear, Shear::Sliding { .. }),
    ];
    let shares = kinds.map(|belongs| {
        let own = || rows.iter().filter(move |row| belongs(&of(row).traction.shear));
        let [both, square] = own().fold([0.0; 2], |[both, square], (_, frame, [along, _])| {
            [both + along * frame.friction, square + frame.friction.powi(2)]
        });
        both / square
    });
    let left = |row: &Row| {
        let kind = kinds.iter().position(|belongs| belongs(&of(row).traction.shear)).unwrap();
        let (scene, frame, [along, across]) = row;
        (scene.clone(), frame.clone(), [along - shares[kind] * frame.friction, *across])
    };
    rows.iter().map(left).collect()
}

#[test]
#[ignore = "prints which way kinds of contacts err, and which of them, for docs/explanation/accuracy.md; minutes"]
fn table() {
    for sensor in ["sensor1", "sensor2"] {
        let [design, narrow] = ["wide", "joint"].map(|kind| design(&format!("{sensor}-{kind}")));
        for kind in Kind::ALL.into_iter().filter(|&kind| kind != Kind::Mixed) {
            let rows = rows(&design, kind, if kind.has_own_friction() { 2000 } else { 200 });
            let beside = self::rows(&narrow, kind, 200);
            println!(
                "| {} | {} | all, narrow | {}",
                &sensor[6..],
                kind.title(),
                line(&beside.iter().collect::<Vec<_>>())
            );
            for (label, belongs) in PARTS {
                let part: Vec<&Row> = rows.iter().filter(|row| belongs(&design.sensor, row)).collect();
                if !part.is_empty() && (label == "all" || part.len() < rows.len()) {
                    println!("| {} | {} | {label} | {}", &sensor[6..], kind.title(), line(&part));
                }
            }
            if kind == Kind::MixedInside {
                let known = known_kinds(&rows);
                println!(
                    "| {} | {} | the shear's kind known | {}",
                    &sensor[6..],
                    kind.title(),
                    line(&known.iter().collect::<Vec<_>>())
                );
            }
        }
    }
}
