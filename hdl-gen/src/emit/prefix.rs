//! Prefix of the library's module names, for two cores of different versions in one project.
//!
//! Verilog has one name space for modules: of two that share a name, tools refuse the second or silently take the later.

use std::collections::{BTreeMap, BTreeSet};

use super::{FileMap, VERSION, rtl};
use crate::cores::Multiplier;

/// Second line of every file of the library.
const PART: &str = "// Part of the SpTFRA hardware generator.";

/// A prefix that cannot begin a module's name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} begins no Verilog identifier; use a letter or _, then letters, digits and _, at most 32 in all")]
pub struct PrefixError(String);

/// What stands before the name of every module of the library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

impl std::str::FromStr for Prefix {
    type Err = PrefixError;

    fn from_str(text: &str) -> Result<Self, PrefixError> {
        let legal = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        if begins && text.len() <= 32 && text.chars().all(legal) {
            Ok(Self(text.to_owned()))
        } else {
            Err(PrefixError(text.to_owned()))
        }
    }
}

/// Writes the generator's version into every file of the library.
pub fn stamp(files: &mut FileMap) {
    let stamped = format!("{PART} Version {VERSION}.");
    for (_, contents) in files.iter_mut().filter(|(path, _)| is_library(path)) {
        *contents = String::from_utf8_lossy(contents).replacen(PART, &stamped, 1).into_bytes();
    }
}

/// Puts the prefix before each module of the library: in its file's name, and in each file that names it.
pub fn rename(files: &mut FileMap, Prefix(prefix): &Prefix) {
    // Scripts name modules too that this core does without.
    let modules: BTreeSet<&str> = rtl::library(Multiplier::Whole).into_keys().collect();
    let renamed: BTreeMap<String, Vec<u8>> = std::mem::take(files)
        .into_iter()
        .map(|(path, contents)| {
            let is_text = path.rsplit_once('.').is_some_and(|(_, ending)| ending != "mem" && ending != "csv");
            let contents = if is_text && path != "design.toml" {
                with_prefix(&String::from_utf8_lossy(&contents), &modules, prefix).into_bytes()
            } else {
                contents
            };
            (with_prefix(&path, &modules, prefix), contents)
        })
        .collect();
    *files = renamed;
}

fn is_library(path: &str) -> bool {
    path.starts_with("rtl/sptfra_")
}

/// The text with the prefix before each word that names a module.
fn with_prefix(text: &str, modules: &BTreeSet<&str>, prefix: &str) -> String {
    let ends = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    let mut result = String::with_capacity(text.len());
    // A word and what ends it, or what stands between words.
    for piece in text.split_inclusive(ends) {
        if modules.contains(piece.trim_end_matches(ends)) {
            result.push_str(prefix);
        }
        result.push_str(piece);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_names_of_modules_get_the_prefix_wherever_they_stand() {
        let text = |path: &str, text: &str| (path.to_owned(), text.as_bytes().to_vec());
        let mut files = FileMap::from([
            text("rtl/pad.v", "sptfra_mac a (); // sptfra_mac, not sptfra_machine\n"),
            text("rtl/sptfra_mac.v", "// SPDX\n// Part of the SpTFRA hardware generator.\nmodule sptfra_mac (\n"),
            text("pad.f", "rtl/pad.v\nrtl/sptfra_mac.v\nsptfra_field\n"),
            text("design.toml", "name = \"sptfra_mac\"\n"),
        ]);
        stamp(&mut files);
        rename(&mut files, &"old_".parse().unwrap());
        let text = |path: &str| String::from_utf8(files[path].clone()).unwrap();
        assert_eq!(text("rtl/pad.v"), "old_sptfra_mac a (); // old_sptfra_mac, not sptfra_machine\n");
        assert_eq!(text("pad.f"), "rtl/pad.v\nrtl/old_sptfra_mac.v\nold_sptfra_field\n");
        assert_eq!(text("design.toml"), "name = \"sptfra_mac\"\n");
        let library = text("rtl/old_sptfra_mac.v");
        assert!(
            library.contains(&format!("hardware generator. Version {VERSION}.\nmodule old_sptfra_mac")),
            "{library}"
        );
    }

    #[test]
    fn a_prefix_begins_an_identifier() {
        for wrong in ["", "1_", "a-b", "é", "a b"] {
            assert!(wrong.parse::<Prefix>().is_err(), "{wrong:?}");
        }
        assert_eq!("v2_".parse(), Ok(Prefix("v2_".to_owned())));
    }
}
