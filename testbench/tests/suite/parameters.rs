//! Parameters that make no sense end the elaboration, with a name that says why.

use std::fs;

use testbench::tools;

use crate::support::{library_file, library_folders, look_in};

/// Module, parameter, value, what the tool must name. A value that several modules share is looked at in one of them.
const SENSELESS: [(&str, &str, &str, &str); 27] = [
    ("bz", "COLUMNS", "1", "columns_and_rows_must_be_2_to_64"),
    ("frame_writer", "DATA_BITS", "36", "data_bits_must_be_16_to_27_or_to_35_where_taxels_are_folded"),
    ("frame_writer", "SAMPLES", "3", "samples_of_a_beat_must_be_1_2_4_or_8"),
    ("bz", "EXPECTED_STAGES", "6", "the_plan_counts_on_other_stages"),
    ("creep", "SHARE", "2228224", "the_share_has_18_fraction_bits_and_more"),
    ("spmv_array", "CHANNELS", "3", "channels_must_be_1_or_4"),
    ("spmv_array", "PES", "129", "pes_must_be_1_to_128"),
    ("spmv_array", "DESTINATION_BITS", "5", "a_destination_has_3_or_4_bits"),
    ("spmv_pe", "OPERAND_DEPTH", "12", "the_operand_memory_does_not_hold_its_vectors"),
    ("spmv_pe", "MIRROR_SIDE", "4", "only_a_square_grid_is_mirrored"),
    ("spmv_lane", "COEFFICIENT_BITS", "28", "two_multipliers_have_27_by_35_bits"),
    ("spmv_array", "LASTS", "1", "the_last_product_must_end_its_program"),
    ("spmv_collector", "LEAST_SHIFT", "17", "each_shift_lies_from_the_least_to_the_largest"),
    ("contact_counter", "CHANNELS", "2", "channels_must_be_1_or_4"),
    ("contact_counter", "ROWS", "1", "columns_and_rows_must_be_2_to_64"),
    ("program_scheduler", "PROGRAMS", "4", "programs_must_be_1_to_3"),
    ("program_scheduler", "RESIDUALS", "3", "one_or_two_residuals_have_a_buffer"),
    ("op", "SLIP_RELEASE", "1", "a_slip_ends_below_its_limit"),
    ("output", "WORDS", "3", "words_of_a_beat_must_be_1_2_or_4"),
    ("estimator_line", "CHANNELS", "2", "channels_must_be_1_or_4"),
    ("grid_terms", "SIDE", "15", "a_side_has_13_points"),
    ("grid_search", "FRACTION", "25", "a_value_has_20_to_24_bits_of_fraction"),
    ("grid_search", "TAXELS", "3", "one_taxel_a_cycle_or_two_with_all_points"),
    ("grid_search", "PARALLEL", "26", "a_row_of_points_at_a_time_or_all_of_them"),
    ("joint_stages", "FEATURES", "2", "there_are_features_or_none"),
    ("network", "AT_ONCE", "5", "4_8_or_16_hidden_units_are_worked_on_at_once"),
    ("estimator_joint", "CHANNELS", "1", "the_joint_estimator_needs_four_channels"),
];

/// What Verilator says of a module of the library with these parameters.
fn said(module: &str, parameters: &[String]) -> String {
    let mut verilator = tools::verilator().expect("installed");
    verilator.args(["--lint-only", "-Wno-fatal", "--top-module", &format!("sptfra_{module}")]);
    verilator.args(parameters).args(look_in(library_folders()));
    let output = verilator.arg(library_file(&format!("sptfra_{module}"))).output().expect("starts");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn senseless_parameters_are_named() {
    for (module, parameter, value, reason) in SENSELESS {
        let name = format!("sptfra_error_{reason}");
        let text = said(module, &[format!("-G{parameter}={value}")]);
        assert!(text.contains(&name), "{module} with {parameter} = {value}: {text}");
        let path = library_file(&format!("sptfra_{module}"));
        assert!(fs::read_to_string(path).expect("is there").contains(&name), "{module}");
    }
}

/// By itself a module stands with what it has by default.
#[test]
fn what_makes_sense_is_not_refused() {
    for (module, ..) in SENSELESS {
        let text = said(module, &[]);
        assert!(!text.contains("%Error"), "{module}: {text}");
    }
}
