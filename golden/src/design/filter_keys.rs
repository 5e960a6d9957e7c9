//! From the key `filter` to a checked [`Filter`], and back.

use std::collections::BTreeMap;

use super::checks::Check;
use super::keys::FilterKeys;
use super::{Choices, DesignError, Filter, FilterKind, MatrixFilter, Sensor};
use crate::names::MatrixName;

const KEY: &str = "algorithm.filter";

pub(super) fn filter(check: &Check, keys: FilterKeys, sensor: &Sensor) -> Result<Filter, DesignError> {
    let FilterKeys { kind, l, p, scenes, choices } = keys;
    let given = [
        ("l", l.is_some(), kind == FilterKind::F1),
        ("p", p.is_some(), kind == FilterKind::F2),
        ("scenes", scenes.is_some(), kind == FilterKind::F3),
        ("choices", choices.is_some(), kind == FilterKind::F3),
    ];
    if let Some((foreign, ..)) = given.into_iter().find(|&(_, given, belongs)| given && !belongs) {
        return Err(check.value(
            &format!("{KEY}.{foreign}"),
            format!("does not belong to a filter of kind \"{kind}\""),
            "remove it or choose another kind",
        ));
    }
    let missing = |key: &str, example: &str| {
        let remedy = format!("write filter = {{ kind = \"{kind}\", {example} }}");
        check.value(&format!("{KEY}.{key}"), "is missing", remedy)
    };
    match kind {
        FilterKind::None => Ok(Filter::None),
        FilterKind::F1 => band(check, "l", l.ok_or_else(|| missing("l", "l = 40"))?, sensor).map(|l| Filter::F1 { l }),
        FilterKind::F2 => Ok(Filter::F2 { p: p.ok_or_else(|| missing("p", "p = 30"))? }),
        FilterKind::F3 if scenes.as_ref().is_none_or(Vec::is_empty) && choices.is_none() => {
            Err(missing("scenes", "scenes = [\"../scenes/sensor1-hertz.toml\"]"))
        }
        FilterKind::F3 => {
            let choices = choices.map(|given| self::choices(check, &given, sensor)).transpose()?;
            Ok(Filter::F3 { scenes: scenes.unwrap_or_default(), choices: choices.map(Box::new) })
        }
    }
}

/// The key of a filter.
pub(super) fn keys(filter: &Filter) -> FilterKeys {
    let keys = FilterKeys { kind: filter.kind(), ..FilterKeys::default() };
    match filter {
        Filter::None => keys,
        Filter::F1 { l } => FilterKeys { l: Some(*l as i64), ..keys },
        Filter::F2 { p } => FilterKeys { p: Some(*p), ..keys },
        Filter::F3 { scenes, choices } => {
            let of = |all: &Choices| {
                MatrixName::ALL.map(|matrix| (matrix.to_string(), all[matrix.index()].to_string())).into()
            };
            FilterKeys { scenes: Some(scenes.clone()), choices: choices.as_deref().map(of), ..keys }
        }
    }
}

fn band(check: &Check, key: &str, value: i64, sensor: &Sensor) -> Result<usize, DesignError> {
    // The diagonal and one neighbour on either side is the narrowest band allowed.
    check.integer(&format!("{KEY}.{key}"), value, 1, sensor.taxels() as i64 - 2).map(|l| l as usize)
}

fn choices(check: &Check, given: &BTreeMap<String, String>, sensor: &Sensor) -> Result<Choices, DesignError> {
    let mut filters = [MatrixFilter::None; MatrixName::ALL.len()];
    for name in given.keys() {
        let known = name.parse::<MatrixName>();
        known.map_err(|error| check.value(&format!("{KEY}.choices.{name}"), "is unknown", error))?;
    }
    for (name, filter) in MatrixName::ALL.into_iter().zip(&mut filters) {
        let key = format!("choices.{name}");
        let whole = format!("{KEY}.{key}");
        let remedy = "give a filter for each of the 13 matrices, or remove the choices and run `sptfra tune-filter`";
        let text = given.get(&name.to_string()).ok_or_else(|| check.value(&whole, "is missing", remedy))?;
        *filter = text.parse().map_err(|error: String| check.value(&whole, "cannot be read", error))?;
        match *filter {
            MatrixFilter::None => (),
            MatrixFilter::F1 { l } => drop(band(check, &key, i64::try_from(l).unwrap_or(-1), sensor)?),
            MatrixFilter::F2 { p } => drop(check.above_zero(&whole, p, f64::MAX, "")?),
        }
    }
    Ok(filters)
}
