//! Scripts and file lists for the tools that take the Verilog further: Vivado, `FuseSoC`, Bender, and a plain `.f`.
//!
//! They name the files that the folder holds, relative to the folder, so they come after everything else.

use golden::design::Design;
use serde_json::{Value, json};
use tera::context;

use crate::plan::Plan;
use crate::plan::streams::WORD_BITS;

use super::boards::Board;
use super::registers::core_module;
use super::{EmitError, FileMap, VERSION, debug, template};

/// Bytes of a word of memory.
const WORD_BYTES: usize = WORD_BITS / 8;
/// Width of the DMA's length register unless frames are longer, in bits.
const LEAST_LENGTH_BITS: u32 = 14;

/// Only where there is a testbench to run.
const SIMULATION: &str = "vivado/simulate.tcl";

/// Only where nets are marked.
const ANALYSER: &str = "vivado/ila.tcl";

/// `(path, template)`; `NAME` stands for the design's name.
const FILES: [(&str, &str); 12] = [
    ("vivado/files.tcl", include_str!("../../templates/vivado/files.tcl.tera")),
    ("vivado/NAME.xdc", include_str!("../../templates/vivado/constraints.xdc.tera")),
    ("vivado/synth.tcl", include_str!("../../templates/vivado/synth.tcl.tera")),
    ("vivado/power.tcl", include_str!("../../templates/vivado/power.tcl.tera")),
    (ANALYSER, include_str!("../../templates/vivado/ila.tcl.tera")),
    (SIMULATION, include_str!("../../templates/vivado/simulate.tcl.tera")),
    ("vivado/package_ip.tcl", include_str!("../../templates/vivado/package_ip.tcl.tera")),
    ("vivado/block_design.tcl", include_str!("../../templates/vivado/block_design.tcl.tera")),
    ("vivado/out_of_context.tcl", include_str!("../../templates/vivado/out_of_context.tcl.tera")),
    ("NAME.f", include_str!("../../templates/vivado/files.f.tera")),
    ("NAME.core", include_str!("../../templates/vivado/fusesoc.core.tera")),
    ("Bender.yml", include_str!("../../templates/vivado/Bender.yml.tera")),
];

/// A board with the addresses of its registers as the script writes them.
fn placed(board: &Board) -> Value {
    let mut value = json!(board);
    for (key, address) in [("dma_address", board.registers), ("core_address", board.core_registers())] {
        value[key] = format!("{address:#010X}").into();
    }
    value
}

/// Vendor, library and version, which a checked design has.
pub(super) fn vlnv(design: &Design) -> [String; 3] {
    design.hardware.vendor_library_version().map(|words| words.map(str::to_owned)).unwrap_or_default()
}

/// Adds the scripts and lists; `files` holds what they name.
///
/// # Errors
/// [`EmitError::Template`] if a template does not fit its data.
pub fn insert(
    plan: &Plan,
    hash: &str,
    (boards, debug): (&[Board], bool),
    files: &mut FileMap,
) -> Result<(), EmitError> {
    let (design, hardware) = (&plan.design, &plan.design.hardware);
    let testbench = Some(format!("sim/{}_tb.v", design.name)).filter(|path| files.contains_key(path));
    let core = files.get(&format!("rtl/{}.v", core_module(plan)));
    let core = core.map_or_else(String::new, |text| String::from_utf8_lossy(text).into_owned());
    let streams = plan.streams();
    let bytes_in = streams.words_in() * WORD_BYTES;
    let bytes_out = streams.words_out * WORD_BYTES;
    let [vendor, library, ip_version] = vlnv(design);
    let context = context! {
        name => &design.name,
        version => VERSION,
        hash => hash,
        columns => &design.sensor.columns,
        rows => &design.sensor.rows,
        part => &hardware.part,
        // As a word of Tcl and as a YAML string: neither braces nor quotes nor backslashes are legal in a part's name.
        tcl_part => &format!("{{{}}}", hardware.part),
        yaml_part => &format!("\"{}\"", hardware.part),
        clock_mhz => &hardware.clock_mhz,
        // Nanoseconds with three decimals, Vivado's resolution.
        period_ns => &period_ns(hardware.clock_mhz),
        // Under which tools list the core.
        vendor,
        library,
        ip_version,
        revision => &revision(hash),
        // Bits of a beat on both streams.
        stream_bits => &streams.bits,
        bytes_in,
        bytes_out,
        length_bits => &length_bits(bytes_in, bytes_out),
        rtl => &names(files, "rtl/", ".v"),
        rom => &names(files, "rom/", ".mem"),
        // Path of the self-checking testbench and names of its data files in `sim/`.
        testbench,
        sim_data => &names(files, "sim/", ".mem"),
        dsp_block => plan.resources.dsp_block.name(),
        // Predicted multipliers and block memories.
        blocks => &plan.resources.blocks,
        // Whether there is a register bank.
        control => &hardware.control,
        // Nets that a logic analyser is for, where the design marks them, and its samples.
        debug => &debug.then(|| debug::nets(&core, debug::always_zero(plan))),
        samples => &debug::samples(plan.timeline.latency_cycles),
        boards => &boards.iter().map(placed).collect::<Vec<_>>(),
    };
    for (path, template) in FILES {
        if (path == SIMULATION && testbench.is_none()) || (path == ANALYSER && !debug) {
            continue;
        }
        let text = template::one(path, template, &context)?;
        files.insert(path.replace("NAME", &design.name), text.into_bytes());
    }
    Ok(())
}

/// Names, without the folder, of the files with this ending directly in `folder`.
fn names(files: &FileMap, folder: &str, ending: &str) -> Vec<String> {
    let name = |path: &String| path.strip_prefix(folder).filter(|name| name.ends_with(ending)).map(str::to_owned);
    files.keys().filter_map(name).filter(|name| !name.contains('/')).collect()
}

/// Rounded down, so that the constraint is never weaker than the design asks for.
fn period_ns(clock_mhz: f64) -> String {
    let picoseconds = (1e6 / clock_mhz).floor() as u64;
    format!("{}.{:03}", picoseconds / 1000, picoseconds % 1000)
}

/// The first 28 bits of the design's hash.
fn revision(hash: &str) -> u32 {
    hash.chars().take(7).filter_map(|digit| digit.to_digit(16)).fold(0, |value, digit| value << 4 | digit)
}

/// Width of the DMA's length register: a transfer is a frame or an answer.
fn length_bits(bytes_in: usize, bytes_out: usize) -> u32 {
    (bytes_in.max(bytes_out).ilog2() + 1).max(LEAST_LENGTH_BITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_are_whole_picoseconds_and_never_too_long() {
        assert_eq!(period_ns(125.0), "8.000");
        assert_eq!(period_ns(300.0), "3.333");
        assert_eq!(period_ns(1.0), "1000.000");
        assert_eq!(period_ns(160.5), "6.230");
    }

    #[test]
    fn lengths_are_those_of_the_longer_transfer() {
        // 10 × 10 with a field; 64 × 64 with resultants only, whose frame is 2^14 bytes; 64 × 64 with a field.
        assert_eq!([(400, 1264), (16_384, 64), (16_384, 49_216)].map(|(a, b)| length_bits(a, b)), [14, 15, 16]);
    }

    #[test]
    fn revisions_follow_the_hash() {
        assert_eq!(revision("00000ff00a0b0c0d"), 0xff);
        assert_eq!(revision("ffffffffffffffff"), 0x0fff_ffff);
    }

    #[test]
    fn the_testbench_is_named_only_where_it_is() {
        let text = golden::design::Design::from_toml(
            "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
             name = \"d\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n",
            "d.toml",
        );
        let plan = Plan::new(&text.unwrap()).unwrap();
        let mut files = FileMap::from([("rtl/d.v".to_owned(), Vec::new())]);
        insert(&plan, "0123456789abcdef", (&Board::all().unwrap(), false), &mut files).unwrap();
        let text = |files: &FileMap, path: &str| String::from_utf8(files[path].clone()).unwrap();
        assert!(!text(&files, "d.core").contains("d_tb"));
        assert_eq!(text(&files, "d.f"), "rtl/d.v\n");
        assert!(!files.contains_key(SIMULATION) && !text(&files, "vivado/files.tcl").contains("testbench"));
        files.insert("sim/d_tb.v".to_owned(), Vec::new());
        files.insert("sim/d_stimulus.mem".to_owned(), Vec::new());
        insert(&plan, "0123456789abcdef", (&Board::all().unwrap(), false), &mut files).unwrap();
        assert!(text(&files, "d.core").contains("sim/d_stimulus.mem: {copyto: d_stimulus.mem}"));
        assert!(text(&files, "d.core").contains("toplevel: d_tb"));
        assert!(text(&files, "Bender.yml").contains("sim/d_tb.v"));
        assert!(text(&files, "vivado/files.tcl").contains("[file join $root sim/d_tb.v]"));
        assert!(text(&files, SIMULATION).contains("testbench of d in"));
    }
}
