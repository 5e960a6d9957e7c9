//! The page of a sweep: one HTML file without a network, with pictures as SVG, for light and dark.

mod averaged;
pub mod conclusion;
pub mod front;
mod kinds;

use golden::design::{Design, Estimator, Sensor};
use golden::table::Table;
use serde::Serialize;
use tera::{Context, Tera};
use thiserror::Error;

use crate::figures::{grouped, or_dash, percent};
use crate::sweep::point::{Calibration, Point, Verified, sensor_title, sensors};
use crate::sweep::{Sweep, SweepError, SweepScene};

const TEMPLATE: &str = include_str!("../../../templates/report.html.tera");
/// The name ends so that text is escaped.
const NAME: &str = "report.html";
/// Folder beside the page with the designs that it recommends.
pub const RECOMMENDED: &str = "recommended";
/// Variants in a table at most; the CSV has all.
const MOST_ROWS: usize = 150;
const HEADER: [&str; 12] =
    ["variant", "cycles", "µs", "frames/s", "DSP", "RAMB36", "entries", "x, y %", "z %", "µ %", "format %", "verified"];

/// Why there is no page.
#[derive(Debug, Error)]
pub enum PageError {
    /// A table's data cannot be computed.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// The template does not fit.
    #[error("report.html: {0}; please report this")]
    Template(#[from] tera::Error),
}

/// Everything on the page.
#[derive(Clone, Debug, Serialize)]
pub struct Contents {
    version: &'static str,
    points: usize,
    /// How many points were found how.
    pub verified: Vec<(usize, &'static str)>,
    /// Why points are not in hardware, each reason once.
    pub refusals: Vec<String>,
    legend: Vec<(&'static str, &'static str)>,
    sensors: Vec<SensorSection>,
}

/// One sensor's part.
#[derive(Clone, Debug, Serialize)]
struct SensorSection {
    title: String,
    conclusion: Option<conclusion::Conclusion>,
    /// The recommended design as files, the design's own the last.
    recommended: Vec<(String, String)>,
    scenes: Vec<SceneSection>,
    averaged: averaged::Section,
    kinds: Option<Table>,
}

/// One scene's part of it.
#[derive(Clone, Debug, Serialize)]
struct SceneSection {
    name: String,
    svg: String,
    caption: String,
    variants: Table,
    /// Variants that the table leaves out.
    more: usize,
}

impl Contents {
    /// Gathers what the page shows; the table of kinds is computed here.
    ///
    /// # Errors
    /// [`PageError::Sweep`] if a design that was swept has no answer.
    pub fn new(designs: &[Design], sweep: &Sweep, points: &[Point]) -> Result<Self, PageError> {
        let count = |verified: Verified| points.iter().filter(|point| point.verified == verified).count();
        let mut refusals: Vec<String> = points.iter().filter_map(|point| point.refusal.clone()).collect();
        refusals.sort_unstable();
        refusals.dedup();
        let sections = sensors(points)
            .iter()
            .map(|sensor| section(sensor, designs, sweep, points))
            .collect::<Result<_, PageError>>()?;
        Ok(Self {
            version: hdl_gen::emit::VERSION,
            points: points.len(),
            verified: [Verified::Rtl, Verified::Model, Verified::Golden]
                .map(|verified| (count(verified), verified.title()))
                .into_iter()
                .filter(|&(count, _)| count > 0)
                .collect(),
            refusals,
            legend: front::legend(points),
            sensors: sections,
        })
    }

    /// The designs that the page recommends, as files: their places beside the page, and contents.
    pub fn recommended(&self) -> impl Iterator<Item = &(String, String)> {
        self.sensors.iter().flat_map(|sensor| &sensor.recommended)
    }
}

/// The page.
///
/// # Errors
/// [`PageError::Template`] if template and contents do not fit each other.
pub fn render(contents: &Contents) -> Result<String, PageError> {
    let mut tera = Tera::default();
    tera.add_raw_template(NAME, TEMPLATE)?;
    Ok(tera.render(NAME, &Context::from_serialize(contents)?)?)
}

fn section(sensor: &Sensor, designs: &[Design], sweep: &Sweep, points: &[Point]) -> Result<SensorSection, PageError> {
    let own: Vec<&Point> = points.iter().filter(|point| point.sensor == *sensor).collect();
    let designs: Vec<&Design> = designs.iter().filter(|design| design.sensor == *sensor).collect();
    let scenes: Vec<&SweepScene> = sweep.scenes.iter().filter(|scene| scene.sensor == *sensor).collect();
    let telling: Vec<&str> = scenes.iter().filter(|scene| scene.tells()).map(|scene| scene.name.as_str()).collect();
    let recommended = conclusion::recommended(&own, &telling);
    let foremost = in_order(&designs, recommended);
    Ok(SensorSection {
        title: sensor_title(sensor),
        conclusion: conclusion::conclusion(&own, &telling),
        recommended: recommended_design(recommended, &foremost, sweep).as_ref().map(files_of).unwrap_or_default(),
        scenes: scenes.iter().map(|scene| of_scene(scene, &own)).collect(),
        averaged: averaged::section(&foremost)?,
        kinds: kinds::table(&foremost, sweep.kinds)?,
    })
}

fn of_scene(scene: &SweepScene, points: &[&Point]) -> SceneSection {
    let points: Vec<&Point> = points.iter().copied().filter(|point| point.scene == scene.name).collect();
    let frames = scene.frames.stress.len();
    let mut caption = format!("{frames} frame{}", if frames == 1 { "" } else { "s" });
    if scene.contacts.is_empty() {
        caption += ": as many of each kind of contact";
    }
    if !scene.tells() {
        caption += "; the contacts are pushed against each other, so that the sum of their forces tells nothing of either: \
                    no front, no conclusion";
    }
    SceneSection {
        name: scene.name.clone(),
        svg: front::front(&points, scene.tells()),
        caption,
        variants: Table::new(HEADER).ending_in_words().with(points.iter().take(MOST_ROWS).map(|point| row(point))),
        more: points.len().saturating_sub(MOST_ROWS),
    }
}

fn row(point: &Point) -> [String; HEADER.len()] {
    let hardware = point.hardware.as_ref();
    let errors = &point.errors;
    [
        point.label(),
        hardware.map_or_else(String::new, |hardware| grouped(hardware.latency_cycles)),
        or_dash(hardware.map(|hardware| hardware.latency_us), |time| format!("{time:.1}")),
        hardware.map_or_else(String::new, |hardware| grouped((1e6 / hardware.interval_us).round() as u64)),
        hardware.map_or_else(String::new, |hardware| hardware.dsp.to_string()),
        hardware.map_or_else(String::new, |hardware| format!("{:.1}", hardware.bram36)),
        grouped(point.nnz_total as u64),
        percent(point.tangential()),
        percent(errors.e_fz.max),
        percent(errors.e_mu.max),
        or_dash(point.against_solver.and_then(|error| error.field_max), |error| format!("{:.3}", 100.0 * error)),
        point.verified.title().to_owned(),
    ]
}

/// The designs with the recommended point's first, then those by the estimator that new designs have.
fn in_order<'a>(designs: &[&'a Design], recommended: Option<&Point>) -> Vec<&'a Design> {
    let rank = |design: &&Design| {
        let algorithm = &design.algorithm;
        let is_recommended = recommended.is_some_and(|point| {
            (point.plan, point.estimator, point.kernel) == (algorithm.plan, algorithm.estimator, algorithm.kernel)
                && point.calibration == Calibration::of(algorithm)
        });
        // Of a sweep over filters the point may have one that no design has.
        let filtered_alike = recommended.is_some_and(|point| point.filter == algorithm.filter.to_string());
        (!is_recommended, !filtered_alike, algorithm.estimator != Estimator::Joint)
    };
    let mut designs = designs.to_vec();
    designs.sort_by_key(rank);
    designs
}

/// The design that is recommended for a sensor: the point's, under a name after the given design that is most like it.
fn recommended_design(recommended: Option<&Point>, foremost: &[&Design], sweep: &Sweep) -> Option<Design> {
    let job = sweep.job(&recommended?.key)?;
    Some(Design { name: format!("{}_recommended", foremost.first()?.name), ..job.design.clone() })
}

/// A design as files beside the page: their places and contents. The files that it names come before it.
fn files_of(design: &Design) -> Vec<(String, String)> {
    let named = |name: &str| format!("{}.{name}", design.name);
    let whole = (named("toml"), design.to_toml_with(named));
    let beside = design.files().into_iter().map(|(name, text)| (named(name), text));
    beside.chain([whole]).map(|(name, text)| (format!("{RECOMMENDED}/{name}"), text)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use conclusion::tests::point;

    #[test]
    fn the_recommended_design_comes_first() {
        let designs = ["sensor1-reduced", "sensor1-fast", "sensor1-wide"].map(|name| {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs");
            Design::load(&folder.join(format!("{name}.toml"))).expect("a design")
        });
        let names = |point: Option<&Point>| {
            let ordered = in_order(&designs.each_ref(), point);
            ordered.iter().map(|design| design.name.clone()).collect::<Vec<_>>()
        };
        let mut recommended = point("a", 16, 2000, 2.0);
        recommended.estimator = Estimator::Joint;
        recommended.calibration = Calibration::of(&designs[2].algorithm);
        assert_eq!(names(Some(&recommended)), ["sensor1_wide", "sensor1_fast", "sensor1_reduced"]);
        assert_eq!(names(Some(&point("a", 16, 2000, 2.0)))[0], "sensor1_reduced");
        assert_eq!(names(None), ["sensor1_fast", "sensor1_wide", "sensor1_reduced"]);
    }
}
