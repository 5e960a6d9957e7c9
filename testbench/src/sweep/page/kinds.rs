//! What the hardware of each design makes of contacts of other kinds than those of the scenes.

use golden::design::{Design, Filter};
use golden::metrics::Quantiles;
use golden::scene::{Kind, SceneFrame};
use golden::status::Status;
use golden::table::{Cell, Table};
use hdl_gen::plan::Plan;

use super::PageError;
use crate::frame_set::FrameSet;
use crate::stream_words::Answer;
use crate::sweep::SweepError;
use crate::sweep::evaluate::answers;

/// Friction of the contacts of kinds that have none of their own.
pub const FRICTION: f64 = 0.5;
/// First seed: those of the calibrations' own contacts are others.
const FIRST_SEED: u64 = 1000;

/// The errors of the unfiltered designs of a sensor, kind by kind, on so many frames each; nothing for no frames or
/// without such a design.
///
/// # Errors
/// [`PageError::Sweep`] if the frames cannot be made or a design has no answer.
pub fn table(designs: &[&Design], frames: u64) -> Result<Option<Table>, PageError> {
    let shows = |design: &&Design| design.algorithm.filter == Filter::None && Plan::new(design).is_ok();
    let shown: Vec<&Design> = designs.iter().copied().filter(shows).collect();
    let Some(sensor) = shown.first().map(|design| &design.sensor).filter(|_| frames > 0) else { return Ok(None) };
    let made = Kind::ALL
        .map(|kind| kind.frames(sensor, FRICTION, FIRST_SEED..FIRST_SEED + frames).map(|frames| (kind, frames)))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(SweepError::from)?;
    let stress = made.iter().flat_map(|(_, frames)| frames).map(|frame| frame.stress.clone()).collect();
    let all = FrameSet { origin: String::new(), stress, truth: None, scene: None };
    let mut header = vec![format!("contacts, {frames} frames of each kind")];
    let mut columns = Vec::new();
    for design in shown {
        header.extend([design.name.clone(), "flagged, %".to_owned()]);
        columns.push(answers(design, &all)?);
    }
    let mut table = Table::new(header);
    for (index, (kind, frames)) in made.iter().enumerate() {
        let first = index * frames.len();
        let cells = columns.iter().flat_map(|found| judged(frames, &found[first..][..frames.len()]));
        table.row(std::iter::once(Cell::from(kind.title())).chain(cells));
    }
    Ok(Some(table))
}

/// Median, 95 % and worst of the errors along the surface, in percent of the normal force; and how many of the frames
/// say more than that they are good.
fn judged(frames: &[SceneFrame], found: &[Answer]) -> [Cell; 2] {
    let error = |(frame, answer): (&SceneFrame, &Answer)| {
        let [x, y] = [0, 1].map(|axis| answer.resultant[axis] - frame.force[axis]);
        100.0 * x.hypot(y) / frame.force[2].abs()
    };
    let Quantiles { median, most, worst } = Quantiles::of(frames.iter().zip(found).map(error).collect());
    // A slipping contact is no doubtful one.
    let tells = |answer: &&Answer| answer.status & !Status::SLIP.0 != 0;
    let flagged = 100.0 * found.iter().filter(tells).count() as f64 / found.len() as f64;
    [Cell::from(format!("{median:.1} / {most:.1} / {worst:.1}")), Cell::from(format!("{flagged:.0}"))]
}
