//! What the points of a sensor come to: a design to take, beside the others that one would ask for.

use std::collections::BTreeMap;

use golden::table::Table;
use serde::Serialize;

use crate::figures::grouped;
use crate::sweep::point::{Hardware, Point};

/// Errors that differ by no more, in percent of the normal force, are taken for equal.
const AS_GOOD: f64 = 0.5;
/// A variant that errs by more times the least error is none to take for its speed.
const WORTH: f64 = 2.0;

/// Above the columns of the choices.
const HEADER: [&str; 8] = ["", "x, y %", "z %", "hardest scene %", "µs", "DSP", "RAMB36", "frames/s"];

/// The head of a sensor's part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Conclusion {
    /// On what the variants were judged.
    judged: String,
    /// The choices.
    table: Table,
}

/// A variant with its largest errors on the scenes that tell, in percent of the normal force.
struct Variant<'a> {
    point: &'a Point,
    hardware: &'a Hardware,
    /// Of each scene: its name, the error along x and y, and that along z.
    errors: Vec<(&'a str, f64, f64)>,
}

impl Variant<'_> {
    /// The mean over the scenes of one of the errors.
    fn mean(&self, error: impl Fn(&(&str, f64, f64)) -> f64) -> f64 {
        self.errors.iter().map(error).sum::<f64>() / self.errors.len() as f64
    }

    /// What variants are judged by: the mean over the scenes of the larger of both errors. The worst scene alone would
    /// decide for who is least bad on the hardest one, whatever it makes of the others.
    fn error(&self) -> f64 {
        self.mean(|&(_, tangential, normal)| tangential.max(normal))
    }

    /// The error on the hardest scene.
    fn worst(&self) -> f64 {
        self.errors.iter().map(|&(_, tangential, normal)| tangential.max(normal)).fold(0.0, f64::max)
    }

    /// Its row of the table.
    fn row(&self, role: &str) -> Vec<String> {
        let Hardware { latency_us, interval_us, dsp, bram36, .. } = *self.hardware;
        vec![
            format!("{role}: {}", self.point.label()),
            format!("{:.1}", self.mean(|error| error.1)),
            format!("{:.1}", self.mean(|error| error.2)),
            format!("{:.1}", self.worst()),
            format!("{latency_us:.1}"),
            dsp.to_string(),
            format!("{bram36:.1}"),
            grouped((1e6 / interval_us).round() as u64),
        ]
    }

    /// Cycles times multipliers: what a variant asks of a device for a frame. Of those that ask as much, that with fewer
    /// memories, in halves, and with all entries.
    fn cost(&self) -> (u64, u64, u64, bool) {
        let Hardware { latency_cycles, dsp, bram36, .. } = *self.hardware;
        (latency_cycles * dsp as u64, latency_cycles, (2.0 * bram36) as u64, self.is_filtered())
    }

    fn is_filtered(&self) -> bool {
        self.point.filter != "none"
    }
}

/// The conclusion from a sensor's points on `scenes`, those whose forces tell something; nothing without hardware that
/// was judged on all of them.
pub fn conclusion(points: &[&Point], scenes: &[&str]) -> Option<Conclusion> {
    let variants = variants(points, scenes);
    let best = best(&variants)?;
    let quickest = |variant: &&Variant| (variant.hardware.latency_cycles, variant.cost());
    let exact = variants.iter().filter(|variant| variant.error() <= WORTH * best.error());
    let filtered = variants.iter().filter(|variant| variant.is_filtered());
    let roles = [
        ("recommended", Some(best)),
        ("fastest with at most twice its error", exact.min_by_key(quickest)),
        ("fastest", variants.iter().min_by_key(quickest)),
        ("most exact with a filter", filtered.min_by(|a, b| a.error().total_cmp(&b.error()))),
    ];
    let mut shown: Vec<(&Variant, Vec<&str>)> = Vec::new();
    for (role, variant) in roles {
        let Some(variant) = variant else { continue };
        match shown.iter_mut().find(|(known, _)| known.point.key == variant.point.key) {
            Some((_, roles)) => roles.push(role),
            None => shown.push((variant, vec![role])),
        }
    }
    let table = Table::new(HEADER).with(shown.iter().map(|(variant, roles)| variant.row(&roles.join(", "))));
    let is_best = |point: &&&Point| point.label() == best.point.label() && scenes.contains(&point.scene.as_str());
    let frames: usize = points.iter().filter(is_best).map(|point| point.frames).sum();
    let judged = format!(
        "Errors in percent of the normal force, the largest on each scene, averaged over: {} ({frames} frames). Recommended \
         is the least product of cycles and multipliers among those within half a point of the least error, of {} variants.",
        scenes.join(", "),
        variants.len()
    );
    Some(Conclusion { judged, table })
}

/// The point of the variant that is recommended, as [`conclusion`] names it.
pub fn recommended<'a>(points: &[&'a Point], scenes: &[&str]) -> Option<&'a Point> {
    best(&variants(points, scenes)).map(|variant| variant.point)
}

/// Of those that err least the one that asks least of a device.
fn best<'v, 'a>(variants: &'v [Variant<'a>]) -> Option<&'v Variant<'a>> {
    let least = variants.iter().map(Variant::error).min_by(f64::total_cmp)?;
    let as_good = variants.iter().filter(|variant| variant.error() <= least + AS_GOOD);
    as_good.min_by_key(|variant| variant.cost())
}

/// The variants with hardware and the widest words that were judged on all scenes, by name, so that their order is always
/// the same. Narrower words cost as much here.
fn variants<'a>(points: &[&'a Point], scenes: &[&str]) -> Vec<Variant<'a>> {
    let bits = |point: &Point| (point.coefficient_bits, point.data_bits);
    let widest = points.iter().map(|&point| bits(point)).max();
    let mut found: BTreeMap<String, Vec<&'a Point>> = BTreeMap::new();
    for point in points.iter().filter(|point| scenes.contains(&point.scene.as_str()) && Some(bits(point)) == widest) {
        found.entry(point.label()).or_default().push(point);
    }
    found.retain(|_, points| points.len() == scenes.len() && !scenes.is_empty());
    let errors = |point: &&'a Point| (point.scene.as_str(), point.tangential(), point.errors.e_fz.max);
    found
        .into_values()
        .filter_map(|points| {
            Some(Variant {
                point: points[0],
                hardware: points[0].hardware.as_ref()?,
                errors: points.iter().map(errors).collect(),
            })
        })
        .collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::accuracy::StatusCounts;
    use crate::sweep::point::Verified;
    use golden::design::{Estimator, Kernel, PlanKind, Sensor};
    use golden::metrics::{ErrorSummary, Outcome};

    /// A point on a scene: multipliers, cycles, and its error along x in percent.
    pub(in crate::sweep::page) fn point(scene: &str, lanes: usize, cycles: u64, error: f64) -> Point {
        let truth = Outcome { force: [0.0, 0.0, -1.0], friction: 0.0, direction: 0.0 };
        let found = Outcome { force: [0.01 * error, 0.0, -1.0], ..truth };
        let errors = ErrorSummary::new(&[(truth, found)]);
        Point {
            key: format!("{scene}{lanes}"),
            sensor: Sensor { columns: 10, rows: 10, pitch_mm: [4.0, 2.0], depth_mm: 3.0 },
            scene: scene.to_owned(),
            plan: PlanKind::Reduced,
            kernel: Kernel::Point,
            filter: "none".to_owned(),
            estimator: Estimator::Line,
            calibration: None,
            coefficient_bits: 18,
            data_bits: 27,
            lanes,
            verified: Verified::Model,
            refusal: None,
            hardware: Some(Hardware {
                latency_cycles: cycles,
                interval_cycles: cycles,
                latency_us: cycles as f64 / 125.0,
                interval_us: cycles as f64 / 125.0,
                dsp: lanes,
                bram36: 1.0,
                rom_bits: 1,
                macs: 1,
            }),
            nnz: BTreeMap::new(),
            nnz_total: 0,
            frames: 1,
            mean_mu: 0.0,
            errors,
            solver_errors: errors,
            against_solver: None,
            status_counts: StatusCounts::of(&[]),
        }
    }

    /// The first five columns.
    fn rows(found: &Conclusion) -> Vec<[String; 5]> {
        found.table.rows.iter().map(|row| [0, 1, 2, 3, 4].map(|column| row[column].clone())).collect()
    }

    #[test]
    fn the_cheapest_of_the_most_exact_is_taken() {
        let points = [
            point("a", 4, 9000, 2.4),
            point("a", 16, 2000, 1.0),
            point("a", 64, 1000, 2.1),
            point("a", 8, 1500, 9.0),
            // Exact on one scene only, and there alone.
            point("a", 32, 10, 0.1),
            point("b", 4, 9000, 1.0),
            // The worst of all on one scene, though not in the mean.
            point("b", 16, 2000, 2.8),
            point("b", 64, 1000, 1.0),
            point("b", 8, 1500, 1.0),
        ];
        let points: Vec<&Point> = points.iter().collect();
        let found = conclusion(&points, &["a", "b"]).unwrap();
        let expected = [
            ["recommended: no filter, reduced plan, line, 16 lanes, 18 × 27 bits", "1.9", "0.0", "2.8", "16.0"],
            [
                "fastest with at most twice its error, fastest: no filter, reduced plan, line, 64 lanes, 18 × 27 bits",
                "1.6",
                "0.0",
                "2.1",
                "8.0",
            ],
        ];
        assert_eq!(rows(&found), expected);
        assert!(
            found.judged.contains("over: a, b (2 frames)") && found.judged.ends_with("of 4 variants."),
            "{}",
            found.judged
        );
        assert_eq!(conclusion(&points, &["a", "b", "c"]), None);
        assert_eq!(conclusion(&points, &[]), None);
    }

    /// A filter that saves neither cycles nor multipliers is none to take.
    #[test]
    fn of_equal_variants_that_with_fewer_memories_is_taken() {
        let plain = point("a", 16, 2000, 2.0);
        let mut filtered = point("a", 16, 2000, 2.0);
        "f2 p=50".clone_into(&mut filtered.filter);
        "filtered".clone_into(&mut filtered.key);
        filtered.hardware.as_mut().expect("hardware").bram36 += 6.0;
        let found = conclusion(&[&filtered, &plain], &["a"]).expect("a conclusion");
        let [first, second] = rows(&found).try_into().expect("two rows");
        assert!(first[0].contains("recommended, ") && first[0].contains(": no filter"), "{first:?}");
        assert!(second[0].starts_with("most exact with a filter: F2 p = 50"), "{second:?}");
        let alone = conclusion(&[&filtered], &["a"]).expect("a conclusion");
        assert_eq!(rows(&alone).len(), 1, "one row with all roles");
    }

    /// What is fast and wrong has a row of its own.
    #[test]
    fn the_fastest_is_one_to_take() {
        let points = [point("a", 16, 2000, 2.0), point("a", 64, 1000, 3.9), point("a", 32, 900, 4.1)];
        let found = rows(&conclusion(&points.each_ref(), &["a"]).expect("a conclusion"));
        let [_, exact, fastest] = found.try_into().expect("three rows");
        assert!(
            exact[0].starts_with("fastest with at most twice its error: ") && exact[0].contains("64 lanes"),
            "{exact:?}"
        );
        assert!(fastest[0].starts_with("fastest: ") && fastest[0].contains("32 lanes"), "{fastest:?}");
    }
}
