//! Which points a sweep has.

use std::collections::BTreeSet;
use std::str::FromStr;

use golden::design::{Design, Estimator, Filter, JointConstants, PlanKind};
use hdl_gen::estimators::has_hardware;
use hdl_gen::plan::Plan;
use sha2::{Digest, Sha256};

use super::{SweepError, SweepScene};

/// Steps of L and p in the paper's sweep.
const STEPS: [usize; 9] = [10, 20, 30, 40, 50, 60, 70, 80, 90];
const COEFFICIENT_BITS: [u32; 6] = [8, 10, 12, 14, 16, 18];
const DATA_BITS: [u32; 6] = [16, 18, 20, 22, 24, 27];
const LANES: [usize; 5] = [4, 8, 16, 32, 64];
/// Digits of a key.
const KEY_DIGITS: usize = 20;
/// The name of every design of a sweep: what a design is called changes nothing of it.
const NAME: &str = "point";

/// A filter as the command line names it: `none`, `f1` (all of its sweep), `f1-40`, `f3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterAxis {
    /// No filter.
    None,
    /// F1 with one L or all.
    F1(Option<usize>),
    /// F2 with one p or all.
    F2(Option<f64>),
    /// F3 of a design that has it.
    F3,
}

impl FromStr for FilterAxis {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let unknown = || {
            format!("\"{word}\" is no filter of a sweep; write none, f1, f2 or f3, or one of them as f1-40 or f2-50")
        };
        Ok(match word {
            "none" => Self::None,
            "f1" => Self::F1(None),
            "f2" => Self::F2(None),
            "f3" => Self::F3,
            _ => match word.split_once('-') {
                Some(("f1", l)) => Self::F1(Some(l.parse().map_err(|_| unknown())?)),
                Some(("f2", p)) => Self::F2(Some(p.parse().map_err(|_| unknown())?)),
                _ => return Err(unknown()),
            },
        })
    }
}

/// The values along each axis; without any, the usual ones.
#[derive(Clone, Debug, Default)]
pub struct Axes {
    /// Filters.
    pub filters: Vec<FilterAxis>,
    /// Plans.
    pub plans: Vec<PlanKind>,
    /// Widths of the coefficients.
    pub coefficient_bits: Vec<u32>,
    /// Widths of the vectors.
    pub data_bits: Vec<u32>,
    /// Numbers of lanes.
    pub lanes: Vec<usize>,
    /// Estimators; the joint one with the constants of a design that has it, on the same sensor.
    pub estimators: Vec<Estimator>,
    /// Every combination; otherwise filters with plans, and the other axes one at a time around each design.
    pub full: bool,
}

/// One point to be computed.
#[derive(Clone, Debug)]
pub struct Job {
    /// What the point is filed under: a digest of resolved design, scene and program.
    pub key: String,
    /// The variant.
    pub design: Design,
    /// Which of the sweep's scenes.
    pub scene: usize,
    /// Whether it is a design as it was given.
    pub base: bool,
}

impl Job {
    /// For messages.
    pub fn label(&self, scene: &SweepScene) -> String {
        let hardware = &self.design.hardware;
        format!(
            "point {} ({}, {} plan, {} estimator, {} lanes, {} x {} bits, scene {})",
            self.key,
            self.design.algorithm.filter,
            self.design.algorithm.plan,
            self.design.algorithm.estimator,
            hardware.lanes,
            hardware.coefficient_bits,
            hardware.data_bits,
            scene.name
        )
    }
}

/// All points: the variants of each design, each on every scene of its sensor. A sensor without a scene gets its
/// standing one, and with `kinds` each gets so many frames of each kind of contact as a scene: these are added to `scenes`. Variants that more than one design has are there once.
///
/// # Errors
/// [`SweepError::At`] for a scene of none of the designs, [`SweepError::NoPoints`] if no variant exists.
pub fn jobs(designs: &[Design], axes: &Axes, scenes: &mut Vec<SweepScene>, kinds: u64) -> Result<Vec<Job>, SweepError> {
    if let Some(foreign) = scenes.iter().find(|scene| designs.iter().all(|design| design.sensor != scene.sensor)) {
        return Err(SweepError::at(
            format!("scene {}", foreign.frames.origin),
            "its [sensor] is that of none of the designs; add a design with the same columns, rows, pitch_mm and \
             depth_mm, or leave the scene out",
        ));
    }
    let mut seen = BTreeSet::new();
    let mut jobs = Vec::new();
    for design in designs {
        if scenes.iter().all(|scene| scene.sensor != design.sensor) {
            scenes.push(SweepScene::standing(&design.sensor)?);
        }
        if kinds > 0 && !scenes.iter().any(|scene| scene.sensor == design.sensor && scene.contacts.is_empty()) {
            scenes.push(SweepScene::kinds(&design.sensor, kinds)?);
        }
        let base = normal(design);
        for variant in variants(&base, designs, axes) {
            let own = scenes.iter().enumerate().filter(|(_, scene)| scene.sensor == design.sensor);
            for (number, scene) in own {
                let key = key(&variant, scene);
                if seen.insert(key.clone()) {
                    jobs.push(Job { key, base: variant == base, design: variant.clone(), scene: number });
                }
            }
        }
    }
    // A variant of one design may be another design as given.
    let bases: Vec<Design> = designs.iter().map(normal).collect();
    for job in &mut jobs {
        job.base = bases.contains(&job.design);
    }
    if jobs.is_empty() { Err(SweepError::NoPoints) } else { Ok(jobs) }
}

/// The design under the name of all points, and for one contact: how well several are separated is said
/// beside the points.
fn normal(design: &Design) -> Design {
    let mut normal = Design { name: NAME.to_owned(), ..design.clone() };
    normal.algorithm.contacts = 1;
    normal
}

/// The digest that a point is filed under.
fn key(design: &Design, scene: &SweepScene) -> String {
    let (text, files) = (design.to_toml(), design.files());
    let parts = [hdl_gen::emit::VERSION, env!("SPTFRA_SOURCES"), &text, &scene.name, &scene.text];
    let mut digest = Sha256::new();
    for part in parts.into_iter().chain(files.iter().map(|(_, content)| content.as_str())) {
        // With the length, so that no two lists of parts are the same bytes.
        digest.update((part.len() as u64).to_le_bytes());
        digest.update(part.as_bytes());
    }
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect::<String>()[..KEY_DIGITS].to_owned()
}

/// The values of an axis, or the usual ones.
fn or<T: Copy>(given: &[T], usual: &[T]) -> Vec<T> {
    if given.is_empty() { usual } else { given }.to_vec()
}

/// The designs that differ from `base`, one of `designs`, along the axes, and exist.
fn variants(base: &Design, designs: &[Design], axes: &Axes) -> Vec<Design> {
    let lanes = or(&axes.lanes, &LANES);
    let coefficient_bits = or(&axes.coefficient_bits, &COEFFICIENT_BITS);
    let data_bits = or(&axes.data_bits, &DATA_BITS);
    let plans = or(&axes.plans, &[PlanKind::Reduced, PlanKind::Paper]);
    // The design itself first, unless another grid was asked for.
    let asked = axes.full || !axes.filters.is_empty() || !axes.plans.is_empty() || !axes.estimators.is_empty();
    let mut variants = if asked { Vec::new() } else { vec![base.clone()] };
    let estimated = with_estimators(base, designs, axes);
    for filtered in estimated.iter().flat_map(|base| with_filters(base, &axes.filters)) {
        variants.extend(plans.iter().filter_map(|&plan| {
            let mut variant = filtered.clone();
            variant.algorithm.plan = plan;
            has_hardware(&variant).then_some(variant)
        }));
    }
    let coefficient = |design: &mut Design, bits| design.hardware.coefficient_bits = bits;
    let data = |design: &mut Design, bits| design.hardware.data_bits = bits;
    if asked {
        // What was asked for by name is combined; everything if all is asked for.
        if axes.full || !axes.lanes.is_empty() {
            variants = product(&variants, &lanes, set_lanes);
        }
        if axes.full || !axes.coefficient_bits.is_empty() {
            variants = product(&variants, &coefficient_bits, coefficient);
        }
        if axes.full || !axes.data_bits.is_empty() {
            variants = product(&variants, &data_bits, data);
        }
    } else if Plan::new(base).is_ok() {
        // A design without hardware has no axes of hardware.
        let base = std::slice::from_ref(base);
        variants.extend(product(base, &lanes, set_lanes));
        variants.extend(product(base, &coefficient_bits, coefficient));
        variants.extend(product(base, &data_bits, data));
    }
    variants.retain(exists);
    variants
}

/// The design with each estimator of the axis: the paper's, for which the filters are, unless others are asked for.
/// One that is calibrated has the constants that it needs from a design of the same sensor, else it is left out.
fn with_estimators(base: &Design, designs: &[Design], axes: &Axes) -> Vec<Design> {
    let usual: &[Estimator] = if axes.full { &[Estimator::Line, Estimator::Joint] } else { &[Estimator::Line] };
    or(&axes.estimators, usual)
        .iter()
        .filter_map(|&estimator| {
            if estimator.is_calibrated() { calibrated(base, estimator, designs) } else { Some(plain(base, estimator)) }
        })
        .collect()
}

/// The design with an estimator that is calibrated.
fn calibrated(base: &Design, estimator: Estimator, designs: &[Design]) -> Option<Design> {
    // What the constants make good for: the sensor, the load kernel and what is added to it.
    let fits = |design: &&Design| {
        let (one, other) = (&design.algorithm, &base.algorithm);
        one.estimator == estimator
            && (&design.sensor, one.kernel, one.regularisation) == (&base.sensor, other.kernel, other.regularisation)
    };
    let calibrated = std::iter::once(base).chain(designs).find(fits)?;
    let mut design = base.clone();
    design.algorithm.estimator = estimator;
    design.algorithm.joint.clone_from(&calibrated.algorithm.joint);
    design.algorithm.take_errors(&calibrated.algorithm);
    Some(design)
}

/// The design with an estimator that is not.
fn plain(base: &Design, estimator: Estimator) -> Design {
    let mut design = base.clone();
    design.algorithm.estimator = estimator;
    *design.algorithm.joint = JointConstants::default();
    design.algorithm.take_errors(&base.algorithm);
    design
}

fn set_lanes(design: &mut Design, lanes: usize) {
    design.hardware.lanes = lanes;
}

/// Each design with each value.
fn product<T: Copy>(designs: &[Design], values: &[T], set: impl Fn(&mut Design, T)) -> Vec<Design> {
    let with = |design: &Design, value| {
        let mut design = design.clone();
        set(&mut design, value);
        design
    };
    designs.iter().flat_map(|design| values.iter().map(|&value| with(design, value)).collect::<Vec<_>>()).collect()
}

/// The design with each filter of the axis; all of the paper's without any.
fn with_filters(base: &Design, axis: &[FilterAxis]) -> Vec<Design> {
    let usual = [FilterAxis::None, FilterAxis::F1(None), FilterAxis::F2(None), FilterAxis::F3];
    let mut filters = Vec::new();
    for kind in or(axis, &usual) {
        match kind {
            FilterAxis::None => filters.push(Filter::None),
            FilterAxis::F1(Some(l)) => filters.push(Filter::F1 { l }),
            FilterAxis::F1(None) => filters.extend(STEPS.map(|l| Filter::F1 { l })),
            FilterAxis::F2(Some(p)) => filters.push(Filter::F2 { p }),
            FilterAxis::F2(None) => filters.extend(STEPS.map(|p| Filter::F2 { p: p as f64 })),
            FilterAxis::F3 => {
                filters
                    .extend(Some(&base.algorithm.filter).filter(|filter| matches!(filter, Filter::F3 { .. })).cloned());
            }
        }
    }
    let with = |filter| {
        let mut design = base.clone();
        design.algorithm.filter = filter;
        design.algorithm.take_errors(&base.algorithm);
        design
    };
    filters.into_iter().map(with).collect()
}

/// Whether a design file could say this.
fn exists(design: &Design) -> bool {
    Design::from_parts(&design.to_toml(), NAME, &design.files()).is_ok_and(|again| again == *design)
}
