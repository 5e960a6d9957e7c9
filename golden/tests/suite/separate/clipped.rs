//! Several contacts on sensors that read no tension.

use std::ops::Range;

use golden::design::Sensor;
use golden::metrics::ContactErrors;
use golden::scene::SceneFrame;
use golden::solver::Solver;

use super::kinds::{Kind, frame};
use super::{design, judge};

/// Frames of a kind as a sensor reads them that knows no pull.
pub fn frames(sensor: &Sensor, kind: Kind, seeds: Range<u64>) -> Vec<SceneFrame> {
    let mut frames: Vec<SceneFrame> = seeds.map(|seed| frame(sensor, kind, seed)).collect();
    for stress in frames.iter_mut().flat_map(|frame| &mut frame.stress) {
        *stress = stress.min(0.0);
    }
    frames
}

/// Contacts are separated as well as where tension is read; their own forces are half as exact (docs/explanation/accuracy.md).
/// With the tension that each would cause alone left in its frame they would err by 6 to 8 and 28 to 33 %.
#[test]
fn half_of_the_contacts_are_known() {
    for (name, kind) in [("sensor1-clipped-wide", Kind::Opposed), ("sensor2-clipped-wide", Kind::Anyhow)] {
        let [one, several] = [1, 4].map(|contacts| Solver::new(&design(name, contacts)).unwrap());
        let frames = frames(one.matrices().sensor(), kind, 7000..7024);
        let [one, several] = [one, several].map(|solver| judge(&solver, &frames));
        let ContactErrors { tangential, normal, right, within, .. } = several.contacts;
        let said = format!("{name}, {kind:?}: {right} of 24, {tangential:.1?}, {normal:.1?}, {within:.0}");
        assert!(
            right >= 20 && tangential.median < 8.0 && tangential.most < 22.0 && normal.median < 1.9 && within > 90.0,
            "{said}"
        );
        assert!(several.total.median < 0.5 * one.total.median, "{said}: {:.1?} {:.1?}", several.total, one.total);
    }
}
