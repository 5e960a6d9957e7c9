//! The plan of a design, and the keys that only one of the plans has.

use super::checks::Check;
use super::{
    Algorithm, DesignError, Estimator, Filter, Hardware, MAX_LANES, MAX_SIDE_PAPER, Optimise, Outputs, PlanKind, Sensor,
};

/// Lanes of the reduced plan come in fours, one for each class of parity.
const LANES_MULTIPLE: usize = 4;

/// The plan that `word` names. Without one it is the reduced plan wherever that changes nothing of the result and the
/// lanes fit.
pub(super) fn kind(
    check: &Check,
    word: Option<&str>,
    filter: &Filter,
    hardware: &Hardware,
) -> Result<PlanKind, DesignError> {
    let given = check.optional_word("algorithm.plan", word)?;
    let fits = hardware.lanes.is_multiple_of(LANES_MULTIPLE);
    let default = if *filter == Filter::None && fits { PlanKind::Reduced } else { PlanKind::Paper };
    Ok(given.unwrap_or(default))
}

/// What is checked against the plan.
pub(super) struct PlanKeys<'a> {
    pub(super) sensor: &'a Sensor,
    pub(super) algorithm: &'a Algorithm,
    pub(super) hardware: &'a Hardware,
    /// Whether the file has the key `hardware.lanes`.
    pub(super) lanes_given: bool,
}

/// Refuses keys that contradict the plan or each other.
pub(super) fn check(check: &Check, keys: &PlanKeys) -> Result<(), DesignError> {
    let PlanKeys { sensor, algorithm, hardware, lanes_given } = keys;
    if let Some(target) = hardware.target_us
        && *lanes_given
    {
        return Err(check.value(
            "hardware.target_us",
            format!("is {target} beside lanes = {}", hardware.lanes),
            "state the need or the lanes: remove one of the two".to_owned(),
        ));
    }
    match algorithm.plan {
        PlanKind::Paper => paper(check, sensor, algorithm, hardware),
        PlanKind::Reduced => reduced(check, algorithm, hardware),
    }
}

fn paper(check: &Check, sensor: &Sensor, algorithm: &Algorithm, hardware: &Hardware) -> Result<(), DesignError> {
    let needs = |key: &str, problem: String| {
        let remedy = "only the reduced plan has that: write plan = \"reduced\" under [algorithm], or remove the key";
        Err(check.value(key, problem, remedy.to_owned()))
    };
    if algorithm.outputs == Outputs::Resultants {
        return needs("algorithm.outputs", "is \"resultants\" with the paper's plan".to_owned());
    }
    if hardware.optimise != Optimise::Interval {
        return needs("hardware.optimise", format!("is \"{}\" with the paper's plan", hardware.optimise));
    }
    if let Some(target) = hardware.target_us {
        return needs("hardware.target_us", format!("is {target} with the paper's plan"));
    }
    for (key, side) in [("sensor.columns", sensor.columns), ("sensor.rows", sensor.rows)] {
        if side > MAX_SIDE_PAPER {
            return Err(check.value(
                key,
                format!("is {side} with the paper's plan, which has matrices for at most {MAX_SIDE_PAPER}"),
                "write plan = \"reduced\" under [algorithm] and a multiple of 4 for lanes".to_owned(),
            ));
        }
    }
    Ok(())
}

fn reduced(check: &Check, algorithm: &Algorithm, hardware: &Hardware) -> Result<(), DesignError> {
    if matches!(algorithm.filter, Filter::F3 { .. }) {
        return Err(check.value(
            "algorithm.filter",
            "is of kind \"f3\", which chooses for each matrix of the paper; the reduced plan has other matrices"
                .to_owned(),
            "write plan = \"paper\" or another filter".to_owned(),
        ));
    }
    if !hardware.lanes.is_multiple_of(LANES_MULTIPLE) {
        return Err(check.value(
            "hardware.lanes",
            format!("is {} with the reduced plan", hardware.lanes),
            format!("use a multiple of 4 from 4 to {MAX_LANES}, or write plan = \"paper\" under [algorithm]"),
        ));
    }
    if hardware.optimise == Optimise::Area && algorithm.estimator != Estimator::Joint {
        return Err(check.value(
            "hardware.optimise",
            "is \"area\", which needs estimator = \"joint\"".to_owned(),
            "set it, or remove the key".to_owned(),
        ));
    }
    Ok(())
}
