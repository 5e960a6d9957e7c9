//! Range checks, each with a message that says what to do.

use super::{DesignError, Hardware};

/// Makes errors that name the file.
pub(crate) struct Check<'a> {
    pub(crate) origin: &'a str,
}

impl Check<'_> {
    pub(crate) fn value(&self, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> DesignError {
        DesignError(format!("{}: {key} {}; {}", self.origin, problem.into(), remedy.into()))
    }

    /// The error of a key, if a rule is broken.
    pub(crate) fn refuse_if(
        &self,
        is_broken: bool,
        key: &str,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<(), DesignError> {
        if is_broken { Err(self.value(key, problem, remedy)) } else { Ok(()) }
    }

    pub(crate) fn integer(&self, key: &str, value: i64, low: i64, high: i64) -> Result<i64, DesignError> {
        if (low..=high).contains(&value) {
            Ok(value)
        } else {
            Err(self.value(key, format!("is {value}"), format!("use a whole number from {low} to {high}")))
        }
    }

    pub(crate) fn real(&self, key: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<f64, DesignError> {
        // A NaN is in no range.
        if (low..=high).contains(&value) {
            Ok(value)
        } else {
            Err(self.value(
                key,
                format!("is {value}"),
                format!("use a number from {low} to {high} {unit}").trim_end().to_owned(),
            ))
        }
    }

    pub(crate) fn above_zero(&self, key: &str, value: f64, high: f64, unit: &str) -> Result<f64, DesignError> {
        if value > 0.0 && value <= high {
            Ok(value)
        } else {
            let limit = if high < f64::MAX { format!("and at most {high} {unit}") } else { "and finite".to_owned() };
            Err(self.value(key, format!("is {value}"), format!("use a number greater than 0 {limit}")))
        }
    }
}

/// Longest name; file systems and tools cope with it as a part of longer names.
const MAX_NAME: usize = 64;

/// Modules that are the same in every design begin so.
const RESERVED_PREFIX: &str = "sptfra_";

/// Whether a word may be the name of a design.
pub fn is_name(word: &str) -> bool {
    name(&Check { origin: "" }, word).is_ok()
}

pub(crate) fn name(check: &Check, name: &str) -> Result<(), DesignError> {
    let refuse = |problem: String| {
        Err(check.value("name", problem, "use a Verilog identifier: a letter or _, then letters, digits and _"))
    };
    let mut characters = name.chars();
    let starts_well = characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !starts_well || !characters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return refuse(format!("is {name:?}, which is no Verilog identifier"));
    }
    if name.len() > MAX_NAME {
        return refuse(format!("has {} characters, more than {MAX_NAME}", name.len()));
    }
    if KEYWORDS.split_whitespace().any(|keyword| keyword == name) {
        return refuse(format!("is \"{name}\", a Verilog keyword"));
    }
    if name.starts_with(RESERVED_PREFIX) {
        return refuse(format!("is \"{name}\", which begins like the modules that all designs share"));
    }
    Ok(())
}

pub(crate) fn part(check: &Check, part: &str) -> Result<(), DesignError> {
    let legal = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    if part.is_empty() || part.len() > MAX_NAME || !part.chars().all(legal) {
        return Err(check.value(
            "hardware.part",
            format!("is {part:?}"),
            format!("use 1 to {MAX_NAME} letters, digits, dots, dashes and underscores"),
        ));
    }
    Ok(())
}

pub(crate) fn vlnv(check: &Check, hardware: &Hardware) -> Result<(), DesignError> {
    if hardware.vendor_library_version().is_none() {
        return Err(check.value(
            "hardware.vlnv",
            format!("is {:?}", hardware.vlnv),
            "write vendor:library:version, the version as two numbers, such as \"example.org:sensors:1.2\"",
        ));
    }
    Ok(())
}

/// Keywords of IEEE 1364-2005 and IEEE 1800-2017: tools read the generated files as either.
const KEYWORDS: &str = include_str!("keywords.txt");
