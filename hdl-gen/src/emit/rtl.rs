//! The library of modules in `hdl-gen/rtl`, the same in every design: what of it a design's folder needs.

use std::collections::{BTreeMap, BTreeSet};

use crate::cores::Multiplier;

/// `(module, text)` of every file in a folder.
macro_rules! library {
    ($folder:literal: $($module:literal),* $(,)?) => {
        &[$(($module, include_str!(concat!("../../", $folder, "/", $module, ".v")))),*]
    };
}

const LIBRARY: &[(&str, &str)] = library![
    "rtl":
    "sptfra_adder_tree",
    "sptfra_axi_lite",
    "sptfra_axis_skid",
    "sptfra_axis_skids",
    "sptfra_bank",
    "sptfra_banks",
    "sptfra_butterfly",
    "sptfra_bz",
    "sptfra_bz_wide",
    "sptfra_calibration",
    "sptfra_calibration_registers",
    "sptfra_cean",
    "sptfra_check_delay",
    "sptfra_check_latency",
    "sptfra_co",
    "sptfra_coefficient_field",
    "sptfra_coefficients",
    "sptfra_component_labels",
    "sptfra_component_sums",
    "sptfra_contact_counter",
    "sptfra_context_words",
    "sptfra_cordic",
    "sptfra_correction",
    "sptfra_counts",
    "sptfra_curve",
    "sptfra_curve_bank",
    "sptfra_curve_check",
    "sptfra_dead_bank",
    "sptfra_decode",
    "sptfra_diagonal_mirror",
    "sptfra_direction",
    "sptfra_divider",
    "sptfra_doubt",
    "sptfra_estimator_joint",
    "sptfra_estimator_line",
    "sptfra_field",
    "sptfra_field_port",
    "sptfra_field_wide",
    "sptfra_fixed_to_float",
    "sptfra_float_to_fixed",
    "sptfra_fold",
    "sptfra_fold_frame",
    "sptfra_frame_context",
    "sptfra_frame_gate",
    "sptfra_frame_memory",
    "sptfra_frame_meter",
    "sptfra_frame_writer",
    "sptfra_friction",
    "sptfra_gains",
    "sptfra_grid_centroid",
    "sptfra_ingress_fifo",
    "sptfra_int_to_fixed",
    "sptfra_joint_stages",
    "sptfra_leading_bit",
    "sptfra_level_set",
    "sptfra_line",
    "sptfra_look",
    "sptfra_look_scale",
    "sptfra_look_stress",
    "sptfra_look_window",
    "sptfra_mac",
    "sptfra_mac_wide",
    "sptfra_members",
    "sptfra_multiply",
    "sptfra_multiply_wide",
    "sptfra_network",
    "sptfra_op",
    "sptfra_output",
    "sptfra_output_word",
    "sptfra_overrun_registers",
    "sptfra_plane",
    "sptfra_plane_cell",
    "sptfra_plane_search",
    "sptfra_points",
    "sptfra_points_centroid",
    "sptfra_points_level",
    "sptfra_points_taxel",
    "sptfra_quad_rows",
    "sptfra_ram",
    "sptfra_range",
    "sptfra_ratio",
    "sptfra_registers",
    "sptfra_replace",
    "sptfra_reset",
    "sptfra_rom",
    "sptfra_rom_bank",
    "sptfra_row_sequencer",
    "sptfra_samples",
    "sptfra_search",
    "sptfra_search_cell",
    "sptfra_search_cells",
    "sptfra_search_distance",
    "sptfra_spmv_array",
    "sptfra_spmv_collector",
    "sptfra_spmv_lane",
    "sptfra_spmv_sequencer",
    "sptfra_spmv_way",
    "sptfra_stream_gate",
    "sptfra_summary",
    "sptfra_tare",
    "sptfra_taxel_memory",
    "sptfra_taxel_walk",
    "sptfra_times_index",
    "sptfra_turns",
    "sptfra_unfold",
    "sptfra_unpack",
    "sptfra_we",
    "sptfra_weight_raster",
    "sptfra_weight_totals",
    "sptfra_whole_frames",
];

/// Other implementations of some of them, for ECP5.
const ECP5: &[(&str, &str)] = library!["rtl/ecp5": "sptfra_mac", "sptfra_multiply"];

/// Every module of the library and its text, for fabrics that multiply like that.
pub fn library(multiplier: Multiplier) -> BTreeMap<&'static str, &'static str> {
    let other = match multiplier {
        Multiplier::Whole => &[],
        Multiplier::Split => ECP5,
    };
    LIBRARY.iter().chain(other).copied().collect()
}

/// The modules of the library that `texts` instantiate, and those that these do, but for what stands only in a
/// `generate if` that the design does not take, which `without` names: every tool passes over a module that is missing
/// there.
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
    use std::fs;

    use super::{ECP5, LIBRARY, used_by, words};
    use crate::cores::Multiplier;

    /// The names of the Verilog files in a folder.
    fn modules(folder: &str) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut modules: Vec<String> = entries.filter_map(|name| name.strip_suffix(".v").map(str::to_owned)).collect();
        modules.sort();
        modules
    }

    #[test]
    fn the_library_is_the_folder() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/rtl");
        for (folder, library) in [(folder.to_owned(), LIBRARY), (format!("{folder}/ecp5"), ECP5)] {
            assert_eq!(modules(&folder), library.iter().map(|(module, _)| *module).collect::<Vec<_>>());
        }
        for (module, text) in LIBRARY.iter().chain(ECP5) {
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
        let used = used_by(["sptfra_ram a (); sptfra_rom b ();"].into_iter(), &["sptfra_rom"], Multiplier::Whole);
        assert_eq!(used.into_keys().collect::<Vec<_>>(), ["sptfra_ram"]);
    }
}
