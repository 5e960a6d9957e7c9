//! From the `filter` of a design file to a checked [`Filter`].

use std::collections::BTreeMap;

use serde::Deserialize;

use super::checks::Check;
use super::{Choices, DesignError, Filter, FilterKind, MatrixFilter, Sensor};
use crate::names::MatrixName;

// Not a tagged enum: those lose the position of an error and cannot say which key belongs to which kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFilter {
    kind: String,
    l: Option<i64>,
    p: Option<f64>,
    scenes: Option<Vec<String>>,
    choices: Option<BTreeMap<String, String>>,
}

pub(super) fn filter(check: &Check, raw: &RawFilter, sensor: &Sensor) -> Result<Filter, DesignError> {
    let kind: FilterKind = check.word("algorithm.filter.kind", &raw.kind)?;
    let own: &[&str] = match kind {
        FilterKind::None => &[],
        FilterKind::F1 => &["l"],
        FilterKind::F2 => &["p"],
        FilterKind::F3 => &["scenes", "choices"],
    };
    let given = [
        ("l", raw.l.is_some()),
        ("p", raw.p.is_some()),
        ("scenes", raw.scenes.is_some()),
        ("choices", raw.choices.is_some()),
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
            let l = band(check, "algorithm.filter.l", raw.l.ok_or_else(|| missing("l", "l = 40"))?, sensor)?;
            Ok(Filter::F1 { l })
        }
        FilterKind::F2 => {
            let value = raw.p.ok_or_else(|| missing("p", "p = 30"))?;
            Ok(Filter::F2 { p: check.above_zero("algorithm.filter.p", value, f64::MAX, "")? })
        }
        FilterKind::F3 => {
            let scenes = raw.scenes.clone().unwrap_or_default();
            if scenes.is_empty() && raw.choices.is_none() {
                return Err(missing("scenes", "scenes = [\"../scenes/sensor1-hertz.toml\"]"));
            }
            let choices = raw.choices.as_ref().map(|raw| choices(check, raw, sensor)).transpose()?;
            Ok(Filter::F3 { scenes, choices: choices.map(Box::new) })
        }
        FilterKind::None => Ok(Filter::None),
    }
}

fn band(check: &Check, key: &str, value: i64, sensor: &Sensor) -> Result<usize, DesignError> {
    // The diagonal and one neighbour on either side is the narrowest band allowed.
    check.integer(key, value, 1, sensor.taxels() as i64 - 2).map(|l| l as usize)
}

fn choices(check: &Check, raw: &BTreeMap<String, String>, sensor: &Sensor) -> Result<Choices, DesignError> {
    for name in raw.keys() {
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
        let text = raw.get(&name.to_string()).ok_or_else(|| {
            check.value(
                &key,
                "is missing".to_owned(),
                "give a filter for each of the 13 matrices, or remove the choices and run `sptfra tune-filter`"
                    .to_owned(),
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
