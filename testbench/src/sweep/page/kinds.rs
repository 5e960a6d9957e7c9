//! What the hardware of each design makes of contacts of other kinds than those of the scenes.

use golden::design::{Design, Filter, PlanKind};
use golden::metrics::Quantiles;
use golden::scene::SceneFrame;
use golden::solver::{Solution, Status};
use golden::table::Table;
use hdl_gen::plan::Plan;

use super::PageError;
use crate::frame_set::FrameSet;
use crate::sweep::evaluate::answers;
use crate::sweep::point::Calibration;
use crate::sweep::{SweepError, frames_of_kinds};

/// Those of the unfiltered designs with hardware that answer differently: another plan or more lanes change a digit at most,
/// and of such designs only the first by the reduced plan is shown.
pub(super) fn distinct<'a>(designs: &[&'a Design]) -> Vec<&'a Design> {
    let shows = |design: &&Design| design.algorithm.filter == Filter::None && Plan::new(design).is_ok();
    let shown: Vec<&Design> = designs.iter().copied().filter(shows).collect();
    let same = |a: &Design, b: &Design| {
        let of =
            |design: &Design| (design.algorithm.estimator, design.algorithm.kernel, Calibration::of(&design.algorithm));
        of(a) == of(b) && a.input == b.input
    };
    let is_paper = |design: &Design| design.algorithm.plan == PlanKind::Paper;
    let is_first = |&(index, design): &(usize, &&Design)| {
        let mut others = shown.iter().enumerate().filter(|(other, _)| *other != index);
        !others.any(|(other, first)| same(first, design) && (is_paper(first), other) < (is_paper(design), index))
    };
    shown.iter().enumerate().filter(is_first).map(|(_, design)| *design).collect()
}

/// The errors of the unfiltered designs of a sensor, in the order of the page, kind by kind, on so many frames each; nothing
/// for no frames or without such a design.
///
/// # Errors
/// [`PageError::Sweep`] if the frames cannot be made or a design has no answer.
pub fn table(designs: &[&Design], frames: u64) -> Result<Option<Table>, PageError> {
    let shown = distinct(designs);
    let Some(sensor) = shown.first().map(|design| &design.sensor).filter(|_| frames > 0) else { return Ok(None) };
    let made = frames_of_kinds(sensor, frames).map_err(SweepError::from)?;
    let all: Vec<SceneFrame> = made.iter().flat_map(|(_, frames)| frames).cloned().collect();
    let all = FrameSet::of_frames(&all, "contacts of all kinds");
    let mut header = vec![format!("contacts, {frames} frames of each kind")];
    let mut columns = Vec::new();
    for design in shown {
        header.extend([format!("{}, {}", design.name, design.algorithm.estimator), "flagged, %".to_owned()]);
        columns.push(answers(design, &all)?);
    }
    let mut table = Table::new(header);
    for (index, (kind, frames)) in made.iter().enumerate() {
        let first = index * frames.len();
        let cells = columns.iter().flat_map(|found| judged(frames, &found[first..][..frames.len()]));
        table.row(std::iter::once(kind.title().to_owned()).chain(cells));
    }
    Ok(Some(table))
}

/// Median, 95 % and worst of the errors along the surface, in percent of the normal force; and how many of the frames
/// say more than that they are good.
fn judged(frames: &[SceneFrame], found: &[Solution]) -> [String; 2] {
    let error = |(frame, answer): (&SceneFrame, &Solution)| {
        let [x, y] = [0, 1].map(|axis| answer.resultant[axis] - frame.force[axis]);
        100.0 * x.hypot(y) / frame.force[2].abs()
    };
    let Quantiles { median, most, worst } = Quantiles::of(frames.iter().zip(found).map(error).collect());
    // A slipping contact has no low confidence by that.
    let tells = |answer: &&Solution| answer.status.0 & !Status::SLIP.0 != 0;
    let flagged = 100.0 * found.iter().filter(tells).count() as f64 / found.len() as f64;
    [format!("{median:.1} / {most:.1} / {worst:.1}"), format!("{flagged:.0}")]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn designs_that_answer_alike_are_one() {
        let designs = ["sensor1-fast", "paper", "sensor1-reduced", "sensor1-fast-100", "sensor1-fast-64", "paper"];
        let mut designs = designs.map(|name| {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs");
            Design::load(&folder.join(format!("{name}.toml"))).expect("a design")
        });
        designs[5].algorithm.filter = Filter::F2 { p: 50.0 };
        let names: Vec<String> = distinct(&designs.each_ref()).iter().map(|design| design.name.clone()).collect();
        assert_eq!(names, ["sensor1_fast", "sensor1_reduced", "sensor1_fast_100"]);
    }
}
