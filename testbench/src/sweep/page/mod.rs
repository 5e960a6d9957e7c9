//! The page of a sweep: one HTML file without a network, with pictures as SVG, for light and dark.

pub mod conclusion;
mod dots;
pub mod forces;
pub mod front;
mod kinds;
pub mod lanes;
pub mod matrices;
pub mod paper;
pub mod tables;

use golden::choose::choose;
use golden::design::{Design, FileNames, Filter, MatrixFilter};
use golden::matrices::Matrices;
use serde::Serialize;
use tera::{Context, Tera};
use thiserror::Error;

use crate::sweep::point::{Geometry, Point, Verified, sensor_title, sensors};
use crate::sweep::{Sweep, SweepError, SweepScene};
use front::{DASHES, Series};
use golden::table::Table;
use matrices::Figure;

const TEMPLATE: &str = include_str!("../../../templates/report.html.tera");
/// The name ends so that text is escaped.
const NAME: &str = "report.html";
/// Folder beside the page with the designs that it recommends.
pub const RECOMMENDED: &str = "recommended";
/// Larger sensors have too many entries for a picture of each.
const MOST_TAXELS: usize = 256;

/// Why there is no page.
#[derive(Debug, Error)]
pub enum PageError {
    /// A picture's data cannot be computed.
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
    verified: Vec<(usize, &'static str)>,
    refusals: Vec<String>,
    legend: front::Legend,
    ramp: Vec<(String, &'static str)>,
    sensors: Vec<SensorSection>,
}

/// One sensor's part.
#[derive(Clone, Debug, Serialize)]
struct SensorSection {
    title: String,
    conclusion: Option<conclusion::Conclusion>,
    /// The recommended design as files, the design's own the last.
    recommended: Vec<(String, String)>,
    fronts: Vec<Figure>,
    table_1: Option<Table>,
    table_3: Option<Table>,
    /// The same on contacts of all kinds, without the paper's.
    table_3_kinds: Option<Table>,
    kinds: Option<Table>,
    lanes: Table,
    lanes_plot: Option<String>,
    widths: Vec<Figure>,
    field: Vec<Figure>,
    field_caption: String,
    costs: Option<Figure>,
    magnitudes: Vec<Figure>,
    rows: Option<String>,
    bands: Vec<Figure>,
    thresholds: Vec<Figure>,
}

impl Contents {
    /// Gathers what the points do not hold: matrices, costs of filters, a field.
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
            ramp: matrices::ramp_legend(),
            sensors: sections,
        })
    }
}

/// The design that is recommended for a sensor: the point's, under a name after the given design that is most like it.
fn recommended_design(recommended: Option<&Point>, foremost: &[&Design], sweep: &Sweep) -> Option<Design> {
    let job = sweep.job(&recommended?.key)?;
    Some(Design { name: format!("{}_recommended", foremost.first()?.name), ..job.design.clone() })
}

/// A design as files beside the page: their places and contents. The files that it names come before it.
fn files_of(design: &Design) -> Vec<(String, String)> {
    let names = FileNames::of(&design.name);
    let whole = (format!("{}.toml", design.name), design.to_toml_with(&names));
    let beside = design.files().into_iter().map(|(name, text)| (names.of_file(name).to_owned(), text));
    beside.chain([whole]).map(|(name, text)| (format!("{RECOMMENDED}/{name}"), text)).collect()
}

impl Contents {
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

fn section(sensor: &Geometry, designs: &[Design], sweep: &Sweep, points: &[Point]) -> Result<SensorSection, PageError> {
    let own: Vec<&Point> = points.iter().filter(|point| point.sensor == *sensor).collect();
    let designs: Vec<&Design> = designs.iter().filter(|design| is_of(design, sensor)).collect();
    let scenes: Vec<&SweepScene> =
        sweep.scenes.iter().filter(|scene| designs.iter().any(|design| design.sensor == scene.sensor)).collect();
    // The paper's contacts are swept over all directions: its tables stand beside the first such scene.
    let main = scenes.iter().copied().find(|scene| scene.frames.stress.len() > 1).or(scenes.first().copied());
    let on = |scene: &SweepScene| own.iter().copied().filter(|point| point.scene == scene.name).collect::<Vec<_>>();
    let telling: Vec<&str> = scenes.iter().filter(|scene| scene.tells()).map(|scene| scene.name.as_str()).collect();
    let recommended = conclusion::recommended(&own, &telling);
    let foremost = forces::in_order(&designs, recommended);
    let fronts = scenes
        .iter()
        .map(|scene| {
            let paper = main.is_some_and(|main| main.name == scene.name);
            let frames = scene.frames.stress.len();
            let mut caption = format!("scene {}, {frames} frame{}", scene.name, if frames == 1 { "" } else { "s" });
            if scene.contacts.is_empty() {
                caption += ": contacts of all kinds, as many of each (what they are is in the table of kinds)";
            }
            if !scene.tells() {
                caption += "; the contacts are pushed against each other, so that this error is that of a sum near zero, which \
                            tells nothing of either: no front, no conclusion";
            }
            if let Some(contacts) = forces::contacts(&foremost, scene) {
                caption += &contacts;
            }
            Figure { svg: front::front(&on(scene), paper, scene.tells()), caption }
        })
        .collect();
    let on_main = main.map(on).unwrap_or_default();
    let small = sensor.columns * sensor.rows <= MOST_TAXELS;
    let pictures = match designs.first().filter(|_| small) {
        Some(design) => Matrices::of(design).ok(),
        None => None,
    };
    let (field, field_caption) = forces::field(&foremost, main)?;
    let filters = |kinds: [MatrixFilter; 4]| {
        // F1 has no more diagonals than the matrix.
        let legal =
            |filter: &MatrixFilter| !matches!(filter, MatrixFilter::F1 { l } if l + 2 > sensor.columns * sensor.rows);
        pictures.as_ref().map_or_else(Vec::new, |matrices| {
            matrices::sparsity(matrices, &kinds.into_iter().filter(legal).collect::<Vec<_>>())
        })
    };
    Ok(SensorSection {
        title: sensor_title(sensor),
        conclusion: conclusion::conclusion(&own, &telling),
        recommended: recommended_design(recommended, &foremost, sweep).as_ref().map(files_of).unwrap_or_default(),
        fronts,
        table_1: tables::table_1(&on_main),
        table_3: tables::table_3(&on_main),
        table_3_kinds: scenes
            .iter()
            .find(|scene| scene.contacts.is_empty())
            .and_then(|scene| tables::on_kinds(&on(scene))),
        kinds: kinds::table(&foremost, sweep.kinds)?,
        lanes: tables::lanes(&on_main),
        lanes_plot: lanes::plot(&on_main),
        widths: widths(&on_main),
        field,
        field_caption,
        costs: costs(&foremost, main, small),
        magnitudes: pictures.as_ref().map(matrices::magnitudes).unwrap_or_default(),
        rows: pictures.as_ref().map(|matrices| matrices::rows(matrices, sensor.columns)),
        bands: filters([10, 40, 50, 90].map(|l| MatrixFilter::F1 { l })),
        thresholds: filters([10.0, 30.0, 50.0, 90.0].map(|p| MatrixFilter::F2 { p })),
    })
}

fn is_of(design: &Design, sensor: &Geometry) -> bool {
    Geometry::from(&design.sensor) == *sensor
}

/// What each filter of each matrix costs, on the scene of the sensor's tables.
fn costs(designs: &[&Design], scene: Option<&SweepScene>, small: bool) -> Option<Figure> {
    // The search needs no filter of its own.
    let mut design = designs.first().filter(|_| small).map(|&design| design.clone())?;
    design.algorithm.filter = Filter::None;
    let choice = choose(&design, &scene?.made, &|| ()).ok()?;
    let caption = format!(
        "e_µ · Nnz in thousands, with only that matrix filtered, by the estimator {} of {}; \
         mean over {} frames of scene {}. Purple: the least of the matrix, which is F3; only framed where its e_µ is more \
         than twice that without a filter, {:.2} %, and the entries that it saves are dear. With all of these choices e_µ \
         is {:.2} %.",
        design.algorithm.estimator, design.name, choice.frames, scene?.name, choice.e_mu_unfiltered, choice.e_mu_chosen
    );
    Some(Figure { svg: matrices::costs(&choice), caption })
}

/// Error of the number format over the widths, for each plan and filter that was varied.
fn widths(points: &[&Point]) -> Vec<Figure> {
    let over = |title: &str, bits: fn(&Point) -> u32, other: fn(&Point) -> u32, usual: u32| {
        let mut series: Vec<Series> = Vec::new();
        for point in points.iter().filter(|point| other(point) == usual && point.lanes == 16) {
            let Some(error) = point.against_solver.and_then(|error| error.field_max) else { continue };
            let name = format!("{}, {}, {}", point.plan, point.filter_title(), point.estimator_title());
            if let Some(known) = series.iter_mut().find(|known| known.name == name) {
                known.values.push((bits(point), error));
                continue;
            }
            series.push(Series { name, colour: front::style(point).1, dashes: "", values: vec![(bits(point), error)] });
        }
        series.retain(|series| series.values.len() > 1);
        let mut used: Vec<&str> = Vec::new();
        for series in &mut series {
            series.values.sort_by_key(|&(bits, _)| bits);
            series.values.dedup_by_key(|&mut (bits, _)| bits);
            let before = used.iter().filter(|&&colour| colour == series.colour).count();
            series.dashes = DASHES[before % DASHES.len()];
            used.push(series.colour);
        }
        let caption = format!("largest error of a force against f64, relative to max |f_z|, over the {title}");
        (!series.is_empty()).then(|| Figure { svg: front::widths(&series, title), caption })
    };
    [
        over("coefficient bits", |point| point.coefficient_bits, |point| point.data_bits, 27),
        over("data bits", |point| point.data_bits, |point| point.coefficient_bits, 18),
    ]
    .into_iter()
    .flatten()
    .collect()
}
