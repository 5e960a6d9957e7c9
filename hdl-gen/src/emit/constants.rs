//! Constants that stand in the library of modules, held against those of the schedule and the integer model.

use golden::estimators::ERROR_RANGE;

use super::rtl::library;
use crate::cores::{Multiplier, cordic};
use crate::estimators::{joint, line};
use crate::format::FRICTION_FRACTION;
use crate::model::{PULLING, inverse_gain};
use crate::plan::smoothing::VARIANCE_FRACTION;
use crate::plan::standard_error::SHARE_FRACTION;
use crate::timing::latency::{
    STANDARD_ERROR, TAKE_TO_BUS, TAXEL_TO_CEAN, bus_to_sums, bus_to_taxels, bus_to_write, read_to_write,
    taxels_to_write,
};

/// What a constant in a module of the library is.
fn literal(module: &str, name: &str) -> String {
    let text = library(Multiplier::Whole)[module];
    let (_, rest) = text.split_once(&format!(" {name} = ")).unwrap_or_else(|| panic!("{module} has no {name}"));
    rest.split_once(';').unwrap().0.to_owned()
}

/// The value of such a constant, its width left out.
fn constant(module: &str, name: &str) -> i64 {
    let literal = literal(module, name);
    let digits = literal.rsplit('d').next().unwrap();
    digits.parse().unwrap_or_else(|_| panic!("{module}: {name} = {literal}"))
}

/// The algorithm's constants stand in the modules and in the integer model.
#[test]
fn modules_and_model_have_the_same_constants() {
    let one = 1 << FRICTION_FRACTION;
    let expected: [(&str, &str, i64); 31] = [
        ("sptfra_taxel_stream", "READ_TO_STRESS", TAXEL_TO_CEAN as i64),
        ("sptfra_spmv_collector", "TAKE_TO_BUS", TAKE_TO_BUS as i64),
        ("sptfra_direction", "CENTROID_FRACTION", line::CENTROID_FRACTION.into()),
        ("sptfra_direction", "PITCH_FRACTION", line::PITCH_FRACTION.into()),
        ("sptfra_line", "LINE_FRACTION", line::LINE_FRACTION.into()),
        ("sptfra_line", "LINE_SUM_BITS", line::LINE_SUM_BITS.into()),
        ("sptfra_search", "SEARCH_STEPS", line::SEARCH_STEPS.into()),
        ("sptfra_search", "ONE", one),
        ("sptfra_search_cells", "FRICTION_FRACTION", FRICTION_FRACTION.into()),
        ("sptfra_search_cells", "LINE_FRACTION", line::LINE_FRACTION.into()),
        ("sptfra_search_cells", "RECTIFIER_DROP", line::RECTIFIER_DROP.into()),
        ("sptfra_summary", "LINE_FRACTION", line::LINE_FRACTION.into()),
        ("sptfra_summary", "INVERSE_GAIN", inverse_gain()),
        ("sptfra_summary", "ONE", one),
        ("sptfra_op", "FRICTION_FRACTION", FRICTION_FRACTION.into()),
        ("sptfra_op", "PULLING", PULLING),
        ("sptfra_output", "FRICTION_EXPONENT", FRICTION_FRACTION.into()), // a negative one
        ("sptfra_output", "ANGLE_EXPONENT", cordic::ANGLE_FRACTION_BITS.into()),
        ("sptfra_grid_level", "WEIGHT_BITS", joint::search::WEIGHT_BITS.into()),
        ("sptfra_friction", "LINEAR_FRACTION", joint::LINEAR_FRACTION.into()),
        ("sptfra_friction", "CUBIC_FRACTION", joint::CUBIC_FRACTION.into()),
        ("sptfra_friction", "FACTOR_FRACTION", joint::FACTOR_FRACTION.into()),
        ("sptfra_features_stress", "STRESS_BITS", joint::STRESS_BITS.into()),
        ("sptfra_features_window", "CENTRE_HALF", joint::CENTRE_HALF),
        ("sptfra_features_window", "INPUT_ONE", 1 << joint::INPUT_FRACTION),
        ("sptfra_network", "UNIT_BITS", joint::UNIT_BITS.into()),
        ("sptfra_network", "LIMIT", joint::CORRECTION_LIMIT),
        ("sptfra_standard_error", "LAST", STANDARD_ERROR as i64 - 2),
        ("sptfra_smoothing", "ONE", 1 << VARIANCE_FRACTION),
        ("sptfra_standard_error", "LEAST", 1 << (i64::from(SHARE_FRACTION) + i64::from(ERROR_RANGE[0]))),
        ("sptfra_standard_error", "MOST", (1 << (i64::from(SHARE_FRACTION) + i64::from(ERROR_RANGE[1]))) - 1),
    ];
    for (module, name, value) in expected {
        assert_eq!(constant(module, name), value, "{module}: {name}");
    }
}

/// Latencies that depend on whether vectors are folded.
#[test]
fn modules_and_schedule_have_the_same_latencies() {
    let both = |latency: fn(bool) -> u64| [latency(true), latency(false)];
    let expected = [
        ("sptfra_unfold", "LATENCY", both(bus_to_taxels)),
        ("sptfra_we", "LATENCY", both(taxels_to_write)),
        ("sptfra_co", "WRITE_LATENCY", both(bus_to_write)),
        ("sptfra_co", "SUMS_LATENCY", both(bus_to_sums)),
    ];
    for (module, name, [folded, taxels]) in expected {
        let choice = format!("(CHANNELS == 4) ? {folded} : {taxels}");
        assert_eq!(literal(module, name), choice, "{module}: {name}");
    }
    let [scaled, unscaled] = [true, false].map(read_to_write);
    let choice = format!("(SCALED != 0) ? {scaled} : {unscaled}");
    assert_eq!(literal("sptfra_fold", "READ_TO_WRITTEN"), choice);
}
