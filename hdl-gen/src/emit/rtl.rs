//! The library of hand-written modules in `hdl-gen/rtl`: what of it a design's folder needs.

use std::collections::{BTreeMap, BTreeSet};

/// `(module, text)` of every file in `hdl-gen/rtl`.
macro_rules! library {
    ($($module:literal),* $(,)?) => { [$(($module, include_str!(concat!("../../rtl/", $module, ".v")))),*] };
}

const LIBRARY: [(&str, &str); 29] = library![
    "sptfra_adder_tree",
    "sptfra_butterfly",
    "sptfra_cean",
    "sptfra_check_latency",
    "sptfra_direction",
    "sptfra_estimator_joint",
    "sptfra_estimator_line",
    "sptfra_friction",
    "sptfra_grid_centroid",
    "sptfra_leading_bit",
    "sptfra_level_set",
    "sptfra_line",
    "sptfra_look",
    "sptfra_look_scale",
    "sptfra_look_stress",
    "sptfra_look_window",
    "sptfra_members",
    "sptfra_network",
    "sptfra_op",
    "sptfra_output",
    "sptfra_plane",
    "sptfra_plane_cell",
    "sptfra_ram",
    "sptfra_rom",
    "sptfra_search",
    "sptfra_search_cell",
    "sptfra_search_cells",
    "sptfra_summary",
    "sptfra_times_index",
];

/// The modules of the library that `texts` instantiate, and those that these do, but for what stands only in a
/// `generate if` that the design does not take, which `without` names: every tool passes over a module that is missing
/// there.
pub fn used_by<'a>(texts: impl Iterator<Item = &'a str>, without: &[&str]) -> BTreeMap<&'static str, &'static str> {
    let library: BTreeMap<&str, &str> = LIBRARY.into_iter().collect();
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
    use super::{LIBRARY, used_by, words};

    #[test]
    fn the_library_is_the_folder() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/rtl");
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut files: Vec<String> = entries.filter_map(|name| name.strip_suffix(".v").map(str::to_owned)).collect();
        files.sort();
        assert_eq!(files, LIBRARY.map(|(module, _)| module.to_owned()));
        for (module, text) in LIBRARY {
            assert!(text.contains(&format!("\nmodule {module} ")), "{module}: the file holds another module");
            assert!(text.starts_with("// SPDX-License-Identifier: MIT OR Apache-2.0\n// Part of "), "{module}");
            assert!(text.lines().all(|line| line.chars().count() <= 120), "{module}: a line is too long");
        }
    }

    #[test]
    fn what_is_named_in_code_is_used() {
        assert_eq!(
            words("sptfra_rom #( // sptfra_ram\n) x_sptfra_ram").into_iter().collect::<Vec<_>>(),
            ["sptfra_rom"]
        );
        let used = used_by(["sptfra_ram a (); sptfra_rom b ();"].into_iter(), &["sptfra_rom"]);
        assert_eq!(used.into_keys().collect::<Vec<_>>(), ["sptfra_ram"]);
    }
}
