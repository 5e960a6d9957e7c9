//! Yosys' cells by block: modules with parameters have other names there, one for each set of values.

use std::fs;
use std::process::Command;

use serde_json::Value;
use testbench::tools;

/// Two blocks of the library, one of them there twice with a small one inside, beside registers of the top's own.
const LIBRARY: &str = "
module sptfra_stage #(parameter WIDTH = 1) (input wire clock, input wire [WIDTH-1:0] x, output reg [WIDTH-1:0] y);
    always @(posedge clock) y <= x;
endmodule
module sptfra_bz #(parameter WIDTH = 1) (input wire clock, input wire [WIDTH-1:0] x, output wire [WIDTH-1:0] y);
    wire [WIDTH-1:0] between;
    sptfra_stage #(.WIDTH (WIDTH)) first (.clock(clock), .x(x), .y(between));
    sptfra_stage #(.WIDTH (WIDTH)) second (.clock(clock), .x(between), .y(y));
endmodule
module sptfra_we #(parameter A_PARAMETER_WHOSE_NAME_IS_LONG_ENOUGH_FOR_YOSYS_TO_MAKE_A_HASH_OF_ALL_OF_IT = 1) (
    input wire clock, input wire [17:0] a, input wire [26:0] b, output reg [44:0] y);
    reg signed [17:0] left;
    reg signed [26:0] right;
    always @(posedge clock) begin
        left <= a; right <= b; y <= left * right;
    end
endmodule
module small (input wire clock, input wire [26:0] x, output reg [44:0] y);
    wire [8:0] low;
    wire [17:0] high;
    wire [44:0] product;
    sptfra_bz #(.WIDTH (9)) one (.clock(clock), .x(x[8:0]), .y(low));
    sptfra_bz #(.WIDTH (18)) two (.clock(clock), .x(x[26:9]), .y(high));
    sptfra_we #(.A_PARAMETER_WHOSE_NAME_IS_LONG_ENOUGH_FOR_YOSYS_TO_MAKE_A_HASH_OF_ALL_OF_IT (2)) three
        (.clock(clock), .a(high), .b({3{low}}), .y(product));
    always @(posedge clock) y <= product;
endmodule
";

const METADATA: &str = r#"{ "top": "small", "design_hash": "0", "predicted": { "dsp": 1, "bram36": 0.0, "blocks": [
    { "name": "Bz", "modules": ["sptfra_bz", "sptfra_fold"], "dsp": 0, "bram36": 0.0 },
    { "name": "We", "modules": ["sptfra_we"], "dsp": 1, "bram36": 0.0 } ] } }"#;

#[test]
fn modules_of_the_library_count_for_their_block_whatever_their_parameters() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    for (name, contents) in [("library.v", LIBRARY), ("metadata.json", METADATA)] {
        fs::write(place(name), contents).expect("writable");
    }
    let script = "read_verilog -defer library.v; synth_xilinx -family xcup -noiopad -noclkbuf -top small; \
                  tee -o stat.json stat -json";
    let made = tools::yosys().expect("installed").args(["-q", "-p", script]).current_dir(&folder).output();
    let made = made.expect("starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let statistics = fs::read_to_string(place("stat.json")).expect("written");
    assert!(statistics.contains("$paramod\\\\sptfra_bz\\\\WIDTH") && statistics.contains("$paramod$"), "{statistics}");

    let counted = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .arg("cells")
        .args(["small.toml".into(), folder.path().to_owned(), place("stat.json")])
        .arg("--json")
        .output()
        .expect("starts");
    let cells: Value = serde_json::from_slice(&counted.stdout).expect("JSON");
    let found = |kind: &str| [0, 1, 2].map(|block| cells["blocks"][block]["yosys"][kind].as_u64().expect("a count"));
    assert_eq!(found("dsp"), [0, 1, 0], "{cells:#}");
    let [bz, _, rest] = found("ff");
    assert_eq!([bz, rest], [2 * (9 + 18), 45], "{cells:#}");
}
