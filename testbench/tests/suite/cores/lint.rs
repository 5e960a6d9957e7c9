//! What other tools say of the emitted text.

use std::error::Error;
use std::fs;

use hdl_gen::cores::emit_all;
use tempfile::TempDir;
use testbench::tools;

use super::bench::succeed;

/// The cores as files, and their names in the order of emission.
fn written() -> Result<(TempDir, Vec<String>), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let mut names = Vec::new();
    for core in emit_all()? {
        let name = format!("{}.v", core.module);
        fs::write(folder.path().join(&name), core.verilog)?;
        names.push(name);
    }
    Ok((folder, names))
}

#[test]
fn verilator_and_icarus_have_no_warning() -> Result<(), Box<dyn Error>> {
    let (folder, names) = written()?;
    for name in &names {
        succeed(tools::verilator()?.args(["--lint-only", "-Wall", name]).current_dir(&folder))?;
        let said = succeed(tools::icarus()?.args(["-Wall", "-g2005", "-t", "null", name]).current_dir(&folder))?;
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
