//! Cycles of a frame against lanes and taxels: predicted for all, simulated for some.

use golden::design::{Design, DesignError};
use hdl_gen::plan::Plan;
use serde::Serialize;

use super::BenchError;
use crate::PLAIN_DESIGN;
use golden::progress::Progress;
use testbench::co_simulation::{CoSimulation, planned};
use testbench::frame_set::FrameSet;
use testbench::simulate::Cycles;
use testbench::stream_words::packets;

/// Sides of the square sensors.
pub const SIDES: [usize; 8] = [4, 6, 8, 10, 12, 16, 24, 32];
/// Numbers of lanes.
pub const LANES: [usize; 5] = [4, 8, 16, 32, 64];
/// What is simulated too: kind, side, lanes.
const SIMULATED: [(Kind, usize, usize); 10] = [
    (Kind::Reduced, 4, 16),
    (Kind::Reduced, 10, 4),
    (Kind::Reduced, 10, 16),
    (Kind::Reduced, 10, 64),
    (Kind::Reduced, 16, 16),
    (Kind::Filtered, 10, 16),
    (Kind::Filtered, 16, 16),
    (Kind::Paper, 10, 16),
    (Kind::Joint, 10, 16),
    (Kind::Joint, 10, 64),
];
const SEED: u32 = 1;

/// What a design of the series computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The reduced plan, no filter.
    Reduced,
    /// The reduced plan with F2, p = 1.
    Filtered,
    /// The paper's plan, no filter.
    Paper,
    /// The reduced plan with the grid search, no filter and no network: one is trained for a sensor.
    Joint,
}

impl Kind {
    /// In the order of the page.
    pub const ALL: [Self; 4] = [Self::Reduced, Self::Filtered, Self::Paper, Self::Joint];

    /// For people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Reduced => "reduced plan, no filter",
            Self::Filtered => "reduced plan, F2 with p = 1",
            Self::Paper => "the paper's plan, no filter",
            Self::Joint => "reduced plan, no filter, the grid search without a network",
        }
    }

    /// Keys of the design file.
    fn keys(self) -> &'static str {
        match self {
            Self::Reduced => "plan = \"reduced\"",
            Self::Filtered => "plan = \"reduced\"\nfilter = { kind = \"f2\", p = 1.0 }",
            Self::Paper => "plan = \"paper\"",
            Self::Joint => "plan = \"reduced\"\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]",
        }
    }
}

/// One design of the series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// What it computes.
    pub kind: Kind,
    /// Columns and rows.
    pub side: usize,
    /// Lanes.
    pub lanes: usize,
    /// Multiply-accumulates of a frame, over all lanes.
    pub macs: u64,
    /// By the plan.
    pub predicted: Cycles,
    /// By simulation, where it was done.
    pub simulated: Option<Cycles>,
}

/// A square sensor with the pitch and depth of the paper's sensor 1.
///
/// # Errors
/// [`DesignError`] if side or lanes are out of range.
pub fn square(kind: Kind, side: usize, lanes: usize) -> Result<Design, DesignError> {
    let keys = kind.keys();
    let text = format!(
        "{PLAIN_DESIGN}name = \"square_{side}\"\n[sensor]\ncolumns = {side}\nrows = {side}\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\n{keys}\n[hardware]\nlanes = {lanes}\n"
    );
    Design::from_toml(&text, "series of square sensors")
}

/// The whole series up to the `largest` side.
pub(super) fn measure(largest: usize, progress: &Progress) -> Result<Vec<Point>, BenchError> {
    let mut points = Vec::new();
    for kind in Kind::ALL {
        for side in SIDES.into_iter().filter(|&side| side <= largest) {
            for lanes in LANES {
                progress.stage(format!("planning {side} × {side}, {lanes} lanes, {}", kind.title()));
                let plan = planned(&square(kind, side, lanes)?)?;
                let simulated = if SIMULATED.contains(&(kind, side, lanes)) {
                    progress.stage(format!("simulating {side} × {side}, {lanes} lanes, {}", kind.title()));
                    Some(simulate(&plan)?)
                } else {
                    None
                };
                let predicted = Cycles::predicted(&plan);
                points.push(Point { kind, side, lanes, macs: plan.macs(), predicted, simulated });
            }
        }
    }
    Ok(points)
}

/// The cycles of the sensor's standing frames, if the words are right too.
fn simulate(plan: &Plan) -> Result<Cycles, BenchError> {
    let frames = FrameSet::standing(&plan.design.sensor)?.stress;
    let verdict = CoSimulation::new(plan, packets(plan.streams(), &frames), SEED).run()?;
    let wrong = |fault| BenchError::Wrong { design: plan.design.name.clone(), fault };
    Ok(verdict.right().map_err(wrong)?.cycles)
}
