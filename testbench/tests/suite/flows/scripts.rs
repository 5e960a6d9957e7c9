//! Synthesis and IP packaging, in the stub.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::folder::{Folder, NAME, files};

/// All files below a folder with their contents.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(contents(&path));
        } else {
            found.push((path.display().to_string(), fs::read(&path).expect("readable")));
        }
    }
    found.sort();
    found
}

fn names(files: impl IntoIterator<Item = String>) -> BTreeSet<String> {
    files.into_iter().filter_map(|path| Some(Path::new(&path).file_name()?.to_str()?.to_owned())).collect()
}

#[test]
fn synthesis_reads_all_files_and_ends_with_the_figures() {
    let folder = Folder::small();
    let ran = folder.vivado("vivado/synth.tcl", &[], &[]).succeeded();
    assert_eq!(
        ran.last_line(),
        "small_4x3 at 125.0 MHz: timing met, WNS 0.345 ns, LUT 4321, FF 5432, DSP 34, BRAM 12.5"
    );
    let synthesis = ran.call("synth_design");
    assert!(synthesis.contains("-mode out_of_context") && synthesis.contains("-part xczu9eg-ffvb1156-2-e"));
    assert!(ran.call("create_clock").contains("-period 8.000"));
    for (path, _) in files(None) {
        let place = folder.design().join(&path).display().to_string();
        if path.starts_with("rtl/") {
            assert!(ran.call("read_verilog").contains(&place), "{path} is not read");
        } else if path.starts_with("rom/") {
            assert!(ran.call("read_mem").contains(&place), "{path} is not read");
        }
    }
    let reports = names(contents(&folder.work().join(format!("{NAME}_synth"))).into_iter().map(|(path, _)| path));
    for report in ["utilization.rpt", "utilization_by_module.rpt", "timing.rpt", "small_4x3.dcp"] {
        assert!(reports.contains(report), "{reports:?}");
    }
}

#[test]
fn synthesis_is_for_the_designs_part() {
    let part = "xc7a200tfbg676-2";
    let ran = Folder::new(&files(Some(part))).vivado("vivado/synth.tcl", &[], &[]).succeeded();
    assert!(ran.call("create_project").ends_with(part) && ran.call("synth_design").contains(part));
}

#[test]
fn missed_timing_is_an_error_with_the_figures() {
    let ran = Folder::small().vivado("vivado/synth.tcl", &[], &[("STANDIN_SLACK", "-0.012")]);
    ran.refused("timing MISSED, WNS -0.012 ns, LUT 4321");
}

#[test]
fn a_multiplier_that_became_four_is_an_error_that_names_its_block() {
    let ran = Folder::small().vivado("vivado/synth.tcl", &[], &[("STANDIN_SPLIT", "sptfra_cean")]);
    ran.refused("found and counted on differ: CeAn DSP 4 for 1, RAMB36 0.0 for 0");
}

#[test]
fn the_packaged_ip_holds_every_source() {
    let folder = Folder::small();
    let ran = folder.vivado("vivado/package_ip.tcl", &[], &[]).succeeded();
    let packaged = names(contents(&folder.work().join("small_4x3_ip/src")).into_iter().map(|(path, _)| path));
    let clock = format!("vivado/{NAME}.xdc");
    let sources = files(None).into_keys();
    let sources = sources.filter(|path| path.starts_with("rtl/") || path.starts_with("rom/") || *path == clock);
    assert_eq!(packaged, names(sources));
    let used_in = ran.call("set_property USED_IN");
    assert!(used_in.contains("out_of_context") && used_in.contains("small_4x3.xdc"), "{used_in}");
    assert!(!ran.calls.iter().any(|call| call.contains("FREQ_HZ")), "the clock is the system's");
    for stream in ["s_axis", "m_axis"] {
        ran.call(&format!("ipx::associate_bus_interfaces -busif {stream} -clock aclk"));
    }
    ran.call("ipx::associate_bus_interfaces -clock aclk -reset aresetn");
    ran.call("ipx::check_integrity");
    assert!(!ran.calls.iter().any(|call| call.starts_with("ipx::infer_bus_interface")), "nothing is left to infer");
}

#[test]
fn interfaces_that_were_not_inferred_are_added() {
    let ran = Folder::small().vivado("vivado/package_ip.tcl", &[], &[("STANDIN_BLIND", "1")]).succeeded();
    assert!(ran.call("ipx::infer_bus_interface {s_axis_tdata").contains("axis_rtl"));
    assert!(ran.call("ipx::infer_bus_interface aresetn").contains("reset_rtl"));
}

#[test]
fn no_script_writes_into_the_generated_folder_or_knows_where_it_was() {
    let folder = Folder::small();
    let before = contents(&folder.design());
    for script in ["synth", "package_ip", "block_design"] {
        folder.vivado(&format!("vivado/{script}.tcl"), &[], &[]).succeeded();
    }
    assert_eq!(contents(&folder.design()), before);
    for (path, text) in files(None) {
        let text = String::from_utf8(text).expect("text");
        let mut words = text.split(|c: char| c.is_whitespace() || "{}[]\"'".contains(c));
        let no_paths = ["/UserIP", "/dts-v1/;", "/plugin/;"];
        let absolute = words.find(|word| {
            word.len() > 2 && word.starts_with('/') && !word.starts_with("//") && !no_paths.contains(word)
        });
        assert_eq!(absolute, None, "{path}");
    }
}
