//! Deep ROMs: their banks take as many block memories as predicted, and give every word.

use std::fmt::Write as _;
use std::fs;

use hdl_gen::resources::memory::{BANK, banks, memory};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tempfile::TempDir;
use testbench::tools;

use crate::support::{icarus, icarus_runtime, library_file};

/// A ROM of the mat's lanes, of its collector, and one whose last bank is shallow.
const SHAPES: [(usize, u32); 3] = [(12_015, 11), (4_935, 18), (BANK + 300, 36)];

/// The two modules and the banks' files, with words drawn at random; the words.
fn folder(depth: usize, width: u32) -> (TempDir, Vec<u128>) {
    let folder = tempfile::tempdir().expect("a folder");
    for module in ["sptfra_rom", "sptfra_ram"] {
        let name = format!("{module}.v");
        fs::copy(library_file(module), folder.path().join(&name)).expect("a module");
    }
    let mut random = ChaCha8Rng::seed_from_u64(depth as u64);
    let words: Vec<u128> = (0..depth).map(|_| random.random::<u128>() >> (128 - width)).collect();
    for (bank, words) in words.chunks(BANK).enumerate() {
        let digits = width.div_ceil(4) as usize;
        let text: String = words.iter().map(|word| format!("{word:0digits$x}\n")).collect();
        fs::write(folder.path().join(format!("bank{bank:02}_deep.mem")), text).expect("writable");
    }
    (folder, words)
}

fn address_width(depth: usize) -> u32 {
    depth.next_power_of_two().trailing_zeros()
}

#[test]
#[ignore = "half a minute of Yosys: part of `make test-long`"]
fn yosys_finds_the_predicted_block_memories() {
    for (depth, width) in SHAPES {
        let (folder, _) = folder(depth, width);
        let script = format!(
            "read_verilog -defer sptfra_rom.v sptfra_ram.v; chparam -set DEPTH {depth} -set WIDTH {width} \
             -set ADDRESS_WIDTH {} -set FILE \"deep.mem\" sptfra_rom; \
             synth_xilinx -family xcup -noiopad -noclkbuf -flatten -top sptfra_rom; tee -o stat.json stat -json",
            address_width(depth)
        );
        let mut yosys = tools::yosys().expect("installed");
        let made = yosys.args(["-q", "-p", &script]).current_dir(&folder).output().expect("starts");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let text = fs::read_to_string(folder.path().join("stat.json")).expect("written");
        let cells: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let count = |kind: &str| cells["design"]["num_cells_by_type"][kind].as_f64().unwrap_or(0.0);
        let found = count("RAMB36E2") + count("RAMB18E2") / 2.0;
        let predicted = memory("deep", 1, depth, width, true).bram36;
        assert!((found - predicted).abs() < 1e-9, "{depth} x {width}: {found}, not {predicted}: {text}");
    }
}

/// A tool that keeps the hierarchy does not see that a port is tied off: a small ROM would be a block memory.
#[test]
fn a_rom_has_no_write_port() {
    let (folder, _) = folder(300, 12);
    let script = "read_verilog sptfra_rom.v sptfra_ram.v; hierarchy -top sptfra_rom; proc; memory_collect; \
                  select -assert-none t:$mem_v2 r:WR_PORTS>0 %i; select -assert-min 1 t:$mem_v2";
    let made = tools::yosys().expect("installed").args(["-q", "-p", script]).current_dir(&folder).output();
    let made = made.expect("starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
}

#[test]
fn every_word_of_every_bank_is_read() {
    let (depth, width) = SHAPES[1];
    assert_eq!(banks(depth), 2);
    let (folder, words) = folder(depth, width);
    let mut bench = format!(
        "module bench;\n    reg clock = 0;\n    reg enable = 1;\n    reg [{0}:0] address = 0;\n    wire [{1}:0] data;\n    \
         integer index;\n    sptfra_rom #(.WIDTH({width}), .DEPTH({depth}), .ADDRESS_WIDTH({2}), .FILE(\"deep.mem\")) rom\n        \
         (.clock(clock), .enable(enable), .address(address), .data(data));\n    initial begin\n",
        address_width(depth) - 1,
        width - 1,
        address_width(depth),
    );
    // Each word is read, then held while another address, of the other bank, is there without an enable.
    write!(
        bench,
        "        for (index = 0; index < {depth}; index = index + 1) begin\n            enable = 1; address = index;\n            \
         #1 clock = 1; #1 clock = 0;\n            enable = 0; address = {depth} - 1 - index;\n            \
         #1 clock = 1; #1 clock = 0;\n            $display(\"%h\", data);\n        end\n        $finish;\n    end\nendmodule\n"
    )
    .expect("a string");
    fs::write(folder.path().join("bench.v"), bench).expect("writable");
    let mut compiler = icarus();
    compiler.args(["-g2005", "-o", "bench", "-s", "bench", "bench.v", "sptfra_rom.v", "sptfra_ram.v"]);
    let compiled = compiler.current_dir(&folder).output().expect("starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = icarus_runtime().args(["-n", "bench"]).current_dir(&folder).output();
    let said = String::from_utf8_lossy(&ran.expect("starts").stdout).into_owned();
    let read: Vec<u128> = said.lines().filter_map(|line| u128::from_str_radix(line, 16).ok()).collect();
    assert_eq!(read.len(), depth, "{said}");
    assert!(read == words, "a word is another one's");
}
