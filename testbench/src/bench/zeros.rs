//! What passing over zeros saves: cycles of frames by contact, with and without `skip_zeros`.

use golden::design::Design;
use golden::scene::{Contact, Medium, Scene, Shape, Traction};
use hdl_gen::plan::Plan;
use serde::Serialize;

use super::BenchError;
use crate::simulate::Cycles;
use crate::stream::{Exchange, Pacing};
use crate::trial::{self, TrialError, planned};
use golden::progress::Progress;

/// Sides of the square sensors.
const SIDES: [usize; 2] = [10, 20];
const LANES: usize = 16;
const SEED: u32 = 1;
/// The contact, in columns and rows from the corner: centre and semi-axis. It lies within the first quarter.
const CENTRE: f64 = 1.5;
const RADIUS: f64 = 1.5;
/// Tangential over normal force of the contacts.
const FRICTIONS: [f64; 2] = [0.0, 0.4];
/// Directions of the tangential force.
const SWEEP_DEG: [f64; 6] = [0.0, 60.0, 120.0, 180.0, 240.0, 300.0];

/// One sensor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Zeros {
    /// Columns and rows.
    pub side: usize,
    /// With `skip_zeros = false`: the same for every frame.
    pub without: Cycles,
    /// The bound with `skip_zeros = true`, reached by a frame without zeros.
    pub worst: Cycles,
    /// Simulated, contact by contact: friction, and the most cycles over the directions.
    pub contacts: Vec<(f64, Cycles)>,
}

pub(super) fn measure(largest: usize, progress: &Progress) -> Result<Vec<Zeros>, BenchError> {
    let mut rows = Vec::new();
    for side in SIDES.into_iter().filter(|&side| side <= largest) {
        progress.stage(format!("simulating {side} × {side} with zeros passed over"));
        let plain = planned(&square(side, false)?)?;
        let plan = planned(&square(side, true)?)?;
        let built = trial::build(&plan)?;
        let mut core = built.load(SEED).map_err(TrialError::from)?;
        let mut contacts = Vec::new();
        for friction in FRICTIONS {
            let frames = scene(&plan, friction).frames()?;
            let packets: Vec<Vec<u32>> = frames.iter().map(|frame| plan.streams().packet(&frame.stress)).collect();
            let mut run = |pacing| trial::send(&mut core, &plan, &packets, pacing).map(|outcome| outcome.exchanges);
            let alone = run(Pacing::OneAtATime)?;
            let ends: Vec<u64> = run(Pacing::BackToBack)?.iter().map(|exchange| exchange.last_out).collect();
            let latency = alone.iter().map(Exchange::latency).max().unwrap_or_default();
            let interval = ends.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or_default();
            contacts.push((friction, Cycles { latency, interval }));
        }
        rows.push(Zeros { side, without: Cycles::predicted(&plain), worst: Cycles::predicted(&plan), contacts });
    }
    Ok(rows)
}

fn square(side: usize, skip_zeros: bool) -> Result<Design, BenchError> {
    let text = format!(
        "name = \"zeros_{side}\"\n[sensor]\ncolumns = {side}\nrows = {side}\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n[hardware]\nlanes = {LANES}\nskip_zeros = {skip_zeros}\n"
    );
    Ok(Design::from_toml(&text, "sensors with zeros passed over")?)
}

fn scene(plan: &Plan, friction: f64) -> Scene {
    let standing = Scene::standing(&plan.design.sensor);
    let [x, y] = plan.design.sensor.pitch_mm.map(|pitch| pitch * 1e-3);
    let contact = Contact {
        shape: Shape::Hertz { semi_axes_m: [RADIUS * x, RADIUS * y] },
        centre_m: [CENTRE * x, CENTRE * y],
        normal_force_n: 0.5,
        friction,
        traction: Traction::default(),
        direction_deg: 0.0,
    };
    Scene { contacts: vec![contact], medium: Medium::HalfSpace, sweep_deg: SWEEP_DEG.to_vec(), ..standing }
}
