//! The memory with two ports: its words, and what it answers where it must not be asked.

use std::fs;

use tempfile::TempDir;

use crate::support::{icarus, icarus_runtime, library_file};

/// Reads old words, a word in the cycle that writes it, it again, and one held without an enable.
const BENCH: &str = "module bench;
    reg clock = 0;
    reg write_enable = 0, read_enable = 0;
    reg [2:0] write_address = 0, read_address = 0;
    reg [6:0] write_data = 0;
    wire [6:0] read_data;
    sptfra_ram #(.WIDTH(7), .DEPTH(5), .ADDRESS_WIDTH(3)) ram (.clock(clock), .write_enable(write_enable),
        .write_address(write_address), .write_data(write_data), .read_enable(read_enable), .read_address(read_address),
        .read_data(read_data));
    task turn(input write, input [2:0] to, input [6:0] data, input read, input [2:0] from);
        begin
            {write_enable, write_address, write_data, read_enable, read_address} = {write, to, data, read, from};
            #1 clock = 1;
            #1 clock = 0;
        end
    endtask
    initial begin
        turn(1, 3, 7'h15, 0, 0);
        turn(1, 4, 7'h2a, 0, 3);
        turn(0, 3, 7'h7f, 1, 3);
        $display(\"read %h\", read_data);
        turn(1, 2, 7'h33, 1, 4);
        $display(\"read %h\", read_data);
        turn(1, 3, 7'h61, 1, 3);
        $display(\"read %h\", read_data);
        turn(1, 4, 7'h01, 0, 4);
        $display(\"read %h\", read_data);
        turn(0, 0, 0, 1, 3);
        $display(\"read %h\", read_data);
        turn(0, 0, 0, 1, 4);
        $display(\"read %h\", read_data);
        $finish;
    end
endmodule
";

/// What the bench reads, from a memory with a change.
fn read(simulation: bool, right: &str, wrong: &str) -> Vec<u32> {
    let folder = TempDir::new().expect("a folder");
    let text = fs::read_to_string(library_file("sptfra_ram")).expect("a module");
    assert!(text.contains(right), "{right}");
    fs::write(folder.path().join("ram.v"), text.replace(right, wrong)).expect("writable");
    fs::write(folder.path().join("bench.v"), BENCH).expect("writable");
    let mut compiler = icarus();
    compiler.args(["-g2005", "-o", "bench", "-s", "bench", "bench.v", "ram.v"]);
    if simulation {
        compiler.arg("-DSIMULATION");
    }
    let compiled = compiler.current_dir(&folder).output().expect("starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = icarus_runtime().args(["-n", "bench"]).current_dir(&folder).output();
    let said = String::from_utf8_lossy(&ran.expect("starts").stdout).into_owned();
    said.lines().filter_map(|line| u32::from_str_radix(line.strip_prefix("read ")?, 16).ok()).collect()
}

#[test]
fn a_word_read_as_it_is_written_is_the_old_ones_complement() {
    let right = [0x15, 0x2a, !0x15 & 0x7f, !0x15 & 0x7f, 0x61, 0x01];
    assert_eq!(read(true, "", ""), right);
    // What is synthesised has no such rule.
    assert_eq!(read(false, "", ""), [0x15, 0x2a, 0x15, 0x15, 0x61, 0x01]);
    // A memory without it, or with it elsewhere, would let a design use such a word.
    for (part, other) in [
        ("~memory[read_address]", "memory[read_address]"),
        ("~memory[read_address]", "write_data"),
        ("~memory[read_address]", "~write_data"),
        ("write_enable && (write_address", "(write_address"),
        ("write_enable && (write_address == read_address)", "write_enable"),
        ("if (read_enable) begin", "begin"),
    ] {
        assert_ne!(read(true, part, other), right, "{part} as {other}");
    }
}
