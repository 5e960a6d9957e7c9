//! Estimated LUTs and flip-flops: a linear fit to what Yosys counts module by module, in `results/luts.csv`.

use std::fmt;

use golden::design::Samples;
use serde::Serialize;

use super::Plan;
use super::streams::Intake;
use crate::resources::memory::Memory;

/// LUTs and flip-flops of one of each feature, and quantiles of the error: `make luts` writes the file.
const FIT: &str = include_str!("luts.csv");
/// What is in no other module.
pub const REST: &str = "rest";
/// Stands for a module in the rows with the quantiles of the error.
pub const ERROR: &str = "error";
/// Names of these quantiles, and their shares of the designs.
pub const QUANTILES: [(&str, f64); 3] = [("median", 0.5), (MOST, 0.95), ("worst", 1.0)];
/// That of the estimate.
const MOST: &str = "95 %";

/// Estimated logic of a design on UltraScale+.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Logic {
    /// LUTs of six inputs, those used as memories and shift registers too.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
    /// Error of LUTs in percent that 95 % of the counted designs are not above, each by a fit to the others.
    pub lut_error_percent: u64,
    /// The same of flip-flops.
    pub ff_error_percent: u64,
}

impl fmt::Display for Logic {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { lut, ff, lut_error_percent, ff_error_percent } = self;
        write!(f, "{lut} LUT, {ff} FF by a fit to Yosys' counts; ")?;
        write!(f, "95 % of designs are within {lut_error_percent} and {ff_error_percent} %")
    }
}

/// What counts grow with: the module, the feature, and how much of it a plan has. A module counts with what it
/// instantiates, but for modules that are features themselves.
pub fn features(plan: &Plan) -> Vec<(&'static str, &'static str, f64)> {
    let (design, streams, factors) = (&plan.design, plan.streams(), plan.factors());
    let (input, hardware) = (&design.input, &design.hardware);
    let flag = |is: bool| f64::from(u8::from(is));
    let multipliers = |name| {
        let block = plan.resources.blocks.iter().find(|block| block.name == name);
        block.map_or(0.0, |block| block.multipliers as f64)
    };
    let memory = |block, name| {
        let memories = plan.resources.memories.iter();
        let memories = memories.filter(|memory| memory.block == block && memory.name.starts_with(name));
        memories.map(Memory::luts).sum::<f64>()
    };
    let grid = plan.estimator.joint();
    let [grid_search, network] = [grid.is_some(), grid.is_some_and(|grid| grid.network.is_some())].map(flag);
    let [parallel, taxels] =
        grid.map_or([0.0; 2], |grid| [grid.search.parallel, grid.search.taxels].map(|of| of as f64));
    let by_rows = flag(grid.is_some_and(|grid| grid.search.is_serial()));
    let [one, line, lanes] = [1.0, 1.0 - grid_search, hardware.lanes as f64];
    let [channels, width] = [plan.channels() as f64, f64::from(hardware.data_bits)];
    let (reduced, wide) = (flag(plan.channels() > 1), flag(factors.is_wide()));
    let [beat, words, bits] = [streams.conversions(), streams.words(), streams.bits].map(|of| of as f64);
    let places = plan.places_for_dead() as f64;
    let [ram, curve, counts] = [plan.calibration.is_some(), input.curve.is_some(), input.counts()].map(flag);
    let [smoothing, crosstalk, creep] =
        [plan.smoothing.is_some(), plan.crosstalk.is_some(), plan.creep.is_some()].map(flag);
    let [control, float] = [hardware.control, hardware.samples == Samples::Float32].map(flag);
    let [field, error] = [plan.has_field(), plan.thresholds.error.is_some()].map(flag);
    let counter = flag(design.algorithm.count_contacts);
    vec![
        ("spmv_array", "one", one),
        ("spmv_array", "lanes x data bits", lanes * width),
        ("spmv_array", "lanes x coefficient bits", lanes * f64::from(factors.coefficient_bits)),
        ("spmv_array", "wide lanes", lanes * wide),
        ("spmv_array", "memory", memory("lanes", "")),
        ("we", "folded bits", reduced * width),
        ("co", "bits", channels * width),
        ("co", "not folded", one - reduced),
        ("unfold", "folded bits", reduced * width),
        ("unfold", "memory", memory("Co", "")),
        ("cean", "one", one),
        ("cean", "line", line),
        ("estimator_line", "line", line),
        ("estimator_line", "standard error", line * error),
        ("search", "line", line),
        ("search", "cells", multipliers("cells")),
        ("estimator_joint", "grid", grid_search),
        ("estimator_joint", "network", network),
        ("estimator_joint", "standard error", grid_search * error),
        ("grid_search", "grid", grid_search),
        ("grid_search", "by rows", by_rows),
        ("grid_search", "points", parallel * taxels),
        ("features", "network", network),
        ("network", "network", network),
        ("network", "multipliers", multipliers("network")),
        ("network", "memory", memory("network", "")),
        ("summary", "one", one),
        ("output", "one", one),
        ("output", "words", words),
        ("field", "folded bits", field * reduced * words * width),
        ("field", "memory", reduced * memory("field", "")),
        ("coefficient_field", "not folded bits", field * (one - reduced) * words * width),
        ("contact_counter", "one", counter),
        ("contact_counter", "folded", counter * reduced),
        ("samples", "floats", beat * float),
        ("samples", "integers", beat * (one - float)),
        ("samples", "counts", beat * counts),
        ("samples", "along a curve", beat * curve),
        ("fold", "folded", reduced),
        ("fold", "scaled", flag(plan.scales_frames())),
        ("fold", "memory", memory("Bz", "frame by")),
        ("frame_scale", "samples", beat * flag(plan.scales_frames())),
        ("taxel_stream", "samples", beat),
        ("smoothing", "samples", beat * smoothing),
        ("crosstalk", "one", crosstalk),
        ("creep", "one", creep),
        ("replace", "dead", places),
        ("replace", "ram", ram * places),
        ("banks", "ram", ram),
        ("banks", "curve", ram * curve),
        ("curve_bank", "curve", ram * curve),
        ("dead_bank", "dead", ram * places),
        ("ingress_fifo", "bits", bits * flag(streams.drops)),
        ("unpack", "bits", bits * flag(streams.intake == Intake::Unpacked)),
        (REST, "control", control),
        (REST, "ram", ram),
        (REST, "bits of the streams", bits),
        (REST, "one", one),
        (REST, "corrections", smoothing + crosstalk + creep),
    ]
}

/// LUTs and flip-flops of one of a feature, if a design with it was counted.
fn fitted(module: &str, feature: &str) -> Option<[f64; 2]> {
    let row = format!("{module},{feature},");
    let (lut, ff) = FIT.lines().find_map(|line| line.strip_prefix(&row))?.split_once(',')?;
    Some([lut.parse().ok()?, ff.parse().ok()?])
}

/// The estimate of a plan, in hundreds, if all was counted that it has.
pub fn logic(plan: &Plan) -> Option<Logic> {
    let mut sums = [0.0; 2];
    for (module, feature, of) in features(plan).into_iter().filter(|(.., of)| *of > 0.0) {
        let one = fitted(module, feature)?;
        sums.iter_mut().zip(one).for_each(|(sum, one)| *sum += of * one);
    }
    let [lut, ff] = sums.map(|sum| 100 * (sum / 100.0).round() as u64);
    let [lut_error_percent, ff_error_percent] = fitted(ERROR, MOST)?.map(|error| error.ceil() as u64);
    Some(Logic { lut, ff, lut_error_percent, ff_error_percent })
}
