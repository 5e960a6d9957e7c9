//! The library of modules in `hdl-gen/rtl`, the same in every design: what of it a design's folder needs.

use std::collections::{BTreeMap, BTreeSet};

use include_dir::{Dir, include_dir};

use crate::cores::Multiplier;

/// The rooms of the library, and in `ecp5` other implementations of some of its modules.
static RTL: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/rtl");
const ECP5: &str = "ecp5";

/// `(module, text)` of every Verilog file in a room.
fn room<'a>(folder: &'a Dir<'a>) -> impl Iterator<Item = (&'a str, &'a str)> {
    folder.files().filter_map(|file| {
        let module = file.path().file_name()?.to_str()?.strip_suffix(".v")?;
        Some((module, file.contents_utf8()?))
    })
}

/// Every module of the library and its text, for fabrics that multiply like that.
pub fn library(multiplier: Multiplier) -> BTreeMap<&'static str, &'static str> {
    let mut library: BTreeMap<_, _> =
        RTL.dirs().filter(|folder| !folder.path().ends_with(ECP5)).flat_map(room).collect();
    if multiplier == Multiplier::Split {
        library.extend(RTL.get_dir(ECP5).into_iter().flat_map(room));
    }
    library
}

/// The modules of the library that `texts` instantiate, and those that these do, but for what `without` names. That
/// stands only in a conditional block that neither the design takes nor the default parameters, which Yosys elaborates too.
pub fn used_by<'a>(
    texts: impl Iterator<Item = &'a str>,
    without: &[&str],
    multiplier: Multiplier,
) -> BTreeMap<&'static str, &'static str> {
    let library = library(multiplier);
    let mut used = BTreeMap::new();
    let mut open: Vec<&str> = texts.collect();
    while let Some(text) = open.pop() {
        for name in words(text) {
            if let Some((&module, &body)) = library.get_key_value(name)
                && !without.contains(&name)
                && used.insert(module, body).is_none()
            {
                open.push(body);
            }
        }
    }
    used
}

/// The words of a text that begin as the library's modules do, comments left out.
fn words(text: &str) -> BTreeSet<&str> {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let words = code.flat_map(|line| line.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_'));
    words.filter(|word| word.starts_with("sptfra_")).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{RTL, room, used_by, words};
    use crate::cores::Multiplier;

    #[test]
    fn every_file_is_a_module_in_one_room() {
        assert_eq!(RTL.files().next().map(include_dir::File::path), None::<&Path>);
        for (module, text) in RTL.dirs().flat_map(room) {
            assert!(text.contains(&format!("\nmodule {module} ")), "{module}: the file holds another module");
            assert!(text.starts_with("// SPDX-License-Identifier: MIT OR Apache-2.0\n// Part of "), "{module}");
        }
        let all = RTL.dirs().filter(|folder| !folder.path().ends_with("ecp5")).flat_map(room).count();
        assert!(all > 50 && all == super::library(Multiplier::Whole).len(), "a module stands in two rooms");
    }

    #[test]
    fn what_is_named_in_code_is_used() {
        assert_eq!(
            words("sptfra_rom #( // sptfra_ram\n) x_sptfra_ram").into_iter().collect::<Vec<_>>(),
            ["sptfra_rom"]
        );
        let used = used_by(["sptfra_ram a (); sptfra_rom b ();"].into_iter(), &["sptfra_rom"], Multiplier::Whole);
        assert_eq!(used.into_keys().collect::<Vec<_>>(), ["sptfra_ram"]);
    }
}
