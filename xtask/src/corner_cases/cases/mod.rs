//! What makes an estimator fail: deep sensors, contacts that fit no taxel, frames that are no contact, broken taxels.

use golden::calibrate::{Settings, calibrate};
use golden::contacts::ContactForces;
use golden::design::{Design, DesignError, Estimator, JointConstants, Sensor};
use golden::metrics::Outcome;
use golden::scene::{Contact, Kind, Medium, Scene, SensorErrors, Shape, Traction};

mod sensor;

use super::CornerCasesError;
use crate::PLAIN_DESIGN;
use testbench::frame_set::FrameSet;

/// Frames for one design.
#[derive(Clone, Debug)]
pub struct Case {
    /// What it is about.
    pub group: &'static str,
    /// The case.
    pub name: String,
    /// The design.
    pub design: Design,
    /// Stresses in Pa.
    pub frames: Vec<Vec<f64>>,
    /// True forces where there are any.
    pub truth: Option<Vec<Outcome>>,
    /// Of each frame the true contacts, where errors are to be of each contact: their sum may be next to nothing.
    pub contacts: Option<Vec<Vec<ContactForces>>>,
}

/// Designs with constants of the grid search for their sensors, and the names and contents of their weights.
const CALIBRATED: [[&str; 3]; 2] = [
    [
        include_str!("../../../../designs/sensor1-fast.toml"),
        "sensor1-fast.weights.csv",
        include_str!("../../../../designs/sensor1-fast.weights.csv"),
    ],
    [
        include_str!("../../../../designs/sensor2-fast.toml"),
        "sensor2-fast.weights.csv",
        include_str!("../../../../designs/sensor2-fast.weights.csv"),
    ],
];

/// Depth over pitch of the deep sensors.
pub const DEPTHS: [f64; 8] = [0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0];
/// Noise of the deep sensors, as a share of the largest stress.
pub const NOISE: f64 = 0.002;
/// Group of the deep sensors as they are.
pub const PLAIN: &str = "depth";
/// Group of the deep sensors, regularised by [`NOISE`].
pub const REGULARISED: &str = "depth, regularised";
/// From this depth over pitch on a larger regularisation is tried too.
const DEEP: f64 = 3.0;
/// That one.
const MORE: f64 = 0.03;
/// Key under `[hardware]` with which each frame is scaled by its own largest stress.
const OWN_RANGE: &str = "scaling = \"per_frame\"";
const DIRECTIONS: usize = 12;
const SEED: u64 = 7;
const FORCE_N: f64 = 6.0;

fn design(sensor: &Sensor, algorithm: &str) -> Result<Design, DesignError> {
    let Sensor { columns, rows, pitch_mm: [x, y], depth_mm } = sensor;
    let text = format!(
        "{PLAIN_DESIGN}name = \"hard\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [{x:?}, {y:?}]\n\
         depth_mm = {depth_mm:?}\n[algorithm]\nplan = \"reduced\"\n{algorithm}\n"
    );
    Design::from_toml(&text, "corner case")
}

fn square(side: usize, depth_mm: f64) -> Sensor {
    Sensor { columns: side, rows: side, pitch_mm: [4.0, 4.0], depth_mm }
}

fn sensor_1() -> Sensor {
    Sensor { columns: 10, rows: 10, pitch_mm: [4.0, 2.0], depth_mm: 3.0 }
}

/// A contact in the middle of the sensor.
fn contact(sensor: &Sensor, radius_mm: f64) -> Contact {
    let half = |count: usize, pitch: f64| 0.5e-3 * (count - 1) as f64 * pitch;
    Contact {
        shape: Shape::Hertz { semi_axes_m: [radius_mm * 1e-3; 2] },
        centre_m: [half(sensor.columns, sensor.pitch_mm[0]), half(sensor.rows, sensor.pitch_mm[1])],
        normal_force_n: FORCE_N,
        friction: 0.5,
        traction: Traction::default(),
        direction_deg: 0.0,
    }
}

fn scene(sensor: &Sensor, contacts: Vec<Contact>, sweep_deg: Vec<f64>, sensor_errors: SensorErrors) -> Scene {
    let medium = Medium::BondedLayer { poisson: 0.49 };
    Scene { sensor: sensor.clone(), medium, contacts, sweep_deg, sensor_errors }
}

fn all_directions() -> Vec<f64> {
    (0..DIRECTIONS).map(|step| step as f64 * 360.0 / DIRECTIONS as f64).collect()
}

fn noise(share: f64) -> SensorErrors {
    SensorErrors { seed: SEED, noise: share, ..SensorErrors::default() }
}

/// The cases so far.
struct Cases(Vec<Case>);

impl Cases {
    fn scene(
        &mut self,
        group: &'static str,
        name: impl Into<String>,
        algorithm: &str,
        scene: &Scene,
    ) -> Result<&mut Case, CornerCasesError> {
        let FrameSet { stress: frames, truth, .. } = FrameSet::of_scene(scene, "")?;
        let design = design(&scene.sensor, algorithm)?;
        let last = self.0.len();
        self.0.push(Case { group, name: name.into(), design, frames, truth, contacts: None });
        Ok(&mut self.0[last])
    }

    fn frames(&mut self, group: &'static str, name: &str, frames: Vec<Vec<f64>>) -> Result<(), CornerCasesError> {
        let design = design(&sensor_1(), "")?;
        self.0.push(Case { group, name: name.to_owned(), design, frames, truth: None, contacts: None });
        Ok(())
    }
}

/// All cases; without the `large` ones those that take milliseconds.
///
/// # Errors
/// [`CornerCasesError`] if a scene cannot be computed.
pub fn all(large: bool) -> Result<Vec<Case>, CornerCasesError> {
    let mut cases = Cases(Vec::new());
    depths(&mut cases)?;
    if large {
        let sensor = square(32, 3.0);
        let swept = scene(&sensor, vec![contact(&sensor, 20.0)], vec![0.0, 50.0, 220.0], SensorErrors::default());
        cases.scene("size", "32 × 32 taxels", "", &swept)?;
    }
    contacts(&mut cases)?;
    if large {
        kinds(&mut cases)?;
    }
    directions(&mut cases)?;
    sensor::errors(&mut cases)?;
    ends_of_range(&mut cases)?;
    without_answer(&mut cases)?;
    Ok(cases.0)
}

/// The same cases by the grid search: with the constants of the shipped designs where the sensor and its
/// regularisation are theirs, else with those that a new design gets: gain and friction fitted, no correction.
///
/// # Errors
/// [`CornerCasesError::Design`] if a shipped design cannot be read.
pub fn by_joint(cases: &[Case]) -> Result<Vec<Case>, CornerCasesError> {
    let shipped = |[text, file, weights]: [&str; 3]| Design::from_parts(text, "joint", &[(file, weights.to_owned())]);
    let calibrated = CALIBRATED.map(shipped).into_iter().collect::<Result<Vec<_>, _>>()?;
    // One fit serves all the cases of a design.
    let mut fitted: Vec<(Design, JointConstants)> = Vec::new();
    let of = |case: &Case| {
        let mut case = case.clone();
        let algorithm = &mut case.design.algorithm;
        algorithm.estimator = Estimator::Joint;
        let shipped = calibrated.iter().find(|shipped| {
            shipped.sensor == case.design.sensor && shipped.algorithm.regularisation == algorithm.regularisation
        });
        if let Some(shipped) = shipped {
            algorithm.joint.clone_from(&shipped.algorithm.joint);
            return case;
        }
        let same = |other: &&(Design, JointConstants)| {
            other.0.sensor == case.design.sensor && other.0.algorithm == case.design.algorithm
        };
        let known = fitted.iter().find(same).map(|(_, constants)| constants.clone());
        let constants = known.unwrap_or_else(|| {
            // Where nothing can be fitted there is no solver and no hardware either, and the row says so.
            let found = calibrate(&case.design, &Settings::constants(), &mut || ()).unwrap_or_default();
            fitted.push((case.design.clone(), found.clone()));
            found
        });
        *case.design.algorithm.joint = constants;
        case
    };
    Ok(cases.iter().map(of).collect())
}

fn depths(cases: &mut Cases) -> Result<(), CornerCasesError> {
    for share in [0.0, NOISE] {
        for ratio in DEPTHS {
            let sensor = square(10, 4.0 * ratio);
            let swept = scene(&sensor, vec![contact(&sensor, 10.0)], all_directions(), noise(share));
            let noise = if share > 0.0 { format!(", noise {} %", 100.0 * share) } else { String::new() };
            cases.scene(PLAIN, format!("h/s = {ratio}{noise}"), "", &swept)?;
            let by_noise = format!("regularisation = {{ noise = {NOISE} }}");
            cases.scene(REGULARISED, format!("h/s = {ratio}{noise}, regularised"), &by_noise, &swept)?;
            if ratio >= DEEP {
                let more = format!("regularisation = {MORE}");
                cases.scene("depth, more", format!("h/s = {ratio}{noise}, regularisation {MORE}"), &more, &swept)?;
            }
        }
    }
    Ok(())
}

fn contacts(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let sensor = sensor_1();
    let swept = |contacts| scene(&sensor, contacts, all_directions(), SensorErrors::default());
    let needle = |x: f64, y: f64| Contact { centre_m: [x * 1e-3, y * 1e-3], ..contact(&sensor, 0.3) };
    let light = |contact: Contact| Contact { normal_force_n: 0.5, ..contact };
    cases.scene("contact", "needle on a taxel", "", &swept(vec![light(needle(16.0, 8.0))]))?;
    cases.scene("contact", "needle between four taxels", "", &swept(vec![light(needle(18.0, 9.0))]))?;
    cases.scene(
        "contact",
        "centre on the edge",
        "",
        &swept(vec![Contact { centre_m: [0.0, 9e-3], ..contact(&sensor, 7.0) }]),
    )?;
    cases.scene(
        "contact",
        "mostly beyond the corner",
        "",
        &swept(vec![Contact { centre_m: [-4e-3, -4e-3], ..contact(&sensor, 7.0) }]),
    )?;
    let apart = |x: f64, direction_deg| Contact {
        centre_m: [x * 1e-3, 9e-3],
        normal_force_n: 3.0,
        direction_deg,
        ..contact(&sensor, 5.0)
    };
    let opposed = swept(vec![apart(9.0, 0.0), apart(27.0, 180.0)]);
    let case = cases.scene("contact", "two contacts, opposed pushes", "count_contacts = true", &opposed)?;
    case.contacts = Some(opposed.frames()?.into_iter().map(|frame| frame.contacts).collect());
    cases.scene("contact", "µ = 0", "", &swept(vec![Contact { friction: 0.0, ..contact(&sensor, 7.0) }]))?;
    for friction in [0.2, 0.8, 1.5] {
        let name = format!("µ = {friction}");
        cases.scene("contact", name, "", &swept(vec![Contact { friction, ..contact(&sensor, 7.0) }]))?;
    }
    Ok(())
}

/// Contacts anywhere within the grid of kinds that no constant was fitted to.
fn kinds(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let sensor = sensor_1();
    for kind in Kind::all() {
        let made = kind.frames(&sensor, 0.5, 0..DIRECTIONS as u64)?;
        let truth = Some(made.iter().map(Outcome::from).collect());
        let frames = made.into_iter().map(|frame| frame.stress).collect();
        let design = design(&sensor, "")?;
        cases.0.push(Case { group: "kind", name: kind.title().to_owned(), design, frames, truth, contacts: None });
    }
    Ok(())
}

fn directions(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let sensor = sensor_1();
    let swept = |sweep| scene(&sensor, vec![contact(&sensor, 7.0)], sweep, SensorErrors::default());
    let every = |first: f64, step: f64| (0..4).map(move |quarter| first + step * f64::from(quarter));
    let around = |first: f64, by: f64| every(first - by, 90.0).chain(every(first + by, 90.0)).collect::<Vec<f64>>();
    cases.scene("direction", "on the axes", "", &swept(every(0.0, 90.0).collect()))?;
    cases.scene("direction", "on the diagonals", "", &swept(every(45.0, 90.0).collect()))?;
    for by in [1e-9, 1e-3, 0.5] {
        cases.scene("direction", format!("{by}° off the axes"), "", &swept(around(0.0, by)))?;
        cases.scene("direction", format!("{by}° off the diagonals"), "", &swept(around(45.0, by)))?;
    }
    Ok(())
}

/// The same contact, louder and fainter.
fn ends_of_range(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let sensor = sensor_1();
    let swept = scene(&sensor, vec![contact(&sensor, 7.0)], all_directions(), SensorErrors::default());
    let design = design(&sensor, "")?;
    let full_scale = design.hardware.full_scale_pa;
    let step = full_scale / f64::from(design.hardware.data_bits - 1).exp2();
    let floor = design.algorithm.noise_floor_pa;
    let peak = swept.frames()?.iter().flat_map(|frame| &frame.stress).fold(0.0_f64, |max, b| max.max(b.abs()));
    for (name, to) in [
        ("peak at the full scale", full_scale),
        ("peak at twice the full scale", 2.0 * full_scale),
        ("peak at 100 noise floors", 100.0 * floor),
        ("peak at the noise floor", floor),
        ("peak at one step", step),
    ] {
        let contacts = vec![Contact { normal_force_n: FORCE_N * to / peak, ..contact(&sensor, 7.0) }];
        let swept = Scene { contacts, ..swept.clone() };
        cases.scene("range", name, "", &swept)?;
        if to <= full_scale && to > floor {
            cases.scene("range", format!("{name}, {OWN_RANGE}"), &format!("[hardware]\n{OWN_RANGE}"), &swept)?;
        }
    }
    let all = |value: f64| vec![value; sensor.taxels()];
    let checkered = |value: f64| {
        let sign = |taxel: usize| if (taxel % 10 + taxel / 10).is_multiple_of(2) { value } else { -value };
        (0..sensor.taxels()).map(sign).collect::<Vec<f64>>()
    };
    cases.frames("range", "full scale everywhere", vec![all(-full_scale), all(full_scale)])?;
    cases.frames("range", "full scale, signs alternating", vec![checkered(full_scale), checkered(-full_scale)])?;
    cases.frames("range", "one step everywhere", vec![all(-step), all(step), checkered(step)])?;
    let largest = f64::from(f32::MAX);
    cases.frames("range", "the largest float32", vec![all(-largest), checkered(largest)])
}

fn without_answer(cases: &mut Cases) -> Result<(), CornerCasesError> {
    let taxels = sensor_1().taxels();
    let one = |value: f64| (0..taxels).map(|taxel| if taxel == 44 { value } else { 0.0 }).collect::<Vec<f64>>();
    cases.frames("frame", "no contact", vec![vec![0.0; taxels], vec![-0.0; taxels], vec![-1e-3; taxels]])?;
    cases.frames("frame", "no tension", vec![vec![-1000.0; taxels], one(-1000.0)])?;
    cases.frames("frame", "no compression", vec![vec![1000.0; taxels]])?;
    cases.frames("frame", "one taxel", vec![one(-50_000.0), one(50_000.0), one(-1e5)])?;
    cases.frames("frame", "NaN and infinities", vec![one(f64::NAN), one(f64::INFINITY), one(f64::NEG_INFINITY)])
}
