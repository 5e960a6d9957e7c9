//! From the key `filter` to a checked [`Filter`], and back.

use std::collections::BTreeMap;

use super::checks::Check;
use super::keys::FilterKeys;
use super::{Choices, DesignError, Filter, FilterKind, MatrixFilter, Sensor};
use crate::names::MatrixName;

pub(super) fn filter(check: &Check, keys: &FilterKeys, sensor: &Sensor) -> Result<Filter, DesignError> {
    let kind = keys.kind;
    let own: &[&str] = match kind {
        FilterKind::None => &[],
        FilterKind::F1 => &["l"],
        FilterKind::F2 => &["p"],
        FilterKind::F3 => &["scenes", "choices"],
    };
    let given = [
        ("l", keys.l.is_some()),
        ("p", keys.p.is_some()),
        ("scenes", keys.scenes.is_some()),
        ("choices", keys.choices.is_some()),
    ];
    if let Some((foreign, _)) = given.into_iter().find(|&(key, given)| given && !own.contains(&key)) {
        return Err(check.value(
            &format!("algorithm.filter.{foreign}"),
            format!("does not belong to a filter of kind \"{kind}\""),
            "remove it or choose another kind".to_owned(),
        ));
    }
    let missing = |key: &str, example: &str| {
        check.value(
            &format!("algorithm.filter.{key}"),
            "is missing".to_owned(),
            format!("write filter = {{ kind = \"{kind}\", {example} }}"),
        )
    };
    match kind {
        FilterKind::F1 => {
            let l = band(check, "algorithm.filter.l", keys.l.ok_or_else(|| missing("l", "l = 40"))?, sensor)?;
            Ok(Filter::F1 { l })
        }
        FilterKind::F2 => {
            let p = keys.p.ok_or_else(|| missing("p", "p = 30"))?;
            Ok(Filter::F2 { p })
        }
        FilterKind::F3 => {
            let scenes = keys.scenes.clone().unwrap_or_default();
            if scenes.is_empty() && keys.choices.is_none() {
                return Err(missing("scenes", "scenes = [\"../scenes/sensor1-hertz.toml\"]"));
            }
            let choices = keys.choices.as_ref().map(|given| choices(check, given, sensor)).transpose()?;
            Ok(Filter::F3 { scenes, choices: choices.map(Box::new) })
        }
        FilterKind::None => Ok(Filter::None),
    }
}

/// The key of a filter.
pub(super) fn keys(filter: &Filter) -> FilterKeys {
    let kind = filter.kind();
    match filter {
        Filter::None => FilterKeys::default(),
        Filter::F1 { l } => FilterKeys { kind, l: Some(*l as i64), ..FilterKeys::default() },
        Filter::F2 { p } => FilterKeys { kind, p: Some(*p), ..FilterKeys::default() },
        Filter::F3 { scenes, choices } => {
            let named = |matrix: MatrixName, choices: &Choices| (matrix.to_string(), choices.of(matrix).to_string());
            let choices = choices.as_ref().map(|all| MatrixName::ALL.map(|matrix| named(matrix, all)).into());
            FilterKeys { kind, scenes: Some(scenes.clone()), choices, ..FilterKeys::default() }
        }
    }
}

fn band(check: &Check, key: &str, value: i64, sensor: &Sensor) -> Result<usize, DesignError> {
    // The diagonal and one neighbour on either side is the narrowest band allowed.
    check.integer(key, value, 1, sensor.taxels() as i64 - 2).map(|l| l as usize)
}

fn choices(check: &Check, given: &BTreeMap<String, String>, sensor: &Sensor) -> Result<Choices, DesignError> {
    for name in given.keys() {
        if let Err(error) = name.parse::<MatrixName>() {
            return Err(check.value(
                &format!("algorithm.filter.choices.{name}"),
                "is unknown".to_owned(),
                error.to_string(),
            ));
        }
    }
    let mut filters = [MatrixFilter::None; MatrixName::ALL.len()];
    for (name, filter) in MatrixName::ALL.into_iter().zip(&mut filters) {
        let key = format!("algorithm.filter.choices.{name}");
        let text = given.get(&name.to_string()).ok_or_else(|| {
            check.value(
                &key,
                "is missing".to_owned(),
                "give a filter for each of the 13 matrices, or remove the choices and run `golden choose`".to_owned(),
            )
        })?;
        *filter = match text.parse::<MatrixFilter>() {
            Ok(MatrixFilter::F1 { l }) => {
                MatrixFilter::F1 { l: band(check, &key, l.try_into().unwrap_or(-1), sensor)? }
            }
            Ok(MatrixFilter::F2 { p }) => MatrixFilter::F2 { p: check.above_zero(&key, p, f64::MAX, "")? },
            Ok(MatrixFilter::None) => MatrixFilter::None,
            Err(error) => return Err(check.value(&key, "cannot be read".to_owned(), error.to_string())),
        };
    }
    Ok(Choices::new(filters))
}
