//! What the points of a sensor come to: a design to take, and three sentences that say why.

use std::collections::BTreeMap;
use std::fmt::Write;

use golden::design::PlanKind;
use serde::Serialize;

use super::paper::TABLE_3;
use crate::figures::grouped;
use crate::sweep::point::{Calibration, Hardware, Point, paper_sensor};

/// Errors that differ by no more, in percent of the normal force, are taken for equal.
const AS_GOOD: f64 = 0.5;
/// A variant that errs by more times the least error is none to take for its speed.
const WORTH: f64 = 2.0;

/// The head of a sensor's part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Conclusion {
    sentences: Vec<String>,
    /// The recommended variant as keys of a design file.
    keys: String,
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

    /// The scene with the largest error, and that error.
    fn worst(&self) -> (&str, f64) {
        let each = self.errors.iter().map(|&(scene, tangential, normal)| (scene, tangential.max(normal)));
        each.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
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
    let fastest_of_all = variants.iter().min_by_key(quickest)?;
    let exact = variants.iter().filter(|variant| variant.error() <= WORTH * best.error());
    let fastest = exact.min_by_key(quickest)?;
    let is_best = |point: &&&Point| point.label() == best.point.label() && scenes.contains(&point.scene.as_str());
    let frames: usize = points.iter().filter(is_best).map(|point| point.frames).sum();
    let (worst, at_worst) = best.worst();
    let mut sentences = vec![format!(
        "Take {}: of {} variants none errs by half a point less, and of those that err as little it has the least product \
         of cycles and multipliers. On {} ({frames} frames in all) its largest error{} is {:.1} % of the normal force \
         along x and y and {:.1} % along z{}. It takes {} cycles, {:.1} µs, with {} DSP and {:.1} RAMB36; {} frames a \
         second.",
        best.point.label(),
        variants.len(),
        listed(scenes),
        if scenes.len() > 1 { ", averaged over the scenes," } else { "" },
        best.mean(|error| error.1),
        best.mean(|error| error.2),
        if scenes.len() > 1 { format!("; on {worst}, the hardest, {at_worst:.1} %") } else { String::new() },
        grouped(best.hardware.latency_cycles),
        best.hardware.latency_us,
        best.hardware.dsp,
        best.hardware.bram36,
        grouped((1e6 / best.hardware.interval_us).round() as u64),
    )];
    sentences.extend(beside_the_paper(best));
    let mut last = format!(
        "Fastest of those that err by at most twice as much is {}, {:.1} µs on {} DSP, with errors of {:.1} %",
        fastest.point.label(),
        fastest.hardware.latency_us,
        fastest.hardware.dsp,
        fastest.error()
    );
    if fastest.point.key == best.point.key {
        "None that errs by at most twice as much is faster".clone_into(&mut last);
    }
    if fastest_of_all.point.key != fastest.point.key {
        // Writing to a String cannot fail.
        let _ = write!(
            last,
            "; fastest of all is {}, {:.1} µs with {:.1} %",
            fastest_of_all.point.label(),
            fastest_of_all.hardware.latency_us,
            fastest_of_all.error()
        );
    }
    let filtered = variants.iter().filter(|variant| variant.is_filtered() && variant.point.key != best.point.key);
    if let Some(filtered) = filtered.min_by(|a, b| a.error().total_cmp(&b.error())) {
        let verdict = match filtered.error() - best.error() {
            more if more > AS_GOOD => "which is less exact",
            less if less < -AS_GOOD => "which is more exact",
            _ => "which is as exact",
        };
        let time = match filtered.hardware.latency_us / best.hardware.latency_us {
            less if less < 0.95 => format!("{:.0} % of the time", 100.0 * less),
            more if more > 1.05 => format!("{more:.1} times as long"),
            _ => "as long".to_owned(),
        };
        // Writing to a String cannot fail.
        let _ = write!(
            last,
            "; of the filtered ones the most exact is {}, with {:.1} % in {:.1} µs, {verdict} and takes {time}",
            filtered.point.label(),
            filtered.error(),
            filtered.hardware.latency_us,
        );
    }
    sentences.push(last + ".");
    Some(Conclusion { sentences, keys: keys(best.point) })
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

/// The paper's hardware without a filter, if the sensor is one of its two.
fn beside_the_paper(best: &Variant<'_>) -> Option<String> {
    let number = paper_sensor(&best.point.sensor)?;
    let row = TABLE_3.iter().find(|row| (row.sensor, row.filter, row.software) == (number, "none", false))?;
    Some(format!(
        "The published hardware without a filter errs by {:.1} and {:.1} % on a contact of its own, against finite elements, \
         and takes {:.2} ms: {} times as long.",
        row.max[0].max(row.max[1]),
        row.max[2],
        row.milliseconds,
        grouped((1000.0 * row.milliseconds / best.hardware.latency_us).round() as u64)
    ))
}

fn listed(names: &[&str]) -> String {
    match names {
        [one] => format!("scene {one}"),
        [rest @ .., last] => format!("scenes {} and {last}", rest.join(", ")),
        [] => String::new(),
    }
}

fn keys(point: &Point) -> String {
    let filter = match point.filter.split_once('=') {
        Some((kind, value)) => {
            let (kind, key) = kind.split_once(' ').unwrap_or((kind, "l"));
            format!("{{ kind = \"{kind}\", {key} = {value} }}")
        }
        // The choices of F3 are the design's.
        None if point.filter == "f3" => {
            "{ kind = \"f3\", scenes = [\"SCENE.toml\"] }   # your own, then sptfra tune-filter".to_owned()
        }
        None => format!("{{ kind = \"{}\" }}", point.filter),
    };
    let calibrated = point.calibration.map_or_else(String::new, |Calibration { units, training_set }| {
        let remark = if units > 0 { format!("   # sptfra calibrate --hidden {units}") } else { String::new() };
        format!("\ntraining_set = \"{training_set}\"{remark}")
    });
    let plan = if point.plan == PlanKind::Paper { "paper" } else { "reduced" };
    format!(
        "[algorithm]\nplan = \"{plan}\"\nfilter = {filter}\nestimator = \"{}\"{calibrated}\n\n[hardware]\nlanes = {}\n\
         coefficient_bits = {}\ndata_bits = {}\n",
        point.estimator, point.lanes, point.coefficient_bits, point.data_bits
    )
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::accuracy::StatusCounts;
    use crate::sweep::point::{Geometry, Verified};
    use golden::design::{Design, Estimator, Kernel};
    use golden::metrics::{ErrorSummary, Outcome};

    /// A point on a scene: multipliers, cycles, and its error along x in percent.
    pub(in crate::sweep::page) fn point(scene: &str, lanes: usize, cycles: u64, error: f64) -> Point {
        let truth = Outcome { force: [0.0, 0.0, -1.0], friction: 0.0, direction: 0.0 };
        let found = Outcome { force: [0.01 * error, 0.0, -1.0], ..truth };
        let errors = ErrorSummary::new(&[(truth, found)]);
        Point {
            key: format!("{scene}{lanes}"),
            sensor: Geometry { columns: 10, rows: 10, pitch_mm: [4.0, 2.0], depth_mm: 3.0 },
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
        let [take, paper, others] = found.sentences.as_slice() else { panic!("{found:?}") };
        assert!(take.starts_with("Take no filter, reduced plan, line, 16 lanes"), "{take}");
        assert!(take.contains("of 4 variants") && take.contains("averaged over the scenes, is 1.9 %"), "{take}");
        assert!(take.contains("; on b, the hardest, 2.8 %") && take.contains("(2 frames in all)"), "{take}");
        assert!(paper.contains("28.76 ms: 1,798 times"), "{paper}");
        let fastest = "Fastest of those that err by at most twice as much is no filter, reduced plan, line, 64 lanes";
        assert!(others.starts_with(fastest) && !others.contains("fastest of all"), "{others}");
        assert!(found.keys.contains("filter = { kind = \"none\" }") && found.keys.contains("lanes = 16"), "{found:?}");
        assert_eq!(conclusion(&points, &["a", "b", "c"]), None);
        assert_eq!(conclusion(&points, &[]), None);
    }

    /// A filter that saves neither cycles nor multipliers is none to take, nor one to speak of.
    #[test]
    fn of_equal_variants_that_with_fewer_memories_is_taken() {
        let plain = point("a", 16, 2000, 2.0);
        let mut filtered = point("a", 16, 2000, 2.0);
        "f2 p=50".clone_into(&mut filtered.filter);
        "filtered".clone_into(&mut filtered.key);
        filtered.hardware.as_mut().expect("hardware").bram36 += 6.0;
        let found = conclusion(&[&filtered, &plain], &["a"]).expect("a conclusion");
        assert!(found.sentences[0].starts_with("Take no filter"), "{:?}", found.sentences);
        let alone = conclusion(&[&filtered], &["a"]).expect("a conclusion");
        assert!(!alone.sentences.concat().contains("of the filtered ones"), "{:?}", alone.sentences);
    }

    /// What is fast and wrong is half a sentence.
    #[test]
    fn the_fastest_is_one_to_take() {
        let points = [point("a", 16, 2000, 2.0), point("a", 64, 1000, 3.9), point("a", 32, 900, 4.1)];
        let found = conclusion(&points.each_ref(), &["a"]).expect("a conclusion");
        let last = found.sentences.last().expect("sentences");
        assert!(last.contains("is no filter, reduced plan, line, 64 lanes, 18 × 27 bits, 8.0 µs"), "{last}");
        assert!(last.contains("; fastest of all is no filter, reduced plan, line, 32 lanes"), "{last}");
        let alone = conclusion(&[&points[0], &points[2]], &["a"]).expect("a conclusion");
        let last = alone.sentences.last().expect("sentences");
        assert!(last.starts_with("None that errs by at most twice as much is faster; fastest of all is"), "{last}");
    }

    #[test]
    fn filters_are_written_as_a_design_file_has_them() {
        let of = |filter: &str| keys(&Point { filter: filter.to_owned(), ..point("a", 4, 1, 1.0) });
        for filter in ["none", "f1 l=10", "f2 p=50", "f3"] {
            let sensor = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
                 name = \"pad\"\n[sensor]\ncolumns = 4\nrows = 4\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
            // The reduced plan does not know F3.
            let text = format!("{sensor}{}", of(filter)).replace("plan = \"reduced\"", "plan = \"paper\"");
            assert!(Design::from_toml(&text, "pad.toml").is_ok(), "{text}");
        }
        assert!(of("f1 l=40").contains("filter = { kind = \"f1\", l = 40 }"));
        assert!(of("f2 p=50").contains("filter = { kind = \"f2\", p = 50 }"));
    }
}
