//! What other tools say of the emitted text.

use std::error::Error;
use std::fs;

use tempfile::TempDir;
use testbench::tools;

use super::bench::{cores, succeed};
use crate::support::effort::half_of;
use crate::support::icarus;

/// The cores as files, and their names.
fn written() -> Result<(TempDir, Vec<String>), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let mut names = Vec::new();
    for (module, text) in cores() {
        let name = format!("{module}.v");
        fs::write(folder.path().join(&name), text)?;
        names.push(name);
    }
    Ok((folder, names))
}

#[test]
fn verilator_and_icarus_have_no_warning() -> Result<(), Box<dyn Error>> {
    let (folder, names) = written()?;
    for name in &names {
        succeed(tools::verilator()?.args(["--lint-only", "-Wall", name]).current_dir(&folder))?;
        let said = succeed(icarus().args(["-Wall", "-g2005", "-t", "null", name]).current_dir(&folder))?;
        assert_eq!(said, "", "{name}");
    }
    Ok(())
}

#[test]
fn yosys_finds_no_latch_and_no_loose_wire() -> Result<(), Box<dyn Error>> {
    let (folder, names) = written()?;
    let script = format!("read_verilog {}; proc; check -assert; select -assert-none t:$dlatch", names.join(" "));
    succeed(tools::yosys()?.args(["-q", "-p", &script]).current_dir(&folder))?;
    Ok(())
}

/// One DSP block holds the whole lane, its adder and registers included. For the 25 bits of the older DSP block, since
/// Yosys packs registers into that one only.
#[test]
fn mac_becomes_one_dsp_block() -> Result<(), Box<dyn Error>> {
    let (folder, _) = written()?;
    let narrow = "module narrow(input clock, reset, valid, first, input signed [17:0] coefficient,
            input signed [24:0] data, output signed [47:0] accumulator);
        sptfra_mac mac(.clock(clock), .reset(reset), .valid(valid), .first(first), .coefficient(coefficient),
            .data({{2{data[24]}}, data}), .accumulator(accumulator));
    endmodule";
    fs::write(folder.path().join("narrow.v"), narrow)?;
    let script = "read_verilog sptfra_mac.v narrow.v; synth_xilinx -family xc7 -noiopad -flatten -top narrow;
        select -assert-count 1 t:DSP48E1; select -assert-none t:CARRY4; select -assert-max 8 t:FD*";
    succeed(tools::yosys()?.args(["-q", "-p", script]).current_dir(&folder))?;
    let script = "read_verilog sptfra_mac.v; synth_xilinx -family xcup -noiopad -flatten -top sptfra_mac;
        select -assert-count 1 t:DSP48E2";
    succeed(tools::yosys()?.args(["-q", "-p", script]).current_dir(&folder))?;
    Ok(())
}

/// Yosys' passes up to its search for DSP blocks, but for those that narrow what was widened: other tools have none.
const WITHOUT_NARROWING: &str = "proc; flatten; tribuf -logic; deminout; opt_expr; opt_clean; opt -nodffe -nosdff; \
                                 fsm; opt; opt_clean";

/// A product is one block for a tool that takes it as it is written.
#[test]
fn a_product_becomes_one_dsp_block_without_being_narrowed() -> Result<(), Box<dyn Error>> {
    let (folder, _) = written()?;
    for module in half_of(["sptfra_multiply", "sptfra_mac"]) {
        let synth = format!("synth_xilinx -family xcup -noiopad -noclkbuf -flatten -top {module}");
        let ways = [
            format!("{synth} -run :coarse"),
            format!("{synth} -run :prepare; {WITHOUT_NARROWING}; {synth} -run map_dsp:coarse"),
        ];
        for way in ways {
            let script = format!(
                "read_verilog {module}.v; {way}; select -assert-count 1 t:DSP48E2; \
                                  select -assert-none t:$mul t:$__soft_mul t:$macc_v2"
            );
            succeed(tools::yosys()?.args(["-q", "-p", &script]).current_dir(&folder))?;
        }
    }
    for module in half_of(["sptfra_multiply_wide", "sptfra_mac_wide"]) {
        let synth = format!("synth_xilinx -family xcup -noiopad -noclkbuf -flatten -top {module}");
        for way in [
            format!("{synth} -run :coarse"),
            format!("{synth} -run :prepare; {WITHOUT_NARROWING}; {synth} -run map_dsp:coarse"),
        ] {
            let script = format!(
                "read_verilog {module}.v; {way}; select -assert-count 2 t:DSP48E2; \
                                  select -assert-none t:$mul t:$__soft_mul t:$macc_v2"
            );
            succeed(tools::yosys()?.args(["-q", "-p", &script]).current_dir(&folder))?;
        }
    }
    for module in half_of(["sptfra_multiply_ecp5", "sptfra_mac_ecp5"]) {
        let script = format!(
            "read_verilog {module}.v; synth_ecp5 -top {module} -run :map_ram; select -assert-count 2 t:MULT18X18D"
        );
        succeed(tools::yosys()?.args(["-q", "-p", &script]).current_dir(&folder))?;
    }
    Ok(())
}

/// The test above can fail: widened to 45 bits by concatenation, the product is many blocks until it is narrowed.
#[test]
fn a_widened_product_becomes_many_dsp_blocks() -> Result<(), Box<dyn Error>> {
    let (folder, _) = written()?;
    let text = fs::read_to_string(folder.path().join("sptfra_multiply.v"))?;
    let plain = "coefficient * data;";
    assert!(text.contains(plain), "{text}");
    let wide = "$signed({{27{coefficient[17]}}, coefficient}) * $signed({{18{data[26]}}, data});";
    fs::write(folder.path().join("sptfra_multiply.v"), text.replace(plain, wide))?;
    let synth = "synth_xilinx -family xcup -noiopad -noclkbuf -flatten -top sptfra_multiply";
    let script = format!(
        "read_verilog sptfra_multiply.v; {synth} -run :prepare; {WITHOUT_NARROWING}; \
                          {synth} -run map_dsp:coarse; select -assert-min 2 t:DSP48E2"
    );
    succeed(tools::yosys()?.args(["-q", "-p", &script]).current_dir(&folder))?;
    Ok(())
}
